/* wire.h - messages between a batch and its workers. Both are the same program on the same machine, so
   structs are sent as they are in memory. */
#ifndef FFD_BATCH_WIRE_H
#define FFD_BATCH_WIRE_H

#include "base/memory/hash.h"
#include "base/system/process.h"
#include "batch/files/claims.h"
#include "batch/row_array.h"
#include "batch/task_look.h"
#include "job/chain/job_cache.h"
#include "job/input/shown_box.h"
#include "view/view_frame.h"
#include <stdint.h>

/* argv[0] of a worker process. */
#define WORKER_NAME "ffd batch worker"

/* Hashes of a finished job's inputs and outputs. */
typedef struct job_record {
    hash128 inputs, outputs;
} job_record;

/* What all tasks of a pool ask for. */
typedef struct task_wishes {
    bool records;            /* make a record (task_end) */
    bool resume;             /* keep outputs that are up to date, replace others */
    bool dry;                /* dry run: write nothing */
    bool depfile;            /* make the depfile rule */
    bool report;             /* make the report entry, */
    bool quality;            /* with figures of quality, */
    bool stable;             /* without times */
    bool of_table;           /* values of placeholders are in columns of a table */
    bool quiet;              /* log no warnings */
    bool verbose;            /* log details too */
    bool measure;            /* only measure the mesh's box, and list its files if depfile is set */
    bool count;              /* only count the mesh's vertices */
    bool result;             /* answer with the result of the job */
    bool reports_empty_scan; /* tell at once that a scan has found nothing */
    bool frames;             /* only measure the frames of pictures: orders to draw them follow */
} task_wishes;

/* What one task asks for besides. */
typedef struct task_order {
    job_record record; /* of the last time, if has_record */
    hash128 drawn;     /* bytes of the picture that was drawn then, if has_drawn */
    bool has_record, has_drawn;
    bool draws; /* only draw the picture of a job that has ended, whose inputs are those of record */
    bool has_frame;
    view_frame frame;   /* if has_frame: to draw with, or what was measured when the picture was drawn */
    bool scans;         /* first scan the files of the job (scan.h), */
    claim_needs needs;  /* and of them these */
    bool only_scans;    /* answer after the scan, whatever it finds */
    bool surveys;       /* likewise, and scan the models of the folder of the output */
    bool is_unsurveyed; /* scan these models when a file beside the output would be replaced */
} task_order;

typedef enum task_outcome { OUTCOME_DONE, OUTCOME_SKIPPED, OUTCOME_FAILED } task_outcome;

/* How a task has ended. */
typedef struct task_end {
    task_outcome outcome;
    job_record record;   /* if has_record */
    hash128 drawn;       /* bytes of the picture, with those of its page, if has_drawn */
    view_frame frame;    /* of the picture, if has_frame */
    hash128 state;       /* of the mesh's files, if has_state (job_cache.h) */
    cache_counts counts; /* of this job */
    shown_box box;       /* of a measured mesh */
    uint64_t vertices;   /* if only vertices were counted */
    uint64_t sidecars;   /* after a scan: number of files beside the output */
    bool has_record, has_drawn, has_frame, has_state;
    bool dry_run_done; /* dry run: everything except writing was done */
    bool has_picture;  /* it exists and shows this job, and so does the page, if one is wanted */
    bool took_row;     /* the row may have been written to */
    bool own_box;      /* a lattice's box was laid round the job's mesh */
} task_end;

/* A task for a worker, followed by its texts: the settings of the job (ffd_settings_write), and each
   terminated by 0 the path of the mesh, the names of the manifest, of the input and of the output (empty: no
   mesh is written), the paths of the picture, of the page, of the array of positions and of the journal
   (empty: none), the animation that the picture shows (empty: none), the folder that the names in the journal
   are relative to, what was logged of the job before, and passed_count pairs of texts as ffd_claims_others
   fills them. */
typedef struct wire_task {
    uint64_t text_size;
    uint64_t line, row; /* of the job */
    hash128 content;    /* likewise */
    task_wishes wishes;
    task_look look;
    task_order order;
    row_array rows; /* array of positions, if has_row; without its path */
    shown_box box;  /* shared box, if has_box */
    uint32_t passed_count;
    int32_t threads;
    bool dry_run_job; /* dry run: do everything except writing */
    bool has_row, has_box;
} wire_task;

/* What the journal is to note of a copy beside an output. */
typedef struct copy_note {
    hash128 target, content; /* its key (ffd_journal_copy_key), and the hash of its bytes */
} copy_note;

/* The texts that follow an answer, in this order: X(NAME) for each. Workers and tasks have a buffer for each.
   `rule` is the rule of the depfile; of a measured mesh its files, each terminated by 0; after a scan what
   was found (scan.h). `log` has messages, each with its line break, `entry` that of the report. `figures` are
   those of the job, as JSON terminated by 0; `result` is its ffd_job_result, and one for each of its morph
   targets. `outputs` has the names of its outputs for the report, `targets` their paths for the depfile, each
   terminated by 0; `copies` the notes of copies (copy_note). */
#define FOR_EACH_ANSWER_TEXT(X) X(rule) X(log) X(entry) X(figures) X(result) X(outputs) X(targets) X(copies)

#define ANSWER_TEXT_BUFFER(name) byte_buffer name;
#define ANSWER_TEXT_ONE(name) +1
enum { ANSWER_TEXTS = 0 FOR_EACH_ANSWER_TEXT(ANSWER_TEXT_ONE) };

/* An answer of a worker, followed by its texts. */
typedef struct wire_answer {
    uint64_t sizes[ANSWER_TEXTS]; /* of the texts */
    task_end end;
    bool scanned;       /* the scan found files, and nothing else was done */
    bool goes_on;       /* the scan found nothing: the answer has no more yet */
    bool retires;       /* the worker ends: send no more tasks */
    bool out_of_memory; /* memory ran out for the answer, so the job failed and there are no texts */
} wire_answer;

/* Larger lengths are invalid. */
#define WIRE_MOST ((uint64_t)1 << 28)

#endif
