/* spec_seeds.h - which numbers of moves come from which placeholders: what derivatives by these start from.
 */
#ifndef FFD_LATTICE_FILE_SPEC_SEEDS_H
#define FFD_LATTICE_FILE_SPEC_SEEDS_H

#include "lattice/spec.h"
#include "json/json_reader.h"

/* A placeholder of the file: its value in the tree, the variable that it stands for, and its factor. */
typedef struct spec_origin {
    uint32_t value;
    size_t variable;
    double factor;
} spec_origin;

/* All zeros: empty. Free origins with ffd_free. */
typedef struct spec_origins {
    spec_origin *origins; /* by ascending value */
    size_t count, capacity;
} spec_origins;

/* Adds a placeholder, and, where its name is new, the variable with the numbers of tree, which is without the
   factor. Errors: FFD_E_MEMORY. */
ffd_status ffd_spec_add_origin(const json_file *file, spec_origin origin, const char *name,
                               const json_span *tree, lattice_spec *spec, spec_origins *origins);

/* Makes the seeds of what was read from the placeholders. Errors: FFD_E_INVALID at a placeholder that is not
   a number or selects points, FFD_E_MEMORY. */
ffd_status ffd_spec_make_seeds(const json_file *file, const spec_origins *origins, lattice_spec *spec);

#endif
