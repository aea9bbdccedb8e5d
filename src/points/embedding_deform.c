/* embedding_deform.c - deforms embedded points. */
#include "base/memory/memory.h"
#include "base/vector/array_kernel.h"
#include "deform/displacement.h"
#include "deform/extension.h"
#include "deform/weighting.h"
#include "points/embedding.h"
#include "points/point_run.h"
#include "points/span.h"
#include "points/weights.h"
#include <float.h>
#include <string.h>

_Static_assert(POINT_TILE <= DISPLACEMENT_BATCH, "a tile is one batch");

/* At most this many points are displaced one by one, because the setup of a batch would take longer. The bits
   are the same. */
#define FEW_POINTS ((size_t)32)

/* Scratch memory of a thread for a tile, in one block. */
typedef struct deform_scratch {
    double *room, *delta, *gradient,
        *uvw;  /* 3, 3, 9, 3 numbers for each point; uvw: of the listed vertices */
    double *x; /* the points: room, or the output's own */
    uint32_t *which;
    uint8_t *moves, *changed;
    displacement_scratch *displacement; /* NULL for few points */
} deform_scratch;

typedef struct deform_work {
    const ffd_embedding *embedding;
    const ffd_lattice *lattice;
    const uint32_t *vertices; /* NULL: all */
    bool is_weighted;
    const double *weights, *slopes; /* of all points; slopes NULL: all are 0 */
    ffd_span in, out;
    double *gradients;
    ffd_isa isa;
    const array_kernel *arrays;
    deform_scratch *scratch; /* one for each thread */
} deform_work;

/* Returns the index of the i-th point to be deformed. */
static size_t point_of(const deform_work *work, size_t i)
{
    return work->vertices ? work->vertices[i] : i;
}

/* Lists the points of a tile that have u,v,w, and sets the displacements of the others to 0. Returns the
   number of listed points. */
static size_t choose(const deform_work *work, size_t first, size_t count, deform_scratch *s)
{
    size_t chosen = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t point = point_of(work, first + i);
        if (work->vertices)
            memcpy(s->uvw + 3 * i, work->embedding->uvw + 3 * point, 3 * sizeof *s->uvw);
        if (ffd_embedding_has(work->embedding, point)) {
            s->which[chosen++] = (uint32_t)i;
            continue;
        }
        memset(s->delta + 3 * i, 0, 3 * sizeof *s->delta);
        if (work->gradients)
            memset(s->gradient + 9 * i, 0, 9 * sizeof *s->gradient);
    }
    return chosen;
}

/* Computes the displacements of the extended points of a tile. */
static void extend(const deform_work *work, size_t first, size_t count, deform_scratch *s)
{
    const ffd_embedding *const embedding = work->embedding;
    size_t next = ffd_embedding_first_extended(embedding, point_of(work, first));
    for (size_t i = 0; i < count && next < embedding->extended_count; i++) {
        const size_t point = point_of(work, first + i);
        while (next < embedding->extended_count && embedding->extended[next].point < point)
            next++;
        if (next == embedding->extended_count || embedding->extended[next].point != point)
            continue;
        ffd_extension_displacement(work->lattice, &embedding->extended[next].nearest, embedding->falloff,
                                   s->delta + 3 * i, work->gradients ? s->gradient + 9 * i : NULL);
    }
}

/* Replaces the displacements of a tile by the weighted ones. */
static void weigh(const deform_work *work, size_t first, size_t count, const deform_scratch *s)
{
    for (size_t i = 0; i < count && work->is_weighted; i++) {
        const size_t point = point_of(work, first + i);
        weigh_displacement(work->weights[point], work->slopes ? work->slopes + 3 * point : NULL,
                           s->delta + 3 * i, work->gradients ? s->gradient + 9 * i : NULL);
    }
}

/* Whether all points of a tile are written as they are computed. */
static bool is_whole(const deform_work *work, size_t first, size_t count)
{
    return !work->vertices && !memchr(work->embedding->status + first, FFD_VERTEX_INVALID, count);
}

