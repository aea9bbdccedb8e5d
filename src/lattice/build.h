/* build.h - makes a lattice from its spec. */
#ifndef FFD_LATTICE_BUILD_H
#define FFD_LATTICE_BUILD_H

#include "lattice/moves.h"
#include "lattice/spec.h"
#include <stdint.h>

/* Bytes that the lattice of a spec takes, with what is searched in it where that is in closed form: for its
   knots, and for its control points. No more than 2^34; known before they are taken. */
uint64_t ffd_spec_knot_bytes(const lattice_spec *spec);
/* The same for the control points, those that the spec itself holds included. */
uint64_t ffd_spec_point_bytes(const lattice_spec *spec);

/* Makes the lattice: knots, control points, moves. min, max are the bounds of the mesh for SPEC_BOX_MESH;
   without them (NULL) such a lattice gets only its knots, as any does from ffd_spec_build_knots. Errors name
   the file and the position in it. On success the lattice owns the spec; on failure the spec is still the
   caller's. */
ffd_status ffd_spec_build(lattice_spec *spec, const double *min, const double *max, ffd_lattice **lattice,
                          ffd_error *error);

/* Applies the moves of a lattice that has its control points once more, for somebody who sees them. */
ffd_status ffd_lattice_replay(const ffd_lattice *lattice, const move_observer *observer, ffd_error *error);

/* Makes a lattice that has only its knots. */
ffd_status ffd_spec_build_knots(lattice_spec *spec, ffd_lattice **lattice, ffd_error *error);

#endif
