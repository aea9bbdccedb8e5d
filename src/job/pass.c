#include "base/memory.h"
#include "base/thread.h"
#include "base/vec.h"
#include "deform/attribute.h"
#include "job/tile.h"
#include <ffd/deform.h>
#include <math.h>
#include <string.h>

/* Takes the points (positions as the file has them) of a tile to the lattice's space. */
static void place_points(const part_work *work, tile_scratch *scratch, size_t first, size_t count,
                         double *points)
{
    const mesh_document *document = work->pass->document;
    ffd_vertex_places_read(document, work->part_number, first, count, &scratch->places);
    if (work->part->skinned)
        ffd_points_place(scratch->places.transforms, count, points);
    else
        ffd_part_place(document, work->part_number, first, count, points);
}

static void clear_totals(pass_totals *totals)
{
    memset(totals, 0, sizeof *totals);
    for (int a = 0; a < 3; a++) {
        totals->before.min[a] = totals->after.min[a] = HUGE_VAL;
        totals->before.max[a] = totals->after.max[a] = -HUGE_VAL;
    }
    totals->first_outside = totals->first_invalid = totals->first_overflow = UINT64_MAX;
    totals->first_shape_outside = totals->first_shape_invalid = UINT64_MAX;
    totals->det_min = HUGE_VAL;
    totals->det_max = -HUGE_VAL;
}

static void widen(ffd_bounds *box, const double p[3])
{
    for (int a = 0; a < 3; a++) {
        box->min[a] = p[a] < box->min[a] ? p[a] : box->min[a];
        box->max[a] = p[a] > box->max[a] ? p[a] : box->max[a];
    }
}

