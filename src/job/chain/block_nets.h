/* block_nets.h - whether blocks (lattices side by side) make up one continuous displacement, by the control
   points of their faces. */
#ifndef FFD_JOB_CHAIN_BLOCK_NETS_H
#define FFD_JOB_CHAIN_BLOCK_NETS_H

#include "job/chain/chain.h"

/* Sets *join to whether all blocks are boxes that are connected by common faces, and any two that touch have
   one face in common, with the same control points, knots and weights, and move it alike (to 1e-9 of the
   diagonal). Then no edge between two points of blocks is torn, unless it leads through a gap or along an
   edge that only two of them have in common. False says nothing. Requires ffd_chain_boxes. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_blocks_join(const lattice_chain *chain, bool *join, ffd_error *error);

#endif
