/* chain_boxes.h - bounding boxes of a chain's lattices. */
#ifndef FFD_JOB_CHAIN_CHAIN_BOXES_H
#define FFD_JOB_CHAIN_CHAIN_BOXES_H

#include "job/chain/chain.h"

/* Returns a box outside of which a fitted link moves nothing: the bounds of its control points, widened by
   the falloff if it extends. */
bounds ffd_chain_reach(const lattice_chain *chain, size_t link);

/* Makes the boxes of a chain of several lattices, and for blocks the tree over them. All must be fitted.
   Errors: FFD_E_MEMORY. */
ffd_status ffd_chain_boxes(lattice_chain *chain, ffd_error *error);

#endif
