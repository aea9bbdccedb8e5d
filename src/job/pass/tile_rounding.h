/* tile_rounding.h - what the rounding of results to floats does to a tile (mesh/precision.h). A conversion's
   results are judged by the model that is written. */
#ifndef FFD_JOB_PASS_TILE_ROUNDING_H
#define FFD_JOB_PASS_TILE_ROUNDING_H

#include "job/pass/tile.h"

/* Returns the rounding error of a part's results above which its shape changes, relative to its largest
   side. */
double ffd_part_tolerance(const mesh_document *document);

/* Notes how fine the floats of a tile's positions are before it is displaced. */
void ffd_tile_rounding_at_rest(const pass_tile *tile);

/* Whether floats hold a displacement of the tile: the position of a vertex changes in the output. True too
   where the results are not rounded here. Call it before the vertices are displaced in the file's space. */
bool ffd_tile_shows(const pass_tile *tile);

/* Notes the rounding errors of the results, if they may exceed the tolerance. */
void ffd_tile_rounding_of_results(const pass_tile *tile);

#endif
