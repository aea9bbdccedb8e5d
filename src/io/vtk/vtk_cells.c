/* vtk_cells.c - the cells of a VTK file of the legacy format: a list of sizes and points, from version 5 on
   offsets and a connectivity. */
#include "base/system/deadline.h"
#include "io/vtk/vtk_reader.h"
#include <inttypes.h>
#include <string.h>

/* Moves past count numbers. */
static ffd_status take_wholes(vtk_reader *r, number_type type, uint64_t count, vtk_wholes *wholes)
{
    text_word word;
    *wholes = (vtk_wholes){!r->is_binary, type, r->scan, count};
    if (r->is_binary) {
        const size_t size = ffd_type_size(type);
        wholes->scan.at = ffd_vtk_binary(r);
        if ((uint64_t)(r->scan.last - wholes->scan.at) / size < count)
            return VTK_REFUSE(r, "the file ends within %" PRIu64 " numbers of cells", count);
        r->scan.at = wholes->scan.at + count * size;
        return FFD_OK;
    }
    for (uint64_t i = 0; i < count; i++) {
        TRY(ffd_deadline_check_at((size_t)i, r->error));
        TRY(ffd_vtk_word(r, "a number of cells", &word));
    }
    return FFD_OK;
}

/* Takes the next of them. */
static ffd_status next_whole(vtk_reader *r, vtk_wholes *wholes, uint64_t *value)
{
    text_word word = {"", ""};
    if (wholes->count == 0)
        return VTK_REFUSE(r, "the cells have more points than their list");
    wholes->count--;
    if (wholes->is_text) {
        if (ffd_text_find(&wholes->scan) && ffd_text_word(&wholes->scan, &word) &&
            ffd_text_whole(word, value))
            return FFD_OK;
        return ffd_fail_line(r->error, FFD_E_INVALID, r->d->file.name, wholes->scan.line,
                             "\"%s\" is not a point or a number of points", ffd_text_shown(word).text);
    }
    const bool is_whole = ffd_type_load_whole(wholes->type, true, wholes->scan.at, value);
    wholes->scan.at += ffd_type_size(wholes->type);
    return is_whole ? FFD_OK : VTK_REFUSE(r, "a point or a number of points of a cell is below 0");
}

static ffd_status take_array(vtk_reader *r, const char *keyword, uint64_t count, vtk_wholes *wholes)
{
    const vtk_type *type;
    text_word word;
    TRY(ffd_vtk_word(r, keyword, &word));
    if (!ffd_text_is(word, keyword))
        return VTK_REFUSE(r, "\"%s\" is not %s", ffd_text_shown(word).text, keyword);
    TRY(ffd_vtk_type(r, &type));
    if (type->special || number_is_real(type->type))
        return VTK_REFUSE(r, "%s are not whole numbers", keyword);
    return take_wholes(r, type->type, count, wholes);
}

/* Takes the two counts behind a keyword, and the lists. */
static ffd_status take_lists(vtk_reader *r, uint64_t *cells, vtk_wholes *sizes, vtk_wholes *points)
{
    uint64_t count, size;
    TRY(ffd_vtk_count(r, "a number of cells", &count));
    TRY(ffd_vtk_count(r, "the size of the list of cells", &size));
    *cells = count;
    if (!r->has_offsets)
        return take_wholes(r, NUMBER_INT32, size, points);
    *cells = count ? count - 1 : 0;
    TRY(take_array(r, "OFFSETS", count, sizes));
    return take_array(r, "CONNECTIVITY", size, points);
}

/* Takes the number of points of the next cell. *offset: where it begins in the connectivity. */
static ffd_status next_size(vtk_reader *r, vtk_wholes *sizes, vtk_wholes *points, uint64_t *offset,
                            uint64_t *size)
{
    uint64_t end;
    if (!r->has_offsets)
        return next_whole(r, points, size);
    TRY(next_whole(r, sizes, &end));
    if (end < *offset)
        return VTK_REFUSE(r, "the offset %" PRIu64 " of a cell is below the one before it, %" PRIu64, end,
                          *offset);
    *size = end - *offset;
    *offset = end;
    return FFD_OK;
}

static ffd_status add_cell(vtk_reader *r, vtk_wholes *points, uint64_t size, uint64_t kind)
{
    uint64_t point;
    for (uint64_t i = 0; i < size; i++) {
        TRY(next_whole(r, points, &point));
        TRY(ffd_cells_word(&r->d->cells, point < UINT32_MAX ? (uint32_t)point : UINT32_MAX, r->error));
    }
    const size_t line = points->is_text ? points->scan.line : 0;
    return ffd_volume_at_line(
        r->d, line, ffd_cells_end(&r->d->cells, kind, r->d->file.part.vertex_count, r->error), r->error);
}

