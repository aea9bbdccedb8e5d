/* brick.h - bricks: groups of neighbouring cells that are divided into leaves when a point first needs
   them. */
#ifndef FFD_EMBED_CELLS_BRICK_H
#define FFD_EMBED_CELLS_BRICK_H

#include "embed/cells/cells.h"

/* A cache of bricks that belong to one search, at their index modulo OWN_BRICKS. */
#define OWN_BRICKS 64
typedef struct own_bricks {
    cell_brick *brick[OWN_BRICKS];
    uint32_t index[OWN_BRICKS];
} own_bricks;
/* Frees the cached bricks. */
void ffd_own_bricks_free(own_bricks *own);

/* Computes the hulls of all bricks and builds a tree over them. The bricks are made on demand. */
ffd_status ffd_bricks_create(const ffd_locator *locator, ffd_error *error);
/* Frees the bricks. */
void ffd_bricks_free(cell_search *cells);

/* Finds or makes a brick. It belongs to the locator, or to own until own gets its next brick. Errors:
   FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_cells_brick(const ffd_locator *locator, uint32_t index, own_bricks *own,
                           const cell_brick **brick, ffd_error *error);

#endif
