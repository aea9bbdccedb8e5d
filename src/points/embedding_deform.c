/* embedding_deform.c - deforms embedded points. */
#include "base/memory/memory.h"
#include "deform/displacement.h"
#include "deform/extension.h"
#include "points/deform_tiles.h"
#include "points/embedding.h"
#include <string.h>

_Static_assert(POINT_TILE <= DISPLACEMENT_BATCH, "a tile is one batch");

/* At most this many points are displaced one by one, because the setup of a batch would take longer. The bits
   are the same. */
#define FEW_POINTS ((size_t)32)

/* Scratch memory of a thread for a tile, in one block. */
typedef struct deform_scratch {
    double *uvw; /* 3 numbers for each listed vertex */
    uint32_t *which;
    uint8_t *moves;
    displacement_scratch *displacement; /* NULL for few points */
} deform_scratch;

typedef struct deform_work {
    const ffd_embedding *embedding;
    const ffd_lattice *lattice;
    deform_arrays arrays;
    ffd_isa isa;
    deform_scratch *scratch; /* one for each thread */
} deform_work;

/* Lists the points of a tile that have u,v,w, and sets the displacements of the others to 0. Returns the
   number of listed points. */
static size_t choose(const deform_work *work, const deform_tile *tile, const deform_scratch *s)
{
    size_t chosen = 0;
    for (size_t i = 0; i < tile->count; i++) {
        const size_t point = ffd_tile_point(tile, i);
        if (work->arrays.vertices)
            memcpy(s->uvw + 3 * i, work->embedding->uvw + 3 * point, 3 * sizeof *s->uvw);
        if (ffd_embedding_has(work->embedding, point)) {
            s->which[chosen++] = (uint32_t)i;
            continue;
        }
        memset(tile->delta + 3 * i, 0, 3 * sizeof *tile->delta);
        if (tile->gradient)
            memset(tile->gradient + 9 * i, 0, 9 * sizeof *tile->gradient);
    }
    return chosen;
}

/* Computes the displacements of the extended points of a tile. */
static void extend(const deform_work *work, const deform_tile *tile)
{
    const ffd_embedding *const embedding = work->embedding;
    size_t next = ffd_embedding_first_extended(embedding, ffd_tile_point(tile, 0));
    for (size_t i = 0; i < tile->count && next < embedding->extended_count; i++) {
        const size_t point = ffd_tile_point(tile, i);
        while (next < embedding->extended_count && embedding->extended[next].point < point)
            next++;
        if (next == embedding->extended_count || embedding->extended[next].point != point)
            continue;
        ffd_extension_displacement(work->lattice, &embedding->extended[next].nearest, embedding->falloff,
                                   tile->delta + 3 * i, tile->gradient ? tile->gradient + 9 * i : NULL);
    }
}

static ffd_status displace(void *context, const deform_tile *tile, int worker, ffd_error *error)
{
    const deform_work *const work = context;
    const deform_scratch *const s = &work->scratch[worker];
    const size_t chosen = choose(work, tile, s);
    const displacement_batch batch = {.uvw = work->arrays.vertices ? s->uvw
                                                                   : work->embedding->uvw + 3 * tile->first,
                                      .stride = 3 * sizeof(double),
                                      .which = s->which,
                                      .count = chosen,
                                      .delta = tile->delta,
                                      .gradient = tile->gradient,
                                      .moves = s->moves};
    (void)error;
    ffd_displacements(work->lattice, work->isa, &batch, s->displacement);
    if (work->embedding->extended_count > 0)
        extend(work, tile);
    return FFD_OK;
}

