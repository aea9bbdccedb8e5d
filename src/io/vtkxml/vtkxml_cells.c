/* vtkxml_cells.c - the cells of a VTK file in XML. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/vtkxml/vtkxml_data.h"
#include <inttypes.h>

/* The numbers of an array of cells. */
typedef struct cell_numbers {
    uint64_t *values, count;
} cell_numbers;

typedef struct cell_reader {
    vtkxml_document *d;
    const vtkxml_piece *piece;
    const vtkxml_cells *list;
    vtkxml_list of;
    cell_numbers arrays[VTKXML_CELL_ARRAYS];
    uint64_t face;  /* the first of the next polyhedron */
    uint64_t sides; /* points of listed faces that polyhedra have named */
    ffd_error *error;
} cell_reader;

#define REFUSE(r, ...)                                                                                       \
    ffd_fail_line((r)->error, FFD_E_INVALID, (r)->d->volume.file.name, (r)->piece->line, __VA_ARGS__)

static bool has(const cell_reader *r, vtkxml_cell_array array)
{
    return r->list->arrays[array].is_there;
}

/* Reads an array of at least so many numbers. */
static ffd_status read_array(cell_reader *r, vtkxml_cell_array array, uint64_t count)
{
    return ffd_vtkxml_wholes(r->d, &r->list->arrays[array], count, &r->arrays[array].values,
                             &r->arrays[array].count, r->error);
}

/* Reads the faces of polyhedra, in the form that is there. */
static ffd_status read_faces(cell_reader *r)
{
    const bool listed = has(r, VTKXML_LISTED_FACES);
    const vtkxml_cell_array first = listed ? VTKXML_LISTED_FACES : VTKXML_FACES;
    const vtkxml_cell_array last = listed ? VTKXML_CELL_FACES_ENDS : VTKXML_FACES_ENDS;
    for (vtkxml_cell_array a = first; a <= last; a++)
        if (!has(r, a))
            return FFD_OK; /* none, or a polyhedron will say that it misses them */
    for (vtkxml_cell_array a = first; a <= last; a++)
        TRY(read_array(r, a, VTKXML_ANY_SIZE));
    return FFD_OK;
}

