/* leaf_subdivision.h - subdivides hard leaves for a single point. */
#ifndef FFD_EMBED_CELLS_LEAF_SUBDIVISION_H
#define FFD_EMBED_CELLS_LEAF_SUBDIVISION_H

#include "embed/cells/point_search.h"

/* Searches the point in a hard leaf by subdividing it for this point. */
void ffd_search_hard_leaf(point_search *search, const cell_leaf *leaf);
/* Searches the point in the same way in a region in which the iteration stalled: smaller parts can decide
   whether they contain it. */
void ffd_search_part(point_search *search, const cell_region *region);

#endif
