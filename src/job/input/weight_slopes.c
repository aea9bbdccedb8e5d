/* weight_slopes.c - how the weights of a document's vertices change along its surface. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "job/input/source.h"
#include "job/input/weights.h"
#include "mesh/slopes.h"
#include <string.h>

/* Positions that are looked at at a time. */
#define TILE ((size_t)1 << 14)

/* What the slopes are found from. */
typedef struct slope_search {
    vertex_weights *weights;
    mesh_document *document;
    mesh_state state;
    bool judged;
    int threads;
    ffd_isa isa;
    const mesh_faces *faces; /* NULL: the format passes triangles */
    mesh_faces own;          /* read for this */
    double largest;          /* the greatest magnitude of a coordinate; without faces only */
    uint32_t *twins;         /* NULL: no two vertices share a position */
    bool has_triangles;
} slope_search;

/* Takes the faces that are there, or else reads those of a format that cannot pass its triangles one by one.
 */
static ffd_status take_faces(slope_search *search, const mesh_faces *faces, memory_budget *budget,
                             ffd_error *error)
{
    const mesh_format *const format = search->document->format;
    search->faces = faces;
    if (faces)
        return FFD_OK;
    if (format->visit_triangles)
        return ffd_budget_take(budget, search->weights->count, SLOPE_BYTES, error);
    TRY(format->faces(search->document, search->state, &search->own, error));
    search->faces = &search->own;
    return ffd_mesh_faces_take(&search->own, search->own.start[search->own.face_count], budget, error);
}

static ffd_status walk(const void *surface, mesh_triangle_visitor *visit, void *context, ffd_error *error)
{
    const slope_search *const search = surface;
    return search->faces ? ffd_slopes_walk_faces(search->faces, visit, context, error)
                         : search->document->format->visit_triangles(search->document, search->weights->first,
                                                                     visit, context, error);
}

/* Reads positions of any parts. */
static void read_positions(const void *surface, size_t first, size_t count, double *positions)
{
    const slope_search *const search = surface;
    const mesh_document *const document = search->document;
    for (size_t i = 0; i < document->part_count && count > 0; i++) {
        const mesh_part *const part = &document->parts[i];
        const size_t from = first - search->weights->first[i];
        if (part->repeats_positions || from >= part->vertex_count)
            continue;
        const size_t left = part->vertex_count - from, taken = left < count ? left : count;
        ffd_source_positions(document, search->state, i, from, taken, positions);
        first += taken;
        count -= taken;
        positions += 3 * taken;
    }
}

/* Adds the positions of the faces to a filter. */
typedef struct filter_work {
    const repeat_filter *filter;
    const double *positions;
} filter_work;

static void add_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const filter_work *const work = context;
    (void)tile;
    ffd_repeats_add(work->filter, first, last - first, work->positions + 3 * first, worker);
}

/* Reads the positions of the vertices that are listed. */
static ffd_status read_places(const slope_search *search, const uint32_t *list, size_t count, double *places,
                              ffd_error *error)
{
    if (!search->faces)
        return ffd_vertex_weights_read_listed(search->weights, search->document, search->state, list, count,
                                              search->threads, places, error);
    for (size_t k = 0; k < count; k++)
        memcpy(places + 3 * k, search->faces->positions + 3 * (size_t)list[k], 3 * sizeof *places);
    return FFD_OK;
}

/* Adds all positions to a filter. */
static ffd_status add_positions(slope_search *search, const repeat_filter *filter, ffd_error *error)
{
    if (!search->faces)
        return ffd_vertex_weights_filter(search->weights, search->document, search->state, filter,
                                         &search->largest, error);
    filter_work work = {filter, search->faces->positions};
    ffd_parallel_tiles(search->weights->count, TILE, filter->workers, add_tile, &work);
    return ffd_deadline_check(error);
}

/* Finds the twins, and the splits of what is judged. */
static ffd_status find_twins(slope_search *search, ffd_error *error)
{
    vertex_weights *const weights = search->weights;
    repeat_filter filter;
    uint32_t *list = NULL;
    double *places = NULL;
    size_t count;
    ffd_status status;
    /* The slopes come later: fresh memory costs more than what is done in it. */
    TRY_END(ffd_repeats_begin(&filter, weights->count, search->threads, weights->slopes[search->state].sums,
                              weights->count * SLOPE_STRIDE * sizeof(double), error));
    TRY_END(add_positions(search, &filter, error));
    TRY_END(ffd_repeats_list(&filter, &list, &count, error));
    places = ffd_alloc(count, 3 * sizeof *places);
    TRY_END(places ? read_places(search, list, count, places, error) : ffd_fail_memory(error));
    TRY_END(ffd_twins_find(&filter, places, list, count, &search->twins, error));
    TRY_END(search->judged ? ffd_vertex_weights_take_repeats(weights, search->document, search->state,
                                                             &filter, list, count, error)
                           : FFD_OK);
end:
    ffd_free(list);
    ffd_free(places);
    ffd_repeats_end(&filter);
    return status;
}

static ffd_status find(slope_search *search, ffd_error *error)
{
    vertex_weights *const weights = search->weights;
    slope_sums *const slopes = &weights->slopes[search->state];
    slopes->sums = ffd_alloc_whole(weights->count, SLOPE_STRIDE * sizeof *slopes->sums);
    if (!slopes->sums)
        return ffd_fail_memory(error);
    TRY(find_twins(search, error));
    const weighted_surface surface = {.positions = search->faces ? search->faces->positions : NULL,
                                      .weights = weights->values,
                                      .vertex_count = weights->count,
                                      .read = read_positions,
                                      .largest = search->largest,
                                      .walk = walk,
                                      .surface = search,
                                      .isa = search->isa};
    return ffd_slopes_find(&surface, search->twins, search->threads, slopes, &search->has_triangles, error);
}

ffd_status ffd_vertex_weights_find_slopes(vertex_weights *weights, mesh_document *document, mesh_state state,
                                          bool judged, const mesh_faces *faces, int threads, ffd_isa isa,
                                          memory_budget *budget, const mesh_log *log, ffd_error *error)
{
    slope_search search = {.weights = weights,
                           .document = document,
                           .state = state,
                           .judged = judged,
                           .threads = threads,
                           .isa = isa};
    memory_budget meanwhile = *budget;
    ffd_status status;
    if (!weights->differ || weights->slopes[state].sums)
        return FFD_OK;
    TRY_END(
        ffd_budget_take(budget, weights->count, SLOPE_STRIDE * sizeof *weights->slopes[state].sums, error));
    meanwhile.taken = budget->taken;
    TRY_END(take_faces(&search, faces, &meanwhile, error));
    TRY_END(ffd_budget_check(&meanwhile, weights->count, sizeof *search.twins + SPLIT_BYTES, error));
    TRY_END(find(&search, error));
    if (!search.has_triangles)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "has no faces: how {weight} changes along the surface is not known, and normals turn as "
                     "if it did not");
end:
    ffd_mesh_faces_free(&search.own);
    ffd_free(search.twins);
    return status;
}
