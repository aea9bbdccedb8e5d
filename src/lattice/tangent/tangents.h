/* tangents.h - the derivatives of a lattice's control points by the placeholders of its moves. */
#ifndef FFD_LATTICE_TANGENT_TANGENTS_H
#define FFD_LATTICE_TANGENT_TANGENTS_H

#include "lattice/lattice.h"
#include "lattice/spec.h"

/* One column for each number of each variable of the spec, in their order. */
typedef struct lattice_tangents {
    size_t columns;
    double *points;  /* 3 a control point, column after column */
    double *weights; /* of the deformed weights: one a control point, column after column; NULL: all 0 */
} lattice_tangents;

/* Finds the derivatives, by forward differentiation through the moves. The lattice's spec was read with
   settings that ask for what comes from placeholders, and has its control points. Where a derivative does not
   exist (a falloff's centre on a control point, two points that share an extreme place) one side's is given.
   Free them after a failure too. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_lattice_tangents_find(const ffd_lattice *lattice, lattice_tangents *tangents,
                                     ffd_error *error);
/* Leaves none. */
void ffd_lattice_tangents_free(lattice_tangents *tangents);

/* The number of columns that a spec has. */
size_t ffd_spec_column_count(const lattice_spec *spec);

#endif
