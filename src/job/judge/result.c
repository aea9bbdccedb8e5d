#include "job/judge/result.h"
#include "job/chain/coverage.h"
#include "job/input/source.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void ffd_result_clear(ffd_job_result *result)
{
    memset(result, 0, sizeof *result);
    for (int a = 0; a < 3; a++) {
        result->before.min[a] = result->after.min[a] = 1; /* nothing yet: min > max */
        result->before.max[a] = result->after.max[a] = -1;
    }
    result->det_min = 1;
    result->det_max = -1;
}

void ffd_result_fill(ffd_job_result *result, const pass_totals *totals, double seconds)
{
    result->vertices = totals->vertices;
    for (int s = 0; s < FFD_VERTEX_STATUS_COUNT; s++)
        result->counts[s] = totals->counts[s];
    result->moved = totals->moved;
    result->residual_max = sqrt(totals->residual_square_max);
    result->residual_rms = totals->located ? sqrt(totals->residual_square_sum / (double)totals->located) : 0;
    result->evaluations_mean = totals->vertices ? (double)totals->evaluations / (double)totals->vertices : 0;
    result->evaluations_max = totals->evaluations_max;
    result->before = totals->before;
    result->after = totals->after;
    for (int a = 0; a < 3; a++) { /* of -0 and 0, which are equal, either may have been found first */
        result->before.min[a] += 0.0;
        result->before.max[a] += 0.0;
        result->after.min[a] += 0.0;
        result->after.max[a] += 0.0;
    }
    result->displacement_max = sqrt(totals->displacement_square_max);
    result->displacement_rms =
        totals->vertices ? sqrt(totals->displacement_square_sum / (double)totals->vertices) : 0;
    result->normals_collapsed = totals->normals_collapsed;
    result->normals_carried = totals->normals_carried;
    result->transforms_singular = totals->transforms_singular;
    const double own = totals->embed_seconds + totals->deform_seconds;
    result->seconds_embed = own > 0 ? seconds * totals->embed_seconds / own : 0;
    result->seconds_deform = seconds - result->seconds_embed;
}

/* What has become of the vertices outside. */
static void tell_outside(const pass_totals *totals, const chain_outside *outside, bool deformed, char *text,
                         size_t capacity)
{
    static const char moved[] = "moved with the nearest boundary point", stay[] = "left where they are";
    const uint64_t count = totals->counts[FFD_OUTSIDE], kept = count - totals->extended;
    const char *why = outside->extend && outside->falloff > 0 ? " beyond the falloff" : "";
    if (!deformed)
        snprintf(text, capacity, "%" PRIu64 " outside (no u,v,w)", count);
    else if (kept == 0)
        snprintf(text, capacity, "%" PRIu64 " outside (%s)", count, moved);
    else if (totals->extended == 0)
        snprintf(text, capacity, "%" PRIu64 " outside (%s%s)", count, stay, why);
    else
        snprintf(text, capacity, "%" PRIu64 " outside (%" PRIu64 " %s, %" PRIu64 " %s%s)", count,
                 totals->extended, moved, kept, stay, why);
}

void ffd_result_warn(const pass_totals *totals, const lattice_chain *chain, bool deformed,
                     const mesh_log *log)
{
    static const char *const names[] = {"inside", "outside", "multiple", "singular", "invalid"};
    const uint64_t others = totals->vertices - totals->counts[FFD_INSIDE];
    if (others) {
        char list[400] = "", coverage[600] = "";
        if (totals->counts[FFD_OUTSIDE])
            tell_outside(totals, &chain->outside, deformed, list, sizeof list);
        for (int s = FFD_OUTSIDE + 1; s < FFD_VERTEX_STATUS_COUNT; s++)
            if (totals->counts[s]) {
                const size_t length = strlen(list);
                snprintf(list + length, sizeof list - length, "%s%" PRIu64 " %s", length ? ", " : "",
                         totals->counts[s], names[s]);
            }
        if (totals->outside_any)
            ffd_chain_coverage(chain, coverage, sizeof coverage);
        ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " of %" PRIu64 " vertices are not inside: %s%s%s",
                     others, totals->vertices, list, *coverage ? "; " : "", coverage);
    }
    if (totals->shapes_outside)
        ffd_log_line(log, FFD_LOG_WARNING, "morph targets move %" PRIu64 " vertices outside the lattice (%s)",
                     totals->shapes_outside,
                     chain->outside.extend ? "moved with the nearest boundary point" : "left where they are");
    if (totals->unresolved)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "for %" PRIu64
                     " vertices the search ended at its limits: the lattice folds or collapses there",
                     totals->unresolved);
    if (totals->transforms_singular)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " vertices do not move: the matrix of their node or skin has no inverse",
                     totals->transforms_singular);
    if (totals->normals_carried)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " normals have no face with an area to be computed from: they follow the "
                     "deformation",
                     totals->normals_carried);
    if (totals->normals_collapsed)
        ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " normals are kept: the deformation collapses them",
                     totals->normals_collapsed);
}
