#include "job/author/author_job.h"
#include "base/file/mapping.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/system/thread.h"
#include "job/chain/chain_load.h"
#include "job/input/deform_desc.h"
#include "job/input/shown_box.h"
#include "job/input/source.h"
#include "job/reads.h"
#include "job/report/output_set.h"
#include "lattice/file/lattice_time.h"
#include "lattice/file/spec_text.h"
#include <math.h>
#include <string.h>

void ffd_author_desc_init(ffd_author_desc *desc, size_t size)
{
    const ffd_author_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

/* Registers meshes that are in memory under paths, in a copy of their array. */
static ffd_status take_meshes(author_job *job, ffd_error *error)
{
    const size_t count = job->desc.mesh_count;
    if (!job->desc.meshes || count == 0)
        return FFD_OK;
    job->meshes = ffd_alloc(count, sizeof *job->meshes);
    if (!job->meshes)
        return ffd_fail_memory(error);
    memcpy(job->meshes, job->desc.meshes, count * sizeof *job->meshes);
    job->desc.meshes = job->meshes;
    for (size_t i = 0; i < count; i++)
        TRY(ffd_in_memory_source(&job->memory, &job->meshes[i], error));
    return FFD_OK;
}

ffd_status ffd_author_take(const ffd_author_desc *callers, author_job *job, ffd_error *error)
{
    ffd_author_desc *const desc = &job->desc;
    *job = (author_job){.lattices = &desc->lattice, .lattice_count = 1};
    ffd_author_desc_init(desc, sizeof *desc);
    TRY(ffd_struct_take(desc, sizeof *desc, callers, "ffd_author_desc", error));
    job->log = (mesh_log){desc->log, desc->log_user};
    TRY(ffd_threads_check(desc->threads, error));
    TRY(ffd_in_memory_lattice(&desc->lattice, "the lattice", "lattice", error));
    TRY(take_meshes(job, error));
    return ffd_in_memory_output(desc->sink, desc->output, error);
}

ffd_status ffd_author_leave(author_job *job, ffd_status status, ffd_error *error)
{
    ffd_free(job->meshes);
    return ffd_in_memory_end(&job->memory, status, error);
}

static ffd_status check_desc(const author_job *job, ffd_error *error)
{
    if (job->desc.has_time && !isfinite(job->desc.time))
        return ffd_fail(error, FFD_E_ARGUMENT, "the time %g is not finite", job->desc.time);
    bool is_complete = job->desc.output && ffd_desc_has_settings(job->desc.set, job->desc.set_count) &&
                       ffd_desc_has_texts(job->desc.only, job->desc.only_count);
    for (size_t i = 0; i < job->lattice_count && is_complete; i++)
        is_complete = job->lattices[i].path;
    for (size_t i = 0; i < job->table_count && is_complete; i++)
        is_complete = job->tables[i].path;
    for (size_t i = 0; i < job->desc.mesh_count && is_complete; i++)
        is_complete = job->meshes && job->meshes[i].path;
    if (!is_complete)
        return ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete");
    if (job->desc.only_count > 0 && job->desc.mesh_count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "{only} chooses parts of {meshes}, but there are none");
    return FFD_OK;
}

/* A lattice file is JSON. A name without an ending may be that of a device. */
static ffd_status check_ending(const char *output, ffd_error *error)
{
    if (ffd_format_from_name(output) != FFD_FORMAT_AUTO)
        return ffd_fail_file(error, FFD_E_ARGUMENT, output,
                             "a lattice file is JSON, but the output has the ending of a mesh");
    return !*ffd_path_ending(output) || ffd_path_has_ending(output, ".json")
               ? FFD_OK
               : ffd_fail_file(error, FFD_E_ARGUMENT, output,
                               "a lattice file is JSON, but the output has another ending than .json (ffd "
                               "lattice convert writes other formats)");
}

/* What is read is never replaced, not with force either. */
static ffd_status check_output(const author_job *job, ffd_error *error)
{
    if (job->desc.sink)
        return FFD_OK;
    bool is_input = ffd_job_reads_lattice(job->lattices, job->lattice_count, job->desc.output) ||
                    ffd_job_reads_lattice(job->tables, job->table_count, job->desc.output);
    for (size_t i = 0; i < job->desc.mesh_count; i++)
        is_input = is_input || ffd_job_reads_mesh(&job->meshes[i], job->desc.output);
    if (is_input)
        return ffd_fail_file(error, FFD_E_EXISTS, job->desc.output, "is an input of this command");
    for (size_t i = 0; i < job->desc.mesh_count; i++)
        TRY(ffd_job_check_mesh_files(job->desc.output, &job->meshes[i], NULL, error));
    if (!job->writes_formats)
        TRY(check_ending(job->desc.output, error));
    return ffd_output_check(job->desc.output, job->desc.force, error);
}

/* Measures the box round the job's own meshes. */
static ffd_status measure(const author_job *job, ffd_shared_box *box, ffd_error *error)
{
    ffd_shown_box_clear(&box->box);
    for (size_t i = 0; i < job->desc.mesh_count; i++)
        TRY(ffd_shown_box_add(&box->box, &job->meshes[i], job->desc.only, job->desc.only_count, &box->files,
                              &job->log, error));
    if (job->desc.mesh_count > 0 && !(box->box.all.min[0] <= box->box.all.max[0]))
        return ffd_fail_file(error, FFD_E_INVALID, ffd_source_name(&job->meshes[0]),
                             "there is no vertex that the lattice could go round");
    return FFD_OK;
}

/* Meshes are given for the box of a lattice that names none itself. */
static ffd_status refuse_meshes(const author_job *job, const author_input *input, ffd_error *error)
{
    bool names_own = false;
    if (job->desc.mesh_count == 0 || job->meshes_cut || input->count == 0)
        return FFD_OK;
    for (size_t i = 0; i < input->count; i++) {
        if (ffd_lattice_needs_bounds(input->lattices[i]) &&
            ffd_lattice_get_mesh_count(input->lattices[i]) == 0)
            return FFD_OK;
        names_own = names_own || ffd_lattice_get_mesh_count(input->lattices[i]) > 0;
    }
    const char *const which = names_own ? "other meshes than those that it names" : "a mesh";
    return job->laid ? ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[0].path,
                                     "{cover} cannot be used: the lattice does not go round %s", which)
                     : ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[0].path,
                                     "{meshes} cannot be used: the lattice does not go round %s", which);
}

