/* overlaps.h - detects blocks whose volumes overlap, where they may only share faces. */
#ifndef FFD_JOB_CHAIN_OVERLAPS_H
#define FFD_JOB_CHAIN_OVERLAPS_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"

/* Warns of overlapping blocks, and names one pair. Does nothing for other chains. Boxes with the same axes
   are always found; other blocks by sample places near the middle, edges and corners of their faces, looked
   up in each other. All lattices must be fitted. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_overlaps_warn(const lattice_chain *chain, const mesh_log *log, ffd_error *error);

#endif
