/* tile_misses.h - how many vertices of a tile miss the lattice by very little. */
#ifndef FFD_JOB_PASS_TILE_MISSES_H
#define FFD_JOB_PASS_TILE_MISSES_H

#include "job/pass/tile.h"

/* Finds those of the visible vertices outside of the only lattice that miss it by next to nothing, if they
   are left where they are. Call it before the selected vertices are spread over the tile. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_tile_find_misses(const pass_tile *tile, ffd_error *error);

#endif
