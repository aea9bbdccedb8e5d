/* overlaps.h - lattices side by side whose volumes overlap, though they may share faces only. */
#ifndef FFD_JOB_CHAIN_OVERLAPS_H
#define FFD_JOB_CHAIN_OVERLAPS_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"

/* Warns of blocks that overlap, with the names of two; others are left alone. Boxes with the same axes are
   found wherever they overlap; of others places beside the middles, edges and corners of their faces are
   looked for in each other. All must be fitted. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_overlaps_warn(const lattice_chain *chain, const mesh_log *log, ffd_error *error);

#endif
