/* cell_volume.h - the sign of the lattice's volume, and cells without volume. */
#ifndef FFD_EMBED_CELLS_CELL_VOLUME_H
#define FFD_EMBED_CELLS_CELL_VOLUME_H

#include "embed/cells/cells.h"

/* Computes volume_sign. Errors: FFD_E_INVALID (a cell without volume). */
ffd_status ffd_cells_check_volume(const ffd_locator *locator, ffd_error *error);

#endif
