/* view_inputs.c - the inputs of a view, which its output must not replace. */
#include "base/file/input.h"
#include "base/file/path.h"
#include "job/reads.h"
#include "job/view/view.h"
#include "mesh/linked_files.h"

static ffd_status refuse(const char *output, bool is_linked, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_EXISTS, output, "is %s of this command",
                         is_linked ? "named by an input" : "an input");
}

ffd_status ffd_view_check_inputs(const ffd_view_desc *desc, ffd_error *error)
{
    const ffd_deform_desc *const job = desc->job;
    const bool is_input = ffd_job_reads_mesh(&job->input, desc->output) ||
                          (desc->deformed && ffd_job_reads_mesh(desc->deformed, desc->output)) ||
                          ffd_job_reads_embedding(job, desc->output) ||
                          ffd_job_reads_weights(job, desc->output) ||
                          ffd_job_reads_lattice(job->lattices, job->lattice_count, desc->output);
    return is_input ? refuse(desc->output, false, error) : FFD_OK;
}

/* Adds the resources that are found through the mesh's own file. */
static ffd_status find_resources(const ffd_source *source, const mesh_document *document, path_list *files,
                                 ffd_error *error)
{
    file_input bytes;
    if (!document->format->resources || ffd_file_is_stream(source->path) ||
        ffd_file_load(source->path, &bytes, NULL))
        return FFD_OK;
    const ffd_status status =
        document->format->resources->find_named(source->path, &bytes, &(mesh_named){.copies = files}, error);
    ffd_file_unload(&bytes);
    return status;
}

ffd_status ffd_view_check_files(const ffd_source *source, const mesh_document *document, const char *output,
                                ffd_error *error)
{
    path_list files = {0};
    if (!ffd_file_exists(output) || source->bytes.data)
        return FFD_OK;
    ffd_status status;
    TRY_END(find_resources(source, document, &files, error));
    if (document->format->sidecars)
        TRY_END(document->format->sidecars->list(document, &files, error));
    const size_t read = files.count;
    TRY_END(ffd_mesh_list_linked(document, &files, error));
    for (size_t i = 0; i < files.count; i++)
        if (ffd_file_same(files.paths[i], output))
            TRY_END(refuse(output, i >= read, error));
end:
    ffd_paths_free(&files);
    return status;
}
