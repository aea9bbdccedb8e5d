#include "points/point_cells.h"
#include "base/memory/memory.h"
#include "deform/displacement_cell.h"
#include "deform/extension.h"
#include <string.h>

static const extended_point *extended_of(const ffd_embedding *embedding, size_t point)
{
    size_t first = 0, end = embedding->extended_count;
    while (end - first > 1) {
        const size_t middle = first + (end - first) / 2;
        if (embedding->extended[middle].point <= point)
            first = middle;
        else
            end = middle;
    }
    return embedding->extended + first;
}

/* Adds the points of a list, from those of the lattice's cell on. Returns whether one is on a knot. */
static bool add_points(const ffd_embedding *embedding, const uint32_t *list, const point_cell *cell,
                       point_cells *cells)
{
    const ffd_lattice *const lattice = embedding->rest;
    bool has_knots = false;
    int span[3];
    ffd_displacement_spans(lattice, cell->index, span);
    for (size_t i = 0; i < cell->count; i++) {
        const size_t at = cell->first + i;
        const bool has = ffd_embedding_has(embedding, list[i]);
        const extended_point *const extended = has ? NULL : extended_of(embedding, list[i]);
        double *const uvw = cells->uvw + 3 * at;
        ffd_displacement_wrap(lattice, has ? embedding->uvw + 3 * (size_t)list[i] : extended->nearest.uvw,
                              uvw);
        for (int a = 0; a < 3; a++) {
            const double *const t = lattice->knots[a].t + span[a];
            has_knots = has_knots || uvw[a] <= t[0] || uvw[a] >= t[1];
        }
        cells->which[at] = list[i];
        if (cells->fade)
            cells->fade[at] =
                has ? 1 : ffd_extension_fade(extended->nearest.distance, embedding->falloff, NULL);
    }
    return has_knots;
}

static void add_cell(const ffd_embedding *embedding, const cell_lists *lists, const size_t index[3],
                     point_cells *cells)
{
    const knot_vector *const knots = embedding->rest->knots;
    const size_t key = (index[2] * knots[1].span_count + index[1]) * knots[0].span_count + index[0];
    const size_t count = lists->starts[key + 1] - lists->starts[key];
    if (count == 0)
        return;
    point_cell *const cell = &cells->cells[cells->cell_count++];
    *cell = (point_cell){{index[0], index[1], index[2]}, cells->count, count, false};
    cell->has_knots = add_points(embedding, lists->points + lists->starts[key], cell, cells);
    cells->count += count;
}

static size_t count_cells(const cell_lists *lists)
{
    size_t count = 0;
    for (size_t c = 0; c < lists->cells; c++)
        count += lists->starts[c + 1] > lists->starts[c];
    return count;
}

/* Lists the points without a cell. */
static void add_others(const ffd_embedding *embedding, point_cells *cells)
{
    size_t next = 0;
    for (size_t i = 0; i < embedding->count; i++) {
        const bool is_extended = next < embedding->extended_count && embedding->extended[next].point == i;
        next += is_extended;
        if (!is_extended && !ffd_embedding_has(embedding, i))
            cells->others[cells->other_count++] = (uint32_t)i;
    }
}

/* Returns whether the arrays could be allocated. */
static bool make_arrays(const ffd_embedding *embedding, const cell_lists *lists, point_cells *cells)
{
    const size_t all = lists->starts[lists->cells], others = embedding->count - all;
    const bool fades = embedding->extended_count > 0;
    cells->cells = ffd_alloc(count_cells(lists), sizeof *cells->cells);
    cells->which = ffd_alloc(all, sizeof *cells->which);
    cells->uvw = ffd_alloc(all, 3 * sizeof *cells->uvw);
    cells->fade = fades ? ffd_alloc(all, sizeof *cells->fade) : NULL;
    cells->others = ffd_alloc(others, sizeof *cells->others);
    return cells->cells && cells->which && cells->uvw && cells->others && (cells->fade || !fades);
}

static point_cells *sort_points(const ffd_embedding *embedding)
{
    const knot_vector *const knots = embedding->rest->knots;
    const cell_lists *const lists = ffd_cell_lists(embedding);
    point_cells *const cells = lists ? ffd_alloc_zero(1, sizeof *cells) : NULL;
    if (!cells || !make_arrays(embedding, lists, cells)) {
        ffd_point_cells_destroy(cells);
        return NULL;
    }
    size_t index[3];
    for (index[0] = 0; index[0] < knots[0].span_count; index[0]++)
        for (index[1] = 0; index[1] < knots[1].span_count; index[1]++)
            for (index[2] = 0; index[2] < knots[2].span_count; index[2]++)
                add_cell(embedding, lists, index, cells);
    add_others(embedding, cells);
    return cells;
}

const point_cells *ffd_point_cells(const ffd_embedding *embedding)
{
    /* The embedding does not change for those who use it. */
    _Atomic(point_cells *) *const sorted = (_Atomic(point_cells *) *)&embedding->sorted;
    point_cells *there = atomic_load_explicit(sorted, memory_order_acquire);
    if (there)
        return there;
    point_cells *const mine = sort_points(embedding);
    if (!mine || atomic_compare_exchange_strong(sorted, &there, mine))
        return mine;
    ffd_point_cells_destroy(mine); /* another thread has published the same first */
    return there;
}

bool ffd_point_cells_pay(const ffd_embedding *embedding)
{
    atomic_bool *const asked = (atomic_bool *)&embedding->asked;
    return atomic_load((_Atomic(point_cells *) *)&embedding->sorted) || atomic_exchange(asked, true);
}

void ffd_point_cells_destroy(point_cells *cells)
{
    if (!cells)
        return;
    ffd_free(cells->cells);
    ffd_free(cells->which);
    ffd_free(cells->uvw);
    ffd_free(cells->fade);
    ffd_free(cells->others);
    ffd_free(cells);
}
