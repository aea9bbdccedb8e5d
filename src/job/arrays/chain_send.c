/* chain_send.c - sends points of an array through the lattices of a chain. */
#include "base/memory/memory.h"
#include "base/vector/array_kernel.h"
#include "job/arrays/chain_embedding.h"
#include "job/chain/chain_apply.h"
#include "mesh/rounding.h"
#include <string.h>

/* A float32 point stands for its rounding cell, also where lattices have taken it. */
static void find_cell(const void *context, size_t point, bool is_first, const double x[3], double half[3])
{
    static const mesh_rounding of_floats = {.is_float = {true, true, true}};
    (void)context;
    (void)point;
    (void)is_first;
    ffd_rounding_cell(&of_floats, x, half);
}

/* Fills the locations, the owners and the border places of the points in a layer from the embedding. */
static void recall(const ffd_chain_embedding *embedding, size_t layer, const chain_points *points,
                   chain_room *room)
{
    const ffd_embedding *const places = &embedding->places[layer];
    const bool has_owners = ffd_has_owners(embedding);
    size_t next = points->count > 0 ? ffd_embedding_first_extended(places, ffd_chain_point(points, 0)) : 0;
    for (size_t i = 0; i < points->count; i++) {
        const size_t point = ffd_chain_point(points, i);
        const bool has = ffd_embedding_has(places, point);
        ffd_location *const location = &room->chain.locations[i];
        *location = (ffd_location){.status = places->status[point]};
        memcpy(location->uvw, places->uvw + 3 * point, sizeof location->uvw);
        if (has_owners)
            room->chain.owners[i] = has ? embedding->owners[point] : BLOCK_NONE;
        while (next < places->extended_count && places->extended[next].point < point)
            next++;
        const bool extended = next < places->extended_count && places->extended[next].point == point;
        room->borders[i].nearest =
            extended ? places->extended[next].nearest : (boundary_point){.found = false};
        room->borders[i].block = extended && has_owners ? embedding->owners[point] : 0;
    }
}

ffd_status ffd_chain_send(const ffd_chain_embedding *embedding, chain_link *links, size_t layer, bool known,
                          const chain_points *points, chain_room *room, double *delta, double *gradient,
                          ffd_error *error)
{
    static const chain_rounding of_floats = {.find = find_cell};
    lattice_chain chain = embedding->chain;
    chain.links = links;
    if (!chain.blocks) {
        chain.links += layer;
        chain.count = 1;
    }
    chain_run run = {.x = room->x,
                     .count = points->count,
                     .located = known,
                     .borders = room->borders,
                     .first_only = true,
                     .rounding = embedding->is_float ? &of_floats : NULL,
                     .scratch = &room->chain,
                     .delta = delta,
                     .gradient = gradient,
                     .outcomes = room->outcomes};
    if (known)
        recall(embedding, layer, points, room);
    else
        for (size_t i = 0; i < points->count; i++)
            room->borders[i].nearest.found = false;
    return ffd_chain_apply(&chain, chain.count, &run, error);
}

/* Adds what a later layer does to the displacements and gradients of those before. moved: by these. */
static void join(const ffd_chain_embedding *embedding, size_t count, const chain_room *room, uint8_t *moved,
                 double *delta, double *gradient)
{
    ffd_array_kernel(embedding->chain.isa)->add(room->delta, 3 * count, delta);
    for (size_t i = 0; i < count; i++) {
        const bool moves = room->outcomes[i].moved;
        if (gradient && moves && moved[i])
            ffd_gradients_compose(gradient + 9 * i, room->gradient + 9 * i);
        else if (gradient && moves)
            memcpy(gradient + 9 * i, room->gradient + 9 * i, 9 * sizeof *gradient);
        moved[i] |= moves;
    }
}

ffd_status ffd_chain_send_all(const ffd_chain_embedding *embedding, chain_link *links, size_t known,
                              const chain_points *points, chain_room *room, double *delta, double *gradient,
                              ffd_error *error)
{
    uint8_t moved[CHAIN_RUN];
    for (size_t layer = 0; layer < embedding->layers; layer++) {
        const bool first = layer == 0;
        TRY(ffd_chain_send(embedding, links, layer, layer < known, points, room, first ? delta : room->delta,
                           !gradient ? NULL
                           : first   ? gradient
                                     : room->gradient,
                           error));
        for (size_t i = 0; i < points->count && first; i++)
            moved[i] = room->outcomes[i].moved;
        if (!first)
            join(embedding, points->count, room, moved, delta, gradient);
    }
    return FFD_OK;
}

chain_room *ffd_chain_rooms(const point_run *run)
{
    chain_room *const rooms = ffd_alloc_zero((size_t)run->options.threads, sizeof *rooms);
    for (int i = 0; rooms && i < run->options.threads; i++)
        rooms[i].chain.displacement.kept.threads = run->options.threads;
    return rooms;
}