/* A lattice is made of one moment. Without positions it becomes that of this moment here, where that needs
   none; else the control points tell. */
static ffd_status take_stills(const author_job *job, author_input *input, ffd_error *error)
{
    for (size_t i = 0; i < input->count; i++) {
        ffd_lattice *const lattice = input->lattices[i];
        if (!ffd_lattice_has_keys(lattice))
            continue;
        if (!lattice->spec->keys.is_chosen)
            return ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[i].path,
                                 "has keys, and one moment of them is needed ({time})");
        if (!lattice->rest)
            TRY(ffd_lattice_make_still(&input->lattices[i], error));
    }
    return FFD_OK;
}

static ffd_status load(const author_job *job, author_input *input, ffd_error *error)
{
    ffd_shared_box box = {0};
    const chain_files files = {.lattices = job->lattices,
                               .count = job->lattice_count,
                               .set = job->desc.set,
                               .set_count = job->desc.set_count,
                               .time = job->desc.has_time ? &job->desc.time : NULL,
                               .mesh = &job->desc.reading,
                               .shared = job->laid                  ? job->laid
                                         : job->desc.mesh_count > 0 ? &box
                                                                    : NULL,
                               .log = &job->log};
    ffd_status status;
    if (job->lattice_count == 0)
        return FFD_OK;
    input->lattices = ffd_alloc_zero(job->lattice_count, sizeof *input->lattices);
    TRY_END(input->lattices ? FFD_OK : ffd_fail_memory(error));
    TRY_END(job->laid ? FFD_OK : measure(job, &box, error));
    TRY_END(ffd_chain_load_lattices(&files, &input->memory, input->lattices, &input->files, error));
    input->count = job->lattice_count;
    TRY_END(refuse_meshes(job, input, error));
    TRY_END(take_stills(job, input, error));
end:
    ffd_paths_free(&box.files);
    return status;
}

ffd_status ffd_author_check(const author_job *job, ffd_error *error)
{
    TRY(check_desc(job, error));
    return check_output(job, error);
}

ffd_status ffd_author_begin(const author_job *job, author_input *input, ffd_error *error)
{
    const unsigned losses = ffd_mapping_losses();
    *input = (author_input){.memory = ffd_budget_make(job->desc.reading.memory)};
    TRY(ffd_author_check(job, error));
    TRY(ffd_mapping_judge(losses, load(job, input, error), error));
    return job->desc.sink ? FFD_OK : ffd_job_check_box(job->desc.output, &input->files, job->lattices, error);
}

void ffd_author_end(author_input *input)
{
    for (size_t i = 0; i < input->count; i++)
        ffd_lattice_destroy(&input->lattices[i]);
    ffd_free(input->lattices);
    ffd_paths_free(&input->files);
    *input = (author_input){0};
}

ffd_status ffd_author_output(const author_job *job, file_output **output, ffd_error *error)
{
    TRY(ffd_output_create(output, error));
    ffd_output_record(*output, ffd_output_set_list(job->desc.output_set));
    ffd_output_redirect(*output, job->desc.sink, job->desc.sink_user);
    return FFD_OK;
}

ffd_status ffd_author_write(const author_job *job, const ffd_lattice *made, ffd_error *error)
{
    file_output *output;
    TRY(ffd_author_output(job, &output, error));
    const ffd_status status = ffd_lattice_write(made, output, job->desc.output, job->desc.force, error);
    ffd_output_destroy(&output);
    return status;
}
