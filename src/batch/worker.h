/* worker.h - a worker process of a batch, which does one job at a time (ffd_worker_main in ffd/program.h). */
#ifndef FFD_BATCH_WORKER_H
#define FFD_BATCH_WORKER_H

/* The most characters of a build. */
#define WORKER_BUILD 80
/* Writes what a worker and the first process must have in common to understand each other's structs. */
void ffd_worker_build(char build[WORKER_BUILD]);

#endif
