/* worker.h - a worker process of a batch, which does one job at a time. */
#ifndef FFD_BATCH_WORKER_H
#define FFD_BATCH_WORKER_H

#include <stdbool.h>

/* Whether the program was started as a worker. name: argv[0]. */
bool ffd_worker_is(const char *name);
/* Does jobs until there are no more. Returns the process's exit code. */
int ffd_worker_run(void);

#endif
