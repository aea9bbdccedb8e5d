/* volume_cells.h - the cells of a mesh, in the order of its file: what joins its points. */
#ifndef FFD_IO_VOLUME_VOLUME_CELLS_H
#define FFD_IO_VOLUME_VOLUME_CELLS_H

#include "base/fail.h"
#include "io/volume/cell_kind.h"

/* All zeros: none. */
typedef struct volume_cells {
    uint8_t *kinds; /* count */
    size_t *ends;   /* count: where the words of each cell end */
    /* The points of each cell. Of a polyhedron: the number of its faces; for each face the number of its
       points, and these. */
    uint32_t *words;
    size_t count, word_count;
    size_t kind_capacity, end_capacity, word_capacity;
    size_t volumes; /* cells of three dimensions */
} volume_cells;

/* Frees the cells and empties the struct. */
void ffd_cells_free(volume_cells *cells);

/* Appends a word to the cell that is next to end. Errors: FFD_E_MEMORY. */
ffd_status ffd_cells_word(volume_cells *cells, uint32_t word, ffd_error *error);
/* Ends a cell with the words since the last one. Fails without a file or line. points: how many the mesh
   has. Errors: FFD_E_INVALID for points that are not there, or not as many as the kind has;
   FFD_E_UNSUPPORTED for a kind that is not known; FFD_E_MEMORY. */
ffd_status ffd_cells_end(volume_cells *cells, uint64_t kind, uint64_t points, ffd_error *error);

static inline const uint32_t *ffd_cell_words(const volume_cells *cells, size_t cell, size_t *count)
{
    const size_t first = cell ? cells->ends[cell - 1] : 0;
    *count = cells->ends[cell] - first;
    return first ? cells->words + first : cells->words; /* NULL without words */
}

/* Receives a point of a cell. */
typedef void cell_point_visitor(void *context, uint32_t point);
/* Visits each point of a cell, also those that are named several times. */
void ffd_cell_visit(const volume_cells *cells, size_t cell, cell_point_visitor *visit, void *context);

/* Adds the cells of a grid of so many points along each axis, whose first point is `first`. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_cells_grid(volume_cells *cells, uint64_t first, const uint64_t size[3], ffd_error *error);

#endif