static ffd_status read_arrays(cell_reader *r)
{
    const uint64_t count = r->list->count;
    const bool has_kinds = r->d->grid == VTKXML_UNSTRUCTURED;
    if (!has(r, VTKXML_CONNECTIVITY) || !has(r, VTKXML_ENDS) || (has_kinds && !has(r, VTKXML_KINDS)))
        return REFUSE(r, "a piece has %" PRIu64 " cells, but not their connectivity, offsets and types",
                      count);
    TRY(read_array(r, VTKXML_ENDS, count));
    if (has_kinds) {
        TRY(read_array(r, VTKXML_KINDS, count));
        TRY(read_faces(r));
    }
    const uint64_t size = r->arrays[VTKXML_ENDS].values[count - 1];
    return read_array(r, VTKXML_CONNECTIVITY, size == UINT64_MAX ? size - 1 : size);
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

/* Adds the number of faces; for each its size and points. */
static ffd_status add_faces(cell_reader *r, uint64_t cell)
{
    const cell_numbers *const faces = &r->arrays[VTKXML_FACES];
    uint64_t at = r->face;
    const uint64_t end = r->face = r->arrays[VTKXML_FACES_ENDS].values[cell];
    if (at >= end || end > faces->count || faces->values[at] > end - at)
        return REFUSE(r, "the faces of polyhedron %" PRIu64 " are not there", cell);
    const uint64_t count = faces->values[at++];
    TRY(ffd_cells_word(&r->d->volume.cells, (uint32_t)count, r->error));
    for (uint64_t f = 0; f < count; f++) {
        const uint64_t size = at < end ? faces->values[at++] : UINT64_MAX;
        if (size > end - at)
            return REFUSE(r, "the faces of polyhedron %" PRIu64 " do not fill its cell", cell);
        TRY(ffd_cells_word(&r->d->volume.cells, (uint32_t)size, r->error));
        for (uint64_t p = 0; p < size; p++)
            TRY(add_point(r, faces->values[at++]));
    }
    return FFD_OK;
}

/* Adds a face of the list: its size and points. */
static ffd_status add_listed_face(cell_reader *r, uint64_t cell, uint64_t face)
{
    const cell_numbers *const points = &r->arrays[VTKXML_LISTED_FACES];
    const cell_numbers *const ends = &r->arrays[VTKXML_LISTED_FACES_ENDS];
    if (face >= ends->count)
        return REFUSE(r, "polyhedron %" PRIu64 " has a face that is not there", cell);
    const uint64_t first = face ? ends->values[face - 1] : 0, end = ends->values[face];
    if (end < first || end > points->count || end - first > UINT32_MAX)
        return REFUSE(r, "the points of face %" PRIu64 " are not there", face);
    /* A face has two sides. A file that names one again and again would take any amount of memory. */
    r->sides += end - first;
    if (r->sides > 2 * points->count)
        return REFUSE(r, "polyhedron %" PRIu64 " has a face that two others have", cell);
    TRY(ffd_cells_word(&r->d->volume.cells, (uint32_t)(end - first), r->error));
    for (uint64_t p = first; p < end; p++)
        TRY(add_point(r, points->values[p]));
    return FFD_OK;
}

/* Adds the number of faces, and these, which are in the list. */
static ffd_status add_listed_faces(cell_reader *r, uint64_t cell)
{
    const cell_numbers *const faces = &r->arrays[VTKXML_CELL_FACES];
    const uint64_t *const ends = r->arrays[VTKXML_CELL_FACES_ENDS].values;
    const uint64_t first = cell ? ends[cell - 1] : 0, end = ends[cell];
    if (end <= first || end > faces->count || end - first > UINT32_MAX)
        return REFUSE(r, "the faces of polyhedron %" PRIu64 " are not there", cell);
    TRY(ffd_cells_word(&r->d->volume.cells, (uint32_t)(end - first), r->error));
    for (uint64_t f = first; f < end; f++)
        TRY(add_listed_face(r, cell, faces->values[f]));
    return FFD_OK;
}

static ffd_status add_polyhedron(cell_reader *r, uint64_t cell)
{
    if (cell < r->arrays[VTKXML_FACES_ENDS].count)
        return add_faces(r, cell);
    if (cell < r->arrays[VTKXML_CELL_FACES_ENDS].count)
        return add_listed_faces(r, cell);
    return ffd_fail_line(r->error, FFD_E_INVALID, r->d->volume.file.name, r->piece->line,
                         "polyhedron %" PRIu64 " has neither faces and faceoffsets nor face_connectivity, "
                         "face_offsets, polyhedron_to_faces and polyhedron_offsets",
                         cell);
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
    const cell_numbers *const points = &r->arrays[VTKXML_CONNECTIVITY];
    const uint64_t *const kinds = r->arrays[VTKXML_KINDS].values;
    const uint64_t end = r->arrays[VTKXML_ENDS].values[cell];
    if (end < first || end > points->count)
        return REFUSE(r, "the offset %" PRIu64 " of cell %" PRIu64 " is not between %" PRIu64 " and %" PRIu64,
                      end, cell, first, points->count);
    const uint64_t kind = kinds ? kinds[cell] : kind_of(r->of, end - first);
    if (kind == CELL_POLYHEDRON)
        TRY(add_polyhedron(r, cell));
    else
        for (uint64_t p = first; p < end; p++)
            TRY(add_point(r, points->values[p]));
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
        TRY_END(add_cell(r, c, c ? r->arrays[VTKXML_ENDS].values[c - 1] : 0));
    }
end:
    for (int a = 0; a < VTKXML_CELL_ARRAYS; a++)
        ffd_free(r->arrays[a].values);
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
