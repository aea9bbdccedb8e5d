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
#include "job/pass/tile.h"
#include <ffd/deform.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

/* Transforms the tile's stored positions to the lattice's space. */
static void place_points(const pass_tile *tile)
{
    tile_points *const base = &tile->scratch->base;
    memcpy(base->position, base->stored, 3 * tile->count * sizeof *base->position);
    if (tile->part->skinned)
        ffd_points_transform(tile->scratch->transforms.transforms, tile->count, base->position);
    else
        ffd_part_transform(tile->pass->document, tile->part_index, tile->first, tile->count, base->position);
}

static void fill_nan(double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        values[i] = NAN;
}

static void note_range(double det, bool outside, size_t index, pass_totals *totals)
{
    totals->det_min = lesser_of(totals->det_min, det);
    totals->det_max = larger_of(totals->det_max, det);
    if (outside && det < totals->det_outside) {
        totals->det_outside = det;
        totals->first_det_outside = index;
    }
}

/* det F relative to the product of the lengths of F's rows: closer to 0 its sign is not told. */
#define FLAT 1e-12

static bool turns_over(const double f[9], double det)
{
    return det < 0 && det < -FLAT * vec_length(f) * vec_length(f + 3) * vec_length(f + 6);
}

/* Counts a vertex that turns inside out, or collapses. f: its F. */
static void note_turn(const point_outcome *outcome, const double f[9], size_t index, pass_totals *totals)
{
    const double det = mat_determinant(f);
    if (outcome->collapsed) {
        totals->collapsed++;
        ffd_note_first(&totals->first_collapsed, index);
    }
    if (outcome->collapsed || !turns_over(f, det))
        return;
    totals->inverted++;
    if (det < totals->det_inverted || (det == totals->det_inverted && index < totals->first_inverted)) {
        totals->det_inverted = det;
        totals->first_inverted = index;
    }
}

/* Returns whether a link moves a vertex in a way that F tells. outcome: its own. v: its index in the tile. */
static bool has_gradient(const pass_tile *tile, const point_outcome *outcome, size_t v)
{
    const bool singular = tile->part->skinned ? tile->scratch->transforms.singular[v] : tile->part->singular;
    return !singular && outcome->status != FFD_VERTEX_SINGULAR && (outcome->located || outcome->extended);
}

/* Looks at det F of all vertices of a tile (after spread). */
static void note_determinants(const pass_tile *tile)
{
    const tile_points *const base = &tile->scratch->base;
    for (size_t i = 0; i < tile->count; i++) {
        const point_outcome *const outcome = &base->outcomes[i];
        double f[9];
        mat_add_identity(base->gradient + 9 * i, f);
        const double det = outcome->collapsed ? 0 : mat_determinant(f);
        const size_t index = (size_t)tile->first_index + i;
        if (!has_gradient(tile, outcome, i))
            continue;
        note_range(det, outcome->extended, index, tile->totals);
        if (!outcome->extended)
            note_turn(outcome, f, index, tile->totals);
    }
}

/* Counts the vertices that turn inside out or collapse (before spread). turns has those that may by the
   displacement itself; weights that change along the surface may turn others, where all gradients are known:
   without them the slopes of the weights are not. */
static void note_turns(const pass_tile *tile, bool all)
{
    const tile_points *const base = &tile->scratch->base;
    const turn_list *const turns = &tile->scratch->turns;
    const size_t count = all ? base->count : turns->count;
    for (size_t k = 0; k < count; k++) {
        const size_t i = all ? k : turns->points[k], v = ffd_tile_vertex(base, i);
        const point_outcome *const outcome = &base->outcomes[i];
        double f[9];
        mat_add_identity(base->gradient + 9 * i, f);
        if (!outcome->extended && has_gradient(tile, outcome, v))
            note_turn(outcome, f, (size_t)tile->first_index + v, tile->totals);
    }
}

/* Fills the caller's arrays from a tile's results (after spread). */
static void fill_arrays(const pass_tile *tile)
{
    const mesh_pass *const pass = tile->pass;
    const tile_points *const base = &tile->scratch->base;
    if (!pass->statuses && !pass->deformed && !pass->gradients && !pass->collapsed)
        return;
    for (size_t i = 0; i < tile->count; i++) {
        const size_t index = (size_t)tile->first_index + i;
        const bool singular = ffd_vertex_transform_of(&tile->scratch->transforms, i).singular;
        const double *gradient = base->gradient + 9 * i;
        if (pass->statuses)
            pass->statuses[index] = base->outcomes[i].status;
        if (pass->collapsed)
            pass->collapsed[index] = base->outcomes[i].collapsed;
        if (pass->deformed) {
            memcpy(pass->deformed + 3 * index, base->position + 3 * i, 3 * sizeof *base->position);
            if (singular)
                fill_nan(pass->deformed + 3 * index, 3);
        }
        if (pass->gradients) {
            memcpy(pass->gradients + 9 * index, gradient, 9 * sizeof *gradient);
            if (singular)
                fill_nan(pass->gradients + 9 * index, 9);
        }
    }
}

