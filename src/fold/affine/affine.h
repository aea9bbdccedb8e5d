/* affine.h - deformations that are one affine map, and cannot fold (src/maths.md 10.1). */
#ifndef FFD_FOLD_AFFINE_AFFINE_H
#define FFD_FOLD_AFFINE_AFFINE_H

#include "lattice/lattice.h"

/* Returns whether the rest volume is a box or a cylinder, and all control points stay, or are moved by one
   affine map of positive determinant, to rounding. Weights may be any, but unmoved. *determinant: that of the
   map, 1 where nothing moves or all move alike; else reduced by what the rounding of the points allows. */
bool ffd_fold_is_affine(const ffd_lattice *lattice, double *determinant);

#endif
