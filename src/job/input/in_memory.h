/* in_memory.h - registers what a description holds in memory under paths (base/file/memory_files.h), in a
   copy of the description, so that all other code can read and write it like files. */
#ifndef FFD_JOB_INPUT_IN_MEMORY_H
#define FFD_JOB_INPUT_IN_MEMORY_H

#include "base/file/memory_files.h"
#include <ffd/job.h>

/* The resolve callback of one mesh; its memory files use it until they are freed. */
typedef struct memory_callback memory_callback;

/* Capacity for the name of a lattice without one. */
#define LATTICE_NAME 40

/* All zeros: nothing is in memory. */
typedef struct job_memory {
    memory_files *files;
    memory_callback *callbacks;
    ffd_lattice_source *lattices; /* with names, */
    char (*names)[LATTICE_NAME];  /* of those that the caller gives none */
    ffd_log_function log;         /* the caller's log, with its context */
    void *log_user;
} job_memory;

/* If the source has bytes, registers them and sets its path. */
ffd_status ffd_in_memory_source(job_memory *memory, ffd_source *source, ffd_error *error);
/* If there are bytes, registers them and sets *path. Their name is *path, or `name` if that is NULL. */
ffd_status ffd_in_memory_bytes(job_memory *memory, ffd_bytes bytes, const char *name, const char **path,
                               ffd_error *error);
/* Checks a lattice that may be in memory, whose name is its path, or `name` if that is NULL. what: for
   messages. */
ffd_status ffd_in_memory_lattice(ffd_lattice_source *lattice, const char *what, const char *name,
                                 ffd_error *error);
/* If there is a sink, checks the name of an output that is not NULL. */
ffd_status ffd_in_memory_output(ffd_sink_function sink, const char *output, ffd_error *error);
/* Replaces the log by one that puts the caller's names in place of the paths, and passes lines on. */
void ffd_in_memory_log(job_memory *memory, ffd_log_function *log, void **user);
/* Applies all of these to a job's description. Refuses options that need files. */
ffd_status ffd_in_memory_desc(job_memory *memory, ffd_deform_desc *desc, ffd_error *error);

/* Returns the job's status, or that of a resolve callback that failed. Puts the caller's names in place of
   the paths in error. */
ffd_status ffd_in_memory_judge(const job_memory *memory, ffd_status status, ffd_error *error);
/* Frees the registered paths. */
void ffd_in_memory_end(job_memory *memory);

#endif
