/* affine.h - u,v,w where C is an affine map: one product with the inverse matrix (src/maths.md 5). */
#ifndef FFD_EMBED_DIRECT_AFFINE_H
#define FFD_EMBED_DIRECT_AFFINE_H

#include "embed/frame/frame.h"

/* Whether the rest lattice is an affine map of the domain; fills locator->affine. */
bool ffd_affine_detect(ffd_locator *locator);
/* Finds p, with the origin subtracted; fills uvw, residual and status of *location. */
void ffd_affine_find(const ffd_locator *locator, const double p[3], ffd_location *location);

#endif
