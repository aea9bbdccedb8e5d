/* near_border.h - points that are outside of the volume by at most their rounding or snap: they count as
   inside, at the nearest point of the border (src/maths.md 6.6). */
#ifndef FFD_EMBED_NEAR_BORDER_H
#define FFD_EMBED_NEAR_BORDER_H

#include "embed/frame/frame.h"

/* Examines again those of count points that have no u,v,w, and fills the locations of those within the
   allowance of the border. Errors: FFD_E_MEMORY. */
ffd_status ffd_near_border_find(const ffd_locator *locator, const double *xyz, size_t count,
                                const ffd_border_allowance *allowance, ffd_location *locations,
                                ffd_error *error);

/* The same for one point without u,v,w, with an early exit far from the volume. half: half sides of the
   rounding cell of the point; snap: world units. */
ffd_status ffd_near_border_retry(const ffd_locator *locator, const double x[3], const double half[3],
                                 double snap, ffd_location *location, ffd_error *error);

/* Finds how far a point outside of the volume is from its border: infinite where that is more than reach. A
   snap of this distance makes it inside. *searched: that took a search, which may be slow. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_near_border_miss(const ffd_locator *locator, const double p[3], double reach, double *miss,
                                bool *searched, ffd_error *error);

#endif
