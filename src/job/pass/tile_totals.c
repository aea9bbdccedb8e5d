/* tile_totals.c - counts the figures of one tile of a pass. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "job/pass/tile.h"

void ffd_totals_count_rest(const pass_tile *tile)
{
    const tile_points *const base = &tile->scratch->base;
    pass_totals *const totals = tile->totals;
    totals->vertices += base->count;
    if (ffd_tile_widen(base, &totals->before))
        return;
    for (size_t i = 0; i < base->count; i++)
        if (!vec_is_finite(base->position + 3 * i))
            ffd_note_first(&totals->first_invalid, tile->first_index + ffd_tile_vertex(base, i));
}

/* Flags of a vertex that is not simply inside: its ffd_vertex_status in the low bits, and these. */
enum {
    OTHER_STATUS = 7,
    OTHER_OUTSIDE = 8,
    OTHER_EXTENDED = 16,
    OTHER_MULTIPLE = 32,
    OTHER_UNRESOLVED = 64,
    OTHER_MOVED = 128
};

/* Stores the flags of a vertex of the tile that is not simply inside. Returns false if memory runs out. */
static bool note_other(const point_outcome *outcome, const double delta[3], size_t vertex,
                       pass_totals *totals)
{
    const bool moved = delta[0] != 0 || delta[1] != 0 || delta[2] != 0;
    if (!totals->others)
        totals->others = ffd_alloc_zero(PASS_TILE, 1);
    if (!totals->others)
        return false;
    totals->others[vertex] =
        (uint8_t)(outcome->status | (outcome->outside ? OTHER_OUTSIDE : 0) |
                  (outcome->extended ? OTHER_EXTENDED : 0) | (outcome->multiple ? OTHER_MULTIPLE : 0) |
                  (outcome->unresolved ? OTHER_UNRESOLVED : 0) | (moved ? OTHER_MOVED : 0));
    return true;
}

static void count_other(const mesh_part *part, unsigned other, uint64_t index, pass_totals *totals)
{
    const unsigned status = other & OTHER_STATUS;
    totals->counts[status]++;
    if (other & OTHER_OUTSIDE) {
        totals->outside_all++;
        ffd_note_first(&totals->first_outside, index);
    }
    if (other & OTHER_OUTSIDE && part->shows_shapes) {
        totals->weighted_outside++;
        ffd_note_first(&totals->first_weighted_outside, index);
    }
    if (status == FFD_VERTEX_OUTSIDE && other & OTHER_EXTENDED) {
        totals->extended++;
        totals->extended_moved += (other & OTHER_MOVED) != 0;
    }
    totals->multiple_any += (other & OTHER_MULTIPLE) != 0;
    totals->unresolved += (other & OTHER_UNRESOLVED) != 0;
    totals->degenerate += status == FFD_VERTEX_SINGULAR && !(other & OTHER_UNRESOLVED);
}

static void count_unshown(unsigned other, bool hidden, uint64_t index, pass_totals *totals)
{
    *(hidden ? &totals->hidden : &totals->unused) += 1;
    if (!(other & OTHER_OUTSIDE))
        return;
    totals->unshown_outside++;
    ffd_note_first(&totals->first_unshown_outside, index);
}

/* A vertex that is not finite counts even if nothing shows it: it is a fault of the mesh. */
static bool counts(const mesh_part *part, size_t vertex, unsigned other)
{
    return (other & OTHER_STATUS) == FFD_VERTEX_INVALID || ffd_part_shows(part, vertex);
}

void ffd_totals_count_others(const pass_tile *tile)
{
    pass_totals *const totals = tile->totals;
    for (size_t i = 0; i < tile->count && totals->others; i++) {
        const uint64_t index = tile->first_index + i;
        if (totals->others[i] && counts(tile->part, tile->first + i, totals->others[i]))
            count_other(tile->part, totals->others[i], index, totals);
        else if (totals->others[i])
            count_unshown(totals->others[i], tile->part->hidden, index, totals);
    }
    ffd_free(totals->others);
    totals->others = NULL;
}

/* Returns false if memory runs out. */
static bool count_outcomes(const tile_points *base, pass_totals *totals)
{
    double square_max = 0, square_sum = 0;
    uint64_t evaluations = 0;
    uint32_t evaluations_max = 0;
    size_t inside = 0, located = 0;
    bool noted = true;
    for (size_t i = 0; i < base->count; i++) {
        const point_outcome *const outcome = &base->outcomes[i];
        square_max = larger_of(square_max, outcome->residual_square); /* 0 without u,v,w */
        square_sum += outcome->residual_square;
        located += outcome->located;
        evaluations += outcome->evaluations;
        evaluations_max = outcome->evaluations > evaluations_max ? outcome->evaluations : evaluations_max;
        if (outcome->status == FFD_VERTEX_INSIDE)
            inside++;
        else
            noted = note_other(outcome, base->delta + 3 * i, ffd_tile_vertex(base, i), totals) && noted;
    }
    totals->counts[FFD_VERTEX_INSIDE] += inside;
    totals->located += located;
    totals->residual_square_max = larger_of(totals->residual_square_max, square_max);
    totals->residual_square_sum += square_sum;
    totals->evaluations += evaluations;
    totals->evaluations_max =
        evaluations_max > totals->evaluations_max ? evaluations_max : totals->evaluations_max;
    return noted;
}

/* A vertex whose transform is singular stays, whatever the chain says. */
static bool stays(const tile_points *base, size_t i, pass_totals *totals)
{
    if (!ffd_vertex_transform_of(&base->tile->scratch->transforms, ffd_tile_vertex(base, i)).singular)
        return false;
    totals->transforms_singular += vec_is_finite(base->position + 3 * i);
    return true;
}

static void count_displacements(const tile_points *base, pass_totals *totals)
{
    const bool some_stay = base->tile->part->skinned || base->tile->part->singular;
    double square_max = 0, square_sum = 0;
    for (size_t i = 0; i < base->count; i++) {
        const double square = vec_dot(base->delta + 3 * i, base->delta + 3 * i);
        if (some_stay && stays(base, i, totals))
            continue;
        square_max = larger_of(square_max, square);
        square_sum += square;
    }
    totals->displacement_square_max = larger_of(totals->displacement_square_max, square_max);
    totals->displacement_square_sum += square_sum;
}

ffd_status ffd_totals_count_deformed(const pass_tile *tile, ffd_error *error)
{
    const tile_points *const base = &tile->scratch->base;
    if (!count_outcomes(base, tile->totals))
        return ffd_fail_memory(error);
    count_displacements(base, tile->totals);
    ffd_tile_widen(base, &tile->totals->after);
    return tile->totals->others ? ffd_tile_find_misses(tile, error) : FFD_OK;
}
