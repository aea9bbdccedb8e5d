#include "job/deform_job.h"
#include "base/file/mapping.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/system/clock.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/vector/isa.h"
#include "job/chain/chain_load.h"
#include "job/chain/job_cache.h"
#include "job/chain/lattice_memory.h"
#include "job/chain/overlaps.h"
#include "job/chain/seals.h"
#include "job/deform_passes.h"
#include "job/figures/figure_values.h"
#include "job/input/deform_desc.h"
#include "job/input/selection.h"
#include "job/input/source.h"
#include "job/job_fit.h"
#include "job/judge/gates.h"
#include "job/judge/warnings.h"
#include "job/measure/behind.h"
#include "job/measure/cells.h"
#include "job/measure/figures.h"
#include "job/measure/rig.h"
#include "job/measure/symmetry.h"
#include "job/measure/tear_figures.h"
#include "job/pass/pass.h"
#include "job/reads.h"
#include "job/report/output_set.h"
#include "job/rigid_motions.h"
#include "lattice/file/lattice_source.h"
#include "mesh/places.h"
#include <string.h>

/* Refuses to read what the run has written. */
static ffd_status check_unwritten(const ffd_deform_desc *desc, const char *path, ffd_error *error)
{
    return desc->output_set && ffd_written_holds(&desc->output_set->files, path)
               ? ffd_fail_file(error, FFD_E_EXISTS, path,
                               "was written by this run already, under this name or another")
               : FFD_OK;
}

static ffd_status check_embedding(const ffd_deform_desc *desc, ffd_error *error)
{
    const char *embedding = desc->embedding.path;
    if (!embedding || desc->embedding.bytes.data)
        return FFD_OK;
    if (strcmp(embedding, "-") == 0 &&
        (strcmp(desc->input.path, "-") == 0 || ffd_lattice_is_stream(&desc->lattices[0])))
        return ffd_fail(error, FFD_E_ARGUMENT, "standard input can be read only once");
    return check_unwritten(desc, embedding, error);
}

static bool is_complete(const ffd_deform_desc *desc)
{
    const ffd_source *const input = &desc->input;
    return input->path && (desc->lattices || desc->lattice_count == 0) &&
           ffd_desc_has_texts(desc->only, desc->only_count) &&
           ffd_desc_has_texts(desc->rigid, desc->rigid_count) &&
           ffd_desc_has_texts(desc->uniform, desc->uniform_count) &&
           ffd_desc_has_texts(desc->clips, desc->clip_count) &&
           ffd_desc_has_texts(input->allow_extensions, input->allow_extension_count) &&
           (!desc->morphs || ffd_desc_has_texts(desc->morphs, desc->lattice_count)) &&
           ffd_desc_has_settings(desc->set, desc->set_count);
}

static ffd_status check_desc(const ffd_deform_desc *desc, ffd_error *error)
{
    if (!is_complete(desc))
        return ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete");
    if (!ffd_isa_available(desc->isa))
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "{isa}: this build or this processor does not support the instruction set %s",
                        ffd_isa_name(desc->isa));
    if (ffd_job_weight_file(desc))
        TRY(check_unwritten(desc, ffd_job_weight_file(desc), error));
    return check_embedding(desc, error);
}

ffd_status ffd_deform_job_begin(deform_job *job, const ffd_deform_desc *desc, bool check,
                                ffd_job_result *result)
{
    const mesh_log log = {desc->log, desc->log_user};
    ffd_result_clear(result);
    *job = (deform_job){
        .desc = desc, .check = check, .losses = ffd_mapping_losses(), .log = log, .file_log = log};
    TRY(check_desc(desc, &result->error));
    return ffd_threads_check(desc->threads, &result->error);
}

ffd_status ffd_deform_job_refuse_morphs(const ffd_deform_desc *desc, ffd_error *error)
{
    return desc->morphs ? ffd_fail(error, FFD_E_ARGUMENT,
                                   "morphs: only ffd_deform_run and ffd_view_run support several targets")
                        : FFD_OK;
}

