#include "job/figures/figures.h"
#include "job/figures/pass_totals.h"
#include <math.h>
#include <string.h>

/* clang-format off */
#define TYPE_OF(value) _Generic((value), \
    bool: FIGURE_FLAG, \
    uint64_t: FIGURE_COUNT, \
    double: FIGURE_NUMBER, \
    char *: FIGURE_TEXT, \
    double *: FIGURE_VECTOR, \
    ffd_bounds: FIGURE_BOX, \
    uint64_t *: FIGURE_STATUSES, \
    ffd_fold_verdict: FIGURE_VERDICT, \
    ffd_fold_reference: FIGURE_REFERENCE, \
    ffd_seam: FIGURE_SEAM, \
    ffd_tear_cause: FIGURE_CAUSE, \
    ffd_behind *: FIGURE_BEHIND, \
    ffd_flaw *: FIGURE_FLAWS, \
    const ffd_job_result *: FIGURE_MORPHS, \
    ffd_rigid_part *: FIGURE_RIGID, \
    uint8_t *: FIGURE_FACES)
#define MEMBER(type, member) {TYPE_OF(((type *)0)->member), offsetof(type, member)}
#define RESULT(member) MEMBER(ffd_job_result, member)

/* The parts of a row. */
#define FIGURE(member) .name = #member, .result = RESULT(member)
#define HELD_BACK(member) FIGURE(member), .is_held_back = true
#define GROUP(member) .name = #member, .result = {FIGURE_GROUP, offsetof(ffd_job_result, member)}, \
    .size = sizeof((ffd_job_result *)0)->member
#define END {.result = {FIGURE_END, 0}}
#define FROM(member, how) .total = MEMBER(pass_totals, member), .tiles = (how)
#define TARGETS(how) .targets = (how)
#define LARGEST_BY(member) .targets = JOIN_GROUP, .by = offsetof(ffd_job_result, member)
#define NULL_UNLESS(need) .presence = FIGURE_NULL_UNLESS, .needs = {RESULT(need)}
#define NULL_UNLESS_FINITE(a, b) .presence = FIGURE_NULL_UNLESS_FINITE, .needs = {RESULT(a), RESULT(b)}
#define ABSENT_UNLESS(need) .presence = FIGURE_ABSENT_UNLESS, .needs = {RESULT(need)}
#define ABSENT_UNLESS_EITHER(a, b) .presence = FIGURE_ABSENT_UNLESS, .needs = {RESULT(a), RESULT(b)}
#define OF_JOB .is_of_job = true
#define LINES(which) .lines = (which)

