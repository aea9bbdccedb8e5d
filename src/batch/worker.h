/* worker.h - a worker process of a batch, which does one job at a time. */
#ifndef FFD_BATCH_WORKER_H
#define FFD_BATCH_WORKER_H

#include <ffd/job.h>

/* How the program turns a job's words into a description. */
typedef struct worker_program {
    /* Fills desc from count words of `ffd deform`, without OUT if no mesh is written. Returns what owns the
       memory that desc borrows, for close; NULL on failure, with error. */
    void *(*open)(int count, char **words, bool has_output, ffd_deform_desc *desc, ffd_error *error);
    void (*close)(void *opened);
} worker_program;

/* Whether the program was started as a worker. name: argv[0]. */
bool ffd_worker_is(const char *name);
/* Does jobs until there are no more. Returns the process's exit code. */
int ffd_worker_run(const worker_program *program);

#endif
