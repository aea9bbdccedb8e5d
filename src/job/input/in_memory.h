/* in_memory.h - what a description holds in memory, in the library's own copy of it: names what has none,
   checks it, and lets callbacks that find files be asked once for each. */
#ifndef FFD_JOB_INPUT_IN_MEMORY_H
#define FFD_JOB_INPUT_IN_MEMORY_H

#include "base/file/memory_files.h"

/* Capacity for the name of a lattice without one. */
#define LATTICE_NAME 40

/* All zeros: nothing is in memory. */
typedef struct job_memory {
    memory_files *files;          /* of each mesh in memory */
    ffd_lattice_source *lattices; /* with names, */
    char (*names)[LATTICE_NAME];  /* of those that the caller gives none */
} job_memory;

/* If the source has bytes, names it and replaces its callback by one that asks the caller's once for each
   file and is never NULL. It finds nothing outside of the mesh's folder. */
ffd_status ffd_in_memory_source(job_memory *memory, ffd_source *source, ffd_error *error);
/* If there are bytes, checks their name *path, which is set to `name` if it is NULL. */
ffd_status ffd_in_memory_bytes(ffd_bytes bytes, const char *name, const char **path, ffd_error *error);
/* Checks a lattice that may be in memory, whose name is its path, or `name` if that is NULL. what: for
   messages. */
ffd_status ffd_in_memory_lattice(ffd_lattice_source *lattice, const char *what, const char *name,
                                 ffd_error *error);
/* If there is a sink, checks the name of an output that is not NULL. */
ffd_status ffd_in_memory_output(ffd_sink_function sink, const char *output, ffd_error *error);
/* Applies all of these to a job's description. Refuses options that need files. */
ffd_status ffd_in_memory_desc(job_memory *memory, ffd_deform_desc *desc, ffd_error *error);

/* Returns status; but if a callback for the files of this mesh, or of one that was added before, has failed,
   that failure. */
ffd_status ffd_in_memory_judge(const ffd_source *source, ffd_status status, ffd_error *error);
/* The same for all meshes. Frees what belongs to the memory. */
ffd_status ffd_in_memory_end(job_memory *memory, ffd_status status, ffd_error *error);

#endif
