/* weight_splits.c - reads the positions of vertices, and finds those whose vertices have different weights,
   and get different results. */
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/vector/array_kernel.h"
#include "job/input/source.h"
#include "job/input/weights.h"
#include <math.h>
#include <string.h>

/* Positions that are read at a time. */
#define TILE ((size_t)1 << 12)

/* A part whose positions are read. */
typedef struct position_reader {
    const mesh_document *document;
    mesh_state state;
    size_t part, first;
    const repeat_filter *filter;
    double *largest; /* of each worker; or NULL */
} position_reader;

static void read_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const position_reader *const r = context;
    double xyz[3 * TILE];
    (void)tile;
    ffd_source_positions(r->document, r->state, r->part, first, last - first, xyz);
    ffd_repeats_add(r->filter, r->first + first, last - first, xyz, worker);
    if (r->largest)
        r->largest[worker] =
            larger_of(r->largest[worker], ffd_array_kernel(FFD_ISA_AUTO)->magnitude(xyz, 3 * (last - first)));
}

ffd_status ffd_vertex_weights_filter(const vertex_weights *weights, const mesh_document *document,
                                     mesh_state state, const repeat_filter *filter, double *largest,
                                     ffd_error *error)
{
    double sizes[REPEAT_WORKERS] = {0};
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *const part = &document->parts[i];
        position_reader r = {document, state, i, weights->first[i], filter, largest ? sizes : NULL};
        if (!part->repeats_positions)
            ffd_parallel_tiles(part->vertex_count, TILE, filter->workers, read_tile, &r);
        TRY(ffd_deadline_check(error));
    }
    for (int w = 0; w < REPEAT_WORKERS && largest; w++)
        *largest = w == 0 ? sizes[0] : larger_of(*largest, sizes[w]);
    return FFD_OK;
}

/* Reads the positions of a list of vertices. */
typedef struct list_reader {
    const vertex_weights *weights;
    const mesh_document *document;
    mesh_state state;
    const uint32_t *list;
    double *positions;
} list_reader;

static void read_listed(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const list_reader *const r = context;
    size_t k = ffd_deadline_passed() ? last : first;
    (void)tile, (void)worker;
    for (size_t i = 0; k < last && i < r->document->part_count; i++) {
        const mesh_part *const part = &r->document->parts[i];
        const size_t begin = r->weights->first[i], end = begin + part->vertex_count;
        for (; k < last && r->list[k] < end && !part->repeats_positions; k++)
            ffd_source_positions(r->document, r->state, i, r->list[k] - begin, 1, r->positions + 3 * k);
    }
}

ffd_status ffd_vertex_weights_read_listed(const vertex_weights *weights, const mesh_document *document,
                                          mesh_state state, const uint32_t *list, size_t count, int threads,
                                          double *positions, ffd_error *error)
{
    list_reader r = {weights, document, state, list, positions};
    ffd_parallel_tiles(count, TILE, threads, read_listed, &r);
    return ffd_deadline_check(error);
}

/* A search for splits. */
typedef struct split_search {
    vertex_weights *weights;
    const mesh_document *document;
    mesh_state state;
    const repeat_filter *filter;
    uint32_t *list, *leaders; /* count vertices that may share a position, and the first of each */
    double *positions;        /* of the list */
    bool *splits;             /* of each leader: another weight follows */
    size_t count;
} split_search;

/* Returns the end of the entries of the list from `from` on that are vertices of a part. */
static size_t end_of_part(const split_search *search, size_t part, size_t from)
{
    const size_t end = search->weights->first[part] + search->document->parts[part].vertex_count;
    while (from < search->count && search->list[from] < end)
        from++;
    return from;
}

/* Drops the vertices that are not selected, or hidden. */
static void drop_others(split_search *search)
{
    size_t kept = 0, from = 0;
    for (size_t i = 0; i < search->document->part_count; i++) {
        const mesh_part *const part = &search->document->parts[i];
        if (part->repeats_positions)
            continue;
        for (const size_t end = end_of_part(search, i, from); from < end; from++)
            if (!part->hidden && !isnan(ffd_vertex_weight(search->weights, search->list[from])))
                search->list[kept++] = search->list[from];
    }
    search->count = kept;
}

