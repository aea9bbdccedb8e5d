/* tile_totals.h - counts the figures of one tile of a pass. */
#ifndef FFD_JOB_PASS_TILE_TOTALS_H
#define FFD_JOB_PASS_TILE_TOTALS_H

#include "job/pass/tile.h"

/* Counts a tile's selected vertices at rest. Call it after their positions are read. */
void ffd_totals_count_rest(const pass_tile *tile);
/* Counts them after the chain has moved them, and stores the flags for ffd_totals_count_others. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_totals_count_deformed(const pass_tile *tile, ffd_error *error);
/* Counts the vertices of a tile that are not simply inside. Call it after ffd_mesh_mark_used. */
void ffd_totals_count_others(const pass_tile *tile);

#endif
