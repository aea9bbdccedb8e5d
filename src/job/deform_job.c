#include "job/deform_job.h"
#include "base/system/clock.h"
#include "base/system/thread.h"
#include "base/vector/isa.h"
#include "job/chain/chain_load.h"
#include "job/chain/job_cache.h"
#include "job/input/selection.h"
#include "job/input/source.h"
#include "job/judge/figures.h"
#include "job/judge/gates.h"
#include "job/judge/result.h"
#include "job/pass/chain_fit.h"
#include "job/pass/pass.h"
#include "job/pass/recompute.h"
#include "job/report/output_set.h"
#include <math.h>
#include <string.h>

static ffd_status check_embedding(const ffd_deform_desc *desc, ffd_error *error)
{
    const char *embedding = desc->embedding;
    if (!embedding)
        return FFD_OK;
    if (desc->lattice_count != 1)
        return ffd_fail(error, FFD_E_ARGUMENT, "an embedding belongs to one lattice, not to %zu",
                        desc->lattice_count);
    if (strcmp(embedding, "-") == 0 &&
        (strcmp(desc->input.path, "-") == 0 || strcmp(desc->lattices[0], "-") == 0))
        return ffd_fail(error, FFD_E_ARGUMENT, "standard input can be read only once");
    if (desc->written && ffd_written_holds(&desc->written->files, embedding))
        return ffd_fail_file(error, FFD_E_EXISTS, embedding,
                             "was written by this run already, under this name or another");
    return FFD_OK;
}

static ffd_status check_desc(const ffd_deform_desc *desc, ffd_error *error)
{
    if (desc->struct_size != sizeof *desc || !desc->input.path || (desc->lattice_count && !desc->lattices) ||
        (desc->only_count && !desc->only))
        return ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete");
    if (!(desc->falloff >= 0 && isfinite(desc->falloff)))
        return ffd_fail(error, FFD_E_ARGUMENT, "the falloff %g is not a length", desc->falloff);
    if (desc->falloff > 0 && desc->outside != FFD_OUTSIDE_EXTEND)
        return ffd_fail(error, FFD_E_ARGUMENT, "--falloff needs --outside extend");
    if (!ffd_isa_available(desc->isa))
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "this build or this processor does not support the instruction set %s",
                        ffd_isa_name(desc->isa));
    return check_embedding(desc, error);
}

ffd_status ffd_deform_job_begin(deform_job *job, const ffd_deform_desc *desc, bool check,
                                ffd_job_result *result)
{
    ffd_result_clear(result);
    *job = (deform_job){.desc = desc, .check = check};
    const ffd_status status = check_desc(desc, &result->error);
    if (status)
        return status;
    job->threads = desc->threads > 0 ? desc->threads : ffd_processor_count();
    job->log = (mesh_log){desc->log, desc->log_user};
    return FFD_OK;
}

static ffd_status open_mesh(deform_job *job, ffd_error *error)
{
    const ffd_deform_desc *desc = job->desc;
    ffd_source source = desc->input;
    source.only_positions = job->only_positions;
    file_stamp stamp;
    const bool is_file = ffd_cache_holds_meshes(desc->share) && ffd_file_stamp(source.path, &stamp);
    ffd_status status = ffd_source_open(&source, job->threads, &job->document, error);
    if (!status)
        status = ffd_selection_apply(desc, ffd_source_name(&desc->input), job->document, error);
    if (!status)
        ffd_cache_describe_mesh(desc->share, desc, job->only_positions, is_file ? &stamp : NULL,
                                job->document);
    return status;
}

ffd_status ffd_deform_job_open(deform_job *job, ffd_job_result *result, ffd_error *error)
{
    const ffd_deform_desc *desc = job->desc;
    const chain_files files = {desc->lattices, desc->lattice_count, desc->set, desc->set_count};
    const chain_outside outside = {desc->outside == FFD_OUTSIDE_EXTEND, desc->falloff};
    const double start = ffd_clock_seconds();
    if (desc->written && ffd_written_holds(&desc->written->files, desc->input.path))
        return ffd_fail_file(error, FFD_E_EXISTS, desc->input.path,
                             "was written by this run already, under this name or another");
    ffd_status status = ffd_chain_load(&files, &outside, desc->isa, desc->share, &job->chain, error);
    if (!status)
        job->document = ffd_cache_take_mesh(desc->share, desc, job->only_positions);
    job->document_is_shared = job->document;
    if (!status && !job->document)
        status = open_mesh(job, error);
    result->seconds_read = ffd_clock_seconds() - start;
    return status;
}

static bool has_normals(const mesh_document *document)
{
    for (size_t i = 0; i < document->part_count; i++)
        if (document->parts[i].normal_count)
            return true;
    return false;
}

static bool wants_figures(const deform_job *job)
{
    return job->check || job->desc->quality;
}

