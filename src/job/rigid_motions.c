#include "job/rigid_motions.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/words.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "job/deform_passes.h"
#include "job/input/source.h"
#include "job/pass/pass.h"
#include "mesh/twins.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Temporary memory for each vertex, in bytes: where it lies before and after, and what finds splits. */
#define VERTEX_BYTES (6 * sizeof(double) + sizeof(uint32_t) + POSITION_TWIN_BYTES)

/* Vertices at one position move apart if that is more than this part of the largest coordinate. */
#define APART 1e-9

static rigid_request request_of(const deform_job *job)
{
    const ffd_deform_desc *const desc = job->desc;
    return (rigid_request){desc->rigid, desc->uniform, desc->rigid_count, desc->uniform_count,
                           desc->only_count > 0};
}

ffd_status ffd_rigid_pieces_load(deform_job *job, ffd_error *error)
{
    const rigid_request request = request_of(job);
    if (request.rigid_count + request.uniform_count == 0)
        return FFD_OK;
    return ffd_rigid_parts_load(&request, job->document, ffd_job_judged(job),
                                ffd_source_name(&job->desc->input), job->threads, &job->file_log, &job->rigid,
                                error);
}

/* Where the vertices lie: before, and after if nothing is rigid. */
typedef struct vertex_places {
    size_t count;
    double *before, *after; /* 3 a vertex */
} vertex_places;

static void read_before(const deform_job *job, const vertex_places *places)
{
    const mesh_document *const document = job->document;
    for (size_t i = 0; i < document->part_count; i++) {
        const size_t count = document->parts[i].vertex_count;
        double *const at = places->before + 3 * job->rigid.first[i];
        if (document->parts[i].repeats_positions)
            continue;
        document->format->read(document, i, MESH_POSITIONS, ffd_job_judged(job), 0, count, at);
        ffd_part_transform(document, i, 0, count, at);
    }
}

/* Deforms the mesh without its pieces, into places->after alone. */
static ffd_status deform_freely(deform_job *job, const vertex_places *places, ffd_error *error)
{
    const bool is_stored = ffd_job_judged(job) == MESH_STORED;
    mesh_pass pass = {.document = job->document,
                      .state = ffd_job_judged(job),
                      .chain = &job->chain,
                      .links = job->chain.count,
                      .threads = job->threads,
                      .weights = ffd_job_weights(job),
                      .deformed = places->after};
    pass_totals totals;
    if (is_stored && job->desc->embedding.path)
        pass.embedding = &job->embedding;
    if (is_stored)
        ffd_pass_take_locations(job, true, &pass);
    TRY(ffd_pass_over_mesh(&pass, &totals, error));
    if (is_stored)
        ffd_pass_keep_locations(job, &pass);
    return FFD_OK;
}

typedef void add_function(motion_sums *sums, const double x[3], const double y[3]);

/* Adds all vertices of pieces to their sums, in their order. */
static void add_vertices(const rigid_parts *parts, const vertex_places *places, add_function *add,
                         motion_sums *sums)
{
    for (size_t v = 0; v < places->count; v++) {
        const double *const x = places->before + 3 * v, *const y = places->after + 3 * v;
        if (parts->pieces[v] != MESH_NONE && vec_is_finite(x) && vec_is_finite(y))
            add(&sums[parts->pieces[v]], x, y);
    }
}

static ffd_status find_motions(rigid_parts *parts, const vertex_places *places, const memory_budget *budget,
                               ffd_error *error)
{
    TRY(ffd_budget_check(budget, parts->count, sizeof(motion_sums), error));
    motion_sums *const sums = ffd_alloc_zero(parts->count, sizeof *sums);
    if (!sums)
        return ffd_fail_memory(error);
    add_vertices(parts, places, ffd_motion_add, sums);
    for (size_t i = 0; i < parts->count; i++)
        ffd_motion_middle(&sums[i]);
    add_vertices(parts, places, ffd_motion_add_product, sums);
    for (size_t i = 0; i < parts->count; i++)
        ffd_motion_find(&sums[i], parts->list[i].part >= parts->rigid_count, &parts->list[i].motion);
    ffd_free(sums);
    return FFD_OK;
}

/* Notes how far the pieces take their vertices from where these would lie, and puts them there. */
static void move_vertices(const rigid_parts *parts, const vertex_places *places, ffd_rigid_figures *figures)
{
    for (size_t v = 0; v < places->count; v++) {
        const double *const x = places->before + 3 * v;
        double *const y = places->after + 3 * v, delta[3], off[3];
        if (parts->pieces[v] == MESH_NONE || !vec_is_finite(x) || !vec_is_finite(y))
            continue;
        const rigid_piece *const piece = &parts->list[parts->pieces[v]];
        ffd_motion_displace(&piece->motion, x, delta);
        for (int a = 0; a < 3; a++) {
            off[a] = x[a] + delta[a] - y[a];
            y[a] = x[a] + delta[a];
        }
        ffd_rigid_part *const part = &figures->parts[piece->part];
        part->distance = larger_of(part->distance, vec_length(off));
    }
}