static uint64_t least(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static void join_totals(pass_totals *all, const pass_totals *tile)
{
    all->vertices += tile->vertices;
    for (int s = 0; s < FFD_VERTEX_STATUS_COUNT; s++)
        all->counts[s] += tile->counts[s];
    all->moved += tile->moved;
    all->located += tile->located;
    all->residual_square_max = fmax(all->residual_square_max, tile->residual_square_max);
    all->residual_square_sum += tile->residual_square_sum;
    all->evaluations += tile->evaluations;
    all->evaluations_max =
        tile->evaluations_max > all->evaluations_max ? tile->evaluations_max : all->evaluations_max;
    all->displacement_square_max = fmax(all->displacement_square_max, tile->displacement_square_max);
    all->displacement_square_sum += tile->displacement_square_sum;
    if (tile->before.min[0] <= tile->before.max[0]) {
        widen(&all->before, tile->before.min);
        widen(&all->before, tile->before.max);
        widen(&all->after, tile->after.min);
        widen(&all->after, tile->after.max);
    }
    all->outside_any += tile->outside_any;
    all->multiple_any += tile->multiple_any;
    all->unresolved += tile->unresolved;
    all->extended += tile->extended;
    all->first_outside = least(all->first_outside, tile->first_outside);
    all->first_invalid = least(all->first_invalid, tile->first_invalid);
    all->first_overflow = least(all->first_overflow, tile->first_overflow);
    all->shapes_outside += tile->shapes_outside;
    all->first_shape_outside = least(all->first_shape_outside, tile->first_shape_outside);
    all->first_shape_invalid = least(all->first_shape_invalid, tile->first_shape_invalid);
    all->normals_collapsed += tile->normals_collapsed;
    all->transforms_singular += tile->transforms_singular;
    all->det_min = fmin(all->det_min, tile->det_min);
    all->det_max = fmax(all->det_max, tile->det_max);
    all->embed_seconds += tile->embed_seconds;
    all->deform_seconds += tile->deform_seconds;
}

/* Only the displacement goes back to the file's space: p' = p + linear^{-1} delta. A coordinate whose
   displacement is 0 keeps its bits. Returns whether one changed. */
static bool move_back(const vertex_place *place, const chain_point *point, double p[3])
{
    double delta[3];
    bool changed = false;
    if (!ffd_displacement_bring_back(place, point->delta, delta))
        return false;
    for (int a = 0; a < 3; a++)
        if (delta[a] != 0) {
            const double moved = p[a] + delta[a];
            changed = changed || moved != p[a];
            p[a] = moved;
        }
    return changed;
}

static void count_point(bool singular, const chain_point *point, const double before[3],
                        const double after[3], uint64_t number, pass_totals *totals)
{
    totals->vertices++;
    totals->counts[point->status]++;
    if (point->outside) {
        totals->outside_any++;
        totals->first_outside = least(totals->first_outside, number);
    }
    totals->extended += point->status == FFD_OUTSIDE && point->extended;
    totals->multiple_any += point->multiple;
    totals->unresolved += point->unresolved;
    totals->evaluations += point->evaluations;
    totals->evaluations_max =
        point->evaluations > totals->evaluations_max ? point->evaluations : totals->evaluations_max;
    if (point->located) {
        totals->located++;
        totals->residual_square_max = larger_of(totals->residual_square_max, point->residual_square);
        totals->residual_square_sum += point->residual_square;
    }
    if (!vec_is_finite(before)) {
        totals->first_invalid = least(totals->first_invalid, number);
        return;
    }
    widen(&totals->before, before);
    widen(&totals->after, after);
    if (singular) {
        totals->transforms_singular++;
        return;
    }
    const double square = vec_dot(point->delta, point->delta);
    totals->displacement_square_max = larger_of(totals->displacement_square_max, square);
    totals->displacement_square_sum += square;
}

static void fill_nan(double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        values[i] = NAN;
}

static void note_determinant(const chain_point *point, pass_totals *totals)
{
    double f[9];
    for (int i = 0; i < 9; i++)
        f[i] = point->gradient[i] + (i % 4 == 0 ? 1 : 0);
    const double det = mat_determinant(f);
    totals->det_min = fmin(totals->det_min, det);
    totals->det_max = fmax(totals->det_max, det);
}

/* What the caller wants to have of a vertex. */
static void fill_arrays(const mesh_pass *pass, bool singular, const chain_point *point, const double place[3],
                        uint64_t number, pass_totals *totals)
{
    if (pass->uvw)
        memcpy(pass->uvw + 3 * number, point->uvw, sizeof point->uvw);
    if (pass->statuses)
        pass->statuses[number] = point->status;
    if (pass->deformed) {
        memcpy(pass->deformed + 3 * number, place, 3 * sizeof *place);
        if (singular)
            fill_nan(pass->deformed + 3 * number, 3);
    }
    if (pass->gradients) {
        memcpy(pass->gradients + 9 * number, point->gradient, sizeof point->gradient);
        if (singular)
            fill_nan(pass->gradients + 9 * number, 9);
    }
    if (pass->determinants && !singular && point->status != FFD_SINGULAR &&
        (point->located || point->extended))
        note_determinant(point, totals);
}

bool ffd_tile_fits_file(const mesh_document *document, const double p[3])
{
    const double own = document->largest_coordinate;
    const double largest = own > 0 ? own : document->format->largest_coordinate;
    for (int a = 0; a < 3; a++)
        if (!(fabs(p[a]) <= largest))
            return false;
    return true;
}

/* Positions of a tile: counted, and handed back. */
static void finish_positions(const part_work *work, tile_scratch *scratch, size_t first, size_t count,
                             pass_totals *totals)
{
    const mesh_pass *pass = work->pass;
    const mesh_format *format = pass->document->format;
    vertex_place place = ffd_vertex_place_of(&scratch->places, 0);
    pass_totals own = *totals; /* where no store to the scratch can reach it */
    for (size_t i = 0; i < count; i++) {
        const uint64_t number = work->first_vertex + first + i;
        const chain_point *point = &scratch->points[i];
        double *p = scratch->raw + 3 * i;
        if (work->part->skinned)
            place = ffd_vertex_place_of(&scratch->places, i);
        fill_arrays(pass, place.singular, point, scratch->place + 3 * i, number, &own);
        scratch->changed[i] = false;
        if (!ffd_part_selects(work->part, first + i))
            continue;
        count_point(place.singular, point, scratch->before + 3 * i, scratch->place + 3 * i, number, &own);
        scratch->changed[i] = move_back(&place, point, p);
        if (scratch->changed[i]) {
            own.moved++;
            if (!ffd_tile_fits_file(pass->document, p))
                own.first_overflow = least(own.first_overflow, number);
        }
    }
    *totals = own;
    if (pass->write)
        format->write_positions(pass->document, work->part_number, first, count, scratch->raw,
                                scratch->changed);
}

/* Normals [from, to) of a tile whose first vertex is `first`; vertex is the place to go on from. */
static void deform_normals(const part_work *work, tile_scratch *scratch, size_t first, size_t from, size_t to,
                           size_t *vertex, pass_totals *totals)
{
    const mesh_part *part = work->part;
    mesh_document *document = work->pass->document;
    const attribute_batch batch = {.gradients = scratch->points[0].gradient,
                                   .stride = sizeof *scratch->points / sizeof(double),
                                   .points = scratch->of_points,
                                   .count = to - from,
                                   .directions = scratch->normals,
                                   .step = 3,
                                   .outcomes = scratch->outcomes};
    document->format->read_normals(document, work->part_number, from, batch.count, scratch->normals);
    for (size_t i = 0; i < batch.count; i++) {
        while (part->normal_start ? part->normal_start[*vertex + 1] <= from + i : *vertex < from + i)
            (*vertex)++;
        scratch->of_points[i] = (uint32_t)(*vertex - first);
    }
    ffd_deform_normals(work->pass->chain->isa, &batch);
    if (work->pass->only_offsets)
        return;
    for (size_t i = 0; i < batch.count; i++) {
        const bool selected = !part->selected_normals || part->selected_normals[from + i];
        scratch->normals_changed[i] = selected && scratch->outcomes[i] == ATTRIBUTE_CARRIED;
        totals->normals_collapsed += selected && scratch->outcomes[i] == ATTRIBUTE_COLLAPSED;
    }
    document->format->write_normals(document, work->part_number, from, batch.count, scratch->normals,
                                    scratch->normals_changed);
}

/* Tangents stand one a vertex, as the normals before them, which scratch still holds. */
static void deform_tangents(const part_work *work, tile_scratch *scratch, size_t first, size_t count)
{
    mesh_document *document = work->pass->document;
    const attribute_batch batch = {.gradients = scratch->points[0].gradient,
                                   .stride = sizeof *scratch->points / sizeof(double),
                                   .points = scratch->of_points,
                                   .count = count,
                                   .directions = scratch->tangents,
                                   .step = 4,
                                   .normals = work->part->normal_count ? scratch->normals : NULL,
                                   .outcomes = scratch->outcomes};
    document->format->read_tangents(document, work->part_number, first, count, scratch->tangents);
    for (size_t i = 0; i < count; i++)
        scratch->of_points[i] = (uint32_t)i;
    ffd_deform_tangents(work->pass->chain->isa, &batch);
    for (size_t i = 0; i < count; i++)
        scratch->tangents_changed[i] = scratch->outcomes[i] == ATTRIBUTE_CARRIED;
    if (work->pass->only_offsets)
        return;
    document->format->write_tangents(document, work->part_number, first, count, scratch->tangents,
                                     scratch->tangents_changed);
}

static void finish_attributes(const part_work *work, tile_scratch *scratch, size_t first, size_t count,
                              pass_totals *totals)
{
    const mesh_part *part = work->part;
    for (size_t i = 0; i < count && !part->identity; i++) {
        const vertex_place place = ffd_vertex_place_of(&scratch->places, i);
        ffd_gradient_bring_back(&place, scratch->points[i].gradient);
    }
    if (part->normal_count) {
        size_t from = part->normal_start ? part->normal_start[first] : first, vertex = first;
        const size_t end = part->normal_start ? part->normal_start[first + count] : first + count;
        for (size_t to; from < end; from = to) {
            to = end - from > PASS_TILE ? from + PASS_TILE : end;
            deform_normals(work, scratch, first, from, to, &vertex, totals);
        }
    }
    if (part->has_tangents)
        deform_tangents(work, scratch, first, count);
}

/* Takes the first link's locations from the embedding, or from those that are there, in which repeated
   positions do not stand again. Returns whether it did. */
static bool recall(const part_work *work, tile_scratch *scratch, size_t first)
{
    const mesh_pass *pass = work->pass;
    if (work->part->repeats_positions || (!pass->embedding && !pass->is_located))
        return false;
    const size_t before = (size_t)work->first_vertex + first;
    for (size_t i = 0; i < scratch->chosen_count; i++) {
        const size_t vertex = before + scratch->chosen[i];
        if (pass->is_located)
            scratch->chain.locations[i] = pass->locations[vertex];
        else
            ffd_embedding_locate(pass->embedding, vertex, pass->chain->links[0].lattice,
                                 scratch->place + 3 * i, &scratch->chain.locations[i]);
    }
    return true;
}

static void keep_locations(const part_work *work, const tile_scratch *scratch, size_t first)
{
    const mesh_pass *pass = work->pass;
    if (!pass->locations || pass->is_located || work->part->repeats_positions)
        return;
    ffd_location *const there = pass->locations + work->first_vertex + first;
    for (size_t i = 0; i < scratch->chosen_count; i++)
        there[scratch->chosen[i]] = scratch->chain.locations[i];
}

/* Puts the selected vertices' places at the front. */
static void choose(const part_work *work, tile_scratch *scratch, size_t first, size_t count)
{
    size_t chosen = 0;
    if (!work->part->selected && !work->part->skipped) {
        scratch->chosen_count = count;
        for (size_t i = 0; i < count; i++)
            scratch->chosen[i] = i;
        return;
    }
    for (size_t i = 0; i < count; i++)
        if (ffd_part_selects(work->part, first + i)) {
            if (chosen < i)
                memcpy(scratch->place + 3 * chosen, scratch->place + 3 * i, 3 * sizeof *scratch->place);
            scratch->chosen[chosen++] = i;
        }
    scratch->chosen_count = chosen;
}

/* Brings what has become of the selected vertices to where they stand in the tile; the others stay. */
static void spread(tile_scratch *scratch, size_t count)
{
    size_t left = scratch->chosen_count;
    for (size_t i = count; i-- > left;)
        if (left > 0 && scratch->chosen[left - 1] == i) {
            left--;
            memcpy(scratch->place + 3 * i, scratch->place + 3 * left, 3 * sizeof *scratch->place);
            scratch->points[i] = scratch->points[left];
        } else {
            memcpy(scratch->place + 3 * i, scratch->before + 3 * i, 3 * sizeof *scratch->place);
            scratch->points[i] = (chain_point){.uvw = {NAN, NAN, NAN}, .status = FFD_OUTSIDE};
        }
}

static void run_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    part_work *work = context;
    const mesh_pass *pass = work->pass;
    const mesh_part *part = work->part;
    tile_scratch *scratch = &work->scratch[worker];
    pass_totals *totals = &work->tiles[tile];
    const size_t count = last - first;
    const bool wanted = pass->attributes && (!pass->only_offsets || part->shape_count);
    const bool attributes = wanted && !part->singular && (part->normal_count || part->has_tangents);
    const bool gradients =
        attributes || ((pass->gradients || pass->determinants) && !part->repeats_positions);

    clear_totals(totals);
    if (atomic_load(&work->stopped))
        return;
    pass->document->format->read_positions(pass->document, work->part_number, first, count, scratch->raw);
    memcpy(scratch->place, scratch->raw, 3 * count * sizeof(double));
    place_points(work, scratch, first, count, scratch->place);
    memcpy(scratch->before, scratch->place, 3 * count * sizeof(double));
    choose(work, scratch, first, count);
    chain_run run = {.x = scratch->place,
                     .count = scratch->chosen_count,
                     .gradients = gradients,
                     .located = recall(work, scratch, first),
                     .scratch = &scratch->chain,
                     .points = scratch->points};
    scratch->status = ffd_chain_apply(pass->chain, pass->links, &run, &scratch->error);
    totals->embed_seconds = run.embed_seconds;
    totals->deform_seconds = run.deform_seconds;
    if (scratch->status) {
        atomic_store(&work->stopped, true);
        return;
    }
    keep_locations(work, scratch, first);
    spread(scratch, count);
    if (!part->repeats_positions)
        finish_positions(work, scratch, first, count, totals);
    if (attributes)
        finish_attributes(work, scratch, first, count, totals);
    if (pass->write && part->shape_count > 0)
        ffd_tile_shapes(work, scratch, first, count, totals);
}

