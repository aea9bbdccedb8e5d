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
    all->morph_targets.outside = more(all->morph_targets.outside, target->morph_targets.outside);
    all->morph_targets.invalid = more(all->morph_targets.invalid, target->morph_targets.invalid);
    all->morph_targets.shown_outside =
        more(all->morph_targets.shown_outside, target->morph_targets.shown_outside);
    all->moved = more(all->moved, target->moved);
    all->normals_collapsed = more(all->normals_collapsed, target->normals_collapsed);
    all->normals_carried = more(all->normals_carried, target->normals_carried);
    all->transforms_singular = target->transforms_singular;
    all->skin_weights.off = target->skin_weights.off;
    all->skin_weights.farthest = target->skin_weights.farthest;
    all->skin_weights.none = target->skin_weights.none;
}

static void join_numbers(const ffd_job_result *target, ffd_job_result *all)
{
    all->residual.max = larger(all->residual.max, target->residual.max);
    all->residual.rms = larger(all->residual.rms, target->residual.rms);
    all->iterations.mean = larger(all->iterations.mean, target->iterations.mean);
    if (target->iterations.max > all->iterations.max)
        all->iterations.max = target->iterations.max;
    all->displacement.max = larger(all->displacement.max, target->displacement.max);
    all->displacement.rms = larger(all->displacement.rms, target->displacement.rms);
    all->seconds.read += target->seconds.read;
    all->seconds.embed += target->seconds.embed;
    all->seconds.deform += target->seconds.deform;
    all->seconds.judge += target->seconds.judge;
}

static void join_bounds(const ffd_job_result *target, ffd_job_result *all)
{
    all->bounds.before = target->bounds.before;
    if (!(target->bounds.after.min[0] <= target->bounds.after.max[0]))
        return;
    if (!(all->bounds.after.min[0] <= all->bounds.after.max[0]))
        all->bounds.after = target->bounds.after;
    ffd_bounds_widen(&all->bounds.after, target->bounds.after.min);
    ffd_bounds_widen(&all->bounds.after, target->bounds.after.max);
}

/* With several targets there is no single deformed shape. */
static void join_extent(const ffd_job_result *target, bool is_only, ffd_job_result *all)
{
    all->area.before = target->area.before;
    all->volume.before = target->volume.before;
    all->area.after = is_only ? target->area.after : NAN;
    all->volume.after = is_only ? target->volume.after : NAN;
}

static void join_tears(const ffd_job_result *target, bool is_first, ffd_job_result *all)
{
    const bool is_known = target->tear.is_known && (is_first || all->tear.is_known);
    if (is_first || target->tear.largest > all->tear.largest)
        all->tear = target->tear;
    all->tear.is_known = is_known;
}

/* Combines the figures that take extra time, where all targets have them. */
static void join_quality(const ffd_job_result *target, size_t number, ffd_job_result *all)
{
    const bool is_first = number == 0;
    ffd_figures_join_folds(&target->folds, number, &all->folds);
    all->has_flipped = target->has_flipped && (is_first || all->has_flipped);
    all->faces = target->faces;
    all->flipped_faces = more(all->flipped_faces, target->flipped_faces);
    if (target->det.outside < all->det.outside) {
        all->det.outside = target->det.outside;
        all->det.outside_vertex = target->det.outside_vertex;
    }
    if (!(target->det.min <= target->det.max))
        return;
    const bool known = all->det.min <= all->det.max;
    all->det.min = known && all->det.min < target->det.min ? all->det.min : target->det.min;
    all->det.max = known && all->det.max > target->det.max ? all->det.max : target->det.max;
    all->det.is_known = true;
}

static void join_edges(const ffd_job_result *target, bool is_first, ffd_job_result *all)
{
    all->edges.is_known = target->edges.is_known && (is_first || all->edges.is_known);
    all->edges.count = target->edges.count;
    all->edges.deviation.max = larger(all->edges.deviation.max, target->edges.deviation.max);
    all->edges.deviation.mean = larger(all->edges.deviation.mean, target->edges.deviation.mean);
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
