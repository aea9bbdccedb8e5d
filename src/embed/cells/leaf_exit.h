/* leaf_exit.h - decides on a region in which the iteration stalls: next to a face, in a thin or steep lattice
   (src/maths.md 6.4). */
#ifndef FFD_EMBED_CELLS_LEAF_EXIT_H
#define FFD_EMBED_CELLS_LEAF_EXIT_H

#include "embed/cells/point_search.h"

/* Handles an iteration that stalls at t, whose sample is `at`: finds the root next to t, or that the region
   has none. Returns false if neither succeeds; *stall says where. */
bool ffd_search_end(point_search *search, const cell_region *region, double t[3], sample *at, root *stall);

#endif