/* Whether the weight of an entry is another than that of its leader. */
static bool is_other(const split_search *search, size_t k)
{
    const double own = ffd_vertex_weight(search->weights, search->list[k]);
    const double first = ffd_vertex_weight(search->weights, search->list[search->leaders[k]]);
    return own < first || own > first;
}

/* Keeps the entries whose leader has entries of another weight. */
static void keep_split(split_search *search)
{
    size_t kept = 0;
    for (size_t k = 0; k < search->count; k++)
        search->splits[k] = false;
    for (size_t k = 0; k < search->count; k++)
        search->splits[search->leaders[k]] |= is_other(search, k);
    for (size_t k = 0; k < search->count; k++)
        if (search->splits[search->leaders[k]])
            search->list[kept++] = search->list[k];
    search->count = kept;
}

/* Makes the splits of the entries, whose leaders have their positions. */
static ffd_status make_splits(const split_search *search, ffd_error *error)
{
    vertex_weights *const weights = search->weights;
    weights->splits = ffd_alloc(search->count, sizeof *weights->splits);
    if (!weights->splits)
        return ffd_fail_memory(error);
    for (size_t k = 0; k < search->count; k++) {
        const double *const x = search->positions + 3 * k;
        if (is_other(search, k))
            weights->splits[weights->split_count++] =
                (weight_split){search->list[k], search->list[search->leaders[k]], {x[0], x[1], x[2]}};
    }
    return FFD_OK;
}

/* Nearly all vertices that share a position share their weight too: only of the others positions are
   compared, among all that have one hash. */
static ffd_status find(split_search *search, ffd_error *error)
{
    drop_others(search);
    search->leaders = ffd_alloc(search->count, sizeof *search->leaders);
    search->splits = ffd_alloc(search->count, sizeof *search->splits);
    if (!search->leaders || !search->splits)
        return ffd_fail_memory(error);
    TRY(ffd_leaders_find(search->filter, NULL, search->list, search->count, search->leaders, error));
    keep_split(search);
    search->positions = ffd_alloc(search->count, 3 * sizeof *search->positions);
    if (!search->positions)
        return ffd_fail_memory(error);
    TRY(ffd_vertex_weights_read_listed(search->weights, search->document, search->state, search->list,
                                       search->count, search->filter->workers, search->positions, error));
    TRY(ffd_leaders_find(search->filter, search->positions, search->list, search->count, search->leaders,
                         error));
    return make_splits(search, error);
}

ffd_status ffd_vertex_weights_take_repeats(vertex_weights *weights, const mesh_document *document,
                                           mesh_state state, const repeat_filter *filter, uint32_t *list,
                                           size_t count, ffd_error *error)
{
    split_search search = {.weights = weights,
                           .document = document,
                           .state = state,
                           .filter = filter,
                           .list = list,
                           .count = count};
    if (weights->splits)
        return FFD_OK;
    const ffd_status status = find(&search, error);
    ffd_free(search.leaders);
    ffd_free(search.positions);
    ffd_free(search.splits);
    return status;
}

ffd_status ffd_vertex_weights_find_splits(vertex_weights *weights, const mesh_document *document,
                                          mesh_state state, int threads, const memory_budget *budget,
                                          ffd_error *error)
{
    repeat_filter filter = {0};
    uint32_t *list = NULL;
    size_t count;
    ffd_status status;
    if (!weights->differ || weights->splits)
        return FFD_OK;
    TRY(ffd_budget_check(budget, weights->count, SPLIT_BYTES, error));
    TRY_END(ffd_repeats_begin(&filter, weights->count, threads, NULL, 0, error));
    TRY_END(ffd_vertex_weights_filter(weights, document, state, &filter, NULL, error));
    TRY_END(ffd_repeats_list(&filter, &list, &count, error));
    TRY_END(ffd_vertex_weights_take_repeats(weights, document, state, &filter, list, count, error));
end:
    ffd_free(list);
    ffd_repeats_end(&filter);
    return status;
}
