/* separable.h - u,v,w if x depends only on u, y on v, and z on w: three monotone curves (src/maths.md 5). */
#ifndef FFD_EMBED_DIRECT_SEPARABLE_H
#define FFD_EMBED_DIRECT_SEPARABLE_H

#include "embed/frame/frame.h"

/* Sets *found to whether the rest lattice is separable and monotone, and fills locator->curves. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_separable_detect(ffd_locator *locator, bool *found, ffd_error *error);
/* Frees the curves. */
void ffd_separable_free(ffd_locator *locator);
/* Finds u,v,w of p, which is relative to the origin; fills uvw, residual and status of *location. */
void ffd_separable_find(const ffd_locator *locator, const double p[3], ffd_location *location);

#endif
