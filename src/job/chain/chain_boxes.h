/* chain_boxes.h - where the lattices of a chain are. */
#ifndef FFD_JOB_CHAIN_CHAIN_BOXES_H
#define FFD_JOB_CHAIN_CHAIN_BOXES_H

#include "job/chain/chain.h"

/* Returns the box outside of which a link with a fitted lattice moves nothing: the bounds of its control
   points, which hold the volume, widened by how far the link extends. */
bounds ffd_chain_reach(const lattice_chain *chain, size_t link);

/* Makes the boxes of a chain of several lattices, which are fitted, and the tree over them where they act
   side by side. */
ffd_status ffd_chain_boxes(lattice_chain *chain, ffd_error *error);

#endif
