/* vtkxml_cells.c - the cells of a VTK file in XML. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/vtkxml/vtkxml_data.h"
#include <inttypes.h>

/* The arrays of a list of cells. */
typedef struct cell_arrays {
    uint64_t *points, *ends, *kinds, *faces, *face_ends;
    uint64_t point_count, end_count, kind_count, face_count, face_end_count;
} cell_arrays;

typedef struct cell_reader {
    vtkxml_document *d;
    const vtkxml_piece *piece;
    const vtkxml_cells *list;
    vtkxml_list of;
    cell_arrays arrays;
    uint64_t face; /* the first of the next polyhedron */
    ffd_error *error;
} cell_reader;

#define REFUSE(r, ...)                                                                                       \
    ffd_fail_line((r)->error, FFD_E_INVALID, (r)->d->volume.file.name, (r)->piece->line, __VA_ARGS__)

static ffd_status read_arrays(cell_reader *r)
{
    const vtkxml_cells *const list = r->list;
    cell_arrays *const a = &r->arrays;
    const bool has_kinds = r->d->grid == VTKXML_UNSTRUCTURED;
    if (!list->connectivity.is_there || !list->offsets.is_there || (has_kinds && !list->types.is_there))
        return REFUSE(r, "a piece has %" PRIu64 " cells, but not their connectivity, offsets and types",
                      list->count);
    TRY(ffd_vtkxml_wholes(r->d, &list->offsets, list->count, &a->ends, &a->end_count, r->error));
    if (has_kinds)
        TRY(ffd_vtkxml_wholes(r->d, &list->types, list->count, &a->kinds, &a->kind_count, r->error));
    if (has_kinds && list->faces.is_there && list->face_offsets.is_there) {
        TRY(ffd_vtkxml_wholes(r->d, &list->faces, VTKXML_ANY_SIZE, &a->faces, &a->face_count, r->error));
        TRY(ffd_vtkxml_wholes(r->d, &list->face_offsets, VTKXML_ANY_SIZE, &a->face_ends, &a->face_end_count,
                              r->error));
    }
    const uint64_t size = a->ends[list->count - 1];
    return ffd_vtkxml_wholes(r->d, &list->connectivity, size == UINT64_MAX ? size - 1 : size, &a->points,
                             &a->point_count, r->error);
}

/* Adds a point of the piece. */
static ffd_status add_point(cell_reader *r, uint64_t point)
{
    if (point == UINT64_MAX)
        return REFUSE(r, "a cell has a point below 0");
    if (point >= r->piece->points)
        return REFUSE(r,
                      "a cell has the point %" PRIu64 ", but its piece has only %" PRIu64 " (counted from 0)",
                      point, r->piece->points);
    return ffd_cells_word(&r->d->volume.cells, (uint32_t)(r->piece->vertex + point), r->error);
}

/* The number of faces; for each its size and points. */
static ffd_status add_polyhedron(cell_reader *r, uint64_t cell)
{
    const cell_arrays *const a = &r->arrays;
    if (cell >= a->face_end_count)
        return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->d->volume.file.name, r->piece->line,
                             "polyhedra are supported with arrays faces and faceoffsets");
    uint64_t at = r->face;
    const uint64_t end = r->face = a->face_ends[cell];
    if (at >= end || end > a->face_count || a->faces[at] > end - at)
        return REFUSE(r, "the faces of polyhedron %" PRIu64 " are not there", cell);
    const uint64_t faces = a->faces[at++];
    TRY(ffd_cells_word(&r->d->volume.cells, (uint32_t)faces, r->error));
    for (uint64_t f = 0; f < faces; f++) {
        const uint64_t size = at < end ? a->faces[at++] : UINT64_MAX;
        if (size > end - at)
            return REFUSE(r, "the faces of polyhedron %" PRIu64 " do not fill its cell", cell);
        TRY(ffd_cells_word(&r->d->volume.cells, (uint32_t)size, r->error));
        for (uint64_t p = 0; p < size; p++)
            TRY(add_point(r, a->faces[at++]));
    }
    return FFD_OK;
}

static uint64_t kind_of(vtkxml_list list, uint64_t size)
{
    switch (list) {
    case VTKXML_VERTS:
        return size == 1 ? CELL_VERTEX : CELL_POLY_VERTEX;
    case VTKXML_LINES:
        return size == 2 ? CELL_LINE : CELL_POLYLINE;
    case VTKXML_STRIPS:
        return CELL_STRIP;
    default:
        return size == 3 ? CELL_TRIANGLE : size == 4 ? CELL_QUAD : CELL_POLYGON;
    }
}

static ffd_status add_cell(cell_reader *r, uint64_t cell, uint64_t first)
{
    const cell_arrays *const a = &r->arrays;
    const uint64_t end = a->ends[cell];
    if (end < first || end > a->point_count)
        return REFUSE(r, "the offset %" PRIu64 " of cell %" PRIu64 " is not between %" PRIu64 " and %" PRIu64,
                      end, cell, first, a->point_count);
    const uint64_t kind = a->kinds ? a->kinds[cell] : kind_of(r->of, end - first);
    if (kind == CELL_POLYHEDRON)
        TRY(add_polyhedron(r, cell));
    else
        for (uint64_t p = first; p < end; p++)
            TRY(add_point(r, a->points[p]));
    return ffd_volume_at_line(
        &r->d->volume, r->piece->line,
        ffd_cells_end(&r->d->volume.cells, kind, r->d->volume.file.part.vertex_count, r->error), r->error);
}

static ffd_status read_list(cell_reader *r)
{
    ffd_status status = FFD_OK;
    if (r->list->count == 0)
        return FFD_OK;
    TRY_END(read_arrays(r));
    for (uint64_t c = 0; c < r->list->count; c++) {
        TRY_END(ffd_deadline_check_at((size_t)c, r->error));
        TRY_END(add_cell(r, c, c ? r->arrays.ends[c - 1] : 0));
    }
end:
    ffd_free(r->arrays.points);
    ffd_free(r->arrays.ends);
    ffd_free(r->arrays.kinds);
    ffd_free(r->arrays.faces);
    ffd_free(r->arrays.face_ends);
    return status;
}

ffd_status ffd_vtkxml_cells(vtkxml_document *d, ffd_error *error)
{
    for (size_t p = 0; p < d->piece_count; p++) {
        const vtkxml_piece *const piece = &d->pieces[p];
        if (d->grid == VTKXML_STRUCTURED)
            TRY(ffd_cells_grid(&d->volume.cells, piece->vertex, piece->size, error));
        for (int l = 0; l < VTKXML_LISTS; l++) {
            cell_reader r = {
                .d = d, .piece = piece, .list = &piece->lists[l], .of = (vtkxml_list)l, .error = error};
            TRY(read_list(&r));
        }
    }
    return FFD_OK;
}
