/* recalled.h - validates u,v,w that come from a file instead of a search. */
#ifndef FFD_JOB_CHAIN_RECALLED_H
#define FFD_JOB_CHAIN_RECALLED_H

#include "job/chain/chain.h"

/* Whether a search of the link could have found this location for a point that is at x in the file: if it is
   inside or multiple, it must meet x within the tolerance of acceptance. rounding: as in chain_run. */
bool ffd_recalled_meets(const chain_link *link, const chain_rounding *rounding, size_t point,
                        const double x[3], const ffd_location *location);

#endif
