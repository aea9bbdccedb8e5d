/* pass_shapes.h - the morph targets of a tile. */
#ifndef FFD_JOB_PASS_PASS_SHAPES_H
#define FFD_JOB_PASS_PASS_SHAPES_H

#include "job/pass/tile.h"

/* Deforms the part's morph targets, after all else of the tile: the base's points, and its normals and
   tangents as they are deformed, are in scratch. A failure is noted there, and stops the pass. */
void ffd_tile_shapes(part_work *part, tile_scratch *scratch, size_t first, size_t count, pass_totals *totals);

#endif
