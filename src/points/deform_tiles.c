#include "points/deform_tiles.h"
#include "base/memory/memory.h"
#include "base/vector/array_kernel.h"
#include "deform/weighting.h"
#include "points/span.h"
#include "points/weights.h"
#include <ffd/embedding.h>
#include <float.h>
#include <string.h>

/* Scratch memory of a thread for a tile, in one block. */
typedef struct tile_scratch {
    double *room, *delta, *gradient; /* 3, 3, 9 numbers for each point */
    double *x;                       /* the points: room, or the output's own */
    uint8_t *changed;
} tile_scratch;

typedef struct tiles_work {
    const deform_arrays *arrays;
    displace_function displace;
    void *context;
    const array_kernel *kernel;
    tile_scratch *scratch; /* one for each thread */
} tiles_work;

/* Replaces the displacements of a tile by the weighted ones. */
static void weigh(const deform_tile *tile)
{
    const deform_arrays *const arrays = tile->arrays;
    for (size_t i = 0; i < tile->count && arrays->is_weighted; i++) {
        const size_t point = ffd_tile_point(tile, i);
        weigh_displacement(arrays->weights[point], arrays->slopes ? arrays->slopes + 3 * point : NULL,
                           tile->delta + 3 * i, tile->gradient ? tile->gradient + 9 * i : NULL);
    }
}

/* Whether all points of a tile are written as they are computed. */
static bool is_whole(const deform_arrays *arrays, size_t first, size_t count)
{
    return !arrays->vertices && !memchr(arrays->status + first, FFD_VERTEX_INVALID, count);
}

/* Reads the points of a tile to s->x: into the output itself where that saves a copy. */
static void read_tile(const deform_arrays *arrays, size_t first, size_t count, tile_scratch *s)
{
    double *const out = ffd_span_doubles(&arrays->out, first);
    const bool is_direct = out && is_whole(arrays, first, count) && arrays->in.data != arrays->out.data;
    s->x = is_direct ? out : s->room;
    if (!arrays->vertices)
        ffd_span_read(&arrays->in, first, count, s->x);
    for (size_t i = 0; i < count && arrays->vertices; i++)
        ffd_span_read(&arrays->in, arrays->vertices[first + i], 1, s->x + 3 * i);
}

/* A point that is not finite is copied bytewise if the types are equal, because a conversion may change the
   bits of a NaN. */
static void write_point(const deform_arrays *arrays, size_t point, const double x[3])
{
    const bool invalid = arrays->status[point] == FFD_VERTEX_INVALID;
    if (!invalid || arrays->in.type != arrays->out.type)
        ffd_span_write(&arrays->out, point, 1, x);
    else if (arrays->in.data != arrays->out.data)
        ffd_span_copy(&arrays->in, &arrays->out, point);
}

static void write_tile(const deform_tile *tile, const tile_scratch *s)
{
    const deform_arrays *const arrays = tile->arrays;
    const bool whole = is_whole(arrays, tile->first, tile->count);
    if (whole && s->x == s->room)
        ffd_span_write(&arrays->out, tile->first, tile->count, s->x);
    for (size_t i = 0; i < tile->count && !whole; i++)
        write_point(arrays, ffd_tile_point(tile, i), s->x + 3 * i);
    for (size_t i = 0; i < tile->count && arrays->gradients; i++)
        memcpy(arrays->gradients + 9 * ffd_tile_point(tile, i), s->gradient + 9 * i,
               9 * sizeof *arrays->gradients);
}

static ffd_status run_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const tiles_work *const work = context;
    const deform_arrays *const arrays = work->arrays;
    tile_scratch *const s = &work->scratch[worker];
    read_tile(arrays, first, count, s);
    const deform_tile tile = {arrays, first, count, s->x, s->delta, arrays->gradients ? s->gradient : NULL};
    TRY(work->displace(work->context, &tile, worker, error));
    weigh(&tile);
    const double largest = arrays->out.type == FFD_FLOAT32 ? FLT_MAX : DBL_MAX;
    const size_t unfit = work->kernel->displace(s->delta, count, largest, s->x, s->changed);
    if (unfit < count)
        return ffd_fail(error, FFD_E_INVALID, "point %zu would be too large for %s",
                        ffd_tile_point(&tile, unfit),
                        arrays->out.type == FFD_FLOAT32 ? "float32" : "float64");
    write_tile(&tile, s);
    return FFD_OK;
}

static ffd_status check_vertices(const deform_arrays *arrays, ffd_error *error)
{
    const uint32_t *const vertices = arrays->vertices;
    for (size_t i = 0; vertices && i < arrays->count; i++) {
        if (vertices[i] >= arrays->all)
            return ffd_fail(error, FFD_E_ARGUMENT, "there is no vertex %u: the embedding has %zu",
                            (unsigned)vertices[i], arrays->all);
        if (i > 0 && vertices[i] <= vertices[i - 1])
            return ffd_fail(error, FFD_E_ARGUMENT, "vertex %u after %u: they must be in ascending order",
                            (unsigned)vertices[i], (unsigned)vertices[i - 1]);
    }
    return FFD_OK;
}

ffd_status ffd_deform_check(deform_arrays *arrays, ffd_error *error)
{
    TRY(ffd_span_check(&arrays->in, arrays->all, "the array of points", error));
    TRY(ffd_span_check(&arrays->out, arrays->all, "the array of results", error));
    TRY(check_vertices(arrays, error));
    return arrays->is_weighted ? ffd_weights_check(arrays->weights, arrays->vertices, arrays->count, error)
                               : FFD_OK;
}

/* Allocates the scratch memory of a thread for tiles of this many points. */
static bool make_thread_scratch(size_t tile, tile_scratch *s)
{
    double *const block = ffd_alloc(tile, 15 * sizeof(double) + 1);
    if (!block)
        return false;
    s->room = block;
    s->delta = s->room + 3 * tile;
    s->gradient = s->delta + 3 * tile;
    s->changed = (uint8_t *)(s->gradient + 9 * tile);
    return true;
}

static ffd_status make_scratch(const point_run *run, tiles_work *work, ffd_error *error)
{
    const size_t threads = (size_t)run->options.threads,
                 tile = run->total < POINT_TILE ? run->total : POINT_TILE;
    work->kernel = ffd_array_kernel(run->options.isa);
    work->scratch = ffd_alloc_zero(threads, sizeof *work->scratch);
    for (size_t i = 0; work->scratch && i < threads; i++)
        if (!make_thread_scratch(tile, &work->scratch[i]))
            return ffd_fail_memory(error);
    return work->scratch ? FFD_OK : ffd_fail_memory(error);
}

static void free_scratch(const point_run *run, tile_scratch *scratch)
{
    for (int i = 0; scratch && i < run->options.threads; i++)
        ffd_free(scratch[i].room);
    ffd_free(scratch);
}

ffd_status ffd_deform_tiles(point_run *run, const deform_arrays *arrays, displace_function displace,
                            void *context, ffd_error *error)
{
    tiles_work work = {.arrays = arrays, .displace = displace, .context = context};
    ffd_status status;
    TRY_END(make_scratch(run, &work, error));
    TRY_END(ffd_point_run_tiles(run, run_tile, &work, error));
end:
    free_scratch(run, work.scratch);
    return status;
}