/* Returns the number of threads of the job. A plain job on a part of few vertices is done by one; figures of
   the lattice and of faces may take long for any mesh. */
static int choose_threads(const deform_job *job)
{
    const bool measures = ffd_figures_wanted(job) || job->desc->fail_on;
    const uint64_t pieces = ffd_mesh_vertex_count(job->document) / MESH_RANGE_STEP + 1;
    return ffd_threads_for(job->desc->threads, measures ? UINT64_MAX : pieces);
}

static ffd_status open_mesh(deform_job *job, bool only_positions, ffd_error *error)
{
    const ffd_deform_desc *desc = job->desc;
    ffd_source source = desc->input;
    source.only_positions = only_positions;
    file_stamp stamp;
    file_input bytes;
    const bool is_file =
        ffd_job_cache_holds_meshes(desc->cache) && !source.bytes.data && ffd_file_stamp(source.path, &stamp);
    TRY(is_file && ffd_job_cache_take_bytes(desc->cache, source.path, &stamp, &bytes)
            ? ffd_source_open_bytes(&source, desc->threads, &bytes, &job->document, error)
            : ffd_source_open(&source, desc->threads, &job->document, error));
    TRY(ffd_selection_apply(desc->only, desc->only_count, ffd_source_name(&desc->input), job->document,
                            error));
    ffd_job_cache_describe_mesh(desc->cache, desc, only_positions, is_file ? &stamp : NULL, job->document);
    return FFD_OK;
}

ffd_status ffd_deform_job_load_chain(deform_job *job, unsigned needs, const chain_outside *outside,
                                     ffd_job_cache *cache, ffd_error *error)
{
    const ffd_deform_desc *const desc = job->desc;
    const chain_files files = {.lattices = desc->lattices,
                               .count = desc->lattice_count,
                               .set = desc->set,
                               .set_count = desc->set_count,
                               .time = desc->has_time ? &desc->time : NULL,
                               .made = job->animation ? job->animation->lattices : NULL,
                               .mesh = &desc->input,
                               .derives = needs & JOB_NEEDS_DERIVATIVES,
                               .shared = desc->shared_box,
                               .log = &job->log};
    const ffd_status status = ffd_chain_load(&files, outside, desc->isa, cache, &job->chain, error);
    job->chain.blocks = desc->blocks && desc->lattice_count > 1;
    return status;
}

ffd_status ffd_deform_job_open(deform_job *job, unsigned needs, ffd_job_result *result, ffd_error *error)
{
    const ffd_deform_desc *desc = job->desc;
    const chain_outside outside = {desc->outside == FFD_OUTSIDE_EXTEND, desc->falloff, desc->snap,
                                   desc->snap_relative};
    const chain_seal seal = {.layers = (int)desc->seam, .faces = desc->seam_faces};
    const bool only_positions = !(needs & JOB_NEEDS_NORMALS);
    const double start = ffd_clock_seconds();
    if (!desc->input.bytes.data)
        TRY(check_unwritten(desc, desc->input.path, error));
    ffd_status status;
    TRY_END(ffd_deform_job_load_chain(job, needs, &outside, desc->cache, error));
    TRY_END(ffd_seals_begin(&job->chain, &seal, error));
    job->document = ffd_job_cache_take_mesh(desc->cache, desc, only_positions);
    job->document_is_cached = job->document;
    if (!job->document)
        TRY_END(open_mesh(job, only_positions, error));
    job->threads = choose_threads(job);
    if (desc->rig == FFD_RIG_FOLLOW && !job->document->format->places)
        TRY_END(ffd_fail_file(error, FFD_E_ARGUMENT, ffd_source_name(&desc->input),
                              "has no nodes that could follow: only glTF has ({rig=follow})"));
    ffd_result_note_flaws(result, &job->document->flaws);
    ffd_deadline_done(JOB_IS_OPEN);
    TRY_END(ffd_deadline_check(error));
end:
    /* A mesh that cannot be read gets no box. */
    for (size_t l = 0; l < job->chain.count && job->document; l++)
        result->own_box = result->own_box || !job->chain.links[l].locator;
    result->seconds.read = ffd_clock_seconds() - start;
    return status;
}

