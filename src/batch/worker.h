/* worker.h - the side of a batch that does jobs, one at a time: a process of its own. */
#ifndef FFD_BATCH_WORKER_H
#define FFD_BATCH_WORKER_H

#include <ffd/job.h>

/* What the program makes of a job's words. */
typedef struct worker_program {
    /* Fills desc from the words of `ffd deform`, count of them, without OUT where no mesh is written; what it
       lends is freed by close. NULL after a failure, which is said in error. */
    void *(*open)(int count, char **words, bool has_output, ffd_deform_desc *desc, ffd_error *error);
    void (*close)(void *opened);
} worker_program;

/* Whether this process was started as a worker, by the name that it was given. */
bool ffd_worker_is(const char *name);
/* Does jobs until there are no more. Returns the exit code of the process. */
int ffd_worker_run(const worker_program *program);

#endif
