#include "job/sharing.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/formats.h"
#include "io/users.h"
#include "mesh/linked_files.h"

static ffd_status add_models(job_sharing *s, const char *folder, ffd_error *error)
{
    path_list pairs = {0};
    ffd_status status;
    TRY_END(ffd_users_list(folder, &pairs, error));
    for (size_t i = 0; i + 1 < pairs.count; i += 2)
        TRY_END(ffd_users_add(&s->known->users, pairs.paths[i + 1], pairs.paths[i], error));
end:
    ffd_paths_free(&pairs);
    return status;
}

/* Adds the models of a folder, once. */
static ffd_status list_folder(job_sharing *s, const char *file, ffd_error *error)
{
    char *const folder = ffd_path_folder(file);
    if (!folder)
        return ffd_fail_memory(error);
    const hash128 there = ffd_place_of(&s->known->users.places, folder);
    const size_t count = s->known->folders.count;
    uint32_t index;
    ffd_status status;
    TRY_END(ffd_intern(&s->known->folders, &there, sizeof there, &index) ? FFD_OK : ffd_fail_memory(error));
    if (index == count)
        TRY_END(add_models(s, folder, error));
end:
    ffd_free(folder);
    return status;
}

/* Adds the files of the input, which may be a model of another folder. */
static ffd_status add_input(job_sharing *s, ffd_error *error)
{
    path_list files = {0};
    s->has_input = true;
    if (!s->document->format->sidecars || ffd_file_is_stream(s->input) || s->document->folder.resolve)
        return FFD_OK;
    ffd_status status;
    TRY_END(s->document->format->sidecars->list(s->document, &files, error));
    TRY_END(ffd_mesh_list_linked(s->document, &files, error));
    for (size_t i = 0; i < files.count; i++)
        TRY_END(ffd_users_add(&s->known->users, files.paths[i], s->input, error));
end:
    ffd_paths_free(&files);
    return status;
}

/* A mesh_find_users_function. */
static ffd_status find(void *context, const char *file, const char *output, size_t *count, bool *by_output,
                       path_list *names, ffd_error *error)
{
    job_sharing *const s = context;
    const bool is_complete = s->known->is_complete;
    TRY(is_complete ? FFD_OK : list_folder(s, file, error));
    if (!is_complete && !s->has_input)
        TRY(add_input(s, error));
    return ffd_users_find(&s->known->users, file, output, count, by_output, names, error);
}

void ffd_sharing_begin(job_sharing *sharing, const ffd_deform_desc *desc, const mesh_document *document,
                       const char *output, ffd_format to, const mesh_sharing **used)
{
    *sharing = (job_sharing){.document = document, .input = desc->input.path};
    *used = NULL;
    const mesh_sidecar_calls *const sidecars = ffd_format_table(to)->sidecars;
    if (!sidecars || !sidecars->count || ffd_output_is_stream(output) || desc->sink)
        return;
    sharing->known = desc->output_set ? &desc->output_set->users : &sharing->own;
    sharing->sharing = (mesh_sharing){find, sharing, sharing->known->is_complete};
    *used = &sharing->sharing;
}

void ffd_sharing_end(job_sharing *sharing)
{
    ffd_known_users_free(&sharing->own);
}
