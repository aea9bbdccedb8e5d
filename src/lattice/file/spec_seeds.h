/* spec_seeds.h - records which numbers of the moves come from which placeholders: the seeds of forward
   differentiation with respect to placeholders. */
#ifndef FFD_LATTICE_FILE_SPEC_SEEDS_H
#define FFD_LATTICE_FILE_SPEC_SEEDS_H

#include "lattice/spec.h"
#include "json/json_reader.h"

/* A placeholder in the file: its value in the tree, its variable and its factor. */
typedef struct spec_origin {
    uint32_t value;
    size_t variable;
    double factor;
} spec_origin;

/* All zeros: empty. Free origins with ffd_free. */
typedef struct spec_origins {
    spec_origin *origins; /* sorted by ascending value */
    size_t count, capacity;
} spec_origins;

/* Adds a placeholder and, if its name is new, a variable with the numbers of tree, which are not multiplied
   by the factor. Errors: FFD_E_MEMORY. */
ffd_status ffd_spec_add_origin(const json_file *file, spec_origin origin, const char *name,
                               const json_tree *tree, lattice_spec *spec, spec_origins *origins);

/* Makes the seeds from the numbers that were read from placeholders. Errors: FFD_E_INVALID at a placeholder
   that is not numeric or selects control points, FFD_E_MEMORY. */
ffd_status ffd_spec_make_seeds(const json_file *file, const spec_origins *origins, lattice_spec *spec);

#endif
