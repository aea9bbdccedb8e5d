/* chain_deform.c - deforms points that are embedded in several lattices. */
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/vector/vec.h"
#include "job/arrays/chain_embedding.h"
#include "points/deform_tiles.h"
#include "points/span.h"
#include <math.h>
#include <string.h>

void ffd_chain_deform_desc_init(ffd_chain_deform_desc *desc, size_t size)
{
    const ffd_chain_deform_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

typedef struct deform_work {
    const ffd_chain_embedding *embedding;
    chain_link *links; /* those of the embedding, with moved lattices */
    size_t known;      /* so many layers have the locations of the embedding */
    chain_room *rooms; /* one for each thread */
} deform_work;

static ffd_status displace(void *context, const deform_tile *tile, int worker, ffd_error *error)
{
    const deform_work *const work = context;
    chain_room *const room = &work->rooms[worker];
    const chain_points points = {tile->first, tile->count, tile->arrays->vertices};
    memcpy(room->x, tile->x, 3 * tile->count * sizeof *tile->x);
    return ffd_chain_send_all(work->embedding, work->links, work->known, &points, room, tile->delta,
                              tile->gradient, error);
}

/* Copies the links, with the moved lattices, and finds which layers are known: the first is, and those that
   points reach as the lattices' own control points take them. */
static ffd_status take_moved(const ffd_chain_embedding *embedding, const ffd_lattice *const *moved,
                             deform_work *work, ffd_error *error)
{
    const lattice_chain *const chain = &embedding->chain;
    work->links = ffd_alloc(chain->count, sizeof *work->links);
    if (!work->links)
        return ffd_fail_memory(error);
    memcpy(work->links, chain->links, chain->count * sizeof *work->links);
    work->known = embedding->layers;
    for (size_t l = 0; moved && l < chain->count; l++) {
        ffd_error own;
        if (!moved[l])
            continue;
        if (ffd_embedding_check_lattice(&embedding->places[l], moved[l], &own))
            return ffd_fail(error, FFD_E_INVALID, "lattice %zu: %s", l, own.message);
        work->links[l].moved = moved[l];
        work->known = work->known > l + 1 ? l + 1 : work->known;
    }
    return FFD_OK;
}

static ffd_status deform(const ffd_chain_embedding *embedding, const ffd_chain_deform_desc *desc,
                         const ffd_run_options *options, ffd_error *error)
{
    deform_work work = {.embedding = embedding};
    deform_arrays arrays = {.all = embedding->count,
                            .status = embedding->status,
                            .vertices = desc->vertices,
                            .count = desc->vertices ? desc->vertex_count : embedding->count,
                            .is_weighted = desc->weights != NULL,
                            .weights = desc->weights,
                            .slopes = desc->slopes,
                            .in = desc->in,
                            .out = desc->out,
                            .gradients = desc->gradients};
    point_run run = {.total = 0};
    ffd_status status;
    TRY_END(take_moved(embedding, desc->moved, &work, error));
    TRY_END(ffd_deform_check(&arrays, error));
    TRY_END(ffd_point_run_begin(options, arrays.count, &run, error));
    work.rooms = ffd_chain_rooms(&run);
    TRY_END(work.rooms ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_deform_tiles(&run, &arrays, displace, &work, error));
end:
    ffd_free(work.rooms);
    ffd_free(work.links);
    ffd_point_run_end(&run);
    return status;
}

ffd_status ffd_chain_embedding_deform(const ffd_chain_embedding *embedding,
                                      const ffd_chain_deform_desc *callers, const ffd_run_options *options,
                                      ffd_error *error)
{
    ffd_chain_deform_desc desc;
    ffd_chain_deform_desc_init(&desc, sizeof desc);
    TRY(ffd_struct_take(&desc, sizeof desc, callers, "ffd_chain_deform_desc", error));
    return deform(embedding, &desc, options, error);
}

typedef struct bounds_work {
    const ffd_chain_embedding *embedding;
    ffd_span points;
    chain_room *rooms;
    double (*boxes)[6]; /* one for each thread: the least and the greatest x, y, z */
} bounds_work;

static ffd_status widen_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const bounds_work *const work = context;
    const ffd_chain_embedding *const embedding = work->embedding;
    chain_room *const room = &work->rooms[worker];
    double *const box = work->boxes[worker];
    const chain_points points = {first, count, NULL};
    ffd_span_read(&work->points, first, count, room->x);
    for (size_t layer = 0; layer < embedding->layers; layer++)
        TRY(ffd_chain_send(embedding, embedding->chain.links, layer, true, &points, room, room->delta, NULL,
                           error));
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3 && vec_is_finite(room->x + 3 * i); c++) {
            box[c] = lesser_of(box[c], room->x[3 * i + c]);
            box[3 + c] = larger_of(box[3 + c], room->x[3 * i + c]);
        }
    return FFD_OK;
}

static ffd_status widen_all(point_run *run, bounds_work *work, ffd_error *error)
{
    work->rooms = ffd_chain_rooms(run);
    work->boxes = ffd_alloc((size_t)run->options.threads, sizeof *work->boxes);
    if (!work->rooms || !work->boxes)
        return ffd_fail_memory(error);
    for (int i = 0; i < run->options.threads; i++)
        for (size_t c = 0; c < 6; c++)
            work->boxes[i][c] = c < 3 ? HUGE_VAL : -HUGE_VAL;
    return ffd_point_run_tiles(run, widen_tile, work, error);
}

ffd_status ffd_chain_embedding_bounds(const ffd_chain_embedding *embedding, ffd_span points, double min[3],
                                      double max[3], const ffd_run_options *options, ffd_error *error)
{
    bounds_work work = {.embedding = embedding, .points = points};
    point_run run = {.total = 0};
    ffd_status status;
    TRY_END(ffd_span_check(&work.points, embedding->count, "the array of points", error));
    TRY_END(ffd_point_run_begin(options, embedding->count, &run, error));
    TRY_END(widen_all(&run, &work, error));
    for (size_t c = 0; c < 3; c++) {
        min[c] = HUGE_VAL;
        max[c] = -HUGE_VAL;
        for (int i = 0; i < run.options.threads; i++) {
            min[c] = lesser_of(min[c], work.boxes[i][c]);
            max[c] = larger_of(max[c], work.boxes[i][3 + c]);
        }
    }
end:
    ffd_free(work.rooms);
    ffd_free(work.boxes);
    ffd_point_run_end(&run);
    return status;
}
