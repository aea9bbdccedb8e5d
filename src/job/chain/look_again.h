/* look_again.h - a point whose rounding cell or snap reaches a lattice's volume counts as inside. */
#ifndef FFD_JOB_CHAIN_LOOK_AGAIN_H
#define FFD_JOB_CHAIN_LOOK_AGAIN_H

#include "job/chain/chain.h"

/* Tests a point of the run, at x, that the search found to be outside of the link's volume. If the border is
   within its rounding cell or the snap, *location becomes the nearest border point. is_first: x is the
   position in the file. Errors: FFD_E_MEMORY. */
ffd_status ffd_look_again(const chain_link *link, double snap, bool is_first, const chain_run *run,
                          size_t point, const double x[3], ffd_location *location, ffd_error *error);

#endif
