#include "job/judge/behind.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "job/chain/chain_apply.h"
#include "lattice/lattice.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* What the chain needs to move a run of places. */
typedef struct place_run {
    chain_scratch chain;
    double points[3 * CHAIN_RUN], delta[3 * CHAIN_RUN];
    point_outcome outcomes[CHAIN_RUN];
} place_run;

/* Adds a name where there is room for one. */
static ffd_status add_name(const mesh_document *document, size_t place, ffd_behind *behind, ffd_error *error)
{
    size_t used = 0;
    while (used < FFD_BEHIND_NAMES && behind->names[used][0])
        used++;
    if (used == FFD_BEHIND_NAMES)
        return FFD_OK;
    char *name = document->format->place_name(document, place);
    if (!name)
        return ffd_fail_memory(error);
    ffd_name_shown(name, behind->names[used], sizeof behind->names[used]);
    ffd_free(name);
    return FFD_OK;
}

static ffd_status count_place(const mesh_document *document, const mesh_place *place, ffd_job_result *result,
                              ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (int kind = 0; kind < FFD_BEHIND_KIND_COUNT && status == FFD_OK; kind++) {
        if (!(place->kinds & PLACE_BIT(kind)))
            continue;
        result->behind[kind].count++;
        status = add_name(document, place->number, &result->behind[kind], error);
    }
    return status;
}

/* Counts those of the places at which vertices would be moved. */
static ffd_status count_places(const deform_job *job, const mesh_places *places, place_run *run,
                               ffd_job_result *result, ffd_error *error)
{
    ffd_status status = FFD_OK;
    ffd_displacement_scratch_clear(&run->chain.displacement);
    run->chain.displacement.kept.threads = 1;
    for (size_t first = 0; first < places->count && status == FFD_OK; first += CHAIN_RUN) {
        const mesh_place *list = places->list + first;
        const size_t left = places->count - first, count = left < CHAIN_RUN ? left : CHAIN_RUN;
        chain_run sent = {.x = run->points,
                          .count = count,
                          .scratch = &run->chain,
                          .delta = run->delta,
                          .outcomes = run->outcomes};
        for (size_t i = 0; i < count; i++)
            memcpy(run->points + 3 * i, list[i].at, sizeof list[i].at);
        status = ffd_chain_apply(&job->chain, job->chain.count, &sent, error);
        for (size_t i = 0; i < count && status == FFD_OK; i++)
            if (run->outcomes[i].moved)
                status = count_place(job->document, &list[i], result, error);
    }
    return status;
}

static ffd_status find_places(const deform_job *job, ffd_job_result *result, ffd_error *error)
{
    mesh_places places = {0};
    ffd_status status = job->document->format->list_places(job->document, &places, error);
    place_run *run = status == FFD_OK && places.count > 0 ? ffd_alloc(1, sizeof *run) : NULL;
    if (run)
        status = count_places(job, &places, run, result, error);
    else if (status == FFD_OK && places.count > 0)
        status = ffd_fail_memory(error);
    ffd_free(run);
    ffd_free(places.list);
    return status;
}

static ffd_status find_splats(const deform_job *job, ffd_behind *splats, ffd_error *error)
{
    ffd_status status = FFD_OK;
    splats->count = job->totals.splats_moved;
    for (int i = 0; i < job->totals.splat_part_count && status == FFD_OK; i++) {
        const mesh_part *part = &job->document->parts[job->totals.splat_parts[i]];
        if (part->place != MESH_NO_PLACE)
            status = add_name(job->document, part->place, splats, error);
    }
    return status;
}

/* Differences of control points' moves that are only rounding, as a part of the lattice's diagonal. */
#define ONE_MOVE 1e-12

/* Whether the lattice moves all of its volume by one vector. */
static bool translates(const ffd_lattice *lattice)
{
    const double *const first = lattice->difference;
    for (size_t i = 0; i < 3 * lattice->count; i++)
        if (fabs(lattice->difference[i] - first[i % 3]) > ONE_MOVE * lattice->diagonal)
            return false;
    return !lattice->weights_moved;
}

/* Whether no part of the mesh is turned or stretched: rotations and scales of splats then are right as they
   are. */
static bool only_translates(const lattice_chain *chain)
{
    for (size_t l = 0; l < chain->count; l++)
        if (!translates(chain->links[l].lattice))
            return false;
    return !(chain->outside.extend && chain->outside.falloff > 0);
}

ffd_status ffd_behind_find(const deform_job *job, ffd_job_result *result, ffd_error *error)
{
    /* A conversion has neither nodes nor properties of splats. */
    if (job->totals.moved == 0 || job->desc->as_morph || (job->document->converted && !job->details))
        return FFD_OK;
    ffd_status status = FFD_OK;
    if (job->totals.splats_moved > 0 && !only_translates(&job->chain))
        status = find_splats(job, &result->behind[FFD_BEHIND_SPLAT], error);
    return status || !job->document->format->list_places ? status : find_places(job, result, error);
}

/* "hand, foot, tail and 2 more"; more: how many there are in all, 0 where the names are not of each. */
static void tell_names(const ffd_behind *behind, uint64_t all, char *text, size_t capacity)
{
    size_t length = 0, named = 0;
    *text = 0;
    for (; named < FFD_BEHIND_NAMES && behind->names[named][0]; named++)
        length += (size_t)snprintf(text + length, capacity - length, "%s%s", named ? ", " : ": ",
                                   behind->names[named]);
    if (all > named)
        snprintf(text + length, capacity - length, " and %" PRIu64 " more", all - named);
}

void ffd_behind_warn(const ffd_job_result *result, const mesh_log *log)
{
    static const char *const one[FFD_BEHIND_KIND_COUNT] = {
        [FFD_BEHIND_SOCKET] = "socket",        [FFD_BEHIND_CAMERA] = "camera",
        [FFD_BEHIND_LIGHT] = "light",          [FFD_BEHIND_JOINT] = "joint",
        [FFD_BEHIND_PIVOT] = "animated pivot", [FFD_BEHIND_PHYSICS_SHAPE] = "physics shape"};
    char names[FFD_BEHIND_NAMES * (sizeof result->behind[0].names[0] + 2) + 40];
    for (int kind = 0; kind < FFD_BEHIND_SPLAT; kind++) {
        const ffd_behind *behind = &result->behind[kind];
        if (behind->count == 0)
            continue;
        tell_names(behind, behind->count, names, sizeof names);
        ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " %s%s, though the lattice moves the mesh there%s",
                     behind->count, one[kind],
                     ffd_plural(behind->count, " stays where it is", "s stay where they are"), names);
    }
    const ffd_behind *splats = &result->behind[FFD_BEHIND_SPLAT];
    if (splats->count == 0)
        return;
    tell_names(splats, 0, names, sizeof names);
    ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " Gaussian splat%s%s", splats->count,
                 ffd_plural(splats->count, " moves, but its rotation and scale stay",
                            "s move, but their rotations and scales stay"),
                 names);
}
