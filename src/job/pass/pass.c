#include "job/pass/pass.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/vector/array_kernel.h"
#include "base/vector/vec.h"
#include "deform/attribute.h"
#include "job/chain/chain_apply.h"
#include "job/chain/marks.h"
#include "job/chain/point_rounding.h"
#include "job/pass/pass_shapes.h"
#include "job/pass/pass_splats.h"
#include "job/pass/tile_rounding.h"
#include "job/pass/tile_totals.h"
#include "job/pass/vertex_rounding.h"
#include <ffd/deform.h>
#include <math.h>
#include <string.h>

/* Transforms a tile's positions from the file's space to the lattice's. */
static void place_points(const part_work *work, tile_scratch *scratch, size_t first, size_t count,
                         double *points, pass_totals *totals)
{
    const mesh_document *document = work->pass->document;
    const bool is_counted = !work->part->repeats_positions && !work->part->skipped;
    ffd_vertex_transforms_read(document, work->part_number, first, count, &scratch->transforms,
                               is_counted ? &totals->weights : NULL);
    if (work->part->skinned)
        ffd_points_transform(scratch->transforms.transforms, count, points);
    else
        ffd_part_transform(document, work->part_number, first, count, points);
}

static void fill_nan(double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        values[i] = NAN;
}

/* det F relative to the product of the lengths of F's rows: closer to 0 it may be the rounding of a collapse.
 */
#define COLLAPSE 1e-12

static bool turns_over(const double f[9], double det)
{
    return det < 0 && det < -COLLAPSE * vec_length(f) * vec_length(f + 3) * vec_length(f + 6);
}

static void note_range(double det, bool outside, size_t number, pass_totals *totals)
{
    totals->det_min = lesser_of(totals->det_min, det);
    totals->det_max = larger_of(totals->det_max, det);
    if (outside && det < totals->det_outside) {
        totals->det_outside = det;
        totals->first_det_outside = number;
    }
}

static void note_inversion(double det, size_t number, pass_totals *totals)
{
    totals->inverted++;
    if (det < totals->det_inverted || (det == totals->det_inverted && number < totals->first_inverted)) {
        totals->det_inverted = det;
        totals->first_inverted = number;
    }
}

/* Returns whether a link moves a vertex in a way that F tells. outcome: its own. i: its index in the tile. */
static bool has_gradient(const part_work *work, const tile_scratch *scratch, const point_outcome *outcome,
                         size_t i)
{
    const bool singular = work->part->skinned ? scratch->transforms.singular[i] : work->part->singular;
    return !singular && outcome->status != FFD_SINGULAR && (outcome->located || outcome->extended);
}

/* Computes F = I + E and returns its determinant. */
static double gradient_determinant(const double gradient[9], double f[9])
{
    for (int k = 0; k < 9; k++)
        f[k] = gradient[k] + (k % 4 == 0 ? 1 : 0);
    return mat_determinant(f);
}

/* Looks at det F of all vertices of a tile (after spread). */
static void note_determinants(const part_work *work, const tile_scratch *scratch, size_t first, size_t count,
                              pass_totals *totals)
{
    for (size_t i = 0; i < count; i++) {
        const point_outcome *const outcome = &scratch->point_outcomes[i];
        double f[9];
        const double det = gradient_determinant(scratch->gradient + 9 * i, f);
        const size_t number = (size_t)work->first_vertex + first + i;
        if (!has_gradient(work, scratch, outcome, i))
            continue;
        note_range(det, outcome->extended, number, totals);
        if (!outcome->extended && turns_over(f, det))
            note_inversion(det, number, totals);
    }
}