const figure ffd_figures[] = {
    {FIGURE(vertices), FROM(vertices, JOIN_SUM), TARGETS(JOIN_SAME)},
    {FIGURE(counts), FROM(counts, JOIN_SUM), TARGETS(JOIN_FEWEST), LINES(LINES_OF_STATUSES)},
    {FIGURE(unused), FROM(unused, JOIN_SUM), TARGETS(JOIN_FEWEST)},
    {FIGURE(hidden), FROM(hidden, JOIN_SUM), TARGETS(JOIN_FEWEST)},
    {GROUP(morph_targets)},
        {FIGURE(morph_targets.outside), FROM(shapes_outside, JOIN_SUM), TARGETS(JOIN_LARGEST)},
        {FIGURE(morph_targets.shown_outside), TARGETS(JOIN_LARGEST)},
        {FIGURE(morph_targets.base_outside), FROM(base_outside, JOIN_NONE), TARGETS(JOIN_LARGEST),
         ABSENT_UNLESS(morph_targets.base_outside)},
        {FIGURE(morph_targets.invalid), FROM(shapes_invalid, JOIN_SUM), TARGETS(JOIN_LARGEST)},
    END,
    {FIGURE(moved), FROM(moved, JOIN_SUM), TARGETS(JOIN_LARGEST), LINES(LINES_OF_MOVED)},
    {GROUP(shared_faces)},
        {FIGURE(shared_faces.moved_twice), FROM(moved_twice, JOIN_SUM), TARGETS(JOIN_LARGEST)},
        {FIGURE(shared_faces.disagreeing), FROM(disagreeing, JOIN_SUM), TARGETS(JOIN_LARGEST)},
        {FIGURE(shared_faces.largest), FROM(disagreement, JOIN_LARGEST), TARGETS(JOIN_LARGEST)},
    END,
    {GROUP(residual)},
        {FIGURE(residual.max), TARGETS(JOIN_LARGEST)},
        {FIGURE(residual.rms), TARGETS(JOIN_LARGEST)},
    END,
    {GROUP(iterations)},
        {FIGURE(iterations.mean), TARGETS(JOIN_LARGEST)},
        {FIGURE(iterations.max), FROM(evaluations_max, JOIN_LARGEST), TARGETS(JOIN_LARGEST)},
    END,
    {GROUP(folds), TARGETS(JOIN_FOLDS), NULL_UNLESS(folds.is_known), LINES(LINES_OF_FOLDS)},
        {FIGURE(folds.verdict)},
        {FIGURE(folds.cells)},
        {FIGURE(folds.min_det)},
        {FIGURE(folds.relative_to)},
        {FIGURE(folds.folded_cells)},
        {FIGURE(folds.unknown_cells)},
        {GROUP(folds.witness), NULL_UNLESS(folds.witness.is_there)},
            {FIGURE(folds.witness.lattice)},
            {FIGURE(folds.witness.uvw)},
            {FIGURE(folds.witness.xyz)},
            {FIGURE(folds.witness.rest)},
            {FIGURE(folds.witness.det)},
        END,
    END,
    {HELD_BACK(has_flipped), TARGETS(JOIN_ALL)},
    {HELD_BACK(faces), TARGETS(JOIN_LARGEST)},
    {FIGURE(flipped_faces), TARGETS(JOIN_LARGEST), NULL_UNLESS(has_flipped), LINES(LINES_OF_FLIPPED)},
    {GROUP(tear), LARGEST_BY(tear.largest), NULL_UNLESS(tear.is_known), LINES(LINES_OF_TEAR)},
        {HELD_BACK(tear.is_known), TARGETS(JOIN_ALL)},
        {FIGURE(tear.edges)},
        {FIGURE(tear.largest)},
        {FIGURE(tear.vertex), NULL_UNLESS(tear.edges)},
        {FIGURE(tear.part)},
        {HELD_BACK(tear.stays)},
        {HELD_BACK(tear.cause)},
    END,
    {GROUP(volume), NULL_UNLESS_FINITE(volume.before, volume.after), LINES(LINES_OF_EXTENT)},
        {FIGURE(volume.before), TARGETS(JOIN_SAME)},
        {FIGURE(volume.after), TARGETS(JOIN_ONLY)},
    END,
    {GROUP(area), NULL_UNLESS_FINITE(area.before, area.after)},
        {FIGURE(area.before), TARGETS(JOIN_SAME)},
        {FIGURE(area.after), TARGETS(JOIN_ONLY)},
    END,
    {GROUP(det), NULL_UNLESS(det.is_known), LINES(LINES_OF_DET)},
        {HELD_BACK(det.is_known), TARGETS(JOIN_ANY)},
        {FIGURE(det.min), TARGETS(JOIN_LEAST)},
        {FIGURE(det.max), TARGETS(JOIN_HIGHEST)},
        {FIGURE(det.outside), FROM(det_outside, JOIN_LEAST), TARGETS(JOIN_LEAST)},
        {HELD_BACK(det.outside_vertex), FROM(first_det_outside, JOIN_WITH), TARGETS(JOIN_WITH)},
    END,
    {GROUP(edges), OF_JOB, NULL_UNLESS(edges.is_known), LINES(LINES_OF_EDGES)},
        {HELD_BACK(edges.is_known), TARGETS(JOIN_ALL)},
        {FIGURE(edges.count), TARGETS(JOIN_LARGEST)},
        {GROUP(edges.deviation)},
            {FIGURE(edges.deviation.max), TARGETS(JOIN_LARGEST)},
            {FIGURE(edges.deviation.mean), TARGETS(JOIN_LARGEST)},
        END,
    END,
    {GROUP(cells), OF_JOB, ABSENT_UNLESS(cells.is_there), LINES(LINES_OF_CELLS)},
        {HELD_BACK(cells.is_there)},
        {FIGURE(cells.count)},
        {GROUP(cells.inverted)},
            {FIGURE(cells.inverted.before)},
            {FIGURE(cells.inverted.after)},
        END,
        {FIGURE(cells.by_deformation)},
        {FIGURE(cells.unknown)},
        {GROUP(cells.scaled_jacobian)},
            {FIGURE(cells.scaled_jacobian.before)},
            {FIGURE(cells.scaled_jacobian.after)},
        END,
        {HELD_BACK(cells.has_worst)},
        {FIGURE(cells.worst), NULL_UNLESS(cells.has_worst)},
    END,
    {GROUP(skin_weights), OF_JOB, ABSENT_UNLESS_EITHER(skin_weights.off, skin_weights.none)},
        {FIGURE(skin_weights.off), FROM(weights.off, JOIN_SUM), TARGETS(JOIN_LARGEST)},
        {FIGURE(skin_weights.farthest), FROM(weights.farthest, JOIN_LARGEST), TARGETS(JOIN_LARGEST)},
        {FIGURE(skin_weights.none), FROM(weights.none, JOIN_SUM), TARGETS(JOIN_LARGEST)},
    END,
    {GROUP(weight), OF_JOB, ABSENT_UNLESS(weight.is_there)},
        {HELD_BACK(weight.is_there), TARGETS(JOIN_ANY)},
        {FIGURE(weight.zero), TARGETS(JOIN_LARGEST)},
        {FIGURE(weight.one), TARGETS(JOIN_LARGEST)},
        {FIGURE(weight.clamped), TARGETS(JOIN_LARGEST)},
        {FIGURE(weight.mean), TARGETS(JOIN_SAME)},
    END,
    {GROUP(precision), OF_JOB, ABSENT_UNLESS(precision.side)},
        {FIGURE(precision.error), FROM(lost.error, JOIN_NONE)},
        {FIGURE(precision.side), FROM(lost.side, JOIN_NONE)},
    END,
    {GROUP(splats), OF_JOB, ABSENT_UNLESS_EITHER(splats.carried, splats.broken)},
        {FIGURE(splats.carried), FROM(splats_carried, JOIN_SUM)},
        {FIGURE(splats.flattened), FROM(splats_flattened, JOIN_SUM)},
        {FIGURE(splats.broken), FROM(splats_broken, JOIN_SUM)},
    END,
    {GROUP(bounds)},
        {FIGURE(bounds.before), FROM(before, JOIN_BOUNDS), TARGETS(JOIN_SAME)},
        {FIGURE(bounds.after), FROM(after, JOIN_BOUNDS), TARGETS(JOIN_BOUNDS)},
    END,
    {GROUP(displacement)},
        {FIGURE(displacement.max), TARGETS(JOIN_LARGEST)},
        {FIGURE(displacement.rms), TARGETS(JOIN_LARGEST)},
    END,
    {FIGURE(behind), OF_JOB, TARGETS(JOIN_BEHIND)},
    {GROUP(rig), OF_JOB, LARGEST_BY(rig.largest_lag), ABSENT_UNLESS(rig.is_there), LINES(LINES_OF_RIG)},
        {FIGURE(rig.joints)},
        {FIGURE(rig.moved)},
        {FIGURE(rig.largest_lag)},
        {FIGURE(rig.worst)},
        {FIGURE(rig.sheared)},
        {FIGURE(rig.singular), ABSENT_UNLESS(rig.singular)},
        {FIGURE(rig.partial), ABSENT_UNLESS(rig.partial)},
        {FIGURE(rig.unscaled), ABSENT_UNLESS(rig.unscaled)},
        {FIGURE(rig.unselected), ABSENT_UNLESS(rig.unselected)},
        {FIGURE(rig.unselected_by), ABSENT_UNLESS(rig.unselected)},
        {HELD_BACK(rig.lagging_skins)},
        {HELD_BACK(rig.lagging_pivots)},
        {HELD_BACK(rig.lagging_sockets)},
        {HELD_BACK(rig.lagging_joints)},
    END,
    {.name = "rigid", .result = RESULT(rigid.parts), OF_JOB, ABSENT_UNLESS(rigid.count), LINES(LINES_OF_RIGID)},
    {.name = "morphs", .result = RESULT(morphs.results), OF_JOB, ABSENT_UNLESS(morphs.results)},
    {GROUP(seam), OF_JOB, TARGETS(JOIN_SEAM), ABSENT_UNLESS(seam.is_there)},
        {FIGURE(seam.continuity)},
        {HELD_BACK(seam.count)},
        {FIGURE(seam.faces)},
    END,
    {FIGURE(indices_left), OF_JOB, ABSENT_UNLESS(indices_left)},
    {FIGURE(bytes_left), OF_JOB, ABSENT_UNLESS(bytes_left)},
    {FIGURE(bounds_left), OF_JOB, ABSENT_UNLESS(bounds_left)},
    {FIGURE(flaws), OF_JOB, ABSENT_UNLESS(flaw_count)},
    {HELD_BACK(own_box)},
    {HELD_BACK(normals_collapsed), FROM(normals_collapsed, JOIN_SUM), TARGETS(JOIN_LARGEST)},
    {HELD_BACK(normals_carried), FROM(normals_carried, JOIN_NONE), TARGETS(JOIN_LARGEST)},
    {HELD_BACK(transforms_singular), FROM(transforms_singular, JOIN_SUM), TARGETS(JOIN_LARGEST)},
    {GROUP(seconds), OF_JOB, .is_time = true},
        {FIGURE(seconds.read), TARGETS(JOIN_SUM)},
        {FIGURE(seconds.embed), TARGETS(JOIN_SUM)},
        {FIGURE(seconds.deform), TARGETS(JOIN_SUM)},
        {FIGURE(seconds.judge), TARGETS(JOIN_SUM)},
        {FIGURE(seconds.write), TARGETS(JOIN_SUM)},
    END,

    /* Of a pass only: what other figures are made of, and what messages tell. */
    {FROM(is_visible, JOIN_ANY)},
    {FROM(located, JOIN_SUM)},
    {FROM(residual_square_max, JOIN_LARGEST)},
    {FROM(residual_square_sum, JOIN_SUM)},
    {FROM(evaluations, JOIN_SUM)},
    {FROM(displacement_square_max, JOIN_LARGEST)},
    {FROM(displacement_square_sum, JOIN_SUM)},
    {FROM(shapes, JOIN_BOUNDS)},
    {FROM(rounding.box, JOIN_NONE)},
    {FROM(lost.of_doubles, JOIN_NONE)},
    {FROM(lost.of_steps, JOIN_NONE)},
    {FROM(outside_all, JOIN_SUM)},
    {FROM(misses.count, JOIN_SUM)},
    {FROM(misses.examined, JOIN_SUM)},
    {FROM(misses.largest, JOIN_LARGEST)},
    {FROM(misses.is_least, JOIN_ANY)},
    {FROM(multiple_any, JOIN_SUM)},
    {FROM(unresolved, JOIN_SUM)},
    {FROM(degenerate, JOIN_SUM)},
    {FROM(unshown_outside, JOIN_SUM)},
    {FROM(first_unshown_outside, JOIN_LEAST)},
    {FROM(extended, JOIN_SUM)},
    {FROM(extended_moved, JOIN_SUM)},
    {FROM(first_outside, JOIN_LEAST)},
    {FROM(first_invalid, JOIN_LEAST)},
    {FROM(first_overflow, JOIN_LEAST)},
    {FROM(first_missed, JOIN_LEAST)},
    {FROM(missed_by, JOIN_WITH)},
    {FROM(first_shape_outside, JOIN_LEAST)},
    {FROM(weighted_outside, JOIN_SUM)},
    {FROM(first_weighted_outside, JOIN_LEAST)},
    {FROM(first_base_outside, JOIN_LEAST)},
    {FROM(kept, JOIN_SUM)},
    {FROM(inverted, JOIN_SUM)},
    {FROM(det_inverted, JOIN_LEAST)}, /* the first of equal ones */
    {FROM(first_inverted, JOIN_WITH)},
    {FROM(collapsed, JOIN_SUM)},
    {FROM(first_collapsed, JOIN_LEAST)},
    {FROM(det_min, JOIN_LEAST)},
    {FROM(det_max, JOIN_HIGHEST)},
    {FROM(embed_seconds, JOIN_SUM)},
    {FROM(deform_seconds, JOIN_SUM)},
};
/* clang-format on */

