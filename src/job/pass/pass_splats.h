/* pass_splats.h - Gaussian splats in a tile of a pass (src/maths.md 9.6). */
#ifndef FFD_JOB_PASS_PASS_SPLATS_H
#define FFD_JOB_PASS_PASS_SPLATS_H

#include "job/pass/tile.h"

/* Finds how directions turn at the tile's vertices, in the file's space. Their gradients must still be in the
   lattice's space. */
void ffd_tile_splat_turns(const pass_tile *tile);

/* Deforms the splats of the tile and writes them. Their gradients must be in the file's space. */
void ffd_tile_splats(const pass_tile *tile);

#endif
