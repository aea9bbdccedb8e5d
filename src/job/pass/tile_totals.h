/* tile_totals.h - counts the figures of one tile of a pass. */
#ifndef FFD_JOB_PASS_TILE_TOTALS_H
#define FFD_JOB_PASS_TILE_TOTALS_H

#include "job/pass/tile.h"

/* Counts a tile's chosen vertices at rest. Call it after their positions are read. first: the tile's first
   vertex in the part. */
void ffd_totals_count_rest(const part_work *work, const tile_scratch *scratch, size_t first,
                           pass_totals *totals);
/* Counts them after the chain has moved them, and stores the flags for ffd_totals_count_others. */
/* Errors: FFD_E_MEMORY. */
ffd_status ffd_totals_count_deformed(const part_work *work, const tile_scratch *scratch, size_t first,
                                     pass_totals *totals, ffd_error *error);
/* Counts the vertices of a tile that are not simply inside, from vertex `first` of the part on. Call it after
   ffd_mesh_mark_used. */
void ffd_totals_count_others(const part_work *work, size_t first, size_t count, pass_totals *totals);

#endif