/* So few tiles of the largest size would leave some of many threads without any: then they are smaller. */
#define FEW_TILES ((size_t)16)

/* By the count alone: the sums of tiles are joined, and must not depend on the number of threads. */
static size_t tile_size(size_t count)
{
    return count < FEW_TILES * PASS_TILE ? MESH_RANGE_STEP : PASS_TILE;
}

static ffd_status run_part(part_work *work, pass_totals *totals, ffd_error *error)
{
    const size_t count = work->part->vertex_count, size = tile_size(count);
    const size_t tiles = count / size + (count % size != 0);
    work->tiles = ffd_alloc_zero(tiles, sizeof *work->tiles);
    if (!work->tiles)
        return ffd_fail_memory(error);
    ffd_parallel_tiles(count, size, work->pass->threads, run_tile, work);
    for (size_t i = 0; i < tiles; i++)
        join_totals(totals, &work->tiles[i]);
    ffd_free(work->tiles);
    for (int i = 0; i < work->pass->threads; i++)
        if (work->scratch[i].status) {
            if (error)
                *error = work->scratch[i].error;
            return work->scratch[i].status;
        }
    return FFD_OK;
}

uint64_t ffd_pass_vertex_count(const mesh_document *document)
{
    uint64_t count = 0;
    for (size_t i = 0; i < document->part_count; i++)
        if (!document->parts[i].repeats_positions)
            count += document->parts[i].vertex_count;
    return count;
}

