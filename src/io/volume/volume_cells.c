#include "io/volume/volume_cells.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include <inttypes.h>
#include <string.h>

void ffd_cells_free(volume_cells *cells)
{
    ffd_free(cells->kinds);
    ffd_free(cells->ends);
    ffd_free(cells->words);
    memset(cells, 0, sizeof *cells);
}

ffd_status ffd_cells_word(volume_cells *cells, uint32_t word, ffd_error *error)
{
    if (!ffd_grow((void **)&cells->words, &cells->word_capacity, cells->word_count + 1, sizeof *cells->words))
        return ffd_fail_memory(error);
    cells->words[cells->word_count++] = word;
    return FFD_OK;
}

/* Whether the words are the faces of a polyhedron. */
static bool is_stream(const uint32_t *words, size_t count)
{
    size_t at = 1;
    if (count == 0)
        return false;
    for (uint32_t face = 0; face < words[0]; face++) {
        if (at >= count || words[at] > count - at - 1)
            return false;
        at += 1 + (size_t)words[at];
    }
    return at == count;
}

/* What a check of the points has found. */
typedef struct point_check {
    uint64_t points;
    uint32_t wrong;
    bool is_wrong;
} point_check;

static void check_point(void *context, uint32_t point)
{
    point_check *const check = context;
    if (point < check->points || check->is_wrong)
        return;
    check->is_wrong = true;
    check->wrong = point;
}

static ffd_status check_count(const cell_kind *kind, size_t count, ffd_error *error)
{
    if (kind->points == 0 && count >= cell_corners(kind))
        return FFD_OK;
    return kind->points && count == kind->points
               ? FFD_OK
               : ffd_fail(error, FFD_E_INVALID, "a %s has %zu points, not %s%zu", kind->name, count,
                          kind->points ? "" : "at least ",
                          kind->points ? (size_t)kind->points : cell_corners(kind));
}

ffd_status ffd_cells_end(volume_cells *cells, uint64_t number, uint64_t points, ffd_error *error)
{
    const cell_kind *const kind = ffd_cell_kind(number);
    point_check check = {.points = points};
    if (!kind)
        return ffd_fail(error, FFD_E_UNSUPPORTED, "cells of the type %" PRIu64 " are not supported", number);
    if (!ffd_grow((void **)&cells->kinds, &cells->kind_capacity, cells->count + 1, sizeof *cells->kinds) ||
        !ffd_grow((void **)&cells->ends, &cells->end_capacity, cells->count + 1, sizeof *cells->ends))
        return ffd_fail_memory(error);
    cells->kinds[cells->count] = (uint8_t)number;
    cells->ends[cells->count] = cells->word_count;
    size_t count;
    const uint32_t *const words = ffd_cell_words(cells, cells->count, &count);
    if (number != CELL_POLYHEDRON)
        TRY(check_count(kind, count, error));
    else if (!is_stream(words, count))
        return ffd_fail(error, FFD_E_INVALID, "the faces of a polyhedron do not fill its cell");
    ffd_cell_visit(cells, cells->count, check_point, &check);
    if (check.is_wrong)
        return ffd_fail(error, FFD_E_INVALID,
                        "a %s has the point %" PRIu32 ", but there are only %" PRIu64 " (counted from 0)",
                        kind->name, check.wrong, points);
    cells->count++;
    cells->volumes += kind->dimension == 3;
    return FFD_OK;
}

void ffd_cell_visit(const volume_cells *cells, size_t cell, cell_point_visitor *visit, void *context)
{
    size_t count, at = 0;
    const uint32_t *const words = ffd_cell_words(cells, cell, &count);
    if (cells->kinds[cell] != CELL_POLYHEDRON) {
        for (; at < count; at++)
            visit(context, words[at]);
        return;
    }
    for (at = 1; at < count; at++)
        for (uint32_t left = words[at]; left > 0; left--)
            visit(context, words[++at]);
}

/* Adds the cell at a place of a grid, whose axes of one point are left out. */
static ffd_status add_grid_cell(volume_cells *cells, uint64_t origin, const uint64_t at[3],
                                const uint64_t size[3], ffd_error *error)
{
    static const uint8_t kinds[] = {CELL_VERTEX, CELL_LINE, CELL_QUAD, CELL_HEXAHEDRON};
    static const uint8_t order[8] = {0, 1, 3, 2, 4, 5, 7, 6}; /* bits: a step along each axis */
    const uint64_t steps[3] = {1, size[0], size[0] * size[1]};
    uint64_t along[3];
    size_t dimension = 0;
    for (int a = 0; a < 3; a++)
        if (size[a] > 1)
            along[dimension++] = steps[a];
    const uint64_t first = origin + at[0] + at[1] * steps[1] + at[2] * steps[2];
    for (size_t c = 0; c < (size_t)1 << dimension; c++) {
        uint64_t point = first;
        for (size_t d = 0; d < dimension; d++)
            point += order[c] >> d & 1 ? along[d] : 0;
        TRY(ffd_cells_word(cells, (uint32_t)point, error));
    }
    return ffd_cells_end(cells, kinds[dimension], origin + size[0] * size[1] * size[2], error);
}

ffd_status ffd_cells_grid(volume_cells *cells, uint64_t first, const uint64_t size[3], ffd_error *error)
{
    uint64_t at[3], cell_size[3];
    if (size[0] == 0 || size[1] == 0 || size[2] == 0)
        return FFD_OK; /* the other sizes may be any */
    for (int a = 0; a < 3; a++)
        cell_size[a] = size[a] > 1 ? size[a] - 1 : size[a];
    for (at[2] = 0; at[2] < cell_size[2]; at[2]++)
        for (at[1] = 0; at[1] < cell_size[1]; at[1]++) {
            TRY(ffd_deadline_check(error));
            for (at[0] = 0; at[0] < cell_size[0]; at[0]++)
                TRY(add_grid_cell(cells, first, at, size, error));
        }
    return FFD_OK;
}
