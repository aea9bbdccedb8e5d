/* chain_products.c - products with the derivative of points by the control points of several lattices. */
#include "base/memory/memory.h"
#include "deform/extension.h"
#include "job/arrays/chain_embedding.h"
#include "points/basis_row.h"
#include "points/block_sums.h"
#include <string.h>

/* Scratch memory of a thread. */
typedef struct product_room {
    basis_row row;
    double delta[3 * CHAIN_RUN], gradient[9 * CHAIN_RUN], change[3 * CHAIN_RUN];
    uint32_t which[CHAIN_RUN];
    uint8_t moves[CHAIN_RUN];
    displacement_scratch displacement;
} product_room;

typedef struct product_work {
    const ffd_chain_embedding *embedding;
    const double *const *dq; /* forward: */
    double *dx;
    const double *dfdx; /* back: */
    size_t *starts;     /* where the sums of each lattice begin */
    product_room *rooms;
} product_work;

/* Computes the gradients of a later layer at some points. */
static void find_gradients(const ffd_chain_embedding *embedding, size_t layer, size_t first, size_t count,
                           product_room *room)
{
    const ffd_embedding *const places = &embedding->places[layer];
    displacement_batch batch = {.uvw = places->uvw + 3 * first,
                                .stride = 3 * sizeof(double),
                                .which = room->which,
                                .delta = room->delta,
                                .gradient = room->gradient,
                                .moves = room->moves};
    size_t next = ffd_embedding_first_extended(places, first);
    memset(room->gradient, 0, 9 * count * sizeof *room->gradient);
    for (size_t i = 0; i < count; i++)
        if (ffd_embedding_has(places, first + i))
            room->which[batch.count++] = (uint32_t)i;
    ffd_displacements(places->rest, embedding->chain.isa, &batch, &room->displacement);
    for (; next < places->extended_count && places->extended[next].point < first + count; next++) {
        const size_t i = places->extended[next].point - first;
        ffd_extension_displacement(places->rest, &places->extended[next].nearest, places->falloff,
                                   room->delta + 3 * i, room->gradient + 9 * i);
    }
}

/* Returns the lattice that moves a point in a layer; BLOCK_NONE: none. */
static size_t lattice_of(const ffd_chain_embedding *embedding, size_t layer, size_t point)
{
    return ffd_has_owners(embedding) ? embedding->owners[point] : layer;
}

/* Computes the row of a point in a layer: that of its lattice, which is returned. */
static size_t find_row(const ffd_chain_embedding *embedding, size_t layer, size_t point, size_t *next,
                       basis_row *row)
{
    const size_t l = lattice_of(embedding, layer, point);
    row->count = 0;
    if (l != BLOCK_NONE)
        ffd_basis_row(&embedding->places[l], embedding->places[l].rest->deformed_weights, NULL, BASIS_BY_U,
                      point, next, row);
    return l;
}

/* change = (I + E) change. */
static void carry(const double gradient[9], double change[3])
{
    const double before[3] = {change[0], change[1], change[2]};
    for (int r = 0; r < 3; r++)
        change[r] +=
            gradient[3 * r] * before[0] + gradient[3 * r + 1] * before[1] + gradient[3 * r + 2] * before[2];
}

/* The same with the transposed matrix. */
static void carry_back(const double gradient[9], double change[3])
{
    const double before[3] = {change[0], change[1], change[2]};
    for (int c = 0; c < 3; c++)
        change[c] += gradient[c] * before[0] + gradient[3 + c] * before[1] + gradient[6 + c] * before[2];
}

static ffd_status multiply_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const product_work *const work = context;
    const ffd_chain_embedding *const embedding = work->embedding;
    product_room *const room = &work->rooms[worker];
    double *const dx = work->dx + 3 * first;
    (void)error;
    memset(dx, 0, 3 * count * sizeof *dx);
    for (size_t layer = 0; layer < embedding->layers; layer++) {
        size_t next = ffd_embedding_first_extended(&embedding->places[layer], first);
        if (layer > 0)
            find_gradients(embedding, layer, first, count, room);
        for (size_t i = 0; i < count; i++) {
            const size_t l = find_row(embedding, layer, first + i, &next, &room->row);
            const double *const dq = l == BLOCK_NONE ? NULL : work->dq[l];
            if (layer > 0)
                carry(room->gradient + 9 * i, dx + 3 * i);
            for (size_t e = 0; dq && e < room->row.count; e++)
                for (size_t c = 0; c < 3; c++)
                    dx[3 * i + c] += room->row.values[e] * dq[3 * (size_t)room->row.columns[e] + c];
        }
    }
    return FFD_OK;
}

