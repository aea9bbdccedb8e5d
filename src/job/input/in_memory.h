/* in_memory.h - what a description has in memory gets paths (base/file/memory_files.h) in a copy of the
   description, so that all else reads and writes it like files. */
#ifndef FFD_JOB_INPUT_IN_MEMORY_H
#define FFD_JOB_INPUT_IN_MEMORY_H

#include "base/file/memory_files.h"
#include <ffd/job.h>

/* The callbacks of one mesh, which files have until they end. */
typedef struct memory_callback memory_callback;

/* Zeroed: nothing is in memory. */
typedef struct job_memory {
    memory_files *files;
    memory_callback *callbacks;
    const char **lattices;
    ffd_log_function log; /* the caller's */
    void *log_user;
} job_memory;

/* Gives the mesh of a source a path, if it has bytes. */
ffd_status ffd_in_memory_source(job_memory *memory, ffd_source *source, ffd_error *error);
/* Gives bytes, if there are any, a path under the name that *path is, or this one. */
ffd_status ffd_in_memory_bytes(job_memory *memory, ffd_bytes bytes, const char *name, const char **path,
                               ffd_error *error);
/* Makes an output that is not NULL one of the sink, if there is one. */
ffd_status ffd_in_memory_output(job_memory *memory, ffd_sink_function sink, void *user, const char **output,
                                ffd_error *error);
/* Puts a log before the caller's that knows the names of what is in memory. */
void ffd_in_memory_log(job_memory *memory, ffd_log_function *log, void **user);
/* All of these for the description of a job, and refuses what is for files only. */
ffd_status ffd_in_memory_desc(job_memory *memory, ffd_deform_desc *desc, ffd_error *error);

/* The status of the job, or that of a resolve function. Puts the names of what is in memory into the error.
 */
ffd_status ffd_in_memory_judge(const job_memory *memory, ffd_status status, ffd_error *error);
/* Frees the paths. */
void ffd_in_memory_end(job_memory *memory);

#endif
