/* blocks.h - lattices side by side (--blocks): all act on the points at rest, and each point is in one of
   them. */
#ifndef FFD_JOB_CHAIN_BLOCKS_H
#define FFD_JOB_CHAIN_BLOCKS_H

#include "job/chain/chain.h"

/* Sends the points through the chain's links side by side: the first one that holds a point has it, which the
   run's owners say; a point in none of them is extended from the nearest border of all, where the chain
   extends. On a face of its block a point is looked for in the others too: those that move it otherwise are
   counted (chain_run). The chain's boxes must be there (ffd_chain_boxes). */
ffd_status ffd_blocks_apply(const lattice_chain *chain, chain_run *run, ffd_error *error);

#endif
