/* recalled.h - u,v,w that come from a file instead of a search. */
#ifndef FFD_JOB_CHAIN_RECALLED_H
#define FFD_JOB_CHAIN_RECALLED_H

#include "job/chain/chain.h"

/* Whether the location of a point, which is at x as the file has it, is one that a search of the link can
   have found: one that is inside or multiple meets x within the tolerance by which it was accepted. rounding
   as in chain_run. */
bool ffd_recalled_meets(const chain_link *link, const chain_rounding *rounding, size_t point,
                        const double x[3], const ffd_location *location);

#endif
