#include "points/embedding.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/text/number.h"
#include "embed/locator.h"
#include "embed/locator_border.h"
#include "embed/near_border.h"
#include "lattice/rest_hash.h"
#include "mesh/rounding.h"
#include "points/point_run.h"
#include "points/span.h"
#include <math.h>
#include <string.h>

void ffd_embedding_desc_init(ffd_embedding_desc *desc, size_t size)
{
    const ffd_embedding_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

/* The extended points of a tile, until the lists are joined. */
typedef struct extended_list {
    extended_point *points;
    size_t count, capacity;
} extended_list;

/* The state of a call of ffd_embedding_create. */
typedef struct embed_work {
    const ffd_embedding_desc *desc;
    ffd_embedding *embedding;
    ffd_locator *locator;
    const boundary *border;  /* NULL: points outside are not extended */
    ffd_location *locations; /* POINT_TILE for each thread */
    double *positions;       /* 3 * POINT_TILE for each thread */
    extended_list *outside;  /* one for each tile */
} embed_work;

/* Finds the nearest border point of a point outside, and lists the point if it is within the falloff. */
static ffd_status extend(const embed_work *work, size_t point, const double x[3], extended_list *list,
                         ffd_error *error)
{
    const double reach = work->desc->falloff > 0 ? work->desc->falloff : HUGE_VAL;
    boundary_point nearest;
    TRY(ffd_boundary_find(work->border, x, reach, &nearest, error));
    if (!nearest.found)
        return FFD_OK;
    if (!ffd_grow((void **)&list->points, &list->capacity, list->count + 1, sizeof *list->points))
        return ffd_fail_memory(error);
    list->points[list->count++] = (extended_point){point, nearest};
    return FFD_OK;
}

static ffd_status settle_point(const embed_work *work, size_t point, const double x[3],
                               ffd_location *location, ffd_error *error)
{
    static const mesh_rounding of_floats = {.is_float = {true, true, true}};
    const bool is_float = work->desc->points.type == FFD_FLOAT32;
    ffd_embedding *const embedding = work->embedding;
    ffd_status status = FFD_OK;
    double half[3] = {0, 0, 0};
    if (is_float)
        ffd_rounding_cell(&of_floats, x, half);
    if (!ffd_location_is_placed(location) && location->status != FFD_VERTEX_INVALID &&
        (is_float || work->desc->snap > 0))
        status = ffd_near_border_retry(work->locator, x, half, work->desc->snap, location, error);
    const bool placed = ffd_location_is_placed(location);
    embedding->status[point] = location->status;
    for (size_t c = 0; c < 3; c++)
        embedding->uvw[3 * point + c] = placed ? location->uvw[c] : (double)NAN;
    if (status || placed || location->status == FFD_VERTEX_INVALID)
        return status;
    if (work->desc->outside == FFD_OUTSIDE_ERROR)
        return ffd_fail(error, FFD_E_EMBEDDING, "point %zu at %s %s %s is outside of the lattice", point,
                        ffd_number_text(x[0]).text, ffd_number_text(x[1]).text, ffd_number_text(x[2]).text);
    return work->border ? extend(work, point, x, &work->outside[point / POINT_TILE], error) : FFD_OK;
}

/* Takes the points of a tile that the locator finds at once, and finds the others one by one. */
static ffd_status embed_rest(const embed_work *work, size_t first, size_t count, const double *x,
                             const uint8_t *found, ffd_location *location, ffd_error *error)
{
    ffd_embedding *const embedding = work->embedding;
    memset(embedding->status + first, FFD_VERTEX_INSIDE, count);
    for (size_t i = 0; i < count; i++) {
        if (found[i])
            continue;
        TRY(ffd_locator_find(work->locator, x + 3 * i, 1, location, error));
        TRY(settle_point(work, first + i, x + 3 * i, location, error));
    }
    return FFD_OK;
}

static ffd_status embed_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const embed_work *const work = context;
    double *const x = work->positions + 3 * POINT_TILE * (size_t)worker;
    ffd_location *const locations = work->locations + POINT_TILE * (size_t)worker;
    uint8_t found[POINT_TILE];
    ffd_span_read(&work->desc->points, first, count, x);
    if (ffd_locator_find_inside(work->locator, x, count, work->embedding->uvw + 3 * first, found) == count)
        return embed_rest(work, first, count, x, found, locations, error);
    TRY(ffd_locator_find(work->locator, x, count, locations, error));
    for (size_t i = 0; i < count; i++)
        TRY(settle_point(work, first + i, x + 3 * i, &locations[i], error));
    return FFD_OK;
}

