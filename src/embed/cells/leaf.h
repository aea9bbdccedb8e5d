/* leaf.h - finds the only root of a region. */
#ifndef FFD_EMBED_CELLS_LEAF_H
#define FFD_EMBED_CELLS_LEAF_H

#include "embed/cells/point_search.h"

/* Finds the root of a region, or proves that it has none. Returns false if the iteration stalls without
   either; *stall says where. */
bool ffd_search_region(point_search *search, const cell_region *region, root *stall);

#endif
