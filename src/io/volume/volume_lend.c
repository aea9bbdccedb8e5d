/* volume_lend.c - lends the cells of a volume mesh to whoever judges them. */
#include "io/volume/volume_document.h"
#include "mesh/cell_list.h"

static uint64_t count(const mesh_document *document)
{
    return ffd_volume_of(document)->cells.count;
}

static uint64_t count_volumes(const mesh_document *document)
{
    return ffd_volume_of(document)->cells.volumes;
}

static cell_view get(const mesh_document *document, uint64_t index)
{
    const volume_cells *const cells = &ffd_volume_of(document)->cells;
    const size_t cell = (size_t)index;
    cell_view view = {.number = cells->kinds[cell]};
    if (ffd_cell_kind(view.number)->dimension == 3)
        view.words = ffd_cell_words(cells, cell, &view.count);
    return view;
}

static const double *positions(const mesh_document *document, bool results)
{
    const file_document *const file = &ffd_volume_of(document)->file;
    return results && file->new_positions ? file->new_positions : file->positions;
}

const mesh_cell_calls ffd_volume_cell_calls = {count, count_volumes, get, positions, ffd_volume_sides};