/* Counts the vertices of a carried part that the lattices move. Later all of them are displaced, to make up
   for the motion of the part's node or skin. */
static void count_moved(const pass_tile *tile)
{
    const tile_points *const base = &tile->scratch->base;
    for (size_t i = 0; i < tile->count && tile->part->carried && !tile->part->repeats_positions; i++) {
        const double *const delta = base->delta + 3 * i;
        tile->totals->moved +=
            vec_is_finite(base->position + 3 * i) && (delta[0] != 0 || delta[1] != 0 || delta[2] != 0);
    }
}

/* Adds the displacements to a tile's positions and writes them. */
static void finish_positions(const pass_tile *tile)
{
    const mesh_pass *const pass = tile->pass;
    tile_points *const base = &tile->scratch->base;
    uint8_t *const changed = tile->scratch->changed;
    pass_totals *const totals = tile->totals;
    ffd_tile_rounding_at_rest(tile);
    totals->is_visible = totals->is_visible || ffd_tile_shows(tile);
    const size_t unfit = ffd_array_kernel(pass->chain->isa)
                             ->displace(base->delta, tile->count, ffd_largest_coordinate(pass->document),
                                        base->stored, changed);
    ffd_tile_rounding_of_results(tile);
    for (size_t i = 0; i < tile->count && !tile->part->carried; i++)
        totals->moved += changed[i];
    if (unfit < tile->count)
        totals->first_overflow = tile->first_index + unfit;
    if (ffd_pass_stores(pass))
        pass->document->format->write(pass->document, tile->part_index, MESH_POSITIONS, tile->first,
                                      tile->count, base->stored, changed);
}

/* Lists the points that normals [from, to) belong to. *vertex: the first one's vertex; moved on to the last
   one's. */
static void list_points(const pass_tile *tile, size_t from, size_t to, size_t *vertex)
{
    for (size_t i = from; i < to; i++) {
        while (tile->part->normal_start[*vertex + 1] <= i)
            (*vertex)++;
        tile->scratch->of_points[i - from] = (uint32_t)(*vertex - tile->first);
    }
}

/* Deforms normals [from, to) of a tile: either one a vertex, or those whose points are listed. */
static void deform_normals(const pass_tile *tile, size_t from, size_t to)
{
    const mesh_part *const part = tile->part;
    tile_scratch *const s = tile->scratch;
    mesh_document *const document = tile->pass->document;
    const attribute_batch batch = {.gradients = s->base.gradient,
                                   .points = part->normal_start ? s->of_points : NULL,
                                   .count = to - from,
                                   .directions = s->normals,
                                   .step = 3,
                                   .outcomes = s->outcomes};
    document->format->read(document, tile->part_index, MESH_NORMALS, tile->pass->state, from, batch.count,
                           s->normals);
    ffd_deform_normals(tile->pass->chain->isa, &batch);
    if (tile->pass->only_offsets)
        return;
    for (size_t i = 0; i < batch.count; i++) {
        const bool selected = !part->selected_normals || part->selected_normals[from + i];
        s->normals_changed[i] = selected && s->outcomes[i] == FFD_DIRECTION_CARRIED;
        tile->totals->normals_collapsed += selected && s->outcomes[i] == FFD_DIRECTION_COLLAPSED;
    }
    if (ffd_pass_stores(tile->pass))
        document->format->write(document, tile->part_index, MESH_NORMALS, from, batch.count, s->normals,
                                s->normals_changed);
}

/* Deforms normals that are not one a vertex, in runs of at most a tile. */
static void deform_listed_normals(const pass_tile *tile)
{
    const uint32_t *const start = tile->part->normal_start;
    const size_t end = start[tile->first + tile->count];
    size_t from = start[tile->first], vertex = tile->first;
    for (size_t to; from < end; from = to) {
        to = end - from > PASS_TILE ? from + PASS_TILE : end;
        list_points(tile, from, to, &vertex);
        deform_normals(tile, from, to);
    }
}

