/* tangents.h - the derivatives of a lattice's control points by the placeholders of its moves. */
#ifndef FFD_LATTICE_TANGENT_TANGENTS_H
#define FFD_LATTICE_TANGENT_TANGENTS_H

#include "lattice/lattice.h"
#include "lattice/spec.h"

/* The derivatives: one column for each number of each variable of the spec, in order. */
typedef struct lattice_tangents {
    size_t columns;
    double *points;  /* 3 for each control point, column by column */
    double *weights; /* of the deformed weights: one for each control point, column by column; NULL: all 0 */
} lattice_tangents;

/* Computes the derivatives by forward differentiation through the moves. The lattice must have control
   points, and its spec must have been read with settings that request derivatives. If a derivative does not
   exist (the centre of a falloff at a control point, two points that share the extreme position), a one-sided
   one is given. The caller frees *tangents, also after a failure. Errors: FFD_E_INVALID (a drag
   after an exact bend with a placeholder), FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_lattice_tangents_find(const ffd_lattice *lattice, lattice_tangents *tangents,
                                     ffd_error *error);
/* Frees the derivatives and empties the struct. */
void ffd_lattice_tangents_free(lattice_tangents *tangents);

/* Returns the number of columns of a spec. */
size_t ffd_spec_column_count(const lattice_spec *spec);
/* Returns the full name of a column, NULL: out of memory. It is not shortened, as two columns may share a
   long prefix. */
char *ffd_spec_column_name(const spec_variable *variable, size_t component);

#endif