static bool has_normals(const mesh_document *document)
{
    for (size_t i = 0; i < document->part_count; i++)
        if (document->parts[i].normal_count)
            return true;
    return false;
}

/* A gate that depends on faces fails if some faces are unknown. */
static ffd_status check_unknown(const deform_job *job, ffd_error *error)
{
    const size_t unknown = job->document->unknown_drawings;
    if (unknown == 0 || !(job->desc->fail_on & (FFD_GATE_TEAR | FFD_GATE_FLIPPED | FFD_GATE_EDGES)))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_GATE, ffd_source_name(&job->desc->input),
                         "{fail_on} tear, flipped and edges cannot be judged: the faces of %zu %s not known",
                         unknown, unknown == 1 ? "primitive are" : "primitives are");
}

/* Allocates the positions that the caller wants. */
static ffd_status prepare_positions(deform_job *job, memory_budget *budget, ffd_error *error)
{
    const uint64_t count = ffd_mesh_vertex_count(job->document);
    const size_t bytes = 3 * sizeof *job->positions;
    if (!job->desc->positions)
        return FFD_OK;
    TRY(ffd_budget_take(budget, count, bytes, error));
    job->positions = ffd_alloc((size_t)count, bytes);
    return job->positions ? FFD_OK : ffd_fail_memory(error);
}

/* Reads the faces at rest, and allocates the arrays of the figures and of recomputed normals: in stored, if
   the normals are those of another shape than the figures. */
static ffd_status prepare_arrays(deform_job *job, figure_arrays *arrays, figure_arrays *stored,
                                 ffd_error *error)
{
    const bool both = ffd_job_judged(job) != ffd_job_written(job);
    if (ffd_figures_count_flipped(job) || (job->recomputes && !both))
        TRY(ffd_figures_prepare(job, ffd_job_judged(job), arrays, error));
    if (!job->recomputes || !both)
        return FFD_OK;
    stored->budget = arrays->budget;
    const ffd_status status = ffd_figures_prepare(job, MESH_STORED, stored, error);
    arrays->budget = stored->budget;
    return status;
}

ffd_status ffd_deform_job_load_weights(deform_job *job, ffd_error *error)
{
    const ffd_deform_desc *const desc = job->desc;
    return !desc->weight.source || job->weights.values
               ? FFD_OK
               : ffd_vertex_weights_load(&desc->weight, job->document, ffd_source_name(&desc->input),
                                         job->threads, &job->file_log, &job->weights, error);
}

/* Whether some part has normals that turn, or splats. */
static bool turns_directions(const deform_job *job)
{
    const bool turns = job->desc->normals != FFD_NORMALS_KEEP;
    for (size_t i = 0; i < job->document->part_count; i++) {
        const mesh_part *const part = &job->document->parts[i];
        if (part->has_ellipsoids || (turns && (part->normal_count || part->has_tangents)))
            return true;
    }
    return false;
}

/* Finds how the weights change along the surface in the states whose gradients are wanted, and where they
   tear what is judged. */
static ffd_status survey_weights(deform_job *job, figure_arrays *arrays, ffd_error *error)
{
    const bool of_figures = ffd_figures_wanted(job) || arrays->has_faces;
    const mesh_state judged = ffd_job_judged(job), written = ffd_job_written(job);
    for (int state = MESH_STORED; state <= MESH_SHOWN && job->weights.values; state++) {
        const bool is_wanted = ((mesh_state)state == written && turns_directions(job)) ||
                               ((mesh_state)state == judged && of_figures);
        const mesh_faces *const faces =
            (mesh_state)state == judged && arrays->has_faces ? &arrays->faces : NULL;
        if (is_wanted)
            TRY(ffd_vertex_weights_find_slopes(&job->weights, job->document, (mesh_state)state,
                                               (mesh_state)state == judged, faces, job->threads,
                                               job->chain.isa, &arrays->budget, &job->file_log, error));
    }
    return job->weights.values && ffd_tear_figures_count_splits(job)
               ? ffd_vertex_weights_find_splits(&job->weights, job->document, judged, job->threads,
                                                &arrays->budget, error)
               : FFD_OK;
}

