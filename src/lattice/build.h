/* build.h - makes a lattice from its spec. */
#ifndef FFD_LATTICE_BUILD_H
#define FFD_LATTICE_BUILD_H

#include "lattice/spec.h"

/* Makes the lattice: knots, control points, moves. min, max are the bounds of the mesh for SPEC_BOX_MESH;
   without them (NULL) such a lattice gets only its knots. Errors name the file and the position in it. On
   success the lattice owns the spec; on failure the spec is still the caller's. */
ffd_status ffd_spec_build(lattice_spec *spec, const double *min, const double *max, ffd_lattice **lattice,
                          ffd_error *error);

#endif
