/* moves.h - moves of control points. */
#ifndef FFD_LATTICE_MOVES_H
#define FFD_LATTICE_MOVES_H

#include "lattice/shapes.h"
#include "lattice/spec.h"

/* Applies the spec's moves to lattice->deformed and its difference; units of the box are those of region.
   Errors: FFD_E_INVALID at the move. */
ffd_status ffd_moves_apply(const lattice_spec *spec, const rest_region *region, ffd_lattice *lattice,
                           ffd_error *error);

#endif