/* Deforms the tangents, one a vertex. Requires the tile's deformed normals in scratch, which then are one a
   vertex too. */
static void deform_tangents(const pass_tile *tile)
{
    tile_scratch *const s = tile->scratch;
    mesh_document *const document = tile->pass->document;
    const attribute_batch batch = {.gradients = s->base.gradient,
                                   .count = tile->count,
                                   .directions = s->tangents,
                                   .step = 4,
                                   .normals = tile->part->normal_count ? s->normals : NULL,
                                   .outcomes = s->outcomes};
    document->format->read(document, tile->part_index, MESH_TANGENTS, tile->pass->state, tile->first,
                           tile->count, s->tangents);
    ffd_deform_tangents(tile->pass->chain->isa, &batch);
    for (size_t i = 0; i < tile->count; i++)
        s->tangents_changed[i] = s->outcomes[i] == FFD_DIRECTION_CARRIED;
    if (tile->pass->only_offsets || !ffd_pass_stores(tile->pass))
        return;
    document->format->write(document, tile->part_index, MESH_TANGENTS, tile->first, tile->count, s->tangents,
                            s->tangents_changed);
}

static void finish_attributes(const pass_tile *tile)
{
    const mesh_part *const part = tile->part;
    if (part->normal_count && part->normal_start)
        deform_listed_normals(tile);
    else if (part->normal_count)
        deform_normals(tile, tile->first, tile->first + tile->count);
    if (part->has_tangents)
        deform_tangents(tile);
}

/* Fills the location of point i of the tile from the embedding. */
static void recall_vertex(const pass_tile *tile, const chain_run *run, size_t i, size_t vertex)
{
    const chain_link *const link = &tile->pass->chain->links[0];
    ffd_location *const location = &run->scratch->locations[i];
    const double *const x = run->x + 3 * i;
    ffd_embedding_locate(tile->pass->embedding, vertex, link->lattice, x, location);
    if (tile->totals->first_missed == UINT64_MAX &&
        !ffd_recalled_meets(link, run->rounding, i, x, location)) {
        tile->totals->first_missed = vertex;
        tile->totals->missed_by = location->residual;
    }
}

/* Fills the first link's locations from the embedding, or from pass->locations; both omit the positions of
   parts that repeat others. Returns false if the locations must be searched. */
static bool recall(const pass_tile *tile, const chain_run *run)
{
    const mesh_pass *const pass = tile->pass;
    if (tile->part->repeats_positions || (!pass->embedding && !pass->is_located))
        return false;
    for (size_t i = 0; i < run->count; i++) {
        const size_t vertex = (size_t)tile->first_index + ffd_tile_vertex(&tile->scratch->base, i);
        if (pass->is_located)
            run->scratch->locations[i] = pass->locations[vertex];
        else
            recall_vertex(tile, run, i, vertex);
    }
    return true;
}

/* Copies the last link's locations and u,v,w to the caller's arrays. */
static void keep_locations(const pass_tile *tile)
{
    const mesh_pass *const pass = tile->pass;
    const tile_points *const base = &tile->scratch->base;
    const ffd_location *const locations = tile->scratch->chain.locations;
    const size_t before = (size_t)tile->first_index;
    if (tile->part->repeats_positions)
        return;
    for (size_t i = 0; i < base->count && pass->locations && !pass->is_located; i++)
        pass->locations[before + ffd_tile_vertex(base, i)] = locations[i];
    if (!pass->uvw)
        return;
    fill_nan(pass->uvw + 3 * before, 3 * tile->count);
    for (size_t i = 0; i < base->count; i++)
        memcpy(pass->uvw + 3 * (before + ffd_tile_vertex(base, i)), locations[i].uvw, 3 * sizeof *pass->uvw);
}

/* Compacts the positions of the selected vertices to the front. */
static void choose(const pass_tile *tile)
{
    tile_points *const base = &tile->scratch->base;
    base->are_all = !tile->part->selected && !tile->part->skipped;
    base->count = base->are_all ? tile->count : 0;
    for (size_t i = 0; i < tile->count && !base->are_all; i++)
        if (ffd_part_selects(tile->part, tile->first + i)) {
            if (base->count < i)
                memcpy(base->position + 3 * base->count, base->position + 3 * i, 3 * sizeof *base->position);
            base->which[base->count++] = (uint32_t)i;
        }
}