/* Counts the vertices that turn inside out, of which turns has the candidates (before spread). */
static void note_turns(const part_work *work, const tile_scratch *scratch, size_t first, pass_totals *totals)
{
    for (size_t k = 0; k < scratch->turns.count; k++) {
        const size_t chosen = scratch->turns.points[k], i = ffd_tile_chosen(scratch, chosen);
        const point_outcome *const outcome = &scratch->point_outcomes[chosen];
        double f[9];
        const double det = gradient_determinant(scratch->gradient + 9 * chosen, f);
        if (!outcome->extended && turns_over(f, det) && has_gradient(work, scratch, outcome, i))
            note_inversion(det, (size_t)work->first_vertex + first + i, totals);
    }
}

/* Fills the caller's arrays from a tile's results (after spread). */
static void fill_arrays(const part_work *work, const tile_scratch *scratch, size_t first, size_t count)
{
    const mesh_pass *pass = work->pass;
    if (!pass->statuses && !pass->deformed && !pass->gradients)
        return;
    for (size_t i = 0; i < count; i++) {
        const size_t number = (size_t)work->first_vertex + first + i;
        const bool singular = ffd_vertex_transform_of(&scratch->transforms, i).singular;
        const point_outcome *outcome = &scratch->point_outcomes[i];
        const double *gradient = scratch->gradient + 9 * i;
        if (pass->statuses)
            pass->statuses[number] = outcome->status;
        if (pass->deformed) {
            memcpy(pass->deformed + 3 * number, scratch->position + 3 * i, 3 * sizeof *scratch->position);
            if (singular)
                fill_nan(pass->deformed + 3 * number, 3);
        }
        if (pass->gradients) {
            memcpy(pass->gradients + 9 * number, gradient, 9 * sizeof *gradient);
            if (singular)
                fill_nan(pass->gradients + 9 * number, 9);
        }
    }
}

/* If the part's node or skin moves too (the rig follows), adjusts the displacements so that vertices end up
   where the deformation puts them in the scene. Vertices that are not finite stay. */
static void carry(const part_work *work, tile_scratch *scratch, size_t count, bool gradients,
                  pass_totals *totals)
{
    for (size_t i = 0; i < count && work->part->carried; i++) {
        double *const delta = scratch->delta + 3 * i;
        const double *const place = scratch->position + 3 * i;
        if (!vec_is_finite(place))
            continue;
        totals->moved += !work->part->repeats_positions && (delta[0] != 0 || delta[1] != 0 || delta[2] != 0);
        ffd_part_carry(work->part, place, delta);
        if (gradients)
            ffd_part_carry_gradient(work->part, scratch->gradient + 9 * i);
    }
}

/* Only the displacement is transformed back to the file's space: p' = p + linear^{-1} delta. */
static void bring_back(const part_work *work, tile_scratch *scratch, size_t count)
{
    for (size_t i = 0; i < count && !work->part->identity; i++) {
        const vertex_transform transform = ffd_vertex_transform_of(&scratch->transforms, i);
        ffd_displacement_to_file(&transform, scratch->delta + 3 * i);
    }
}

/* Adds the displacements to a tile's positions and writes them. */
static void finish_positions(const part_work *work, tile_scratch *scratch, size_t first, size_t count,
                             pass_totals *totals)
{
    const mesh_pass *pass = work->pass;
    ffd_tile_rounding_at_rest(work, scratch, count, totals);
    totals->is_visible = totals->is_visible || ffd_tile_shows(work, scratch->raw, scratch->delta, count);
    const size_t unfit = ffd_array_kernel(pass->chain->isa)
                             ->displace(scratch->delta, count, ffd_largest_coordinate(pass->document),
                                        scratch->raw, scratch->changed);
    ffd_tile_rounding_of_results(work, scratch, count, totals);
    for (size_t i = 0; i < count && !work->part->carried; i++)
        totals->moved += scratch->changed[i];
    if (unfit < count)
        totals->first_overflow = work->first_vertex + first + unfit;
    if (ffd_pass_stores(pass))
        pass->document->format->write_positions(pass->document, work->part_number, first, count, scratch->raw,
                                                scratch->changed);
}

/* Lists the points that normals [from, to) belong to. *vertex: the first one's vertex; moved on to the last
   one's. */