/* Allocates the scratch memory of a thread for tiles of this many points. */
static bool make_thread_scratch(const point_run *run, size_t tile, deform_scratch *s)
{
    s->uvw = ffd_alloc(tile, 3 * sizeof *s->uvw + sizeof *s->which + 1);
    if (!s->uvw)
        return false;
    s->which = (uint32_t *)(void *)(s->uvw + 3 * tile);
    s->moves = (uint8_t *)(s->which + tile);
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
    work->scratch = ffd_alloc_zero(threads, sizeof *work->scratch);
    for (size_t i = 0; work->scratch && i < threads; i++)
        if (!make_thread_scratch(run, tile, &work->scratch[i]))
            return ffd_fail_memory(error);
    return work->scratch ? FFD_OK : ffd_fail_memory(error);
}

static void free_scratch(const point_run *run, deform_scratch *scratch)
{
    for (int i = 0; scratch && i < run->options.threads; i++) {
        ffd_free(scratch[i].uvw);
        ffd_free(scratch[i].displacement);
    }
    ffd_free(scratch);
}

static ffd_status deform_elements(const ffd_embedding *embedding, const ffd_lattice *moved,
                                  const deform_arrays *arrays, const ffd_run_options *options,
                                  ffd_error *error)
{
    deform_work work = {.embedding = embedding, .lattice = moved, .arrays = *arrays};
    point_run run = {.total = 0};
    ffd_status status;
    work.arrays.all = embedding->count;
    work.arrays.status = embedding->status;
    work.arrays.count = arrays->vertices ? arrays->count : embedding->count;
    TRY_END(ffd_embedding_check_lattice(embedding, moved, error));
    TRY_END(ffd_deform_check(&work.arrays, error));
    TRY_END(ffd_point_run_begin(options, work.arrays.count, &run, error));
    TRY_END(make_scratch(&run, &work, error));
    TRY_END(ffd_deform_tiles(&run, &work.arrays, displace, &work, error));
end:
    free_scratch(&run, work.scratch);
    ffd_point_run_end(&run);
    return status;
}

ffd_status ffd_embedding_deform(const ffd_embedding *embedding, const ffd_lattice *moved, ffd_span in,
                                ffd_span out, double *gradients, const ffd_run_options *options,
                                ffd_error *error)
{
    const deform_arrays arrays = {.in = in, .out = out, .gradients = gradients};
    return deform_elements(embedding, moved, &arrays, options, error);
}

/* In place of a list that is empty, which may be NULL. */
static const uint32_t none = 0;

ffd_status ffd_embedding_deform_some(const ffd_embedding *embedding, const ffd_lattice *moved,
                                     const uint32_t *vertices, size_t count, ffd_span in, ffd_span out,
                                     double *gradients, const ffd_run_options *options, ffd_error *error)
{
    const deform_arrays arrays = {.vertices = count > 0 ? vertices : &none,
                                  .count = count,
                                  .in = in,
                                  .out = out,
                                  .gradients = gradients};
    return deform_elements(embedding, moved, &arrays, options, error);
}

ffd_status ffd_embedding_deform_weighted(const ffd_embedding *embedding, const ffd_lattice *moved,
                                         const double *weights, const double *slopes, ffd_span in,
                                         ffd_span out, double *gradients, const ffd_run_options *options,
                                         ffd_error *error)
{
    const deform_arrays arrays = {.is_weighted = true,
                                  .weights = weights,
                                  .slopes = slopes,
                                  .in = in,
                                  .out = out,
                                  .gradients = gradients};
    return deform_elements(embedding, moved, &arrays, options, error);
}

ffd_status ffd_embedding_deform_some_weighted(const ffd_embedding *embedding, const ffd_lattice *moved,
                                              const uint32_t *vertices, size_t count, const double *weights,
                                              const double *slopes, ffd_span in, ffd_span out,
                                              double *gradients, const ffd_run_options *options,
                                              ffd_error *error)
{
    const deform_arrays arrays = {.vertices = count > 0 ? vertices : &none,
                                  .count = count,
                                  .is_weighted = true,
                                  .weights = weights,
                                  .slopes = slopes,
                                  .in = in,
                                  .out = out,
                                  .gradients = gradients};
    return deform_elements(embedding, moved, &arrays, options, error);
}
