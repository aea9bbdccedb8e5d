#include "job/rig/rig_places.h"
#include "base/memory/memory.h"
#include "job/chain/chain_apply.h"
#include <string.h>

/* Context of a run of places through the chain. */
typedef struct place_run {
    chain_scratch chain;
    double points[3 * CHAIN_RUN], delta[3 * CHAIN_RUN], gradient[9 * CHAIN_RUN];
    point_outcome outcomes[CHAIN_RUN];
} place_run;

static void note_move(const mesh_place *place, const place_run *run, size_t i, mesh_place_move *move)
{
    const point_outcome *const outcome = &run->outcomes[i];
    *move = (mesh_place_move){.moves = outcome->moved, .singular = outcome->status == FFD_SINGULAR};
    for (int a = 0; a < 3; a++) {
        move->became[a] = place->at[a];
        move->to[a] = place->at[a] + (outcome->moved ? run->delta[3 * i + (size_t)a] : 0);
    }
    if (outcome->moved && !move->singular)
        memcpy(move->gradient, run->gradient + 9 * i, sizeof move->gradient);
}

static ffd_status send(const lattice_chain *chain, const rig_places *rig, place_run *run, ffd_error *error)
{
    ffd_status status = FFD_OK;
    ffd_displacement_scratch_clear(&run->chain.displacement);
    run->chain.displacement.kept.threads = 1;
    for (size_t first = 0; first < rig->places.count && status == FFD_OK; first += CHAIN_RUN) {
        const mesh_place *const list = rig->places.list + first;
        const size_t left = rig->places.count - first, count = left < CHAIN_RUN ? left : CHAIN_RUN;
        chain_run sent = {.x = run->points,
                          .count = count,
                          .scratch = &run->chain,
                          .delta = run->delta,
                          .gradient = run->gradient,
                          .outcomes = run->outcomes};
        for (size_t i = 0; i < count; i++)
            memcpy(run->points + 3 * i, list[i].at, sizeof list[i].at);
        status = ffd_chain_apply(chain, chain->count, &sent, error);
        for (size_t i = 0; i < count && status == FFD_OK; i++)
            note_move(&list[i], run, i, &rig->moves[first + i]);
    }
    return status;
}

ffd_status ffd_rig_places_find(const mesh_document *document, const lattice_chain *chain, bool all,
                               rig_places *rig, ffd_error *error)
{
    *rig = (rig_places){0};
    if (!document->format->list_places)
        return FFD_OK;
    ffd_status status = document->format->list_places(document, all, &rig->places, error);
    if (status || rig->places.count == 0)
        return status;
    rig->moves = ffd_alloc_zero(rig->places.count, sizeof *rig->moves);
    place_run *const run = ffd_alloc(1, sizeof *run);
    status = rig->moves && run ? send(chain, rig, run, error) : ffd_fail_memory(error);
    ffd_free(run);
    return status;
}

void ffd_rig_places_free(rig_places *rig)
{
    ffd_free(rig->places.list);
    ffd_free(rig->moves);
    *rig = (rig_places){0};
}
