#include "job/measure/figures.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/words.h"
#include "io/openmesh/half_edges.h"
#include "job/figures/figure_values.h"
#include "job/input/deform_desc.h"
#include "job/input/selection.h"
#include "job/measure/edge_list.h"
#include "job/measure/extent.h"
#include "job/measure/quality.h"
#include "job/measure/quality_edges.h"
#include "job/pass/normal_groups.h"
#include <inttypes.h>
#include <stdio.h>

/* Memory of the arrays for each vertex, in bytes. */
#define ARRAY_BYTES (12 * sizeof(double) + 1)

/* Of a mesh with more vertices only those with det F < 0 are counted unasked. To read its faces as well takes
   a tenth of a small job's time, and as long as to deform a large mesh. */
#define UNASKED_VERTICES 128
/* Nor are many faces of few vertices counted: some 50,000 triangles need more memory than this. */
#define UNASKED_FACE_BYTES ((uint64_t)1000000)

/* Gates that need the faces. */
#define NEED_FACES (FFD_GATE_TEAR | FFD_GATE_FLIPPED | FFD_GATE_EDGES)

bool ffd_figures_wanted(const deform_job *job)
{
    return job->check || job->desc->quality || job->desc->fail_on & (FFD_GATE_FLIPPED | FFD_GATE_EDGES);
}

/* Whether the job fails without its faces. */
static bool needs_faces(const deform_job *job)
{
    return job->check || job->recomputes || job->desc->fail_on & NEED_FACES;
}

bool ffd_figures_count_flipped(const deform_job *job)
{
    return ffd_figures_wanted(job) ||
           (ffd_deform_desc_writes(job->desc) && ffd_mesh_vertex_count(job->document) <= UNASKED_VERTICES);
}

/* Checks that the budget suffices for recomputing normals. */
static ffd_status check_normals(const deform_job *job, const mesh_faces *faces, memory_budget budget,
                                ffd_error *error)
{
    for (size_t i = 0; i < job->document->part_count; i++)
        TRY(ffd_budget_take(&budget, job->document->parts[i].normal_count, NORMAL_BYTES, error));
    return ffd_budget_check(&budget, ffd_half_edge_bytes(faces), 1, error);
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
    TRY(ffd_budget_take(budget, ffd_mesh_vertex_count(job->document), ARRAY_BYTES, error));
    TRY(ffd_mesh_faces_take(faces, corners, budget, error));
    if (job->recomputes)
        TRY(check_normals(job, faces, *budget, error));
    if (wants_edges(job))
        TRY(ffd_budget_take(budget, corners, EDGE_LIST_BYTES, error));
    return FFD_OK;
}

/* Makes the faces, within the small budget if only an unasked count needs them. */
static ffd_status make_faces(const deform_job *job, mesh_state state, mesh_faces *faces, ffd_error *error)
{
    mesh_document *const document = job->document;
    const memory_budget budget = document->budget;
    if (!ffd_figures_wanted(job) && !needs_faces(job))
        ffd_budget_keep(&document->budget, UNASKED_FACE_BYTES);
    const ffd_status status = document->format->faces(document, state, faces, error);
    document->budget = budget;
    return status;
}

static ffd_status read_faces(const deform_job *job, mesh_state state, figure_arrays *arrays, ffd_error *error)
{
    ffd_error own;
    char line[1024];
    memory_budget budget = arrays->budget;
    ffd_status status;
    TRY_END(make_faces(job, state, &arrays->faces, &own));
    TRY_END(take_memory(job, &arrays->faces, &budget, &own));
    arrays->has_faces = true;
    arrays->budget = budget;
    return FFD_OK;
end:
    ffd_mesh_faces_free(&arrays->faces);
    TRY(ffd_deadline_check(error));
    if (needs_faces(job) || status == FFD_E_MEMORY) {
        if (error)
            *error = own;
        return status;
    }
    if (!ffd_figures_wanted(job))
        return FFD_OK;
    ffd_error_format(&own, line, sizeof line);
    ffd_log_line(&job->log, FFD_LOG_WARNING, "flipped faces are not counted: %s", line);
    return FFD_OK;
}

ffd_status ffd_figures_prepare(const deform_job *job, mesh_state state, figure_arrays *arrays,
                               ffd_error *error)
{
    const size_t count = (size_t)ffd_mesh_vertex_count(job->document);
    TRY(read_faces(job, state, arrays, error));
    if (!arrays->has_faces)
        return FFD_OK;
    arrays->deformed = ffd_alloc(count, 3 * sizeof *arrays->deformed);
    arrays->gradients = ffd_alloc(count, 9 * sizeof *arrays->gradients);
    arrays->collapsed = ffd_alloc_zero(count, sizeof *arrays->collapsed);
    return arrays->deformed && arrays->gradients && arrays->collapsed ? FFD_OK : ffd_fail_memory(error);
}

void ffd_figures_free(figure_arrays *arrays)
{
    ffd_mesh_faces_free(&arrays->faces);
    ffd_free(arrays->deformed);
    ffd_free(arrays->gradients);
    ffd_free(arrays->collapsed);
    *arrays = (figure_arrays){0};
}

ffd_status ffd_figures_folds(lattice_chain *chain, int threads, ffd_job_result *result, ffd_error *error)
{
    for (size_t l = 0; l < chain->count; l++) {
        chain_link *const link = &chain->links[l];
        ffd_folds own = {.struct_size = sizeof own};
        if (link->sealed) { /* with other faces held in the next job */
            TRY(ffd_folds_find(link->sealed, threads, &own, error));
            ffd_folds_join(&own, l, &result->folds);
            continue;
        }
        if (!link->has_folds) {
            TRY(ffd_folds_find(link->lattice, threads, &own, error));
            link->folds = own;
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
    if (ffd_figures_wanted(job)) {
        result->det.is_known = job->totals.det_min <= job->totals.det_max;
        result->det.min = job->totals.det_min;
        result->det.max = job->totals.det_max;
    }
    if (!arrays->has_faces)
        return FFD_OK;
    measure_extent(job, arrays, result);
    if (!ffd_selection_is_all(job->document))
        TRY(ffd_selection_reduce(job->document, &arrays->faces, error));
    TRY(ffd_deadline_check(error));
    result->has_flipped = true;
    result->faces = arrays->faces.face_count;
    const face_motion motion = {arrays->faces.positions, arrays->deformed, arrays->gradients,
                                arrays->collapsed};
    result->flipped_faces = ffd_quality_flipped(&arrays->faces, &motion);
    TRY(ffd_deadline_check(error));
    if (!wants_edges(job))
        return FFD_OK;
    TRY(ffd_quality_edges(job->document, ffd_job_judged(job), &arrays->faces, arrays->deformed, &job->chain,
                          ffd_job_weights(job), ffd_job_rigid(job), job->threads, &edges, error));
    result->edges.is_known = true;
    result->edges.count = edges.edges;
    result->edges.deviation.max = edges.deviation_max;
    result->edges.deviation.mean = edges.deviation_mean;
    return FFD_OK;
}
