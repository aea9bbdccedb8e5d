/* build.h - makes a lattice from its spec. */
#ifndef FFD_LATTICE_BUILD_H
#define FFD_LATTICE_BUILD_H

#include "lattice/moves.h"
#include "lattice/spec.h"
#include <stdint.h>

/* Returns the bytes that the knots of a lattice will need, including those of a locator in closed form. Known
   before anything is allocated; at most 2^34. */
uint64_t ffd_spec_knot_bytes(const lattice_spec *spec);
/* The same for the control points, including those in the spec itself. */
uint64_t ffd_spec_point_bytes(const lattice_spec *spec);

/* Makes a lattice: knots, control points, moves. extent: of the mesh for SPEC_BOX_MESH; if NULL, such a
   lattice gets only its knots, as with ffd_spec_build_knots. Errors contain the file and the position
   in it. After success the lattice owns the spec; after a failure the caller still does. */
ffd_status ffd_spec_build(lattice_spec *spec, const fit_extent *extent, ffd_lattice **lattice,
                          ffd_error *error);

/* Applies the moves of a lattice again, for an observer. The lattice must have control points. */
ffd_status ffd_lattice_replay(const ffd_lattice *lattice, const move_observer *observer, ffd_error *error);

/* Makes a lattice with knots but without control points. */
ffd_status ffd_spec_build_knots(lattice_spec *spec, ffd_lattice **lattice, ffd_error *error);

#endif
