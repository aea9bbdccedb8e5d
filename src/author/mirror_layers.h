/* mirror_layers.h - the reflection that a lattice at rest has along one of its directions. */
#ifndef FFD_AUTHOR_MIRROR_LAYERS_H
#define FFD_AUTHOR_MIRROR_LAYERS_H

#include "lattice/lattice.h"

typedef struct layer_reflection {
    int direction; /* 0 to 2: u, v, w */
    size_t layers, before,
        behind; /* numbers of control points: in the direction, in those before and after it */
    double normal[3], middle[3];
} layer_reflection;

/* Finds it. Errors: FFD_E_ARGUMENT (no such direction), FFD_E_INVALID where the lattice is not symmetric, or
   has no positions yet. */
ffd_status ffd_layer_reflection_make(const ffd_lattice *lattice, int direction, layer_reflection *by,
                                     ffd_error *error);
/* Reflects a displacement. No zero gets a sign. */
void ffd_reflect_vector(const layer_reflection *by, const double from[3], double to[3]);
/* Reflects a place. */
void ffd_reflect_place(const layer_reflection *by, const double from[3], double to[3]);

#endif
