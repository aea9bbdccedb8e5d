/* wire.h - the messages between a batch and its workers. Both are one program on one machine: numbers are
   sent as they are in memory. */
#ifndef FFD_BATCH_WIRE_H
#define FFD_BATCH_WIRE_H

#include "base/memory/hash.h"
#include "base/system/process.h"
#include "job/chain/job_cache.h"
#include "job/input/shown_box.h"
#include <stdint.h>

/* The program's name in argv[0] by which a process knows that it is a worker. */
#define WORKER_NAME "ffd batch worker"

/* What a finished job was made of, and what it made. */
typedef struct job_record {
    hash128 inputs, outputs;
} job_record;

/* To a worker: a task, followed by its texts, each ended by 0: words, content, the name of the manifest,
   the names of input and output (empty: no mesh is written), the paths of the picture and of the array of
   positions (empty: none). */
typedef struct wire_task {
    uint64_t line;     /* of the job */
    job_record record; /* of the last time, where has_record */
    uint64_t text_size;
    uint64_t row, rows, vertices; /* of the array of positions, where has_row */
    uint32_t word_count, content_words;
    int32_t threads;
    bool has_record;
    bool records;  /* records are wanted */
    bool resume;   /* outputs that are up to date stay, others are replaced */
    bool dry;      /* nothing is to be written */
    bool rehearse; /* of a dry run: all is to be done but the writing */
    bool depfile;  /* the rule of a depfile is wanted */
    bool report;   /* the entry of a report is wanted; */
    bool quality;  /* with the figures of quality */
    bool stable;   /* without times */
    bool quiet;    /* no warnings */
    bool verbose;  /* what else there is to say */
    bool measure;  /* only the box of the mesh is wanted, and its files where depfile is set */
    bool count;    /* only the number of the mesh's vertices is wanted */
    bool has_row, is_double;
    bool look; /* what is written beside the output and may be copied with it is wanted first */
    bool has_box;
    shown_box box; /* that all jobs share, where has_box */
} wire_task;

typedef enum wire_outcome { OUTCOME_DONE, OUTCOME_SKIPPED, OUTCOME_FAILED } wire_outcome;

/* From a worker: an answer, followed by its texts. */
typedef struct wire_answer {
    uint64_t log_size;     /* lines for people, each with its line break */
    uint64_t entry_size;   /* of the report */
    uint64_t rule_size;    /* of the depfile; of a measured mesh its files, after a look what may be copied,
                              each ended by 0 */
    uint64_t figures_size; /* of the job, as JSON, ended by 0 */
    job_record record;
    hash128 state;       /* of the files of the mesh, where has_state (job_cache.h) */
    share_counts counts; /* of this job */
    shown_box box;       /* of a measured mesh */
    uint64_t vertices;   /* of a mesh whose vertices were to be counted */
    uint64_t beside;     /* files beside the output, of a look */
    uint8_t outcome;
    bool has_record, has_state;
    bool rehearsed;     /* all was done but the writing */
    bool has_picture;   /* it is there, made now or before */
    bool took_row;      /* it may be replaced */
    bool looked;        /* there is such a file: nothing else was done */
    bool retires;       /* the worker ends, and is to be given nothing more */
    bool out_of_memory; /* so that there are no texts, although the job failed */
} wire_answer;

/* A larger length is not valid. */
#define WIRE_MOST ((uint64_t)1 << 28)

#endif
