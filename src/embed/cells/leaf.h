/* leaf.h - the one root of a region. */
#ifndef FFD_EMBED_CELLS_LEAF_H
#define FFD_EMBED_CELLS_LEAF_H

#include "embed/cells/point_search.h"

/* C - x and F's derivatives at t of a region; the derivatives are by t. */
void ffd_search_evaluate_in(point_search *search, const cell_region *region, const double t[3], sample *at);

/* Records the root at t, whose sample is `at`. */
void ffd_search_record(point_search *search, const cell_region *region, const double t[3], const sample *at,
                       bool singular);
/* Finds the region's root or shows that it has none. */
void ffd_search_region(point_search *search, const cell_region *region);

#endif