/* Reads the points of a tile to s->x: into the output itself where that saves a copy. */
static void read_tile(const deform_work *work, size_t first, size_t count, deform_scratch *s)
{
    double *const out = ffd_span_doubles(&work->out, first);
    const bool is_direct = out && is_whole(work, first, count) && work->in.data != work->out.data;
    s->x = is_direct ? out : s->room;
    if (!work->vertices)
        ffd_span_read(&work->in, first, count, s->x);
    for (size_t i = 0; i < count && work->vertices; i++)
        ffd_span_read(&work->in, work->vertices[first + i], 1, s->x + 3 * i);
}

/* A point that is not finite is copied bytewise if the types are equal, because a conversion may change the
   bits of a NaN. */
static void write_point(const deform_work *work, size_t point, const double x[3])
{
    const bool invalid = work->embedding->status[point] == FFD_VERTEX_INVALID;
    if (!invalid || work->in.type != work->out.type)
        ffd_span_write(&work->out, point, 1, x);
    else if (work->in.data != work->out.data)
        ffd_span_copy(&work->in, &work->out, point);
}

static void write_tile(const deform_work *work, size_t first, size_t count, const deform_scratch *s)
{
    const bool whole = is_whole(work, first, count);
    if (whole && s->x == s->room)
        ffd_span_write(&work->out, first, count, s->x);
    for (size_t i = 0; i < count && !whole; i++)
        write_point(work, point_of(work, first + i), s->x + 3 * i);
    for (size_t i = 0; i < count && work->gradients; i++)
        memcpy(work->gradients + 9 * point_of(work, first + i), s->gradient + 9 * i,
               9 * sizeof *work->gradients);
}

static ffd_status deform_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const deform_work *const work = context;
    deform_scratch *const s = &work->scratch[worker];
    const size_t chosen = choose(work, first, count, s);
    const displacement_batch batch = {.uvw = work->vertices ? s->uvw : work->embedding->uvw + 3 * first,
                                      .stride = 3 * sizeof(double),
                                      .which = s->which,
                                      .count = chosen,
                                      .delta = s->delta,
                                      .gradient = work->gradients ? s->gradient : NULL,
                                      .moves = s->moves};
    read_tile(work, first, count, s);
    ffd_displacements(work->lattice, work->isa, &batch, s->displacement);
    if (work->embedding->extended_count > 0)
        extend(work, first, count, s);
    weigh(work, first, count, s);
    const double largest = work->out.type == FFD_FLOAT32 ? FLT_MAX : DBL_MAX;
    const size_t unfit = work->arrays->displace(s->delta, count, largest, s->x, s->changed);
    if (unfit < count)
        return ffd_fail(error, FFD_E_INVALID, "point %zu would be too large for %s",
                        point_of(work, first + unfit), work->out.type == FFD_FLOAT32 ? "float32" : "float64");
    write_tile(work, first, count, s);
    return FFD_OK;
}

static ffd_status check_vertices(const deform_work *work, size_t count, ffd_error *error)
{
    for (size_t i = 0; work->vertices && i < count; i++) {
        if (work->vertices[i] >= work->embedding->count)
            return ffd_fail(error, FFD_E_ARGUMENT, "there is no vertex %u: the embedding has %zu",
                            (unsigned)work->vertices[i], work->embedding->count);
        if (i > 0 && work->vertices[i] <= work->vertices[i - 1])
            return ffd_fail(error, FFD_E_ARGUMENT, "vertex %u after %u: they must be in ascending order",
                            (unsigned)work->vertices[i], (unsigned)work->vertices[i - 1]);
    }
    return FFD_OK;
}

static ffd_status check(deform_work *work, size_t count, ffd_error *error)
{
    const size_t all = work->embedding->count;
    TRY(ffd_embedding_check_lattice(work->embedding, work->lattice, error));
    TRY(ffd_span_check(&work->in, all, "the array of points", error));
    TRY(ffd_span_check(&work->out, all, "the array of results", error));
    TRY(check_vertices(work, count, error));
    return work->is_weighted ? ffd_weights_check(work->weights, work->vertices, count, error) : FFD_OK;
}