/* Joins the lists of the tiles. */
static ffd_status join_extended(const embed_work *work, size_t tiles, ffd_error *error)
{
    ffd_embedding *const embedding = work->embedding;
    size_t count = 0;
    for (size_t i = 0; i < tiles; i++)
        count += work->outside[i].count;
    embedding->extended = ffd_alloc(count, sizeof *embedding->extended);
    if (!embedding->extended)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < tiles; i++) {
        const extended_list *const list = &work->outside[i];
        if (list->count > 0)
            memcpy(embedding->extended + embedding->extended_count, list->points,
                   list->count * sizeof *list->points);
        embedding->extended_count += list->count;
    }
    return FFD_OK;
}

ffd_status ffd_embedding_desc_check(ffd_embedding_desc *desc, ffd_error *error)
{
    if (!desc->lattice)
        return ffd_fail(error, FFD_E_ARGUMENT, "there is no lattice to embed points in");
    if (!desc->lattice->rest)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "the lattice has no control points yet: its box is that of a mesh");
    if ((int)desc->outside < FFD_OUTSIDE_KEEP || desc->outside > FFD_OUTSIDE_ERROR)
        return ffd_fail(error, FFD_E_ARGUMENT, "%d is not a value of ffd_outside", (int)desc->outside);
    if (!(desc->falloff >= 0 && isfinite(desc->falloff)))
        return ffd_fail(error, FFD_E_ARGUMENT, "falloff %g is not 0 or more", desc->falloff);
    if (desc->falloff > 0 && desc->outside != FFD_OUTSIDE_EXTEND)
        return ffd_fail(error, FFD_E_ARGUMENT, "falloff %g needs outside \"extend\"", desc->falloff);
    if (!(desc->snap >= 0 && isfinite(desc->snap)))
        return ffd_fail(error, FFD_E_ARGUMENT, "snap %g is not 0 or more", desc->snap);
    if (desc->points.count > UINT32_MAX)
        return ffd_fail(error, FFD_E_LIMIT, "%zu points are more than 2^32 - 1", desc->points.count);
    return ffd_span_check(&desc->points, desc->points.count, "the array of points", error);
}

static void free_work(embed_work *work, size_t tiles)
{
    for (size_t i = 0; work->outside && i < tiles; i++)
        ffd_free(work->outside[i].points);
    ffd_free(work->outside);
    ffd_free(work->locations);
    ffd_free(work->positions);
    ffd_locator_destroy(&work->locator);
}

static ffd_status find_all(const ffd_embedding_desc *desc, point_run *run, ffd_embedding *embedding,
                           ffd_error *error)
{
    const size_t threads = (size_t)run->options.threads, tiles = desc->points.count / POINT_TILE + 1;
    embed_work work = {.desc = desc, .embedding = embedding};
    ffd_status status;
    TRY_END(ffd_locator_create_for(embedding->rest, run->options.isa, &work.locator, error));
    if (desc->outside == FFD_OUTSIDE_EXTEND)
        TRY_END(ffd_locator_border(work.locator, &work.border, error));
    work.locations = ffd_alloc(threads * POINT_TILE, sizeof *work.locations);
    work.positions = ffd_alloc(threads * POINT_TILE, 3 * sizeof *work.positions);
    work.outside = ffd_alloc_zero(tiles, sizeof *work.outside);
    if (!(work.locations && work.positions && work.outside))
        TRY_END(ffd_fail_memory(error));
    TRY_END(ffd_point_run_tiles(run, embed_tile, &work, error));
    TRY_END(join_extended(&work, tiles, error));
end:
    free_work(&work, tiles);
    return status;
}

