/* brick.h - a few neighbouring cells, cut into leaves when a point first needs them. */
#ifndef FFD_EMBED_CELLS_BRICK_H
#define FFD_EMBED_CELLS_BRICK_H

#include "embed/cells/cells.h"

/* The bricks that one search made for itself, each at its number modulo the size. */
#define OWN_BRICKS 64
typedef struct own_bricks {
    cell_brick *brick[OWN_BRICKS];
    uint32_t number[OWN_BRICKS];
} own_bricks;
/* Frees what they hold. */
void ffd_own_bricks_free(own_bricks *own);

/* Finds the hulls of all bricks and their tree; bricks themselves are made when they are asked for. */
ffd_status ffd_bricks_create(const ffd_locator *locator, ffd_error *error);
/* Frees them. */
void ffd_bricks_free(cell_search *cells);

/* The brick with this number, made if need be; lent by the locator, or by own until its next brick. Errors:
   FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_cells_brick(const ffd_locator *locator, uint32_t number, own_bricks *own,
                           const cell_brick **brick, ffd_error *error);

#endif
