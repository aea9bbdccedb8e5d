/* acceptance.h - checks u,v,w from a stored embedding: are they as accurate as a search requires
   (src/maths.md 6.4, 6.6)? */
#ifndef FFD_EMBED_ACCEPTANCE_H
#define FFD_EMBED_ACCEPTANCE_H

#include "embed/frame/frame.h"

/* Returns whether ffd_locator_find_near can have found this location (u,v,w in the domain, with residual) for
   the point at xyz: the residual is at most the tolerance plus the change of C by rounding u,v,w; on the
   border plus rounding (3 numbers, or NULL) and snap. Because evaluations differ by rounding, a few times the
   tolerance is allowed. Thread-safe. */
bool ffd_locator_accepts(const ffd_locator *locator, const double xyz[3], const ffd_location *location,
                         const double *rounding, double snap);

#endif
