/* cell_volume.h - the sign of the lattice's volume, and cells that have none. */
#ifndef FFD_EMBED_CELLS_CELL_VOLUME_H
#define FFD_EMBED_CELLS_CELL_VOLUME_H

#include "embed/cells/cells.h"

/* Finds volume_sign; FFD_E_INVALID where a cell has no volume. */
ffd_status ffd_cells_look_at_volume(const ffd_locator *locator, ffd_error *error);

#endif