const size_t ffd_figure_count = sizeof ffd_figures / sizeof *ffd_figures;

const char *ffd_figure_key(const figure *f)
{
    const char *const dot = strrchr(f->name, '.');
    return dot ? dot + 1 : f->name;
}

static bool is_set(const figure_member *need, const ffd_job_result *result)
{
    const void *const value = ffd_figure_value(need, result);
    switch (need->type) {
    case FIGURE_FLAG:
        return *(const bool *)value;
    case FIGURE_COUNT:
        return *(const uint64_t *)value != 0;
    case FIGURE_NUMBER:
        return *(const double *)value > 0;
    case FIGURE_MORPHS:
        return *(const ffd_job_result *const *)value != NULL;
    default:
        return false;
    }
}

static bool is_finite(const figure_member *need, const ffd_job_result *result)
{
    return isfinite(*(const double *)ffd_figure_value(need, result));
}

bool ffd_figure_is_there(const figure *f, const ffd_job_result *result, bool *null)
{
    const figure_member *const needs = f->needs;
    *null = f->presence != FIGURE_ABSENT_UNLESS;
    if (f->presence == FIGURE_ALWAYS)
        return true;
    if (f->presence == FIGURE_NULL_UNLESS_FINITE)
        return is_finite(&needs[0], result) || is_finite(&needs[1], result);
    return is_set(&needs[0], result) || is_set(&needs[1], result);
}