/* Marks a vertex that no link may move. */
static void mark_always(const mesh_pass *pass, size_t vertex, pass_totals *totals)
{
    pass->kept[vertex] |= KEPT_ALWAYS;
    totals->kept++;
}

/* Adds the bits of the selected vertices to the caller's, and clears them. */
static void add_bits(const pass_tile *tile)
{
    const mesh_pass *const pass = tile->pass;
    const tile_points *const base = &tile->scratch->base;
    for (size_t i = 0; i < base->count; i++) {
        const size_t vertex = (size_t)tile->first_index + ffd_tile_vertex(base, i);
        unsigned any = 0;
        for (size_t p = 0; p < pass->chain->marks.kept; p++) {
            uint8_t *const mark = &tile->scratch->kept[p * CHAIN_RUN + i];
            pass->kept[p * pass->kept_stride + vertex] |= *mark;
            any |= *mark;
            *mark = 0;
        }
        tile->totals->kept += any != 0;
    }
}

/* Copies a plane of other marks of the selected vertices to the caller's. */
static void copy_plane(const pass_tile *tile, size_t plane)
{
    const tile_points *const base = &tile->scratch->base;
    const uint8_t *const from = tile->scratch->kept + plane * CHAIN_RUN;
    uint8_t *const to = tile->pass->kept + plane * tile->pass->kept_stride + tile->first_index;
    if (base->are_all)
        memcpy(to, from, base->count);
    for (size_t i = 0; i < base->count && !base->are_all; i++)
        to[base->which[i]] = from[i];
}

/* Marks the vertices of a tile that are not selected, or whose transform is singular. Copies the chain's
   marks to the caller's (keeps: there are bits). */
static void mark_kept(const pass_tile *tile, bool keeps)
{
    const mesh_pass *const pass = tile->pass;
    const size_t before = (size_t)tile->first_index;
    if (tile->part->singular || tile->part->skinned)
        for (size_t i = 0; i < tile->count; i++)
            if (ffd_vertex_transform_of(&tile->scratch->transforms, i).singular)
                mark_always(pass, before + i, tile->totals);
    for (size_t i = 0; i < tile->count && !tile->scratch->base.are_all; i++)
        if (!ffd_part_selects(tile->part, tile->first + i))
            mark_always(pass, before + i, tile->totals);
    if (keeps)
        add_bits(tile);
    for (size_t p = pass->chain->marks.kept; p < pass->chain->marks.planes; p++)
        copy_plane(tile, p);
}

/* Moves the results of the selected vertices to their slots in the tile; the others get no displacement. */
static void spread(const pass_tile *tile)
{
    tile_points *const base = &tile->scratch->base;
    size_t left = base->count;
    for (size_t i = tile->count; i-- > left;) {
        if (left == 0 || base->which[left - 1] != i) {
            ffd_tile_hold(base, i, i);
            continue;
        }
        left--;
        memcpy(base->position + 3 * i, base->position + 3 * left, 3 * sizeof *base->position);
        memcpy(base->delta + 3 * i, base->delta + 3 * left, 3 * sizeof *base->delta);
        memcpy(base->gradient + 9 * i, base->gradient + 9 * left, 9 * sizeof *base->gradient);
        base->outcomes[i] = base->outcomes[left];
    }
    base->are_all = true;
    base->count = tile->count;
}

/* Reads a tile's positions, transforms them to the lattice's space, and selects the ones to deform. */
static void take_points(const pass_tile *tile)
{
    const mesh_document *const document = tile->pass->document;
    const bool counts = !tile->part->repeats_positions;
    tile_points *const base = &tile->scratch->base;
    ffd_tile_points_begin(tile, NULL, 0, base);
    document->format->read(document, tile->part_index, MESH_POSITIONS, tile->pass->state, tile->first,
                           tile->count, base->stored);
    ffd_vertex_transforms_read(document, tile->part_index, tile->first, tile->count,
                               &tile->scratch->transforms,
                               counts && !tile->part->skipped ? &tile->totals->weights : NULL);
    place_points(tile);
    choose(tile);
    if (counts && !tile->pass->places)
        ffd_totals_count_rest(tile);
}

/* What a tile needs of the gradients of the deformation. */
typedef struct gradient_need {
    bool all;          /* those of every vertex */
    bool determinants; /* to look at det F of every vertex */
    bool turns;        /* to find the vertices with det F <= 0 */
} gradient_need;