/* Allocates the scratch memory of a thread for tiles of this many points. */
static bool make_thread_scratch(const point_run *run, size_t tile, deform_scratch *s)
{
    double *const block = ffd_alloc(tile, 18 * sizeof(double) + sizeof(uint32_t) + 2);
    if (!block)
        return false;
    s->room = block;
    s->delta = s->room + 3 * tile;
    s->gradient = s->delta + 3 * tile;
    s->uvw = s->gradient + 9 * tile;
    s->which = (uint32_t *)(void *)(s->uvw + 3 * tile);
    s->moves = (uint8_t *)(s->which + tile);
    s->changed = s->moves + tile;
    if (run->total <= FEW_POINTS)
        return true;
    /* Several megabytes, not cleared, so that unused pages cost nothing. */
    s->displacement = ffd_alloc(1, sizeof *s->displacement);
    if (!s->displacement)
        return false;
    ffd_displacement_scratch_clear(s->displacement);
    s->displacement->kept.threads = run->options.threads;
    return true;
}

static ffd_status make_scratch(const point_run *run, deform_work *work, ffd_error *error)
{
    const size_t threads = (size_t)run->options.threads,
                 tile = run->total < POINT_TILE ? run->total : POINT_TILE;
    work->isa = run->options.isa;
    work->arrays = ffd_array_kernel(run->options.isa);
    work->scratch = ffd_alloc_zero(threads, sizeof *work->scratch);
    for (size_t i = 0; work->scratch && i < threads; i++)
        if (!make_thread_scratch(run, tile, &work->scratch[i]))
            return ffd_fail_memory(error);
    return work->scratch ? FFD_OK : ffd_fail_memory(error);
}

static void free_scratch(const point_run *run, deform_scratch *scratch)
{
    for (int i = 0; scratch && i < run->options.threads; i++) {
        ffd_free(scratch[i].room);
        ffd_free(scratch[i].displacement);
    }
    ffd_free(scratch);
}

static ffd_status deform_elements(deform_work *work, size_t count, const ffd_run_options *options,
                                  ffd_error *error)
{
    point_run run = {.total = 0};
    ffd_status status;
    TRY_END(check(work, count, error));
    TRY_END(ffd_point_run_begin(options, count, &run, error));
    TRY_END(make_scratch(&run, work, error));
    TRY_END(ffd_point_run_tiles(&run, deform_tile, work, error));
end:
    free_scratch(&run, work->scratch);
    ffd_point_run_end(&run);
    return status;
}

ffd_status ffd_embedding_deform(const ffd_embedding *embedding, const ffd_lattice *moved, ffd_span in,
                                ffd_span out, double *gradients, const ffd_run_options *options,
                                ffd_error *error)
{
    deform_work work = {
        .embedding = embedding, .lattice = moved, .in = in, .out = out, .gradients = gradients};
    return deform_elements(&work, embedding->count, options, error);
}

ffd_status ffd_embedding_deform_some(const ffd_embedding *embedding, const ffd_lattice *moved,
                                     const uint32_t *vertices, size_t count, ffd_span in, ffd_span out,
                                     double *gradients, const ffd_run_options *options, ffd_error *error)
{
    static const uint32_t none = 0;
    deform_work work = {.embedding = embedding,
                        .lattice = moved,
                        .vertices = count > 0 ? vertices : &none,
                        .in = in,
                        .out = out,
                        .gradients = gradients};
    return deform_elements(&work, count, options, error);
}

ffd_status ffd_embedding_deform_weighted(const ffd_embedding *embedding, const ffd_lattice *moved,
                                         const double *weights, const double *slopes, ffd_span in,
                                         ffd_span out, double *gradients, const ffd_run_options *options,
                                         ffd_error *error)
{
    deform_work work = {.embedding = embedding,
                        .lattice = moved,
                        .is_weighted = true,
                        .weights = weights,
                        .slopes = slopes,
                        .in = in,
                        .out = out,
                        .gradients = gradients};
    return deform_elements(&work, embedding->count, options, error);
}

ffd_status ffd_embedding_deform_some_weighted(const ffd_embedding *embedding, const ffd_lattice *moved,
                                              const uint32_t *vertices, size_t count, const double *weights,
                                              const double *slopes, ffd_span in, ffd_span out,
                                              double *gradients, const ffd_run_options *options,
                                              ffd_error *error)
{
    static const uint32_t none = 0;
    deform_work work = {.embedding = embedding,
                        .lattice = moved,
                        .vertices = count > 0 ? vertices : &none,
                        .is_weighted = true,
                        .weights = weights,
                        .slopes = slopes,
                        .in = in,
                        .out = out,
                        .gradients = gradients};
    return deform_elements(&work, count, options, error);
}