ffd_status ffd_embedding_make(const ffd_lattice *lattice, size_t count, ffd_embedding **embedding,
                              ffd_error *error)
{
    ffd_embedding *const made = ffd_alloc_zero(1, sizeof *made);
    *embedding = made;
    if (!made)
        return ffd_fail_memory(error);
    made->count = count;
    made->uvw = ffd_alloc_whole(count, 3 * sizeof *made->uvw);
    made->status = ffd_alloc(count, sizeof *made->status);
    made->index = ffd_cell_index_create();
    atomic_init(&made->sorted, NULL);
    atomic_init(&made->asked, false);
    if (made->uvw && made->status && made->index && ffd_lattice_copy(lattice, &made->rest, NULL) == FFD_OK) {
        made->rest_hash = ffd_rest_hash(made->rest);
        return FFD_OK;
    }
    ffd_embedding_destroy(embedding);
    return ffd_fail_memory(error);
}

ffd_status ffd_embedding_create(const ffd_embedding_desc *callers, const ffd_run_options *options,
                                ffd_embedding **embedding, ffd_error *error)
{
    ffd_embedding_desc desc;
    point_run run = {.total = 0};
    *embedding = NULL;
    ffd_embedding_desc_init(&desc, sizeof desc);
    ffd_status status;
    TRY_END(ffd_struct_take(&desc, sizeof desc, callers, "ffd_embedding_desc", error));
    TRY_END(ffd_embedding_desc_check(&desc, error));
    TRY_END(ffd_point_run_begin(options, desc.points.count, &run, error));
    TRY_END(ffd_embedding_make(desc.lattice, desc.points.count, embedding, error));
    (*embedding)->falloff = desc.falloff;
    TRY_END(find_all(&desc, &run, *embedding, error));
end:
    ffd_point_run_end(&run);
    if (status)
        ffd_embedding_destroy(embedding);
    return status;
}

void ffd_embedding_destroy(ffd_embedding **embedding)
{
    if (!embedding || !*embedding)
        return;
    ffd_lattice_destroy(&(*embedding)->rest);
    ffd_free((*embedding)->uvw);
    ffd_free((*embedding)->status);
    ffd_free((*embedding)->extended);
    ffd_cell_index_destroy((*embedding)->index);
    ffd_point_cells_destroy(atomic_load(&(*embedding)->sorted));
    ffd_free(*embedding);
    *embedding = NULL;
}

size_t ffd_embedding_get_count(const ffd_embedding *embedding)
{
    return embedding->count;
}

const double *ffd_embedding_get_uvw(const ffd_embedding *embedding)
{
    return embedding->uvw;
}

const uint8_t *ffd_embedding_get_status(const ffd_embedding *embedding)
{
    return embedding->status;
}

static bool is_of_point_before(const void *extended, const void *point)
{
    return ((const extended_point *)extended)->point < *(const size_t *)point;
}

size_t ffd_embedding_first_extended(const ffd_embedding *embedding, size_t point)
{
    return lower_bound(&point, embedding->extended, embedding->extended_count, sizeof *embedding->extended,
                       is_of_point_before);
}

ffd_status ffd_embedding_check_lattice(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                       ffd_error *error)
{
    if (!lattice || !lattice->rest)
        return ffd_fail(error, FFD_E_ARGUMENT, "there is no lattice, or it has no control points yet");
    return ffd_rest_equal(lattice, embedding->rest)
               ? FFD_OK
               : ffd_fail(error, FFD_E_INVALID,
                          "the embedding is of another lattice: rest points, knots or weights differ");
}
