/* folds.c - says that the deformed volume folds or collapses, or turns faces over. */
#include "base/text/words.h"
#include "job/judge/warnings.h"
#include <inttypes.h>
#include <stdio.h>

void ffd_folds_describe(const ffd_job_result *result, const ffd_lattice_source *lattices, char *text,
                        size_t capacity)
{
    const ffd_folds *folds = &result->folds;
    const double *uvw = folds->witness.uvw, *xyz = folds->witness.xyz;
    const char *const cells = ffd_plural(folds->cells, "cell", "cells");
    if (folds->verdict != FFD_FOLDS_SOME)
        snprintf(text, capacity,
                 "is not proven to be free of folds in %" PRIu64 " of %" PRIu64 " %s (least det J %g)",
                 folds->unknown_cells, folds->cells, cells, folds->min_det);
    else if (!folds->witness.is_there)
        snprintf(text, capacity, "folds in %" PRIu64 " of %" PRIu64 " %s", folds->folded_cells, folds->cells,
                 cells);
    else
        snprintf(text, capacity,
                 "folds in %" PRIu64 " of %" PRIu64 " %s, as at u,v,w = %g %g %g of %.100s, x,y,z = %g %g %g",
                 folds->folded_cells, folds->cells, cells, uvw[0], uvw[1], uvw[2],
                 lattices[result->folds.witness.lattice].path, xyz[0], xyz[1], xyz[2]);
}

/* Says how many faces are turned over. text becomes "" if there are none, or it is not known. */
static void write_turned(const ffd_job_result *result, char *text, size_t capacity)
{
    *text = 0;
    if (result->has_flipped && result->flipped_faces)
        snprintf(text, capacity, "%" PRIu64 " of %" PRIu64 " %s turned over", result->flipped_faces,
                 result->faces, ffd_plural(result->faces, "face is", "faces are"));
}

/* Says at how many vertices the mesh is inside out. text becomes "" if there are none. */
static void write_inverted(const pass_totals *totals, char *text, size_t capacity)
{
    *text = 0;
    if (totals->inverted)
        snprintf(text, capacity,
                 "the mesh turns inside out at %" PRIu64 " of %" PRIu64
                 " %s: det F falls to %g, at vertex %" PRIu64,
                 totals->inverted, totals->vertices, ffd_plural(totals->vertices, "vertex", "vertices"),
                 totals->det_inverted, totals->first_inverted);
}

void ffd_folds_warn(const ffd_job_result *result, const pass_totals *totals,
                    const ffd_lattice_source *lattices, const mesh_log *log)
{
    char text[400], turned[200], inverted[200];
    write_turned(result, turned, sizeof turned);
    write_inverted(totals, inverted, sizeof inverted);
    if (result->folds.is_known && result->folds.verdict != FFD_FOLDS_NONE) {
        const char *const more = *turned ? turned : inverted;
        ffd_folds_describe(result, lattices, text, sizeof text);
        ffd_log_line(log, FFD_LOG_WARNING, "the deformed volume %s%s%s", text, *more ? "; " : "", more);
    } else {
        /* Where the proof is known, it says more than det F at vertices. */
        if (*inverted && !(result->folds.is_known && *turned))
            ffd_log_line(log, FFD_LOG_WARNING, "%s", inverted);
        if (*turned)
            ffd_log_line(log, FFD_LOG_WARNING, "%s", turned);
    }
    if (result->det.outside <= 0)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "outside the lattice det F falls to %g, at vertex %" PRIu64
                     ": the mesh %s there (see {falloff}, a larger lattice)",
                     result->det.outside, result->det.outside_vertex,
                     result->det.outside < 0 ? "turns inside out" : "collapses");
}

void ffd_collapse_warn(const pass_totals *totals, const mesh_log *log)
{
    if (totals->collapsed)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "the mesh collapses at %" PRIu64 " of %" PRIu64
                     " %s: det F is 0 within rounding, first at vertex %" PRIu64,
                     totals->collapsed, totals->vertices, ffd_plural(totals->vertices, "vertex", "vertices"),
                     totals->first_collapsed);
}