static void list_points(const part_work *work, tile_scratch *scratch, size_t first, size_t from, size_t to,
                        size_t *vertex)
{
    for (size_t i = from; i < to; i++) {
        while (work->part->normal_start[*vertex + 1] <= i)
            (*vertex)++;
        scratch->of_points[i - from] = (uint32_t)(*vertex - first);
    }
}

/* Deforms normals [from, to) of a tile: either one a vertex, or those whose points are listed. */
static void deform_normals(const part_work *work, tile_scratch *scratch, size_t from, size_t to,
                           pass_totals *totals)
{
    const mesh_part *part = work->part;
    mesh_document *document = work->pass->document;
    const attribute_batch batch = {.gradients = scratch->gradient,
                                   .points = part->normal_start ? scratch->of_points : NULL,
                                   .count = to - from,
                                   .directions = scratch->normals,
                                   .step = 3,
                                   .outcomes = scratch->outcomes};
    document->format->read_normals(document, work->part_number, from, batch.count, scratch->normals);
    ffd_deform_normals(work->pass->chain->isa, &batch);
    if (work->pass->only_offsets)
        return;
    for (size_t i = 0; i < batch.count; i++) {
        const bool selected = !part->selected_normals || part->selected_normals[from + i];
        scratch->normals_changed[i] = selected && scratch->outcomes[i] == FFD_DIRECTION_CARRIED;
        totals->normals_collapsed += selected && scratch->outcomes[i] == FFD_DIRECTION_COLLAPSED;
    }
    if (ffd_pass_stores(work->pass))
        document->format->write_normals(document, work->part_number, from, batch.count, scratch->normals,
                                        scratch->normals_changed);
}

/* Deforms normals that are not one a vertex, in runs of at most a tile. */
static void deform_listed_normals(const part_work *work, tile_scratch *scratch, size_t first, size_t count,
                                  pass_totals *totals)
{
    const uint32_t *const start = work->part->normal_start;
    const size_t end = start[first + count];
    size_t from = start[first], vertex = first;
    for (size_t to; from < end; from = to) {
        to = end - from > PASS_TILE ? from + PASS_TILE : end;
        list_points(work, scratch, first, from, to, &vertex);
        deform_normals(work, scratch, from, to, totals);
    }
}

/* Deforms the tangents, one a vertex. Requires the tile's deformed normals in scratch, which then are one a
   vertex too. */
static void deform_tangents(const part_work *work, tile_scratch *scratch, size_t first, size_t count)
{
    mesh_document *document = work->pass->document;
    const attribute_batch batch = {.gradients = scratch->gradient,
                                   .count = count,
                                   .directions = scratch->tangents,
                                   .step = 4,
                                   .normals = work->part->normal_count ? scratch->normals : NULL,
                                   .outcomes = scratch->outcomes};
    document->format->read_tangents(document, work->part_number, first, count, scratch->tangents);
    ffd_deform_tangents(work->pass->chain->isa, &batch);
    for (size_t i = 0; i < count; i++)
        scratch->tangents_changed[i] = scratch->outcomes[i] == FFD_DIRECTION_CARRIED;
    if (work->pass->only_offsets || !ffd_pass_stores(work->pass))
        return;
    document->format->write_tangents(document, work->part_number, first, count, scratch->tangents,
                                     scratch->tangents_changed);
}

static void bring_back_gradients(const part_work *work, tile_scratch *scratch, size_t count)
{
    for (size_t i = 0; i < count && !work->part->identity; i++) {
        const vertex_transform transform = ffd_vertex_transform_of(&scratch->transforms, i);
        ffd_gradient_to_file(&transform, scratch->gradient + 9 * i);
    }
}

static void finish_attributes(const part_work *work, tile_scratch *scratch, size_t first, size_t count,
                              pass_totals *totals)
{
    const mesh_part *part = work->part;
    if (part->normal_count && part->normal_start)
        deform_listed_normals(work, scratch, first, count, totals);
    else if (part->normal_count)
        deform_normals(work, scratch, first, first + count, totals);
    if (part->has_tangents)
        deform_tangents(work, scratch, first, count);
}