static gradient_need find_need(const pass_tile *tile, bool directions)
{
    const mesh_pass *const pass = tile->pass;
    const bool counts = !tile->part->repeats_positions;
    const bool determinants = counts && pass->determinants;
    const bool arrays = counts && (pass->gradients || pass->stretches);
    return (gradient_need){.all = directions || determinants || arrays,
                           .determinants = determinants,
                           .turns = determinants || (counts && (pass->inversions || pass->collapsed))};
}

/* Sends the selected vertices through the lattices. */
static ffd_status send_points(const pass_tile *tile, const gradient_need *need, ffd_error *error)
{
    const mesh_pass *const pass = tile->pass;
    const bool counts = !tile->part->repeats_positions;
    turn_list *const turns = &tile->scratch->turns;
    chain_run run = ffd_tile_run(&tile->scratch->base, need->all || need->turns);
    run.located = recall(tile, &run);
    run.pace = tile->pace;
    run.turns = need->turns ? turns : NULL;
    run.only_turns = need->turns && !need->all;
    run.kept = counts ? tile->scratch->kept : NULL;
    turns->count = 0;
    ffd_status status;
    TRY_END(ffd_tile_send(&tile->scratch->base, &run, error));
    if (run.only_turns && turns->count > 0 && pass->links > 1 && !pass->chain->blocks) {
        /* Rare: several lattices turn points inside out, whose gradients only a second run gives. */
        place_points(tile);
        choose(tile);
        run.located = recall(tile, &run);
        turns->count = 0;
        run.only_turns = false;
        run.pace = NULL;
        run.moved_twice = run.disagreeing = 0;
        TRY_END(ffd_tile_send(&tile->scratch->base, &run, error));
    }
end:
    ffd_tile_add_times(tile, &run);
    if (counts) {
        tile->totals->moved_twice = run.moved_twice;
        tile->totals->disagreeing = run.disagreeing;
        tile->totals->disagreement = run.disagreement;
    }
    TRY(status);
    keep_locations(tile);
    if (run.kept)
        mark_kept(tile, run.keeps);
    return counts ? ffd_totals_count_deformed(tile, error) : FFD_OK;
}

/* Fills the caller's arrays of a pass that only locates. */
static void fill_places(const pass_tile *tile)
{
    const mesh_pass *const pass = tile->pass;
    const tile_points *const base = &tile->scratch->base;
    uint8_t *const places = pass->places + tile->first_index;
    memset(places, PASS_ELSEWHERE, tile->count);
    for (size_t i = 0; i < base->count && !tile->part->hidden && !tile->part->singular; i++) {
        const size_t v = ffd_tile_vertex(base, i);
        const point_outcome *const outcome = &base->outcomes[i];
        if (tile->part->skinned && tile->scratch->transforms.singular[v])
            continue;
        if (outcome->located || outcome->outside)
            places[v] = outcome->located ? PASS_INSIDE : PASS_OUTSIDE;
        if (pass->deformed)
            memcpy(pass->deformed + 3 * (tile->first_index + v), base->position + 3 * i,
                   3 * sizeof *pass->deformed);
    }
}

static ffd_status locate_tile(const pass_tile *tile, ffd_error *error)
{
    const mesh_pass *const pass = tile->pass;
    if (tile->part->repeats_positions)
        return FFD_OK;
    take_points(tile);
    TRY(ffd_deadline_check(error));
    chain_run run = ffd_tile_run(&tile->scratch->base, false);
    run.located = recall(tile, &run);
    run.pace = tile->pace;
    TRY(ffd_chain_locate(pass->chain, pass->links, pass->locations != NULL, &run, error));
    if (pass->locations)
        keep_locations(tile);
    fill_places(tile);
    return FFD_OK;
}

static ffd_status deform_tile(const pass_tile *tile, ffd_error *error)
{
    const mesh_pass *const pass = tile->pass;
    const mesh_part *const part = tile->part;
    tile_points *const base = &tile->scratch->base;
    const bool shapes = ffd_pass_takes_shapes(pass, part), splats = ffd_pass_takes_splats(pass, part);
    const bool wanted = pass->attributes && (!pass->only_offsets || shapes);
    const bool attributes = wanted && !part->singular && (part->normal_count || part->has_tangents);
    const gradient_need need = find_need(tile, attributes || splats);

    take_points(tile);
    TRY(ffd_deadline_check(error));
    TRY(send_points(tile, &need, error));
    if (need.turns && !need.determinants && pass->inversions)
        note_turns(tile, need.all && pass->weights);
    spread(tile);
    if (need.determinants)
        note_determinants(tile);
    if (!part->repeats_positions) {
        fill_arrays(tile);
        if (pass->stretches)
            ffd_tile_note_stretches(tile);
    }
    count_moved(tile);
    ffd_tile_carry(base, need.all);
    ffd_tile_bring_back(base);
    if (!part->repeats_positions)
        finish_positions(tile);
    if (splats)
        ffd_tile_splat_turns(tile);
    if (attributes || splats)
        ffd_tile_bring_gradients_back(base);
    if (attributes)
        finish_attributes(tile);
    if (splats)
        ffd_tile_splats(tile);
    return shapes ? ffd_tile_shapes(tile, error) : FFD_OK;
}

