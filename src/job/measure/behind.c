#include "job/measure/behind.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "job/measure/rig.h"
#include "lattice/lattice.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Adds a place's name to the list, if it is not full. */
static ffd_status add_name(const mesh_document *document, size_t place, ffd_behind *behind, ffd_error *error)
{
    size_t used = 0;
    while (used < FFD_BEHIND_NAMES && behind->names[used][0])
        used++;
    if (used == FFD_BEHIND_NAMES)
        return FFD_OK;
    char *name = document->format->places->name(document, place);
    if (!name)
        return ffd_fail_memory(error);
    ffd_name_shown(name, behind->names[used], sizeof behind->names[used]);
    ffd_free(name);
    return FFD_OK;
}

static ffd_status count_place(const mesh_document *document, const mesh_place *place, ffd_job_result *result,
                              ffd_error *error)
{
    for (int kind = 0; kind < FFD_BEHIND_KIND_COUNT; kind++) {
        if (!(place->kinds & PLACE_BIT(kind)))
            continue;
        result->behind[kind].count++;
        TRY(add_name(document, place->index, &result->behind[kind], error));
    }
    return FFD_OK;
}

/* Counts the places where vertices would be moved, but that have not moved along. */
static ffd_status find_places(const deform_job *job, ffd_job_result *result, ffd_error *error)
{
    const double diagonal = ffd_rig_diagonal(&result->bounds.before);
    for (size_t i = 0; i < job->rig.places.count; i++) {
        const mesh_place_move *const move = &job->rig.moves[i];
        const bool stays = job->desc->rig == FFD_RIG_KEEP || ffd_rig_lag(move, diagonal) > 0;
        if (move->moves && stays)
            TRY(count_place(job->document, &job->rig.places.list[i], result, error));
    }
    return FFD_OK;
}

static ffd_status find_splats(const deform_job *job, ffd_behind *splats, ffd_error *error)
{
    splats->count = job->totals.splats_moved;
    for (int i = 0; i < job->totals.splat_part_count; i++) {
        const mesh_part *part = &job->document->parts[job->totals.splat_parts[i]];
        if (part->place != MESH_NO_PLACE)
            TRY(add_name(job->document, part->place, splats, error));
    }
    return FFD_OK;
}

/* Displacements of control points are equal if they differ by at most this part of the lattice's diagonal. */
#define ONE_MOVE 1e-12

/* Whether the lattice only translates its volume. */
static bool translates(const ffd_lattice *lattice)
{
    const double *const first = lattice->difference;
    for (size_t i = 0; i < 3 * lattice->count; i++)
        if (fabs(lattice->difference[i] - first[i % 3]) > ONE_MOVE * lattice->diagonal)
            return false;
    return !lattice->weights_moved;
}

/* Whether the mesh is only translated: then the rotations and scales of splats stay correct. */
static bool only_translates(const lattice_chain *chain)
{
    for (size_t l = 0; l < chain->count; l++)
        if (!translates(ffd_link_mover(&chain->links[l])))
            return false;
    return !(chain->outside.extend && chain->outside.falloff > 0);
}

ffd_status ffd_behind_find(const deform_job *job, ffd_job_result *result, ffd_error *error)
{
    /* Conversions drop nodes and the properties of splats. */
    if (job->totals.moved == 0 || (job->converts && !job->details))
        return FFD_OK;
    ffd_status status = FFD_OK;
    if (job->totals.splats_moved > 0 && !only_translates(&job->chain))
        status = find_splats(job, &result->behind[FFD_BEHIND_SPLAT], error);
    /* A morph target leaves the base shape, and all places, where they were. */
    return status || job->desc->as_morph ? status : find_places(job, result, error);
}
