/* pool.h - the worker processes of a batch: assigns jobs to them and takes their results. */
#ifndef FFD_BATCH_POOL_H
#define FFD_BATCH_POOL_H

#include "batch/manifest/batch_job.h"
#include "batch/wire.h"

typedef struct pool_desc {
    int workers;         /* number of processes; 0: one for each processor, as far as memory allows */
    const char *program; /* whose processes they are; NULL: this one */
    int threads;         /* of each job; 0: an equal share of the processors */
    double timeout;      /* limit of a job in seconds; 0: none */
    const char *origin;  /* name of the manifest, for messages */
    const char *journal; /* path of the journal; NULL: none */
    const char *base;    /* folder that its names are relative to; NULL with no journal */
    task_wishes wishes;
    bool draws;            /* jobs make pictures too */
    const row_array *rows; /* array of positions, or NULL */
    const shown_box *box;  /* shared box, or NULL */
} pool_desc;

typedef enum task_state {
    TASK_WAITS, /* ready to run: all files that it writes are known */
    TASK_NEW,   /* ready to run, but its worker must first scan for files beside and copied with its output */
    TASK_SCANNED, /* such files were found: it waits until the files of all earlier jobs are known */
    TASK_ORDERED, /* its output is not claimed yet; it waits likewise, unless the output has the ending of a
                     mesh format */
    TASK_RUNS,
    TASK_ENDED,
    TASK_DROPPED
} task_state;

/* A job of the batch, from reading to its end. */
typedef struct pool_task {
    batch_job job;
    uint64_t index;         /* in the run, from 0 */
    hash128 target;         /* of its output in the journal */
    hash128 picture_target; /* the journal's key for the picture */
    hash128 drawn_as;       /* hash of what the picture showed when it was drawn, if order.has_drawn */
    hash128 mesh;           /* hash of the input's name: a worker prefers the mesh that it has */
    bool is_large;          /* the input is large: only one worker may read it */
    uint64_t memory;        /* bytes that it may take; 0: the pool has not asked yet */
    bool has_mesh_name;     /* the output has the ending of a mesh format */
    task_order order;
    task_end end;
    task_state state;
    char *picture;            /* path; NULL: none is wanted */
    const char *picture_name; /* part of that path below the folder of pictures */
    char *page;               /* path, which has the picture's folder; NULL: none is wanted */
    bool is_made;             /* the job has ended, but for its picture (run_frames.h): */
    bool is_refused;          /* by a gate */
    size_t told;              /* bytes of the log that were printed */
    uint32_t frame_mesh;      /* number of the mesh among those that have frames */
    const char *own_frame;    /* why the picture has another frame than those of the other jobs; or NULL */
    bool scanned_in_vain;     /* the scan found nothing */
    bool is_learned;          /* ffd_run_learn knows that */
    bool has_scanned;         /* the results of a scan are here: */
    byte_buffer found;        /* end.sidecars, and what else it found (scan.h) */
    byte_buffer passed;       /* names that the output must not take (ffd_claims_others) */
    bool was_returned;        /* a worker had ended before it could take the task */
    bool noted;               /* its end was handled (ffd_run_note_ends) */
    /* After the end: the texts of the answer, or empty. The figures are those of the journal's record before,
       and stay if the output is up to date. */
    FOR_EACH_ANSWER_TEXT(ANSWER_TEXT_BUFFER)
    ffd_error failure; /* of a job whose worker died, or that was invalid from the start */
} pool_task;

typedef struct worker_pool worker_pool;

/* Makes a pool. Workers are started when there are tasks. The texts of desc must outlive it. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_pool_create(const pool_desc *desc, worker_pool **pool, ffd_error *error);
/* Assigns ready tasks to idle workers. tasks: in the order of the jobs; entries may be NULL. Errors: no
   worker can be started. */
ffd_status ffd_pool_assign(worker_pool *pool, pool_task *const *tasks, size_t count, ffd_error *error);
/* Waits at most this many seconds for a worker's answer, or until a descriptor can be read (negative: none),
   and handles what has happened. */
void ffd_pool_wait(worker_pool *pool, int input, double seconds);
/* Returns the number of running tasks. */
size_t ffd_pool_running(const worker_pool *pool);
/* Statistics for --verbose. */
typedef struct pool_counts {
    uint64_t workers; /* number of workers used */
    cache_counts jobs;
} pool_counts;
/* Returns the counts so far. */
pool_counts ffd_pool_counts(const worker_pool *pool);
/* That a task had to wait for memory: the control group (cgroup.h) has too little for one more. */
typedef struct pool_shortage {
    uint64_t limit, needed; /* bytes: of the group; that the task may take */
    int running, processors;
    char name[256]; /* of the task's mesh, for messages */
} pool_shortage;
/* Returns the first shortage; NULL: there was none. */
const pool_shortage *ffd_pool_shortage(const worker_pool *pool);
/* Gives running tasks a moment to finish, then fails the others. */
void ffd_pool_stop(worker_pool *pool);
/* Ends the workers and sets *pool to NULL, which it may be already. */
void ffd_pool_destroy(worker_pool **pool);

/* Whether a task has not run, except for a scan. */
bool ffd_task_is_pending(const pool_task *task);
/* Whether all files that a task writes are known, or it writes none. */
bool ffd_task_is_settled(const pool_task *task);
/* Frees a task with its job and texts. */
void ffd_task_free(pool_task *task);

#endif
