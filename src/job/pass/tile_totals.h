/* tile_totals.h - counts the figures of one tile of a pass. */
#ifndef FFD_JOB_PASS_TILE_TOTALS_H
#define FFD_JOB_PASS_TILE_TOTALS_H

#include "job/pass/tile.h"

/* Adds up what is known of a tile's chosen vertices before they move: to be called when their
   positions have been read. first: the tile's first vertex in the part. */
void ffd_totals_count_rest(const part_work *work, const tile_scratch *scratch, size_t first,
                           pass_totals *totals);
/* And after it: when the chain has been through them. */
void ffd_totals_count_deformed(const part_work *work, const tile_scratch *scratch, size_t first,
                               pass_totals *totals);

#endif