/* Fills the location of a chosen vertex of the tile from the embedding. */
static void recall_vertex(const part_work *work, tile_scratch *scratch, size_t i, size_t vertex,
                          const chain_rounding *rounding, pass_totals *totals)
{
    const chain_link *const link = &work->pass->chain->links[0];
    ffd_location *const location = &scratch->chain.locations[i];
    const double *const x = scratch->position + 3 * i;
    ffd_embedding_locate(work->pass->embedding, vertex, link->lattice, x, location);
    if (totals->first_missed == UINT64_MAX && !ffd_recalled_meets(link, rounding, i, x, location)) {
        totals->first_missed = vertex;
        totals->missed_by = location->residual;
    }
}

/* Fills the first link's locations from the embedding, or from pass->locations; both omit the positions of
   parts that repeat others. Returns false if the locations must be searched. */
static bool recall(const part_work *work, tile_scratch *scratch, size_t first, const chain_rounding *rounding,
                   pass_totals *totals)
{
    const mesh_pass *pass = work->pass;
    if (work->part->repeats_positions || (!pass->embedding && !pass->is_located))
        return false;
    const size_t before = (size_t)work->first_vertex + first;
    for (size_t i = 0; i < scratch->chosen_count; i++) {
        const size_t vertex = before + ffd_tile_chosen(scratch, i);
        if (pass->is_located)
            scratch->chain.locations[i] = pass->locations[vertex];
        else
            recall_vertex(work, scratch, i, vertex, rounding, totals);
    }
    return true;
}

/* Copies the last link's locations and u,v,w to the caller's arrays. */
static void keep_locations(const part_work *work, const tile_scratch *scratch, size_t first, size_t count)
{
    const mesh_pass *pass = work->pass;
    const size_t before = (size_t)work->first_vertex + first;
    if (work->part->repeats_positions)
        return;
    for (size_t i = 0; i < scratch->chosen_count && pass->locations && !pass->is_located; i++)
        pass->locations[before + ffd_tile_chosen(scratch, i)] = scratch->chain.locations[i];
    if (!pass->uvw)
        return;
    fill_nan(pass->uvw + 3 * before, 3 * count);
    for (size_t i = 0; i < scratch->chosen_count; i++)
        memcpy(pass->uvw + 3 * (before + ffd_tile_chosen(scratch, i)), scratch->chain.locations[i].uvw,
               3 * sizeof *pass->uvw);
}

/* Context of find_rounding. */
typedef struct tile_rounding {
    const part_work *work;
    const tile_scratch *scratch;
    size_t first; /* the tile's first vertex in the part */
} tile_rounding;

static void find_rounding(const void *context, size_t point, bool is_first, const double x[3], double half[3])
{
    const tile_rounding *tile = context;
    const size_t i = ffd_tile_chosen(tile->scratch, point);
    const vertex_transform transform = ffd_vertex_transform_of(&tile->scratch->transforms, i);
    double position[3];
    memcpy(position, tile->scratch->raw + 3 * i, sizeof position);
    if (!is_first)
        ffd_vertex_in_file(&transform, x, position);
    ffd_vertex_cell(tile->work->pass->document, tile->work->part_number, tile->first + i, position, half);
    ffd_vertex_rounding_place(&transform, half);
}

/* Compacts the positions of the selected vertices to the front. */
static void choose(const part_work *work, tile_scratch *scratch, size_t first, size_t count)
{
    size_t chosen = 0;
    scratch->all_chosen = !work->part->selected && !work->part->skipped;
    scratch->chosen_count = count;
    if (scratch->all_chosen)
        return;
    for (size_t i = 0; i < count; i++)
        if (ffd_part_selects(work->part, first + i)) {
            if (chosen < i)
                memcpy(scratch->position + 3 * chosen, scratch->position + 3 * i,
                       3 * sizeof *scratch->position);
            scratch->chosen[chosen++] = (uint32_t)i;
        }
    scratch->chosen_count = chosen;
}

