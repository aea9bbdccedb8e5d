/* volume_surface.h - the faces of a mesh of cells: those of volumes that no two of them share, and all faces
   that are cells themselves, but for those that are sides of volumes. Points between corners are left out. */
#ifndef FFD_IO_VOLUME_VOLUME_SURFACE_H
#define FFD_IO_VOLUME_VOLUME_SURFACE_H

#include "io/volume/volume_cells.h"
#include "mesh/memory_budget.h"

/* Called for each face, in the order of the cells; those of volumes first. */
typedef void surface_visitor(void *context, const uint32_t *corners, size_t count);

/* Errors: FFD_E_MEMORY, FFD_E_LIMIT (also of the budget), FFD_E_CANCELLED. */
ffd_status ffd_surface_visit(const volume_cells *cells, const memory_budget *budget, surface_visitor *visit,
                             void *context, ffd_error *error);

/* Visits the sides of all volumes, those between two of them from both, and all faces that are cells. Errors:
   FFD_E_CANCELLED. */
ffd_status ffd_sides_visit(const volume_cells *cells, surface_visitor *visit, void *context,
                           ffd_error *error);

#endif
