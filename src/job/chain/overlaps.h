/* overlaps.h - detects blocks whose volumes overlap, where they may only share faces. */
#ifndef FFD_JOB_CHAIN_OVERLAPS_H
#define FFD_JOB_CHAIN_OVERLAPS_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"

/* Pairs of blocks that overlap: how many, and the lowest pair. */
typedef struct overlap_pairs {
    size_t pairs, first, other;
} overlap_pairs;

/* Finds overlapping blocks; none in other chains. Boxes with the same axes are always found; other blocks by
   sample places near the middle, edges and corners of their faces, looked up in each other. All lattices must
   be fitted. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_overlaps_find(const lattice_chain *chain, overlap_pairs *found, ffd_error *error);
/* Warns of them, and names one pair. */
ffd_status ffd_overlaps_warn(const lattice_chain *chain, const mesh_log *log, ffd_error *error);

#endif
