/* pool.h - the workers of a batch: which job each does, and how it ended. */
#ifndef FFD_BATCH_POOL_H
#define FFD_BATCH_POOL_H

#include "batch/manifest/job_words.h"
#include "batch/row_array.h"
#include "batch/wire.h"

typedef struct pool_desc {
    int workers;        /* jobs at once; 0: one a processor */
    int threads;        /* of a job; 0: what the others leave it */
    double timeout;     /* seconds that a job may take; 0: any */
    const char *origin; /* the name of the manifest, for messages */
    bool records, resume, dry, depfile, report, quality, stable, quiet, verbose, measure, count; /* as in
                                                                                                  wire_task */
    const row_array *rows; /* of the jobs' positions, or NULL */
    const shown_box *box;  /* that all jobs share, or NULL */
} pool_desc;

typedef enum task_state {
    TASK_WAITS,   /* all files that it writes are known */
    TASK_NEW,     /* its worker has a look first at what it writes beside its output, and copies with it */
    TASK_LOOKED,  /* there is such a file: its turn comes when the files of all before it are known */
    TASK_ORDERED, /* its output is not claimed yet; it waits likewise if its name is not that of a mesh */
    TASK_RUNS,
    TASK_ENDED,
    TASK_DROPPED
} task_state;

/* A job on its way through the pool. */
typedef struct pool_task {
    batch_job job;
    uint64_t number;    /* in the run, from 0 */
    hash128 target;     /* which file its output is */
    hash128 mesh;       /* of the name of its input: a worker goes on with the one that it has */
    bool is_large;      /* the input: it is left to one worker */
    bool has_mesh_name; /* the output */
    job_record record;  /* before: of the last time, where has_record; afterwards: of this time, likewise */
    bool has_record;
    byte_buffer figures; /* likewise: of the run that made the output, as JSON, ended by 0; or empty */
    task_state state;
    char *picture;            /* its path; NULL: none is wanted */
    const char *picture_name; /* the part of it below the folder of pictures */
    bool looks;               /* while it runs: begun when it was new */
    size_t beside;            /* that a look has found: files beside the output; */
    byte_buffer copied;       /* and files that may be copied, each path ended by 0 */
    bool was_returned;        /* by a worker that had ended before it could take it */
    bool noted;               /* what its end means at once was seen to */
    bool took_row;            /* its worker may have written to it */
    /* Once it has ended: */
    wire_outcome outcome;
    bool has_picture; /* it is there, of this job */
    bool has_mesh_state;
    hash128 mesh_state; /* as wire_answer's state */
    byte_buffer log;    /* lines for people */
    byte_buffer rule;   /* of the depfile; or the files of a measured mesh */
    shown_box box;      /* of a measured mesh */
    uint64_t vertices;  /* of a mesh whose vertices were to be counted */
    byte_buffer entry;  /* of the report; empty where no worker has made it */
    ffd_error failure;  /* of a job whose worker ended, or that was not valid from the start */
} pool_task;

typedef struct worker_pool worker_pool;

/* Makes a pool without workers: they are started when there are tasks. desc's texts must outlive it.
   Errors: FFD_E_MEMORY. */
ffd_status ffd_pool_create(const pool_desc *desc, worker_pool **pool, ffd_error *error);
/* Gives waiting and new tasks, which are listed in their order with gaps (NULL), to idle workers. Errors: no
   worker can be started. */
ffd_status ffd_pool_assign(worker_pool *pool, pool_task *const *tasks, size_t count, ffd_error *error);
/* Waits until a task has ended, at most for this many seconds, and takes note of what has happened. */
void ffd_pool_wait(worker_pool *pool, double seconds);
/* The number of tasks that run. */
size_t ffd_pool_running(const worker_pool *pool);
/* What the jobs have cost beyond themselves. */
typedef struct pool_counts {
    uint64_t workers; /* that were given jobs */
    share_counts jobs;
} pool_counts;
/* Returns the counts so far. */
pool_counts ffd_pool_counts(const worker_pool *pool);
/* Gives running tasks a moment to finish, then ends the others as failures. */
void ffd_pool_stop(worker_pool *pool);
/* Ends the workers. Sets *pool to NULL; it may be NULL before. */
void ffd_pool_destroy(worker_pool **pool);

/* Whether a task has not begun, but for a look. */
bool ffd_task_is_pending(const pool_task *task);
/* Whether all files that a task writes are known, or there will be none. */
bool ffd_task_is_settled(const pool_task *task);
/* Frees a task with its job and texts. */
void ffd_task_free(pool_task *task);

#endif
