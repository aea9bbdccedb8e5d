/* sidecar.h - the names of the files beside an output: OUT-stem.bin, OUT-stem-1.bin, and so on. */
#ifndef FFD_MESH_RESOURCE_SIDECAR_H
#define FFD_MESH_RESOURCE_SIDECAR_H

#include "mesh/mesh.h"

/* Returns the path of number `index` of these files, from 0; free it with ffd_free. NULL: memory ran out. */
char *ffd_sidecar_name(const char *output, size_t index);

/* State of naming; index and passes are 0 at the start. */
typedef struct sidecar_names {
    const mesh_save_options *options;
    const mesh_log *log;
    bool in_place;   /* the output replaces the input */
    const char *old; /* the file in place that the next name replaces for the output; NULL: none */
    size_t index;    /* of the next name */
    size_t passes;   /* names that were passed over because other models name these files */
} sidecar_names;

/* Whether the output may replace this existing file, as its own. */
typedef bool sidecar_own_function(const void *context, const char *path);

/* Finds the next name: never that of a file which another model names (options->sharing), which is logged,
   and so is `old` if it stays for others.
   Where the output replaces the input, or a name was passed over, nothing may be there but a file of its own.
   own, context: which files in place are that; NULL if not in place. *target: free it with ffd_free. Errors:
   FFD_E_MEMORY, and those of options->sharing. */
ffd_status ffd_sidecar_next(sidecar_names *names, sidecar_own_function *own, const void *context,
                            char **target, ffd_error *error);

#endif
