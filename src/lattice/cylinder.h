/* cylinder.h - control points at rest that fill a cylinder. */
#ifndef FFD_LATTICE_CYLINDER_H
#define FFD_LATTICE_CYLINDER_H

#include "lattice/shapes.h"
#include "lattice/spec.h"

/* Fills points (3*count) with the control points of the spec's cylinder. Errors: FFD_E_INVALID,
   FFD_E_MEMORY. */
ffd_status ffd_shape_cylinder(const ffd_lattice *lattice, const lattice_spec *spec, double *points,
                              ffd_error *error);
/* Sets region to the bounds of the solid cylinder. */
void ffd_shape_cylinder_region(const lattice_spec *spec, rest_region *region);

#endif