static void fill_figures(const deform_job *job, ffd_rigid_figures *figures)
{
    const rigid_parts *const parts = &job->rigid;
    const rigid_request request = request_of(job);
    *figures = (ffd_rigid_figures){.count = parts->part_count};
    for (size_t k = 0; k < parts->part_count; k++) {
        ffd_name_shown(ffd_rigid_part_text(&request, k), figures->parts[k].part,
                       sizeof figures->parts[k].part);
        figures->parts[k].scale = 1;
    }
    for (size_t i = 0; i < parts->count; i++) {
        const rigid_motion *const motion = &parts->list[i].motion;
        ffd_rigid_part *const part = &figures->parts[parts->list[i].part];
        part->pieces++;
        part->rotation = larger_of(part->rotation, ffd_motion_degrees(motion));
        if (fabs(motion->scale - 1) > fabs(part->scale - 1))
            part->scale = motion->scale;
    }
}

/* Counts the vertices that lie apart from an earlier one that shared their position, as only one of them
   moves with a piece. */
static void count_splits(const rigid_parts *parts, const vertex_places *places, const uint32_t *twins,
                         rigid_splits *splits)
{
    double size = 0;
    for (size_t i = 0; i < 3 * places->count; i++)
        size = isfinite(places->after[i]) ? larger_of(size, fabs(places->after[i])) : size;
    for (size_t v = 0; v < places->count; v++) {
        const size_t first = twins[v];
        double off[3];
        if (parts->pieces[v] == parts->pieces[first])
            continue;
        for (size_t a = 0; a < 3; a++)
            off[a] = places->after[3 * v + a] - places->after[3 * first + a];
        const double apart = vec_is_finite(off) ? vec_length(off) : 0;
        splits->count += apart > APART * size;
        if (apart > APART * size && apart > splits->largest) {
            splits->largest = apart;
            splits->vertex = v;
        }
    }
}

static ffd_status find_splits(deform_job *job, const vertex_places *places, ffd_error *error)
{
    uint32_t *const twins = ffd_alloc(places->count, sizeof *twins);
    if (!twins)
        return ffd_fail_memory(error);
    const ffd_status status = ffd_positions_twins(places->before, places->count, job->threads, twins, error);
    if (!status)
        count_splits(&job->rigid, places, twins, &job->rigid.splits);
    ffd_free(twins);
    return status;
}

ffd_status ffd_rigid_motions_find(deform_job *job, ffd_job_result *result, ffd_error *error)
{
    rigid_parts parts = job->rigid;
    vertex_places places = {.count = (size_t)ffd_mesh_vertex_count(job->document)};
    ffd_status status = FFD_OK;
    if (!parts.pieces)
        return FFD_OK;
    if (parts.count == 0)
        goto end;
    TRY(ffd_budget_check(&job->document->budget, places.count, VERTEX_BYTES, error));
    places.before = ffd_alloc(places.count, 3 * sizeof *places.before);
    places.after = ffd_alloc(places.count, 3 * sizeof *places.after);
    TRY_END(places.before && places.after ? FFD_OK : ffd_fail_memory(error));
    read_before(job, &places);
    TRY_END(deform_freely(job, &places, error));
    TRY_END(ffd_deadline_check(error));
    TRY_END(find_motions(&parts, &places, &job->document->budget, error));
    fill_figures(job, &result->rigid);
    move_vertices(&parts, &places, &result->rigid);
    status = find_splits(job, &places, error);
end:
    if (parts.count == 0)
        fill_figures(job, &result->rigid);
    ffd_free(places.before);
    ffd_free(places.after);
    return status;
}

ffd_status ffd_rigid_move_places(deform_job *job, ffd_error *error)
{
    const rig_places *const rig = &job->rig;
    const mesh_place_calls *const calls = job->document->format->places;
    if (job->rigid.count == 0 || rig->places.count == 0)
        return FFD_OK;
    uint32_t *const pieces = ffd_alloc(rig->places.count, sizeof *pieces);
    if (!pieces)
        return ffd_fail_memory(error);
    const ffd_status status =
        calls->find_pieces(job->document, &rig->places, job->rigid.pieces, pieces, error);
    for (size_t i = 0; i < rig->places.count && !status; i++) {
        mesh_place_move *const move = &rig->moves[i];
        const double *const at = rig->places.list[i].at;
        if (pieces[i] == MESH_NONE)
            continue;
        const rigid_motion *const motion = &job->rigid.list[pieces[i]].motion;
        double delta[3];
        ffd_motion_displace(motion, at, delta);
        move->moves = vec_greatest(delta) > 0 || mat_largest_entry(motion->gradient) > 0;
        move->singular = false;
        memcpy(move->gradient, motion->gradient, sizeof move->gradient);
        for (int a = 0; a < 3; a++)
            move->to[a] = at[a] + delta[a];
    }
    ffd_free(pieces);
    return status;
}

/* A turn of less shortens the chords by less than a thousandth. */
#define TURN_SAID 5.0

void ffd_rigid_warn(const deform_job *job, const ffd_job_result *result)
{
    const ffd_rigid_part *worst = NULL;
    if (!job->desc->as_morph)
        return;
    for (uint64_t k = 0; k < result->rigid.count; k++)
        if (result->rigid.parts[k].rotation > (worst ? worst->rotation : TURN_SAID))
            worst = &result->rigid.parts[k];
    if (!worst)
        return;
    double sine, cosine;
    ffd_sincos_degrees(worst->rotation / 2, &sine, &cosine);
    ffd_log_line(&job->log, FFD_LOG_WARNING,
                 "%s turns by %.3g degrees, but a morph target moves vertices straight: halfway it is %.3g "
                 "times as large across its axis",
                 worst->part, worst->rotation, cosine);
}
