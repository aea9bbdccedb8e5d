/* point_rounding.h - what a point of a run stands for, and what a volume may miss it by therefore. */
#ifndef FFD_JOB_CHAIN_POINT_ROUNDING_H
#define FFD_JOB_CHAIN_POINT_ROUNDING_H

#include "job/chain/chain.h"

/* Fills half with how far the cell of a point reaches: zeros where rounding is NULL. The others as in
   chain_rounding. */
static inline void ffd_rounding_find(const chain_rounding *rounding, size_t point, bool is_first,
                                     const double x[3], double half[3])
{
    for (int a = 0; a < 3; a++)
        half[a] = 0;
    if (rounding)
        rounding->find(rounding->context, point, is_first, x, half);
}

/* Looks again at a point of the run, at x, that is outside of the link's volume: within its rounding, or the
   snap, *location becomes the nearest point of the border. is_first: x is where the file has the point.
   Errors: FFD_E_MEMORY. */
ffd_status ffd_retry_near_border(const chain_link *link, double snap, bool is_first, const chain_run *run,
                                 size_t point, const double x[3], ffd_location *location, ffd_error *error);

/* Finds how far a point outside of the link's volume misses it; see ffd_near_border_miss. */
ffd_status ffd_link_miss(const chain_link *link, const double x[3], double reach, double *miss,
                         bool *searched, ffd_error *error);

/* Whether the location of a point, which is at x as the file has it, is one that a search of the link can
   have found, where it comes from a file instead: one that is inside or multiple meets x within the tolerance
   by which it was accepted. rounding as in chain_run. */
bool ffd_recalled_meets(const chain_link *link, const chain_rounding *rounding, size_t point,
                        const double x[3], const ffd_location *location);

#endif
