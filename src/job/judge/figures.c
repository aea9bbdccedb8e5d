#include "job/judge/figures.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/openmesh/half_edges.h"
#include "job/figures/figure_values.h"
#include "job/input/selection.h"
#include "job/judge/edge_list.h"
#include "job/judge/extent.h"
#include "job/judge/quality.h"
#include "job/judge/quality_edges.h"
#include "job/pass/normal_groups.h"
#include <inttypes.h>
#include <stdio.h>

/* Memory of the arrays for each vertex, in bytes. */
#define ARRAY_BYTES (12 * sizeof(double))

/* Gates that need the faces. */
#define NEED_FACES (FFD_GATE_TEAR | FFD_GATE_FLIPPED | FFD_GATE_EDGES)

bool ffd_figures_wanted(const deform_job *job)
{
    return job->check || job->desc->quality || job->desc->fail_on & (FFD_GATE_FLIPPED | FFD_GATE_EDGES);
}

/* Checks that the budget suffices for recomputing normals. */
static ffd_status check_normals(const deform_job *job, const mesh_faces *faces, memory_budget budget,
                                ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < job->document->part_count && status == FFD_OK; i++)
        status = ffd_budget_take(&budget, job->document->parts[i].normal_count, NORMAL_BYTES, error);
    return status ? status : ffd_budget_check(&budget, ffd_half_edge_bytes(faces), 1, error);
}

static bool wants_edges(const deform_job *job)
{
    return job->check || job->desc->fail_on & FFD_GATE_EDGES;
}

/* Charges the memory for the figures of these faces, and checks that the rest suffices for recomputing
   normals, which happens earlier. */
static ffd_status take_memory(const deform_job *job, const mesh_faces *faces, memory_budget *budget,
                              ffd_error *error)
{
    const size_t corners = faces->start[faces->face_count];
    ffd_status status = ffd_budget_take(budget, ffd_mesh_vertex_count(job->document), ARRAY_BYTES, error);
    if (status == FFD_OK)
        status = ffd_mesh_faces_take(faces, corners, budget, error);
    if (status == FFD_OK && job->recomputes)
        status = check_normals(job, faces, *budget, error);
    if (status == FFD_OK && wants_edges(job))
        status = ffd_budget_take(budget, corners, EDGE_LIST_BYTES, error);
    return status;
}

static ffd_status read_faces(const deform_job *job, figure_arrays *arrays, ffd_error *error)
{
    ffd_error own;
    char line[1024];
    memory_budget budget = arrays->budget;
    ffd_status status = job->document->format->faces(job->document, &arrays->faces, &own);
    if (status == FFD_OK)
        status = take_memory(job, &arrays->faces, &budget, &own);
    arrays->has_faces = status == FFD_OK;
    if (!status) {
        arrays->budget = budget;
        return FFD_OK;
    }
    ffd_mesh_faces_free(&arrays->faces);
    if (job->check || job->recomputes || status == FFD_E_MEMORY || job->desc->fail_on & NEED_FACES) {
        if (error)
            *error = own;
        return status;
    }
    ffd_error_format(&own, line, sizeof line);
    ffd_log_line(&job->log, FFD_LOG_WARNING, "flipped faces are not counted: %s", line);
    return FFD_OK;
}

ffd_status ffd_figures_prepare(const deform_job *job, figure_arrays *arrays, ffd_error *error)
{
    const size_t count = (size_t)ffd_mesh_vertex_count(job->document);
    const ffd_status status = read_faces(job, arrays, error);
    if (status || !arrays->has_faces)
        return status;
    arrays->deformed = ffd_alloc(count, 3 * sizeof *arrays->deformed);
    arrays->gradients = ffd_alloc(count, 9 * sizeof *arrays->gradients);
    return arrays->deformed && arrays->gradients ? FFD_OK : ffd_fail_memory(error);
}

void ffd_figures_free(figure_arrays *arrays)
{
    ffd_mesh_faces_free(&arrays->faces);
    ffd_free(arrays->deformed);
    ffd_free(arrays->gradients);
    *arrays = (figure_arrays){0};
}

