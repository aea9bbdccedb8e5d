/* blocks.h - lattices side by side (--blocks): all of them act on the points at rest, and each point is in
   one of them. */
#ifndef FFD_JOB_CHAIN_BLOCKS_H
#define FFD_JOB_CHAIN_BLOCKS_H

#include "job/chain/chain.h"

/* Displaces the points of a run by the chain's links as blocks. A point belongs to the first block that holds
   it (chain_scratch.owners). A point in none is extended from the nearest border of all blocks, if the chain
   extends. A point on a face of its block is looked up in the other blocks too, and counted if one of them
   moves it differently (chain_run). Requires ffd_chain_boxes. */
ffd_status ffd_blocks_apply(const lattice_chain *chain, chain_run *run, ffd_error *error);

/* Finds the block of each point of a run and its location there, as ffd_blocks_apply does, and fills no more
   than outcomes. */
ffd_status ffd_blocks_locate(const lattice_chain *chain, chain_run *run, ffd_error *error);

/* Finds the first block that holds p, without a rounding and a snap, and the location there. *block:
   BLOCK_NONE if none does. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_blocks_holding(const lattice_chain *chain, const double p[3], uint32_t *block,
                              ffd_location *location, ffd_error *error);

/* Finds the point of any block's border that is nearest to p, within reach (ffd_boundary_find), and its
   block; of equally near ones, to 1e-12, that of the first block. Errors: FFD_E_MEMORY. */
ffd_status ffd_blocks_nearest(const lattice_chain *chain, const double p[3], double reach,
                              boundary_point *nearest, uint32_t *block, ffd_error *error);

#endif
