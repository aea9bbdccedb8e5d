/* affine.h - u,v,w if C is an affine map: a multiplication by the inverse matrix (src/maths.md 5). */
#ifndef FFD_EMBED_DIRECT_AFFINE_H
#define FFD_EMBED_DIRECT_AFFINE_H

#include "embed/frame/frame.h"

/* Returns whether the rest volume is an affine map of the domain, and fills locator->affine. */
bool ffd_affine_detect(ffd_locator *locator);
/* Finds u,v,w of p, which is relative to the origin; fills uvw, residual and status of *location. */
void ffd_affine_find(const ffd_locator *locator, const double p[3], ffd_location *location);

#endif
