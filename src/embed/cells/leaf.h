/* leaf.h - the one root of a region. */
#ifndef FFD_EMBED_CELLS_LEAF_H
#define FFD_EMBED_CELLS_LEAF_H

#include "embed/cells/point_search.h"

/* C - x and F's derivatives at t of a region; the derivatives are by t. */
void ffd_search_evaluate_in(point_search *search, const cell_region *region, const double t[3], sample *at);

/* Records the root at t, whose sample is `at`. */
void ffd_search_record(point_search *search, const cell_region *region, const double t[3], const sample *at,
                       bool singular);
/* What is known of an iteration that stands still at t, whose sample is `at`: neither a root nor a proof that
   there is none. */
void ffd_search_stall(point_search *search, const cell_region *region, const double t[3], const sample *at,
                      root *stall);
/* Whether t is a root as far as numbers can tell: C misses the point by no more than the tolerance and what
   the rounding of u,v,w moves it by. */
bool ffd_search_admits(const point_search *search, const cell_region *region, const double t[3],
                       const sample *at);
/* Finds the region's root or shows that it has none. Returns false if the iteration stands still without
   either; *stall says where. */
bool ffd_search_region(point_search *search, const cell_region *region, root *stall);

#endif
