/* leaf_subdivision.h - a leaf without a contraction bound, halved for one point. */
#ifndef FFD_EMBED_CELLS_LEAF_SUBDIVISION_H
#define FFD_EMBED_CELLS_LEAF_SUBDIVISION_H

#include "embed/cells/point_search.h"

/* Looks for the point in a hard leaf, which is halved for this point alone. */
void ffd_search_hard_leaf(point_search *search, const cell_leaf *leaf);
/* Looks for the point in a region in which the iteration stood still, halved likewise: smaller parts can tell
   whether they hold it. */
void ffd_search_part(point_search *search, const cell_region *region);

#endif
