/* affected.c - finds the points that control points affect, by the span cells of the points. */
#include "base/memory/memory.h"
#include "points/embedding.h"
#include "spline/knots.h"
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

struct cell_index {
    _Atomic(cell_lists *) made;
};

struct cell_index *ffd_cell_index_create(void)
{
    struct cell_index *const index = ffd_alloc_zero(1, sizeof *index);
    if (index)
        atomic_init(&index->made, NULL);
    return index;
}

static void free_lists(cell_lists *lists)
{
    if (!lists)
        return;
    ffd_free(lists->starts);
    ffd_free(lists->points);
    ffd_free(lists);
}

void ffd_cell_index_destroy(struct cell_index *index)
{
    if (index)
        free_lists(atomic_load(&index->made));
    ffd_free(index);
}

static size_t cell_of(const ffd_lattice *lattice, const double uvw[3])
{
    size_t span[3];
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        span[a] = ffd_knots_span_index(knots, ffd_knots_wrap(knots, uvw[a]));
    }
    return (span[2] * lattice->knots[1].span_count + span[1]) * lattice->knots[0].span_count + span[0];
}

/* Calls put for each point that has a cell: first the points with u,v,w, then the extended ones, each in
   ascending order. */
static void for_points(const ffd_embedding *embedding,
                       void (*put)(cell_lists *lists, size_t cell, size_t point), cell_lists *lists)
{
    for (size_t i = 0; i < embedding->count; i++)
        if (ffd_embedding_has(embedding, i))
            put(lists, cell_of(embedding->rest, embedding->uvw + 3 * i), i);
    for (size_t i = 0; i < embedding->extended_count; i++)
        put(lists, cell_of(embedding->rest, embedding->extended[i].nearest.uvw),
            embedding->extended[i].point);
}

static void count_point(cell_lists *lists, size_t cell, size_t point)
{
    (void)point;
    lists->starts[cell + 1]++;
}

/* starts[cell] is the index of the next point of the cell; at the end it is the start of the next cell. */
static void add_point(cell_lists *lists, size_t cell, size_t point)
{
    lists->points[lists->starts[cell]++] = (uint32_t)point;
}

static cell_lists *make_lists(const ffd_embedding *embedding)
{
    const knot_vector *const knots = embedding->rest->knots;
    cell_lists *const lists = ffd_alloc_zero(1, sizeof *lists);
    if (!lists)
        return NULL;
    lists->cells = knots[0].span_count * knots[1].span_count * knots[2].span_count;
    lists->starts = ffd_alloc_zero(lists->cells + 2, sizeof *lists->starts);
    lists->points = ffd_alloc(embedding->count, sizeof *lists->points);
    if (!lists->starts || !lists->points) {
        free_lists(lists);
        return NULL;
    }
    for_points(embedding, count_point, lists);
    for (size_t c = 0; c < lists->cells; c++)
        lists->starts[c + 1] += lists->starts[c];
    for_points(embedding, add_point, lists);
    memmove(lists->starts + 1, lists->starts, lists->cells * sizeof *lists->starts);
    lists->starts[0] = 0;
    return lists;
}

const cell_lists *ffd_cell_lists(const ffd_embedding *embedding)
{
    cell_lists *there = atomic_load_explicit(&embedding->index->made, memory_order_acquire);
    if (there)
        return there;
    cell_lists *const mine = make_lists(embedding);
    if (!mine || atomic_compare_exchange_strong(&embedding->index->made, &there, mine))
        return mine;
    free_lists(mine); /* another thread has published the same lists first */
    return there;
}

/* Marks the non-empty spans (one byte each) that are in the support of the control point with this index. */
static void mark_spans(const knot_vector *knots, size_t index, uint8_t *marks)
{
    for (size_t s = 0; s < knots->span_count; s++) {
        const size_t last = (size_t)knots->spans[s], first = last - (size_t)knots->degree;
        bool acts = index >= first && index <= last;
        if (ffd_knots_closed(knots))
            acts = acts || (index + knots->points >= first && index + knots->points <= last);
        marks[s] = acts;
    }
}

/* Marks the cells in the support of a control point. spans: scratch memory, a byte for each span of all
   directions. */
static void mark_cells(const ffd_lattice *lattice, size_t point, uint8_t *spans, uint8_t *cells)
{
    const knot_vector *const knots = lattice->knots;
    const size_t *const size = lattice->size;
    uint8_t *const u = spans, *const v = u + knots[0].span_count, *const w = v + knots[1].span_count;
    mark_spans(&knots[0], point % size[0], u);
    mark_spans(&knots[1], point / size[0] % size[1], v);
    mark_spans(&knots[2], point / size[0] / size[1], w);
    for (size_t k = 0; k < knots[2].span_count; k++)
        for (size_t j = 0; j < knots[1].span_count && w[k]; j++)
            for (size_t i = 0; i < knots[0].span_count && v[j]; i++)
                cells[(k * knots[1].span_count + j) * knots[0].span_count + i] |= u[i];
}

static int compare_indices(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Merges the lists of the marked cells. */
static ffd_status join(const cell_lists *lists, const uint8_t *cells, uint32_t **vertices,
                       size_t *vertex_count, ffd_error *error)
{
    size_t count = 0;
    for (size_t c = 0; c < lists->cells; c++)
        count += cells[c] ? lists->starts[c + 1] - lists->starts[c] : 0;
    uint32_t *const all = ffd_alloc(count, sizeof *all);
    if (!all)
        return ffd_fail_memory(error);
    *vertices = all;
    *vertex_count = count;
    count = 0;
    for (size_t c = 0; c < lists->cells; c++) {
        const size_t in_cell = lists->starts[c + 1] - lists->starts[c];
        if (!cells[c] || in_cell == 0)
            continue;
        memcpy(all + count, lists->points + lists->starts[c], in_cell * sizeof *all);
        count += in_cell;
    }
    qsort(all, count, sizeof *all, compare_indices);
    return FFD_OK;
}

ffd_status ffd_embedding_affected(const ffd_embedding *embedding, const size_t *control_points, size_t count,
                                  uint32_t **vertices, size_t *vertex_count, ffd_error *error)
{
    const ffd_lattice *const lattice = embedding->rest;
    const knot_vector *const knots = lattice->knots;
    *vertices = NULL;
    *vertex_count = 0;
    for (size_t i = 0; i < count; i++)
        if (control_points[i] >= lattice->count)
            return ffd_fail(error, FFD_E_ARGUMENT, "there is no control point %zu: the lattice has %zu",
                            control_points[i], lattice->count);
    const cell_lists *const lists = ffd_cell_lists(embedding);
    uint8_t *const spans = ffd_alloc(knots[0].span_count + knots[1].span_count + knots[2].span_count, 1);
    uint8_t *const cells = lists ? ffd_alloc_zero(lists->cells, 1) : NULL;
    ffd_status status;
    TRY_END(spans && cells ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < count; i++)
        mark_cells(lattice, control_points[i], spans, cells);
    TRY_END(join(lists, cells, vertices, vertex_count, error));
end:
    ffd_free(spans);
    ffd_free(cells);
    return status;
}
