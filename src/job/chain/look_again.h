/* look_again.h - a point that misses a lattice's volume by no more than what it stands for is inside. */
#ifndef FFD_JOB_CHAIN_LOOK_AGAIN_H
#define FFD_JOB_CHAIN_LOOK_AGAIN_H

#include "job/chain/chain.h"

/* Looks again at a point of the run, at x, that is outside of the link's volume: within its rounding, or the
   snap, *location becomes the nearest point of the border. is_first: x is where the file has the point.
   Errors: FFD_E_MEMORY. */
ffd_status ffd_look_again(const chain_link *link, double snap, bool is_first, const chain_run *run,
                          size_t point, const double x[3], ffd_location *location, ffd_error *error);

#endif
