/* cell_list.h - the cells of a volume mesh, in the order of its file. */
#ifndef FFD_MESH_CELL_LIST_H
#define FFD_MESH_CELL_LIST_H

#include "cells/cell_view.h"
#include "mesh/mesh.h"

/* Returns a number of cells. */
typedef uint64_t mesh_count_cells_function(const mesh_document *document);
/* Returns a cell. words is NULL if it is not one of three dimensions. Thread-safe. */
typedef cell_view mesh_get_cell_function(const mesh_document *document, uint64_t cell);
/* Returns the positions that the cells name, 3 numbers each, rounded as they are in the file; or as they will
   be, with the results, if there are any. */
typedef const double *mesh_cell_positions_function(const mesh_document *document, bool results);

struct mesh_cell_calls {
    mesh_count_cells_function *count;   /* of all cells */
    mesh_count_cells_function *volumes; /* of those of three dimensions */
    mesh_get_cell_function *get;
    mesh_cell_positions_function *positions;
    mesh_faces_function *sides; /* of all cells, inside the mesh, too */
};

/* Returns how many volume cells a document has. */
static inline uint64_t ffd_mesh_volumes(const mesh_document *document)
{
    const mesh_cell_calls *const calls = document->format->cells;
    return calls ? calls->volumes(document) : 0;
}

#endif