static void add_block(void *context, size_t first, size_t last, int worker, double *sum)
{
    const product_work *const work = context;
    const ffd_chain_embedding *const embedding = work->embedding;
    const size_t count = last - first;
    product_room *const room = &work->rooms[worker];
    memcpy(room->change, work->dfdx + 3 * first, 3 * count * sizeof *room->change);
    for (size_t layer = embedding->layers; layer-- > 0;) {
        size_t next = ffd_embedding_first_extended(&embedding->places[layer], first);
        if (layer > 0)
            find_gradients(embedding, layer, first, count, room);
        for (size_t i = 0; i < count; i++) {
            const size_t l = find_row(embedding, layer, first + i, &next, &room->row);
            double *const to = l == BLOCK_NONE ? NULL : sum + work->starts[l];
            for (size_t e = 0; e < room->row.count; e++)
                for (size_t c = 0; c < 3; c++)
                    to[3 * (size_t)room->row.columns[e] + c] += room->row.values[e] * room->change[3 * i + c];
            if (layer > 0)
                carry_back(room->gradient + 9 * i, room->change + 3 * i);
        }
    }
}

/* Begins a product. */
static ffd_status begin(const ffd_run_options *options, point_run *run, product_work *work, ffd_error *error)
{
    TRY(ffd_point_run_begin(options, work->embedding->count, run, error));
    work->rooms = ffd_alloc_zero((size_t)run->options.threads, sizeof *work->rooms);
    for (int i = 0; work->rooms && i < run->options.threads; i++)
        work->rooms[i].displacement.kept.threads = run->options.threads;
    return work->rooms ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_chain_embedding_basis_times(const ffd_chain_embedding *embedding, const double *const *dq,
                                           double *dx, const ffd_run_options *options, ffd_error *error)
{
    product_work work = {.embedding = embedding, .dq = dq, .dx = dx};
    point_run run = {.total = 0};
    ffd_status status;
    TRY_END(begin(options, &run, &work, error));
    TRY_END(ffd_point_run_tiles(&run, multiply_tile, &work, error));
end:
    ffd_free(work.rooms);
    ffd_point_run_end(&run);
    return status;
}

/* Adds up the sums of all lattices, and gives the caller those that are wanted. */
static ffd_status add_all(const point_run *run, product_work *work, double *const *dfdq, ffd_error *error)
{
    const lattice_chain *const chain = &work->embedding->chain;
    double *sum = NULL;
    ffd_status status;
    work->starts = ffd_alloc(chain->count + 1, sizeof *work->starts);
    TRY_END(work->starts ? FFD_OK : ffd_fail_memory(error));
    work->starts[0] = 0;
    for (size_t l = 0; l < chain->count; l++)
        work->starts[l + 1] = work->starts[l] + 3 * chain->links[l].lattice->count;
    sum = ffd_alloc(work->starts[chain->count], sizeof *sum);
    TRY_END(sum ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_block_sums(run, work->starts[chain->count], add_block, work, sum, error));
    for (size_t l = 0; l < chain->count; l++)
        if (dfdq[l])
            memcpy(dfdq[l], sum + work->starts[l], (work->starts[l + 1] - work->starts[l]) * sizeof *sum);
end:
    ffd_free(sum);
    ffd_free(work->starts);
    return status;
}

ffd_status ffd_chain_embedding_basis_transposed(const ffd_chain_embedding *embedding, const double *dfdx,
                                                double *const *dfdq, const ffd_run_options *options,
                                                ffd_error *error)
{
    product_work work = {.embedding = embedding, .dfdx = dfdx};
    point_run run = {.total = 0};
    ffd_status status;
    TRY_END(begin(options, &run, &work, error));
    TRY_END(add_all(&run, &work, dfdq, error));
end:
    ffd_free(work.rooms);
    ffd_point_run_end(&run);
    return status;
}