/* Marks a vertex that no link may move. */
static void mark_always(const mesh_pass *pass, size_t vertex, pass_totals *totals)
{
    pass->kept[vertex] |= KEPT_ALWAYS;
    totals->kept++;
}

/* Adds the bits of the chosen vertices to the caller's, and clears them. */
static void add_bits(const mesh_pass *pass, tile_scratch *scratch, size_t before, pass_totals *totals)
{
    for (size_t i = 0; i < scratch->chosen_count; i++) {
        unsigned any = 0;
        for (size_t p = 0; p < pass->chain->marks.kept; p++) {
            uint8_t *const mark = &scratch->kept[p * CHAIN_RUN + i];
            pass->kept[p * pass->kept_stride + before + ffd_tile_chosen(scratch, i)] |= *mark;
            any |= *mark;
            *mark = 0;
        }
        totals->kept += any != 0;
    }
}

/* Copies a plane of other marks of the chosen vertices to the caller's. */
static void copy_plane(const mesh_pass *pass, const tile_scratch *scratch, size_t before, size_t plane)
{
    const uint8_t *const from = scratch->kept + plane * CHAIN_RUN;
    uint8_t *const to = pass->kept + plane * pass->kept_stride + before;
    if (scratch->all_chosen)
        memcpy(to, from, scratch->chosen_count);
    for (size_t i = 0; i < scratch->chosen_count && !scratch->all_chosen; i++)
        to[scratch->chosen[i]] = from[i];
}

/* Marks the vertices of a tile that are not selected, or whose transform is singular. Copies the chain's
   marks to the caller's (keeps: there are bits). */
static void mark_kept(const part_work *work, tile_scratch *scratch, size_t first, size_t count, bool keeps,
                      pass_totals *totals)
{
    const mesh_pass *const pass = work->pass;
    const size_t before = (size_t)work->first_vertex + first;
    if (work->part->singular || work->part->skinned)
        for (size_t i = 0; i < count; i++)
            if (ffd_vertex_transform_of(&scratch->transforms, i).singular)
                mark_always(pass, before + i, totals);
    for (size_t i = 0; i < count && !scratch->all_chosen; i++)
        if (!ffd_part_selects(work->part, first + i))
            mark_always(pass, before + i, totals);
    if (keeps)
        add_bits(pass, scratch, before, totals);
    for (size_t p = pass->chain->marks.kept; p < pass->chain->marks.planes; p++)
        copy_plane(pass, scratch, before, p);
}

/* Moves the results of the selected vertices back to their slots in the tile; the others get no
   displacement. */
static void spread(tile_scratch *scratch, size_t count)
{
    size_t left = scratch->chosen_count;
    for (size_t i = count; i-- > left;) {
        double *const position = scratch->position + 3 * i, *const delta = scratch->delta + 3 * i,
                      *const gradient = scratch->gradient + 9 * i;
        if (left > 0 && scratch->chosen[left - 1] == i) {
            left--;
            memcpy(position, scratch->position + 3 * left, 3 * sizeof *position);
            memcpy(delta, scratch->delta + 3 * left, 3 * sizeof *delta);
            memcpy(gradient, scratch->gradient + 9 * left, 9 * sizeof *gradient);
            scratch->point_outcomes[i] = scratch->point_outcomes[left];
        } else {
            const vertex_transform own = ffd_vertex_transform_of(&scratch->transforms, i);
            memcpy(position, scratch->raw + 3 * i, 3 * sizeof *position);
            ffd_vertex_transform_point(&own, position);
            memset(delta, 0, 3 * sizeof *delta);
            memset(gradient, 0, 9 * sizeof *gradient);
            scratch->point_outcomes[i] = (point_outcome){.status = FFD_OUTSIDE};
        }
    }
}