/* A part in work. */
typedef struct part_work {
    pass_tile whole; /* the part; its tiles are made from it */
    int workers;
    tile_scratch *scratch; /* one for each worker */
    pass_totals *tiles;    /* figures of each tile */
    atomic_bool stopped;   /* a tile has failed: skip the others */
    double vertices;       /* of all parts */
} part_work;

/* Returns a tile with vertices [first, last) of the part, without scratch memory. */
static pass_tile make_tile(const part_work *work, size_t index, size_t first, size_t last)
{
    pass_tile tile = work->whole;
    tile.first = first;
    tile.count = last - first;
    tile.first_index += first;
    tile.totals = &work->tiles[index];
    return tile;
}

static void run_tile(void *context, size_t index, size_t first, size_t last, int worker)
{
    part_work *const work = context;
    tile_scratch *const scratch = &work->scratch[worker];
    pass_tile tile = make_tile(work, index, first, last);
    tile.scratch = scratch;
    tile.pace = worker == 0 ? tile.pass->pace : NULL;
    ffd_totals_clear(tile.totals);
    if (atomic_load(&work->stopped))
        return;
    scratch->status =
        tile.pass->places ? locate_tile(&tile, &scratch->error) : deform_tile(&tile, &scratch->error);
    if (scratch->status)
        atomic_store(&work->stopped, true);
    if (tile.pass->write) /* a pass that only measures is short */
        ffd_deadline_done(JOB_IS_OPEN + (JOB_HAS_PASSED - JOB_IS_OPEN) *
                                            (double)(tile.first_index + tile.count) / work->vertices);
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
    const ffd_status status = any ? ffd_mesh_mark_used(work->whole.pass->document, error) : FFD_OK;
    for (size_t i = 0; i < tiles; i++) {
        const size_t first = i * size, left = work->whole.count - first;
        const pass_tile tile = make_tile(work, i, first, first + (left < size ? left : size));
        ffd_totals_count_others(&tile);
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

static ffd_status pass_over_part(part_work *work, pass_totals *totals, ffd_error *error)
{
    const size_t count = work->whole.count, size = tile_size(count), tiles = tile_count(count);
    work->tiles = ffd_alloc_zero(tiles, sizeof *work->tiles);
    if (!work->tiles)
        return ffd_fail_memory(error);
    ffd_parallel_tiles(count, size, work->workers, run_tile, work);
    const ffd_status status = count_others(work, tiles, size, error);
    for (size_t i = 0; i < tiles; i++)
        ffd_totals_join(&work->tiles[i], totals);
    ffd_totals_judge_rounding(work->tiles, tiles,
                              ffd_part_tolerance(work->whole.pass->document, &work->whole.part->rounding),
                              ffd_rounding_kind(&work->whole.part->rounding), totals);
    ffd_free(work->tiles);
    TRY(status);
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

ffd_status ffd_pass_over_mesh(const mesh_pass *pass, pass_totals *totals, ffd_error *error)
{
    part_work work = {.whole = {.pass = pass},
                      .workers = worker_count(pass),
                      .vertices = maximum_number((double)ffd_mesh_vertex_count(pass->document), 1)};
    ffd_totals_clear(totals);
    atomic_init(&work.stopped, false);
    work.scratch = make_scratch(pass, work.workers);
    if (!work.scratch)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < pass->document->part_count; i++) {
        const mesh_part *const part = &pass->document->parts[i];
        work.whole.part = part;
        work.whole.part_index = i;
        work.whole.count = part->vertex_count;
        const uint64_t moved = totals->moved;
        TRY_END(pass_over_part(&work, totals, error));
        if (part->splats && !ffd_pass_takes_splats(pass, part))
            ffd_totals_note_splats(totals, i, totals->moved - moved);
        if (!part->repeats_positions)
            work.whole.first_index += part->vertex_count;
    }
end:
    free_scratch(work.scratch, work.workers);
    return status;
}
