/* pass_shapes.h - the morph targets of a tile. */
#ifndef FFD_JOB_PASS_PASS_SHAPES_H
#define FFD_JOB_PASS_PASS_SHAPES_H

#include "job/pass/tile.h"

/* Deforms the morph targets of a tile. Call it last: scratch holds the base's positions, and its deformed
   normals and tangents. A failure is stored in scratch, and stops the pass. */
void ffd_tile_shapes(part_work *part, tile_scratch *scratch, size_t first, size_t count, pass_totals *totals);

#endif