ffd_status ffd_figures_folds(lattice_chain *chain, int threads, ffd_job_result *result, ffd_error *error)
{
    for (size_t l = 0; l < chain->count; l++) {
        chain_link *const link = &chain->links[l];
        if (!link->has_folds) {
            link->folds.struct_size = sizeof link->folds;
            const ffd_status status = ffd_folds_find(link->lattice, threads, &link->folds, error);
            if (status)
                return status;
            link->has_folds = true;
        }
        ffd_folds_join(&link->folds, l, &result->folds);
    }
    return FFD_OK;
}

/* Measures area and volume, unless some faces are unknown. */
static void measure_extent(const deform_job *job, const figure_arrays *arrays, ffd_job_result *result)
{
    mesh_extent before, after;
    if (job->document->unknown_drawings || !(job->check || job->desc->quality))
        return;
    ffd_extent_measure(job->document, &arrays->faces, arrays->faces.positions, &before);
    ffd_extent_measure(job->document, &arrays->faces, arrays->deformed, &after);
    result->area.before = before.area;
    result->area.after = after.area;
    result->volume.before = before.volume;
    result->volume.after = after.volume;
}

ffd_status ffd_figures_faces(const deform_job *job, figure_arrays *arrays, ffd_job_result *result,
                             ffd_error *error)
{
    edge_quality edges;
    ffd_status status = FFD_OK;
    result->det.is_known = job->totals.det_min <= job->totals.det_max;
    result->det.min = job->totals.det_min;
    result->det.max = job->totals.det_max;
    if (!arrays->has_faces)
        return FFD_OK;
    measure_extent(job, arrays, result);
    if (!ffd_selection_is_all(job->document))
        status = ffd_selection_reduce(job->document, &arrays->faces, error);
    if (status)
        return status;
    result->has_flipped = true;
    result->faces = arrays->faces.face_count;
    result->flipped_faces = ffd_quality_flipped(&arrays->faces, arrays->deformed, arrays->gradients);
    if (!wants_edges(job))
        return FFD_OK;
    status = ffd_quality_edges(job->document, &arrays->faces, arrays->deformed, &job->chain, job->threads,
                               &edges, error);
    if (status)
        return status;
    result->edges.is_known = true;
    result->edges.count = edges.edges;
    result->edges.deviation.max = edges.deviation_max;
    result->edges.deviation.mean = edges.deviation_mean;
    return FFD_OK;
}

void ffd_figures_describe_folds(const ffd_deform_desc *desc, const ffd_job_result *result, char *text,
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
                 desc->lattices[result->folds.witness.lattice], xyz[0], xyz[1], xyz[2]);
}

/* Says how many faces are turned over, or if that is not known at how many vertices the mesh is inside out.
   text becomes "" if there are none. */
static void tell_turned(const deform_job *job, const ffd_job_result *result, char *text, size_t capacity)
{
    const pass_totals *const totals = &job->totals;
    *text = 0;
    if (result->has_flipped && result->flipped_faces)
        snprintf(text, capacity, "%" PRIu64 " of %" PRIu64 " %s turned over", result->flipped_faces,
                 result->faces, ffd_plural(result->faces, "face is", "faces are"));
    else if (totals->inverted)
        snprintf(text, capacity,
                 "the mesh turns inside out at %" PRIu64 " of %" PRIu64
                 " %s: det F falls to %g, at vertex %" PRIu64,
                 totals->inverted, totals->vertices, ffd_plural(totals->vertices, "vertex", "vertices"),
                 totals->det_inverted, totals->first_inverted);
}

void ffd_figures_warn(const deform_job *job, const ffd_job_result *result)
{
    char text[400], turned[200];
    tell_turned(job, result, turned, sizeof turned);
    if (result->folds.is_known && result->folds.verdict != FFD_FOLDS_NONE) {
        ffd_figures_describe_folds(job->desc, result, text, sizeof text);
        ffd_log_line(&job->log, FFD_LOG_WARNING, "the deformed volume %s%s%s", text, *turned ? "; " : "",
                     turned);
    } else if (*turned) {
        ffd_log_line(&job->log, FFD_LOG_WARNING, "%s", turned);
    }
    if (result->det.outside <= 0)
        ffd_log_line(&job->log, FFD_LOG_WARNING,
                     "outside the lattice det F falls to %g, at vertex %" PRIu64
                     ": the mesh turns inside out there (see --falloff, a larger lattice)",
                     result->det.outside, result->det.outside_vertex);
}
