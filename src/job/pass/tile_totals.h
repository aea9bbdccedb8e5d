/* tile_totals.h - counts the figures of one tile of a pass. */
#ifndef FFD_JOB_PASS_TILE_TOTALS_H
#define FFD_JOB_PASS_TILE_TOTALS_H

#include "job/pass/tile.h"

/* Adds up what is known of a tile's chosen vertices before they move: to be called when their
   positions have been read. first: the tile's first vertex in the part. */
void ffd_totals_count_rest(const part_work *work, const tile_scratch *scratch, size_t first,
                           pass_totals *totals);
/* Adds up what is known after the chain has moved them, and notes which ones ffd_totals_count_others is to
 * look at. */
/* Errors: FFD_E_MEMORY. */
ffd_status ffd_totals_count_deformed(const part_work *work, const tile_scratch *scratch, size_t first,
                                     pass_totals *totals, ffd_error *error);
/* Adds up the vertices of a tile that are not simply inside, count of them from the part's vertex first on,
   after ffd_mesh_mark_used. */
void ffd_totals_count_others(const part_work *work, size_t first, size_t count, pass_totals *totals);

#endif