/* Refuses what can be refused before vertices are processed, and allocates the results. */
static ffd_status prepare(deform_job *job, figure_arrays *arrays, figure_arrays *stored, ffd_error *error)
{
    TRY(ffd_mesh_check(job->document, error));
    TRY(ffd_cell_gates_check(job, error));
    if (!job->details)
        TRY(check_unknown(job, error));
    TRY(ffd_mesh_warn(job->document, &job->file_log, error));
    TRY(ffd_deform_job_load_weights(job, error));
    TRY(ffd_rigid_pieces_load(job, error));
    job->recomputes = job->desc->normals == FFD_NORMALS_RECOMPUTE && has_normals(job->document);
    const mesh_results results = {.state = ffd_job_written(job),
                                  .directions = job->desc->normals != FFD_NORMALS_KEEP,
                                  .converted = job->converts,
                                  .replace = !ffd_job_cache_holds_meshes(job->desc->cache) &&
                                             !ffd_figures_count_flipped(job) && !job->recomputes &&
                                             !job->desc->morphs};
    TRY(job->document->format->begin_results(job->document, &results, error));
    if (job->desc->normals == FFD_NORMALS_RECOMPUTE && !job->recomputes && !job->document->has_face_normals)
        ffd_log_line(&job->file_log, FFD_LOG_WARNING, "has no normals to recompute");
    arrays->budget = job->document->budget;
    TRY(ffd_lattice_memory_share(&job->chain, &arrays->budget, error));
    TRY(prepare_arrays(job, arrays, stored, error));
    TRY(survey_weights(job, arrays, error));
    if (job->details)
        TRY(ffd_details_begin(job->details, (size_t)ffd_mesh_vertex_count(job->document), &arrays->budget,
                              error));
    TRY(prepare_positions(job, &arrays->budget, error));
    job->threads =
        ffd_pass_threads(&arrays->budget, job->check ? ffd_chain_layers(&job->chain) : 0, job->threads);
    return FFD_OK;
}

/* Whether nodes and other places matter: conversions and arrays of positions do not contain them. */
static bool has_rig(const deform_job *job)
{
    return (job->check || ffd_deform_desc_writes(job->desc)) && (!job->converts || job->details);
}

/* Finds how the lattices move the document's places (nodes, joints, sockets), and with --rig follow moves
   them. */
static ffd_status move_rig(deform_job *job, ffd_error *error)
{
    const bool follows = job->desc->rig == FFD_RIG_FOLLOW;
    const mesh_format *const format = job->document->format;
    if (!has_rig(job))
        return FFD_OK;
    TRY(ffd_rig_places_find(job->document, &job->chain, follows, &job->rig, error));
    TRY(ffd_rigid_move_places(job, error));
    return !follows || job->rig.places.count == 0
               ? FFD_OK
               : format->places->follow(job->document, &job->rig.places, job->rig.moves, &job->log,
                                        &job->following, error);
}

/* Finds what is left behind, and how far joints, pivots and sockets lag. */
static ffd_status find_left(deform_job *job, ffd_job_result *result, ffd_error *error)
{
    TRY(ffd_behind_find(job, result, error));
    return ffd_rig_figures_find(job->document, &job->rig, &job->following,
                                job->desc->as_morph ? RIG_KINDS_OF_MORPHS : RIG_KINDS,
                                ffd_rig_diagonal(&result->bounds.before), &result->rig, error);
}

