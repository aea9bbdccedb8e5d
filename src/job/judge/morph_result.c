#include "job/judge/morph_result.h"
#include "job/judge/figures.h"
#include "mesh/bounds.h"
#include <math.h>
#include <string.h>

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static uint64_t more(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* Vertex counts by status come from the target with the fewest vertices inside. */
static void join_counts(const ffd_job_result *target, bool is_first, ffd_job_result *all)
{
    all->vertices = target->vertices;
    if (is_first || target->counts[FFD_INSIDE] < all->counts[FFD_INSIDE]) {
        memcpy(all->counts, target->counts, sizeof all->counts);
        all->unused = target->unused;
        all->hidden = target->hidden;
    }
    all->targets_outside = more(all->targets_outside, target->targets_outside);
    all->targets_invalid = more(all->targets_invalid, target->targets_invalid);
    all->shown_outside = more(all->shown_outside, target->shown_outside);
    all->moved = more(all->moved, target->moved);
    all->normals_collapsed = more(all->normals_collapsed, target->normals_collapsed);
    all->normals_carried = more(all->normals_carried, target->normals_carried);
    all->transforms_singular = target->transforms_singular;
    all->weights_off = target->weights_off;
    all->weights_farthest = target->weights_farthest;
    all->weights_none = target->weights_none;
}

static void join_numbers(const ffd_job_result *target, ffd_job_result *all)
{
    all->residual_max = larger(all->residual_max, target->residual_max);
    all->residual_rms = larger(all->residual_rms, target->residual_rms);
    all->evaluations_mean = larger(all->evaluations_mean, target->evaluations_mean);
    if (target->evaluations_max > all->evaluations_max)
        all->evaluations_max = target->evaluations_max;
    all->displacement_max = larger(all->displacement_max, target->displacement_max);
    all->displacement_rms = larger(all->displacement_rms, target->displacement_rms);
    all->seconds_read += target->seconds_read;
    all->seconds_embed += target->seconds_embed;
    all->seconds_deform += target->seconds_deform;
    all->seconds_judge += target->seconds_judge;
}

static void join_bounds(const ffd_job_result *target, ffd_job_result *all)
{
    all->before = target->before;
    if (!(target->after.min[0] <= target->after.max[0]))
        return;
    if (!(all->after.min[0] <= all->after.max[0]))
        all->after = target->after;
    ffd_bounds_widen(&all->after, target->after.min);
    ffd_bounds_widen(&all->after, target->after.max);
}

/* With several targets there is no single deformed shape. */
static void join_extent(const ffd_job_result *target, bool is_only, ffd_job_result *all)
{
    all->area_before = target->area_before;
    all->volume_before = target->volume_before;
    all->area_after = is_only ? target->area_after : NAN;
    all->volume_after = is_only ? target->volume_after : NAN;
}

static void join_tears(const ffd_job_result *target, bool is_first, ffd_job_result *all)
{
    all->has_tear = target->has_tear && (is_first || all->has_tear);
    if (!is_first && !(target->tear_largest > all->tear_largest))
        return;
    all->tear_edges = target->tear_edges;
    all->tear_largest = target->tear_largest;
    all->tear_vertex = target->tear_vertex;
    memcpy(all->tear_part, target->tear_part, sizeof all->tear_part);
    all->tear_stays = target->tear_stays;
    all->tear_unselected = target->tear_unselected;
    all->tear_seam = target->tear_seam;
    all->tear_cause = target->tear_cause;
}

/* Combines the figures that take extra time, where all targets have them. */
static void join_quality(const ffd_job_result *target, size_t number, ffd_job_result *all)
{
    const bool had_witness = all->folds.has_witness, is_first = number == 0;
    all->has_folds = target->has_folds && (is_first || all->has_folds);
    if (is_first)
        all->folds = target->folds;
    else
        ffd_figures_join_folds(&all->folds, &target->folds);
    if (!had_witness && all->folds.has_witness)
        all->folds_lattice = number;
    all->has_flipped = target->has_flipped && (is_first || all->has_flipped);
    all->faces = target->faces;
    all->flipped_faces = more(all->flipped_faces, target->flipped_faces);
    if (target->det_outside < all->det_outside) {
        all->det_outside = target->det_outside;
        all->det_outside_vertex = target->det_outside_vertex;
    }
    if (!(target->det_min <= target->det_max))
        return;
    const bool known = all->det_min <= all->det_max;
    all->det_min = known && all->det_min < target->det_min ? all->det_min : target->det_min;
    all->det_max = known && all->det_max > target->det_max ? all->det_max : target->det_max;
}

static void join_edges(const ffd_job_result *target, bool is_first, ffd_job_result *all)
{
    all->has_edges = target->has_edges && (is_first || all->has_edges);
    all->edges = target->edges;
    all->deviation_max = larger(all->deviation_max, target->deviation_max);
    all->deviation_mean = larger(all->deviation_mean, target->deviation_mean);
}

/* For each kind, the result of the first target that leaves the most behind. */
static void join_behind(const ffd_job_result *target, ffd_job_result *all)
{
    for (int kind = 0; kind < FFD_BEHIND_KIND_COUNT; kind++)
        if (target->behind[kind].count > all->behind[kind].count)
            all->behind[kind] = target->behind[kind];
}

/* The joints that lie farthest off a target. */
static void join_rig(const ffd_job_result *target, ffd_job_result *all)
{
    if (!all->rig.is_there || target->rig.largest_lag > all->rig.largest_lag)
        all->rig = target->rig;
}

void ffd_morph_results_join(const ffd_job_result *targets, size_t count, ffd_job_result *all)
{
    for (size_t k = 0; k < count; k++) {
        join_counts(&targets[k], k == 0, all);
        join_numbers(&targets[k], all);
        join_bounds(&targets[k], all);
        join_tears(&targets[k], k == 0, all);
        join_quality(&targets[k], k, all);
        join_edges(&targets[k], k == 0, all);
        join_behind(&targets[k], all);
        join_rig(&targets[k], all);
        join_extent(&targets[k], count == 1, all);
    }
}