/* Reads a tile's positions, transforms them to the lattice's space, and selects the ones to deform. */
static void take_points(part_work *work, tile_scratch *scratch, size_t first, size_t count,
                        pass_totals *totals)
{
    const mesh_document *document = work->pass->document;
    document->format->read_positions(document, work->part_number, first, count, scratch->raw);
    memcpy(scratch->position, scratch->raw, 3 * count * sizeof(double));
    place_points(work, scratch, first, count, scratch->position, totals);
    choose(work, scratch, first, count);
    if (!work->part->repeats_positions)
        ffd_totals_count_rest(work, scratch, first, totals);
}

/* Puts the points of a tile back to where they were before the chain moved them. */
static void put_back(part_work *work, tile_scratch *scratch, size_t first, size_t count)
{
    memcpy(scratch->position, scratch->raw, 3 * count * sizeof(double));
    if (work->part->skinned)
        ffd_points_transform(scratch->transforms.transforms, count, scratch->position);
    else
        ffd_part_transform(work->pass->document, work->part_number, first, count, scratch->position);
    choose(work, scratch, first, count);
}

/* What a tile needs of the gradients of the deformation. */
typedef struct gradient_need {
    bool all;          /* those of every vertex */
    bool determinants; /* to look at det F of every vertex */
    bool turns;        /* to count the vertices with det F < 0 */
} gradient_need;

static gradient_need find_need(const part_work *work, bool directions)
{
    const mesh_pass *const pass = work->pass;
    const bool counts = !work->part->repeats_positions;
    const bool determinants = counts && pass->determinants;
    return (gradient_need){.all = directions || determinants || (counts && pass->gradients),
                           .determinants = determinants,
                           .turns = counts && pass->inversions && !determinants};
}

/* Sends the chosen points through the lattices. */
static ffd_status deform_points(part_work *work, tile_scratch *scratch, size_t first, size_t count,
                                const gradient_need *need, pass_totals *totals)
{
    const mesh_pass *pass = work->pass;
    const bool counts = !work->part->repeats_positions;
    const tile_rounding tile_of = {work, scratch, first};
    const chain_rounding cells = {find_rounding, &tile_of};
    const chain_rounding *const rounding = ffd_rounding_is_none(&work->part->rounding) ? NULL : &cells;
    chain_run run = {.x = scratch->position,
                     .count = scratch->chosen_count,
                     .located = recall(work, scratch, first, rounding, totals),
                     .rounding = rounding,
                     .scratch = &scratch->chain,
                     .pace = scratch == work->scratch ? pass->pace : NULL,
                     .delta = scratch->delta,
                     .gradient = need->all || need->turns ? scratch->gradient : NULL,
                     .turns = need->turns ? &scratch->turns : NULL,
                     .only_turns = need->turns && !need->all,
                     .outcomes = scratch->point_outcomes,
                     .kept = counts ? scratch->kept : NULL};
    ffd_status status = ffd_chain_apply(pass->chain, pass->links, &run, &scratch->error);
    if (!status && run.only_turns && scratch->turns.count > 0 && pass->links > 1 && !pass->chain->blocks) {
        /* Rare: several lattices turn points inside out, whose gradients only a second run gives. */
        put_back(work, scratch, first, count);
        run.located = recall(work, scratch, first, rounding, totals);
        run.turns = NULL;
        run.only_turns = false;
        run.pace = NULL;
        run.moved_twice = run.disagreeing = 0;
        status = ffd_chain_apply(pass->chain, pass->links, &run, &scratch->error);
    }
    totals->embed_seconds = run.embed_seconds;
    totals->deform_seconds = run.deform_seconds;
    if (counts) {
        totals->moved_twice = run.moved_twice;
        totals->disagreeing = run.disagreeing;
        totals->disagreement = run.disagreement;
    }
    if (status)
        return status;
    keep_locations(work, scratch, first, count);
    if (run.kept)
        mark_kept(work, scratch, first, count, run.keeps, totals);
    return counts ? ffd_totals_count_deformed(work, scratch, first, totals, &scratch->error) : FFD_OK;
}

