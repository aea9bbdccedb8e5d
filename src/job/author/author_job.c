#include "job/author/author_job.h"
#include "base/file/mapping.h"
#include "base/memory/memory.h"
#include "job/chain/chain_load.h"
#include "job/input/deform_desc.h"
#include "job/input/shown_box.h"
#include "job/input/source.h"
#include "job/reads.h"
#include "job/report/output_set.h"
#include "lattice/file/spec_text.h"
#include <string.h>

ffd_status ffd_author_take_meshes(job_memory *memory, const ffd_source *meshes, size_t count,
                                  ffd_source **copy, ffd_error *error)
{
    *copy = NULL;
    if (!meshes || count == 0)
        return FFD_OK;
    *copy = ffd_alloc(count, sizeof **copy);
    if (!*copy)
        return ffd_fail_memory(error);
    memcpy(*copy, meshes, count * sizeof **copy);
    for (size_t i = 0; i < count; i++)
        TRY(ffd_in_memory_source(memory, &(*copy)[i], error));
    return FFD_OK;
}

static ffd_status check_desc(const author_job *job, ffd_error *error)
{
    bool is_complete = job->output && ffd_desc_has_settings(job->set, job->set_count) &&
                       ffd_desc_has_texts(job->only, job->only_count);
    for (size_t i = 0; i < job->lattice_count && is_complete; i++)
        is_complete = job->lattices[i].path;
    for (size_t i = 0; i < job->mesh_count && is_complete; i++)
        is_complete = job->meshes && job->meshes[i].path;
    if (!is_complete)
        return ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete");
    if (job->only_count > 0 && job->mesh_count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "{only} chooses parts of {meshes}, but there are none");
    return FFD_OK;
}

/* What is read is never replaced, not with force either. */
static ffd_status check_output(const author_job *job, ffd_error *error)
{
    if (job->sink)
        return FFD_OK;
    bool is_input = ffd_job_reads_lattice(job->lattices, job->lattice_count, job->output);
    for (size_t i = 0; i < job->mesh_count; i++)
        is_input = is_input || ffd_job_reads_mesh(&job->meshes[i], job->output);
    if (is_input)
        return ffd_fail_file(error, FFD_E_EXISTS, job->output, "is an input of this command");
    for (size_t i = 0; i < job->mesh_count; i++)
        TRY(ffd_job_check_mesh_files(job->output, &job->meshes[i], NULL, error));
    if (ffd_format_from_name(job->output) != FFD_FORMAT_AUTO)
        return ffd_fail_file(error, FFD_E_ARGUMENT, job->output,
                             "a lattice file is JSON, but the output has the ending of a mesh");
    return ffd_output_check(job->output, job->force, error);
}

/* Measures the box round the job's own meshes. */
static ffd_status measure(const author_job *job, ffd_shared_box *box, ffd_error *error)
{
    ffd_shown_box_clear(&box->box);
    for (size_t i = 0; i < job->mesh_count; i++)
        TRY(ffd_shown_box_add(&box->box, &job->meshes[i], job->only, job->only_count, &box->files, &job->log,
                              error));
    if (job->mesh_count > 0 && !(box->box.all.min[0] <= box->box.all.max[0]))
        return ffd_fail_file(error, FFD_E_INVALID, ffd_source_name(&job->meshes[0]),
                             "there is no vertex that the lattice could go round");
    return FFD_OK;
}

/* Meshes are given for the box of a lattice that names none itself. */
static ffd_status refuse_meshes(const author_job *job, const author_input *input, ffd_error *error)
{
    bool names_own = false;
    if (job->mesh_count == 0)
        return FFD_OK;
    for (size_t i = 0; i < input->count; i++) {
        if (ffd_lattice_needs_bounds(input->lattices[i]) &&
            ffd_lattice_get_mesh_count(input->lattices[i]) == 0)
            return FFD_OK;
        names_own = names_own || ffd_lattice_get_mesh_count(input->lattices[i]) > 0;
    }
    return ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[0].path,
                         "{meshes} cannot be used: the lattice does not go round %s",
                         names_own ? "other meshes than those that it names" : "a mesh");
}

static ffd_status load(const author_job *job, author_input *input, ffd_error *error)
{
    ffd_shared_box box = {0};
    const chain_files files = {.lattices = job->lattices,
                               .count = job->lattice_count,
                               .set = job->set,
                               .set_count = job->set_count,
                               .mesh = job->reading,
                               .shared = job->mesh_count > 0 ? &box : NULL,
                               .log = &job->log};
    ffd_status status;
    input->lattices = ffd_alloc_zero(job->lattice_count, sizeof *input->lattices);
    TRY_END(input->lattices ? FFD_OK : ffd_fail_memory(error));
    TRY_END(measure(job, &box, error));
    TRY_END(ffd_chain_load_lattices(&files, &input->memory, input->lattices, &input->files, error));
    input->count = job->lattice_count;
    TRY_END(refuse_meshes(job, input, error));
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
    *input = (author_input){.memory = ffd_budget_make(job->reading->memory)};
    TRY(ffd_author_check(job, error));
    TRY(ffd_mapping_judge(losses, load(job, input, error), error));
    return job->sink ? FFD_OK : ffd_job_check_box(job->output, &input->files, job->lattices, error);
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
    ffd_output_record(*output, ffd_output_set_list(job->output_set));
    ffd_output_redirect(*output, job->sink, job->sink_user);
    return FFD_OK;
}

ffd_status ffd_author_write(const author_job *job, const ffd_lattice *made, ffd_error *error)
{
    file_output *output;
    TRY(ffd_author_output(job, &output, error));
    const ffd_status status = ffd_lattice_write(made, output, job->output, job->force, error);
    ffd_output_destroy(&output);
    return status;
}