/* The kind of a cell of polygonal data with so many points. */
static uint64_t kind_of(text_word keyword, uint64_t size)
{
    if (ffd_text_is(keyword, "VERTICES"))
        return size == 1 ? CELL_VERTEX : CELL_POLY_VERTEX;
    if (ffd_text_is(keyword, "LINES"))
        return size == 2 ? CELL_LINE : CELL_POLYLINE;
    if (ffd_text_is(keyword, "TRIANGLE_STRIPS"))
        return CELL_STRIP;
    return size == 3 ? CELL_TRIANGLE : size == 4 ? CELL_QUAD : CELL_POLYGON;
}

/* keyword: NULL for an unstructured grid, whose cells have kinds. */
static ffd_status add_cells(vtk_reader *r, const text_word *keyword, uint64_t cells, vtk_wholes sizes,
                            vtk_wholes points)
{
    uint64_t offset = 0, size, kind;
    if (r->has_offsets && sizes.count)
        TRY(next_whole(r, &sizes, &offset));
    if (offset)
        return VTK_REFUSE(r, "the first offset of the cells is %" PRIu64 ", not 0", offset);
    for (uint64_t c = 0; c < cells; c++) {
        TRY(ffd_deadline_check_at((size_t)c, r->error));
        TRY(next_size(r, &sizes, &points, &offset, &size));
        kind = keyword ? kind_of(*keyword, size) : 0;
        if (!keyword)
            TRY(next_whole(r, &r->kinds, &kind));
        TRY(add_cell(r, &points, size, kind));
    }
    return points.count == 0
               ? FFD_OK
               : VTK_REFUSE(r, "the list of cells has %" PRIu64 " more numbers than the cells", points.count);
}

static ffd_status take_polygons(vtk_reader *r, text_word keyword)
{
    vtk_wholes sizes = {0}, points;
    uint64_t cells;
    TRY(take_lists(r, &cells, &sizes, &points));
    if (!r->has_points)
        return VTK_REFUSE(r, "%s are there before POINTS", ffd_text_shown(keyword).text);
    return add_cells(r, &keyword, cells, sizes, points);
}

static ffd_status take_grid(vtk_reader *r)
{
    if (r->has_cells)
        return VTK_REFUSE(r, "there are CELLS twice");
    r->has_cells = true;
    return take_lists(r, &r->cell_count, &r->sizes, &r->points);
}

static ffd_status take_kinds(vtk_reader *r)
{
    uint64_t count;
    if (r->has_kinds)
        return VTK_REFUSE(r, "there are CELL_TYPES twice");
    r->has_kinds = true;
    TRY(ffd_vtk_count(r, "the number of CELL_TYPES", &count));
    return take_wholes(r, NUMBER_INT32, count, &r->kinds);
}

ffd_status ffd_vtk_cells(vtk_reader *r, text_word keyword, bool *taken)
{
    static const char *const of_polydata[] = {"VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS"};
    *taken = true;
    for (size_t i = 0; i < 4 && r->dataset == VTK_POLYDATA; i++)
        if (ffd_text_is(keyword, of_polydata[i]))
            return take_polygons(r, keyword);
    if (r->dataset == VTK_UNSTRUCTURED && ffd_text_is(keyword, "CELLS"))
        return take_grid(r);
    if (r->dataset == VTK_UNSTRUCTURED && ffd_text_is(keyword, "CELL_TYPES"))
        return take_kinds(r);
    *taken = false;
    return FFD_OK;
}

ffd_status ffd_vtk_end_cells(vtk_reader *r)
{
    const uint64_t points = r->d->file.part.vertex_count, *const n = r->dimensions;
    if (r->dataset == VTK_STRUCTURED) {
        if (!r->has_dimensions)
            return VTK_REFUSE(r, "the structured grid has no DIMENSIONS");
        /* Each is at most 8 times the size of the file, so that two of them make no more than 2^64. */
        if (n[0] > points || n[1] > points || n[0] * n[1] > points || n[2] > points ||
            n[0] * n[1] * n[2] != points)
            return VTK_REFUSE(r,
                              "there are %" PRIu64 " points, but the dimensions are %" PRIu64 " by %" PRIu64
                              " by %" PRIu64,
                              points, n[0], n[1], n[2]);
        return ffd_cells_grid(&r->d->cells, 0, n, r->error);
    }
    if (r->dataset != VTK_UNSTRUCTURED || !r->has_cells)
        return FFD_OK;
    if (!r->has_kinds || r->kinds.count != r->cell_count)
        return VTK_REFUSE(r, "there are %" PRIu64 " cells, but %" PRIu64 " CELL_TYPES", r->cell_count,
                          r->has_kinds ? r->kinds.count : 0);
    return add_cells(r, NULL, r->cell_count, r->sizes, r->points);
}
