/* acceptance.h - whether u,v,w that no search of this run has found is as near to its point as a search
   demands (src/maths.md 6.4, 6.6). */
#ifndef FFD_EMBED_ACCEPTANCE_H
#define FFD_EMBED_ACCEPTANCE_H

#include "embed/frame/frame.h"

/* Whether location, which has u,v,w in the domain with its residual, is one that ffd_locator_find_near can
   have found for the point at xyz: C(u,v,w) misses it by no more than the tolerance and what the rounding of
   u,v,w moves C by; on the border also by the rounding (3 numbers, or NULL) and the snap. Evaluations differ
   by roundings: a few times the tolerance is allowed. Thread-safe. */
bool ffd_locator_accepts(const ffd_locator *locator, const double xyz[3], const ffd_location *location,
                         const double *rounding, double snap);

#endif
