/* pass_shapes.h - the morph targets of a tile. */
#ifndef FFD_JOB_PASS_PASS_SHAPES_H
#define FFD_JOB_PASS_PASS_SHAPES_H

#include "job/pass/tile.h"

/* Deforms the morph targets of a tile. Call it last: scratch holds the base's displacements and gradients in
   the file's space, and its deformed normals and tangents. Errors: those of ffd_chain_apply. */
ffd_status ffd_tile_shapes(const pass_tile *tile, ffd_error *error);

#endif