int ffd_pass_threads(const mesh_room *room, size_t edge_links, int threads)
{
    return ffd_room_threads(room, threads, THREAD_BYTES + edge_links * THREAD_LINK_BYTES);
}

_Static_assert(sizeof(tile_scratch) - sizeof(kept_cells) + sizeof(shape_scratch) < THREAD_BYTES,
               "a thread takes more than is counted");

static void free_scratch(tile_scratch *scratch, int workers)
{
    for (int i = 0; scratch && i < workers; i++)
        ffd_free(scratch[i].shape);
    ffd_free(scratch);
}

/* NULL when there is no memory. */
static tile_scratch *make_scratch(const mesh_pass *pass)
{
    bool shapes = false;
    for (size_t i = 0; i < pass->document->part_count; i++)
        shapes = shapes || (pass->write && pass->document->parts[i].shape_count > 0);
    /* Megabytes, of which a small mesh needs little: what need not be cleared is not. */
    tile_scratch *scratch = ffd_alloc((size_t)pass->threads, sizeof *scratch);
    for (int i = 0; scratch && i < pass->threads; i++) {
        ffd_displacement_scratch_clear(&scratch[i].chain.displacement);
        scratch[i].chain.displacement.kept.threads = pass->threads;
        scratch[i].shape = NULL;
        scratch[i].status = FFD_OK;
    }
    for (int i = 0; shapes && scratch && i < pass->threads; i++) {
        scratch[i].shape = ffd_alloc(1, sizeof *scratch[i].shape);
        if (!scratch[i].shape) {
            free_scratch(scratch, pass->threads);
            return NULL;
        }
    }
    return scratch;
}

ffd_status ffd_pass_run(const mesh_pass *pass, pass_totals *totals, ffd_error *error)
{
    part_work work = {.pass = pass};
    ffd_status status = FFD_OK;
    clear_totals(totals);
    atomic_init(&work.stopped, false);
    work.scratch = make_scratch(pass);
    if (!work.scratch)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < pass->document->part_count && !status; i++) {
        work.part = &pass->document->parts[i];
        work.part_number = i;
        status = run_part(&work, totals, error);
        if (!work.part->repeats_positions)
            work.first_vertex += work.part->vertex_count;
    }
    free_scratch(work.scratch, pass->threads);
    return status;
}