static void run_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    part_work *work = context;
    const mesh_pass *pass = work->pass;
    const mesh_part *part = work->part;
    tile_scratch *scratch = &work->scratch[worker];
    pass_totals *totals = &work->tiles[tile];
    const size_t count = last - first;
    const bool shapes = ffd_pass_takes_shapes(pass, part);
    const bool wanted = pass->attributes && (!pass->only_offsets || shapes);
    const bool attributes = wanted && !part->singular && (part->normal_count || part->has_tangents);
    const bool splats = ffd_pass_takes_splats(pass, part);
    const bool counts = !part->repeats_positions;
    const gradient_need need = find_need(work, attributes || splats);

    ffd_totals_clear(totals);
    scratch->turns.count = 0;
    if (atomic_load(&work->stopped))
        return;
    take_points(work, scratch, first, count, totals);
    scratch->status = ffd_deadline_check(&scratch->error);
    if (!scratch->status)
        scratch->status = deform_points(work, scratch, first, count, &need, totals);
    if (scratch->status) {
        atomic_store(&work->stopped, true);
        return;
    }
    if (need.turns)
        note_turns(work, scratch, first, totals);
    spread(scratch, count);
    if (need.determinants)
        note_determinants(work, scratch, first, count, totals);
    if (counts)
        fill_arrays(work, scratch, first, count);
    carry(work, scratch, count, need.all, totals);
    bring_back(work, scratch, count);
    if (!part->repeats_positions)
        finish_positions(work, scratch, first, count, totals);
    if (splats)
        ffd_tile_splat_turns(work, scratch, count);
    if (attributes || splats)
        bring_back_gradients(work, scratch, count);
    if (attributes)
        finish_attributes(work, scratch, first, count, totals);
    if (splats)
        ffd_tile_splats(work, scratch, first, count, totals);
    if (shapes)
        ffd_tile_shapes(work, scratch, first, count, totals);
}

/* Parts with fewer full tiles than this use smaller tiles, to keep many threads busy. */
#define FEW_TILES ((size_t)16)

/* Depends on the count alone: results must not depend on the number of threads, and the sums of tiles are
   joined. */
static size_t tile_size(size_t count)
{
    return count < FEW_TILES * PASS_TILE ? MESH_RANGE_STEP : PASS_TILE;
}

/* Finds which vertices are used only if the part has vertices that are not simply inside. */
static ffd_status count_others(const part_work *work, size_t tiles, size_t size, ffd_error *error)
{
    bool any = false;
    for (size_t i = 0; i < tiles; i++)
        any = any || work->tiles[i].others;
    const ffd_status status = any ? ffd_mesh_mark_used(work->pass->document, error) : FFD_OK;
    for (size_t i = 0; i < tiles; i++) {
        const size_t first = i * size, left = work->part->vertex_count - first;
        ffd_totals_count_others(work, first, left < size ? left : size, &work->tiles[i]);
    }
    return status;
}

static size_t tile_count(size_t count)
{
    const size_t size = tile_size(count);
    return count / size + (count % size != 0);
}

/* Scratch memory is several megabytes a worker: a small mesh needs no more workers than it has tiles. */
static int worker_count(const mesh_pass *pass)
{
    size_t most = 1;
    for (size_t i = 0; i < pass->document->part_count; i++) {
        const size_t tiles = tile_count(pass->document->parts[i].vertex_count);
        most = tiles > most ? tiles : most;
    }
    return most < (size_t)pass->threads ? (int)most : pass->threads;
}

