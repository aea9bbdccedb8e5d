#include "base/clock.h"
#include "base/path.h"
#include "base/thread.h"
#include "io/formats.h"
#include "job/placement.h"
#include "job/source.h"
#include "job/written.h"
#include <inttypes.h>
#include <string.h>

void ffd_deform_desc_init(ffd_deform_desc *desc)
{
    memset(desc, 0, sizeof *desc);
    desc->struct_size = sizeof *desc;
}

static int thread_count(int asked)
{
    return asked > 0 ? asked : ffd_processor_count();
}

/* Where the result goes: path, format and whether it may replace a file. */
static ffd_status resolve_output(const ffd_deform_desc *desc, mesh_save_options *options, ffd_error *error)
{
    const char *input = desc->input.path;
    *options = (mesh_save_options){desc->output, desc->output_format, desc->force, desc->resources};
    if (desc->in_place) {
        if (desc->output)
            return ffd_fail(error, FFD_E_ARGUMENT, "--in-place has no output \"%s\"", desc->output);
        if (strcmp(input, "-") == 0)
            return ffd_fail(error, FFD_E_ARGUMENT, "standard input cannot be overwritten in place");
        options->path = input;
        options->force = true;
        return ffd_source_format(&desc->input, &options->format, error);
    }
    if (!desc->output)
        return ffd_fail(error, FFD_E_ARGUMENT, "no output is given");
    if (options->format == FFD_FORMAT_AUTO)
        options->format = ffd_format_from_name(desc->output);
    if (options->format == FFD_FORMAT_AUTO && strcmp(desc->output, "-") == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "standard output needs --output-format obj, gltf or glb");
    if (options->format == FFD_FORMAT_AUTO)
        return ffd_fail_file(error, FFD_E_ARGUMENT, desc->output,
                             "the ending \"%s\" is not that of a mesh format: .obj, .gltf and .glb are known",
                             ffd_path_ending(desc->output));
    if (strcmp(input, "-") != 0 && strcmp(desc->output, "-") != 0 && ffd_file_same(input, desc->output))
        return ffd_fail_file(error, FFD_E_EXISTS, desc->output, "is the input (--in-place overwrites it)");
    return ffd_output_check(desc->output, desc->force, error);
}

/* What the policies say of the vertices, before anything is written. */
static ffd_status judge(const ffd_deform_desc *desc, const pass_totals *totals, ffd_error *error)
{
    const char *name = ffd_source_name(&desc->input);
    if (totals->first_invalid != UINT64_MAX)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "vertex %" PRIu64 " (counted from 0) has a coordinate that is not finite",
                             totals->first_invalid);
    if (desc->outside == FFD_OUTSIDE_ERROR && totals->outside_any)
        return ffd_fail_file(error, FFD_E_EMBEDDING, name,
                             "%" PRIu64 " of %" PRIu64
                             " vertices are outside the lattice, the first is vertex %" PRIu64
                             " (counted from 0)",
                             totals->outside_any, totals->vertices, totals->first_outside);
    if (totals->first_overflow != UINT64_MAX)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "the deformed position of vertex %" PRIu64
                             " is too large for the file's numbers",
                             totals->first_overflow);
    return FFD_OK;
}

/* What a job holds while it runs. */
typedef struct deform_job {
    const ffd_deform_desc *desc;
    int threads;
    mesh_log log;
    mesh_save_options options;
    lattice_chain chain;
    mesh_document *document;
} deform_job;

/* Everything that can be refused before a vertex is touched. */
static ffd_status prepare(deform_job *job, ffd_error *error)
{
    const ffd_deform_desc *desc = job->desc;
    const bool attributes = desc->normals != FFD_NORMALS_KEEP;
    ffd_status status = resolve_output(desc, &job->options, error);
    if (!status && desc->written && ffd_written_holds(&desc->written->files, desc->input.path))
        status = ffd_fail_file(error, FFD_E_EXISTS, desc->input.path,
                               "was written by this run already, under this name or another");
    if (!status)
        status = ffd_chain_load(desc->lattices, desc->lattice_count, &job->chain, error);
    if (!status)
        status = ffd_source_open(&desc->input, &job->document, error);
    if (status)
        return status;
    const mesh_format *format = job->document->format;
    if (ffd_format_table(job->options.format) != format)
        return ffd_fail_file(error, FFD_E_UNSUPPORTED, ffd_source_name(&desc->input),
                             "cannot become another format: this build writes %s as %s", format->name,
                             format->name);
    status = format->check(job->document, error);
    return status ? status : format->begin_results(job->document, attributes, attributes, error);
}

static ffd_status deform(deform_job *job, pass_totals *totals, ffd_error *error)
{
    const ffd_status status = ffd_chain_place(&job->chain, job->document, job->threads, error);
    if (status)
        return status;
    const mesh_pass pass = {.document = job->document,
                            .chain = &job->chain,
                            .links = job->chain.count,
                            .threads = job->threads,
                            .write = true,
                            .attributes = job->desc->normals != FFD_NORMALS_KEEP};
    return ffd_pass_run(&pass, totals, error);
}

static ffd_status save(const deform_job *job, ffd_error *error)
{
    file_output *output;
    ffd_status status = ffd_output_create(&output, error);
    if (status)
        return status;
    ffd_output_record(output, ffd_written_list(job->desc->written));
    status = job->document->format->save(job->document, &job->options, output, &job->log, error);
    if (!status)
        status = ffd_output_commit(output, error);
    ffd_output_destroy(&output);
    return status;
}

static ffd_status run(deform_job *job, ffd_job_result *result, ffd_error *error)
{
    pass_totals totals;
    const double start = ffd_clock_seconds();
    ffd_status status = prepare(job, error);
    const double prepared = ffd_clock_seconds();
    result->seconds_read = prepared - start;
    if (!status)
        status = deform(job, &totals, error);
    if (status)
        return status;
    const double deformed = ffd_clock_seconds();
    ffd_result_fill(result, &totals, deformed - prepared);
    status = judge(job->desc, &totals, error);
    if (status)
        return status;
    ffd_result_warn(&totals, &job->log);
    status = save(job, error);
    result->seconds_write = ffd_clock_seconds() - deformed;
    return status;
}

ffd_status ffd_deform_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error)
{
    memset(result, 0, sizeof *result);
    for (int a = 0; a < 3; a++) {
        result->before.min[a] = result->after.min[a] = 1; /* no bounds yet: min > max */
        result->before.max[a] = result->after.max[a] = -1;
    }
    if (desc->struct_size != sizeof *desc || !desc->input.path || (desc->lattice_count && !desc->lattices)) {
        result->status = ffd_fail(&result->error, FFD_E_ARGUMENT, "the job's description is not complete");
    } else {
        deform_job job = {
            .desc = desc, .threads = thread_count(desc->threads), .log = {desc->log, desc->log_user}};
        result->status = run(&job, result, &result->error);
        if (result->status && result->status != FFD_E_ARGUMENT)
            ffd_fail_name_file(&result->error, ffd_source_name(&desc->input));
        ffd_source_close(&job.document);
        ffd_chain_free(&job.chain);
    }
    if (result->status && error)
        *error = result->error;
    return result->status;
}
