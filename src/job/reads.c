#include "job/reads.h"
#include "base/file/input.h"
#include "base/file/memory_files.h"
#include "base/file/output.h"
#include "io/formats.h"
#include "job/input/source.h"
#include <string.h>

/* Whether a file is there that an output would replace. */
static bool replaces(const char *output)
{
    file_stamp stamp;
    return !ffd_output_is_stream(output) && !ffd_memory_has(output) && ffd_file_stamp(output, &stamp);
}

static bool holds(const path_list *files, const char *output)
{
    for (size_t i = 0; i < files->count; i++)
        if (ffd_file_same(files->paths[i], output))
            return true;
    return false;
}

/* Whether a mesh may name the file. What is copied with a mesh (images, material libraries) has not the
   ending of one; a buffer may have any. */
static bool may_name(const mesh_format *format, const char *output)
{
    return format->find_named && (format->list_files || ffd_format_from_name(output) == FFD_FORMAT_AUTO);
}

/* Looks for the file among those that the mesh names; resources: images and material libraries. */
static ffd_status find(const mesh_format *format, const ffd_source *source, const char *output,
                       bool *is_named, bool *is_resource, ffd_error *error)
{
    file_input bytes;
    path_list named = {0}, resources = {0};
    *is_named = *is_resource = false;
    if (ffd_file_load(source->path, &bytes, NULL)) /* opening the mesh fails too */
        return FFD_OK;
    ffd_status status = format->find_named(source->path, &bytes, &named, error);
    *is_named = !status && holds(&named, output);
    if (*is_named)
        status = format->find_resources(source->path, &bytes, &resources, error);
    *is_resource = holds(&resources, output);
    ffd_paths_free(&named);
    ffd_paths_free(&resources);
    ffd_file_unload(&bytes);
    return status;
}

ffd_status ffd_reads_check_mesh(const char *output, const ffd_source *source, ffd_error *error)
{
    ffd_format format;
    bool is_named, is_resource;
    if (!replaces(output) || ffd_file_is_stream(source->path) || ffd_memory_has(source->path) ||
        ffd_source_format(source, &format, NULL) || !may_name(ffd_format_table(format), output))
        return FFD_OK;
    const ffd_status status = find(ffd_format_table(format), source, output, &is_named, &is_resource, error);
    if (status || !is_named)
        return status;
    return ffd_fail_file(error, FFD_E_EXISTS, output, "is %s of the input %s and is not overwritten",
                         is_resource ? "an image or a material library" : "a buffer", source->path);
}

ffd_status ffd_reads_check_boxes(const char *output, const lattice_chain *chain, const char *const *lattices,
                                 ffd_error *error)
{
    if (!replaces(output))
        return FFD_OK;
    for (size_t i = 0; i < chain->count; i++)
        if (holds(&chain->links[i].box_files, output))
            return ffd_fail_file(
                error, FFD_E_EXISTS, output,
                "is a file of the meshes that the box of %s goes round and is not overwritten",
                ffd_file_display_name(lattices[i]));
    return FFD_OK;
}