static ffd_status run_part(part_work *work, pass_totals *totals, ffd_error *error)
{
    const size_t count = work->part->vertex_count, size = tile_size(count), tiles = tile_count(count);
    work->tiles = ffd_alloc_zero(tiles, sizeof *work->tiles);
    if (!work->tiles)
        return ffd_fail_memory(error);
    ffd_parallel_tiles(count, size, work->workers, run_tile, work);
    const ffd_status status = count_others(work, tiles, size, error);
    for (size_t i = 0; i < tiles; i++)
        ffd_totals_join(&work->tiles[i], totals);
    ffd_totals_judge_rounding(work->tiles, tiles, ffd_part_tolerance(work->pass->document), totals);
    ffd_free(work->tiles);
    if (status)
        return status;
    for (int i = 0; i < work->workers; i++)
        if (work->scratch[i].status) {
            if (error)
                *error = work->scratch[i].error;
            return work->scratch[i].status;
        }
    return FFD_OK;
}

int ffd_pass_threads(const memory_budget *budget, size_t edge_links, int threads)
{
    return ffd_budget_threads(budget, threads, THREAD_BYTES + edge_links * THREAD_LINK_BYTES);
}

_Static_assert(sizeof(tile_scratch) - sizeof(kept_cells) + sizeof(shape_scratch) + sizeof(splat_scratch) <
                   THREAD_BYTES,
               "a thread takes more than is counted");

static void free_scratch(tile_scratch *scratch, int workers)
{
    for (int i = 0; scratch && i < workers; i++) {
        ffd_free(scratch[i].shape);
        ffd_free(scratch[i].splat);
        ffd_free(scratch[i].kept);
    }
    ffd_free(scratch);
}

/* Returns NULL if memory runs out. */
static tile_scratch *make_scratch(const mesh_pass *pass, int workers)
{
    bool shapes = false, splats = false;
    for (size_t i = 0; i < pass->document->part_count; i++) {
        shapes = shapes || ffd_pass_takes_shapes(pass, &pass->document->parts[i]);
        splats = splats || ffd_pass_takes_splats(pass, &pass->document->parts[i]);
    }
    /* Several megabytes, of which a small mesh uses little: clear only what must be. */
    tile_scratch *scratch = ffd_alloc((size_t)workers, sizeof *scratch);
    for (int i = 0; scratch && i < workers; i++) {
        ffd_displacement_scratch_clear(&scratch[i].chain.displacement);
        scratch[i].chain.displacement.kept.threads = pass->threads;
        scratch[i].shape = NULL;
        scratch[i].splat = NULL;
        scratch[i].kept = NULL;
        scratch[i].status = FFD_OK;
    }
    for (int i = 0; scratch && i < workers; i++) {
        if (shapes)
            scratch[i].shape = ffd_alloc(1, sizeof *scratch[i].shape);
        if (splats)
            scratch[i].splat = ffd_alloc(1, sizeof *scratch[i].splat);
        if (pass->kept)
            scratch[i].kept = ffd_alloc_zero(pass->chain->marks.planes, CHAIN_RUN);
        if ((shapes && !scratch[i].shape) || (splats && !scratch[i].splat) ||
            (pass->kept && !scratch[i].kept)) {
            free_scratch(scratch, workers);
            return NULL;
        }
    }
    return scratch;
}

ffd_status ffd_pass_run(const mesh_pass *pass, pass_totals *totals, ffd_error *error)
{
    part_work work = {.pass = pass, .workers = worker_count(pass)};
    ffd_status status = FFD_OK;
    ffd_totals_clear(totals);
    atomic_init(&work.stopped, false);
    work.scratch = make_scratch(pass, work.workers);
    if (!work.scratch)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < pass->document->part_count && !status; i++) {
        work.part = &pass->document->parts[i];
        work.part_number = i;
        const uint64_t moved = totals->moved;
        status = run_part(&work, totals, error);
        if (work.part->splats && !ffd_pass_takes_splats(pass, work.part))
            ffd_totals_note_splats(totals, i, totals->moved - moved);
        if (!work.part->repeats_positions)
            work.first_vertex += work.part->vertex_count;
    }
    free_scratch(work.scratch, work.workers);
    return status;
}