static void warn_of_left(const deform_job *job, const ffd_job_result *result)
{
    const double diagonal = ffd_rig_diagonal(&result->bounds.before);
    ffd_behind_warn(result, job->desc->rig, &job->log);
    if (job->totals.moved > 0)
        ffd_rig_warn(&result->rig,
                     job->desc->as_morph                ? RIG_MORPHED
                     : job->desc->rig == FFD_RIG_FOLLOW ? RIG_FOLLOWED
                                                        : RIG_KEPT,
                     diagonal, &job->log);
}

/* Computes the figures that take extra time, then applies the gates to all figures. */
static ffd_status judge(deform_job *job, figure_arrays *arrays, ffd_job_result *result, ffd_error *error)
{
    const ffd_deform_desc *desc = job->desc;
    const char *name = ffd_source_name(&desc->input);
    const double start = ffd_clock_seconds();
    ffd_status status;
    TRY_END(ffd_policies_judge(desc, name, &job->chain, &job->totals, error));
    if (ffd_figures_wanted(job) || desc->fail_on & FFD_GATE_FOLDS)
        TRY_END(ffd_figures_folds(&job->chain, job->threads, result, error));
    TRY_END(ffd_deadline_check(error));
    TRY_END(ffd_tear_figures_find(job, arrays, result, error));
    TRY_END(ffd_deadline_check(error));
    if (ffd_figures_count_flipped(job))
        TRY_END(ffd_figures_faces(job, arrays, result, error));
    TRY_END(ffd_cell_figures_find(job, result, error));
    if (job->details) /* check late, so that the picture can be drawn all the same */
        TRY_END(check_unknown(job, error));
    TRY_END(ffd_gates_judge(desc, name, &job->totals, result, error));
end:
    result->seconds.judge = ffd_clock_seconds() - start;
    return status;
}

/* Hands over the arrays of the figures; their memory stays charged to the budget. */
static void keep_arrays(figure_arrays *arrays, job_details *details, memory_budget *budget)
{
    if (arrays->budget.taken > budget->taken)
        budget->taken = arrays->budget.taken;
    details->has_faces = arrays->has_faces;
    details->faces = arrays->faces;
    details->deformed = arrays->deformed;
    details->gradients = arrays->gradients;
    details->collapsed = arrays->collapsed;
    *arrays = (figure_arrays){0};
}

/* Passes the positions to the caller's callback. */
static ffd_status give_positions(deform_job *job, ffd_error *error)
{
    const ffd_deform_desc *const desc = job->desc;
    if (!job->positions)
        return FFD_OK;
    const ffd_status status = ffd_status_known(
        desc->positions(desc->positions_user, job->positions, (size_t)ffd_mesh_vertex_count(job->document)));
    return status ? ffd_fail_file(error, status, ffd_source_name(&desc->input),
                                  "the callback for positions did not take them")
                  : FFD_OK;
}

/* Whether a word is needed if nothing moves: a check prints how many vertices move. */
static bool warns_if_still(const deform_job *job)
{
    return !job->check || job->details;
}

/* From the open mesh to figures that are judged. stored is freed as soon as it is not needed. */
static ffd_status pass_and_judge(deform_job *job, figure_arrays *arrays, figure_arrays *stored,
                                 ffd_job_result *result, ffd_error *error)
{
    const double start = ffd_clock_seconds();
    const ffd_status ready = prepare(job, arrays, stored, error);
    const double prepared = ffd_clock_seconds();
    result->seconds.read += prepared - start;
    TRY(ready);
    TRY(ffd_deadline_check(error));
    TRY(ffd_job_fit(job, error));
    ffd_job_note_seam(job, result);
    TRY(ffd_symmetry_warn(job, error));
    TRY(ffd_tear_figures_prepare(job, arrays, error));
    TRY(ffd_rigid_motions_find(job, result, error));
    TRY(move_rig(job, error));
    if (has_rig(job) && !job->animation)
        TRY(ffd_turned_parts_find(job->document, &job->turned, error));
    const ffd_status passed = ffd_deform_passes(job, arrays, stored, error);
    ffd_figures_free(stored);
    TRY(passed);
    ffd_deadline_done(JOB_HAS_PASSED);
    ffd_result_fill(result, &job->totals, ffd_clock_seconds() - prepared);
    result->weight = job->weights.figures;
    TRY(find_left(job, result, error));
    TRY(judge(job, arrays, result, error));
    ffd_deadline_done(JOB_IS_JUDGED);
    return ffd_deadline_check(error);
}

