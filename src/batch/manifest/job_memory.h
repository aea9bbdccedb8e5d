/* job_memory.h - how much memory a job of a batch may take. */
#ifndef FFD_BATCH_MANIFEST_JOB_MEMORY_H
#define FFD_BATCH_MANIFEST_JOB_MEMORY_H

#include "batch/manifest/job_words.h"

/* Returns the memory budget of a job in bytes (mesh/memory_budget.h), by its option --memory and the sizes of
   its files. Buffers that a .gltf names are not counted, because only a worker reads it. draws: the job makes
   a picture too. */
uint64_t ffd_job_memory(const batch_job *job, bool draws);

#endif