/* What can be refused before a vertex is touched, and memory for the results. */
static ffd_status prepare(deform_job *job, figure_arrays *arrays, ffd_error *error)
{
    const bool attributes = job->desc->normals != FFD_NORMALS_KEEP;
    const mesh_format *format = job->document->format;
    ffd_status status = ffd_mesh_check(job->document, error);
    job->recomputes = job->desc->normals == FFD_NORMALS_RECOMPUTE && has_normals(job->document);
    job->document->results_replace =
        !ffd_cache_holds_meshes(job->desc->share) && !wants_figures(job) && !job->recomputes;
    if (!status)
        status = format->begin_results(job->document, attributes, attributes, error);
    if (job->desc->normals == FFD_NORMALS_RECOMPUTE && !job->recomputes && !format->normals_of_faces)
        ffd_log_line(&job->log, FFD_LOG_WARNING, "has no normals to recompute");
    arrays->budget = job->document->budget;
    if (!status && (wants_figures(job) || job->recomputes))
        status = ffd_figures_prepare(job, arrays, error);
    job->threads = ffd_pass_threads(&arrays->budget, job->check ? job->chain.count : 0, job->threads);
    return status;
}

static ffd_status locate(deform_job *job, ffd_error *error)
{
    const char *embedding = job->desc->embedding;
    const ffd_status status = ffd_chain_fit(&job->chain, job->document, job->threads, error);
    if (status || !embedding)
        return status;
    return ffd_embedding_reuse(embedding, job->document, job->chain.links[0].lattice, job->threads,
                               &job->embedding, error);
}

static ffd_status deform(deform_job *job, const figure_arrays *arrays, ffd_error *error)
{
    ffd_share *const share = job->chain.count == 1 && !job->desc->embedding ? job->desc->share : NULL;
    bool is_located;
    ffd_location *const locations = ffd_cache_locations(share, job->document, job->document_is_shared,
                                                        &job->chain.links[0].rest, &is_located);
    const mesh_pass pass = {.document = job->document,
                            .chain = &job->chain,
                            .links = job->chain.count,
                            .threads = job->threads,
                            .locations = locations,
                            .is_located = is_located,
                            .embedding = job->desc->embedding ? &job->embedding : NULL,
                            .write = true,
                            .attributes = job->desc->normals != FFD_NORMALS_KEEP,
                            .only_offsets = job->desc->normals == FFD_NORMALS_RECOMPUTE,
                            .deformed = arrays->deformed,
                            .gradients = arrays->gradients,
                            .determinants = wants_figures(job)};
    recompute_counts counts = {0};
    ffd_status status = ffd_pass_run(&pass, &job->totals, error);
    if (!status)
        ffd_cache_locations_filled(share);
    if (!status && job->recomputes && job->totals.moved)
        status = ffd_recompute_normals(job->document, &arrays->faces, arrays->deformed, arrays->gradients,
                                       &counts, error);
    job->totals.normals_collapsed += counts.collapsed;
    job->totals.normals_carried = counts.carried;
    return status;
}

/* The figures that cost time of their own, and what the gates say of them all. */
static ffd_status judge(deform_job *job, figure_arrays *arrays, ffd_job_result *result, ffd_error *error)
{
    const ffd_deform_desc *desc = job->desc;
    const char *name = ffd_source_name(&desc->input);
    const double start = ffd_clock_seconds();
    ffd_status status = ffd_policies_judge(desc, name, job->check, &job->chain, &job->totals, error);
    if (!status && (wants_figures(job) || desc->fail_on & FFD_GATE_FOLDS))
        status = ffd_figures_folds(&job->chain, job->threads, result, error);
    if (!status && wants_figures(job))
        status = ffd_figures_faces(job, arrays, result, error);
    if (!status)
        status = ffd_gates_judge(desc, name, &job->totals, result, error);
    result->seconds_judge = ffd_clock_seconds() - start;
    return status;
}

ffd_status ffd_deform_job_run(deform_job *job, ffd_job_result *result, ffd_error *error)
{
    figure_arrays arrays = {0};
    const double start = ffd_clock_seconds();
    ffd_status status = prepare(job, &arrays, error);
    const double prepared = ffd_clock_seconds();
    result->seconds_read += prepared - start;
    if (!status)
        status = locate(job, error);
    if (!status)
        status = deform(job, &arrays, error);
    if (!status) {
        ffd_result_fill(result, &job->totals, ffd_clock_seconds() - prepared);
        status = judge(job, &arrays, result, error);
    }
    if (!status)
        ffd_result_warn(&job->totals, &job->chain, true, &job->log);
    if (!status && job->desc->only_count && job->totals.vertices == 0)
        ffd_log_line(&job->log, FFD_LOG_WARNING, "--only selects no vertices");
    if (!status && !job->check)
        ffd_figures_warn(job, result);
    ffd_figures_free(&arrays);
    return status;
}

ffd_status ffd_deform_job_end(deform_job *job, ffd_status status, ffd_job_result *result, ffd_error *error)
{
    result->status = status;
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(&result->error, ffd_source_name(&job->desc->input));
    ffd_embedding_close(&job->embedding);
    ffd_model_free(&job->base);
    if (status == FFD_OK)
        ffd_cache_put_mesh(job->desc->share, job->desc, job->document);
    else
        ffd_source_close(&job->document);
    ffd_cache_put_chain(job->desc->share, &job->chain);
    ffd_chain_free(&job->chain);
    if (status && error)
        *error = result->error;
    return status;
}