/* Says what the figures of a job that has passed mean for its user. */
static ffd_status warn(const deform_job *job, const ffd_job_result *result, ffd_error *error)
{
    bool falls_short;
    ffd_flaws_warn(&job->document->flaws, NULL, &job->file_log);
    TRY(ffd_overlaps_warn(&job->chain, &job->log, error));
    ffd_result_warn(&job->totals, &job->chain, true, &job->log);
    TRY(ffd_places_warn(&job->chain, &job->log, &falls_short, error));
    if (warns_if_still(job) && !(falls_short && job->totals.moved == 0))
        ffd_still_warn(&job->totals, &job->chain, &job->weights.figures, &result->bounds.before,
                       job->desc->as_morph != NULL, !job->check, &job->log);
    warn_of_left(job, result);
    TRY(ffd_turned_parts_warn(job->document, &job->turned, &job->log, error));
    ffd_rigid_warn(job, result);
    if (job->totals.vertices == 0)
        ffd_log_line(&job->file_log, FFD_LOG_WARNING, "%s",
                     job->desc->only_count ? SPELLED("{only} selects no vertices")
                                           : "there are no vertices to deform");
    ffd_collapse_warn(&job->totals, &job->log);
    if (!job->check) {
        ffd_folds_warn(result, &job->totals, job->desc->lattices, &job->log);
        ffd_tears_warn(result, job->desc->only_count > 0, &job->log);
        ffd_cells_warn(result, &job->log);
    }
    return FFD_OK;
}

static void forget_locations(deform_job *job)
{
    ffd_free(job->locations);
    job->locations = NULL;
    job->is_located = false;
}

ffd_status ffd_deform_job_run(deform_job *job, ffd_job_result *result, ffd_error *error)
{
    figure_arrays arrays = {0}, stored = {0};
    ffd_status status;
    TRY_END(ffd_mapping_judge(job->losses, pass_and_judge(job, &arrays, &stored, result, error), error));
    TRY_END(warn(job, result, error));
    TRY_END(give_positions(job, error));
end:
    if (job->details)
        keep_arrays(&arrays, job->details, &job->document->budget);
    ffd_figures_free(&stored);
    ffd_figures_free(&arrays);
    ffd_rig_places_free(&job->rig);
    ffd_turned_parts_free(&job->turned);
    ffd_free(job->kept);
    ffd_free(job->positions);
    forget_locations(job);
    job->kept = NULL;
    job->positions = NULL;
    return status;
}

ffd_status ffd_deform_job_end(deform_job *job, ffd_status status, ffd_job_result *result, ffd_error *error)
{
    /* A job that has written an output was judged before that: later changes to its inputs do not matter. */
    if (status)
        status = ffd_mapping_judge(job->losses, status, &result->error);
    result->status = status;
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(&result->error, ffd_source_name(&job->desc->input));
    ffd_embedding_close(&job->embedding);
    ffd_vertex_weights_free(&job->weights);
    ffd_rigid_parts_free(&job->rigid);
    forget_locations(job);
    ffd_model_free(&job->base);
    if (!status)
        ffd_job_cache_put_mesh(job->desc->cache, job->desc, job->document);
    else
        ffd_source_close(&job->document);
    ffd_job_cache_put_chain(job->desc->cache, &job->chain);
    ffd_chain_free(&job->chain);
    if (status && error)
        *error = result->error;
    return status;
}
