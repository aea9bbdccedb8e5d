#include "job/reads.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "io/formats.h"
#include "job/input/source.h"
#include "lattice/file/lattice_source.h"
#include <string.h>

/* Whether a file is there that an output would replace. */
static bool replaces(const char *output)
{
    file_stamp stamp;
    return !ffd_output_is_stream(output) && ffd_file_stamp(output, &stamp);
}

static bool holds(const path_list *files, const char *output)
{
    for (size_t i = 0; i < files->count && replaces(output); i++)
        if (ffd_file_same(files->paths[i], output))
            return true;
    return false;
}

/* Whether a mesh may name the file as one that it reads or copies. What is copied with a mesh (images,
   material libraries) has not the ending of one; a buffer may have any. */
static bool may_name(const mesh_format *format, const char *output)
{
    return format->resources && (format->sidecars || ffd_format_from_name(output) == FFD_FORMAT_AUTO);
}

/* The files that a mesh names; resources: images and material libraries; linked: those that no job reads or
   copies. Both may be among `named`. */
typedef struct mesh_names {
    path_list named, resources, linked;
} mesh_names;

static ffd_status list_by_document(const mesh_document *document, mesh_names *names, ffd_error *error)
{
    const mesh_sidecar_calls *const sidecars = document->format->sidecars;
    TRY(sidecars->list(document, &names->named, error));
    return sidecars->list_images(document, &names->resources, error);
}

static ffd_status list_by_bytes(const mesh_format *format, const ffd_source *source, mesh_names *names,
                                ffd_error *error)
{
    file_input bytes;
    if (ffd_file_load(source->path, &bytes, NULL)) /* opening the mesh fails too */
        return FFD_OK;
    const mesh_named found = {&names->named, &names->resources, &names->linked};
    const ffd_status status = format->resources->find_named(source->path, &bytes, &found, error);
    ffd_file_unload(&bytes);
    return status;
}

/* What an output is to the input, if it would replace a file of it; NULL: nothing. */
static const char *role_of(const mesh_format *format, const mesh_names *names, const char *output)
{
    const bool has_buffers = format->sidecars && format->sidecars->count;
    if (holds(&names->resources, output))
        return "an image or a material library of the input";
    if (holds(&names->linked, output))
        return "a file that is named by the input";
    if (!holds(&names->named, output))
        return NULL;
    return has_buffers ? "a buffer of the input" : "a file of the input";
}

/* Asks for the output first: usually it does not exist, which is a quick answer. */
bool ffd_job_reads_mesh(const ffd_source *source, const char *path)
{
    return source->path && !source->bytes.data && ffd_file_same(path, source->path);
}

bool ffd_job_reads_embedding(const ffd_deform_desc *desc, const char *path)
{
    const ffd_embedding_source *const embedding = &desc->embedding;
    return embedding->path && !embedding->bytes.data && ffd_file_same(path, embedding->path);
}

const char *ffd_job_weight_file(const ffd_deform_desc *desc)
{
    return desc->weight.source && !desc->weight.bytes.data ? ffd_weight_file(desc->weight.source) : NULL;
}

bool ffd_job_reads_weights(const ffd_deform_desc *desc, const char *path)
{
    const char *const file = ffd_job_weight_file(desc);
    return file && ffd_file_same(path, file);
}

bool ffd_job_reads_lattice(const ffd_lattice_source *lattices, size_t count, const char *path)
{
    for (size_t i = 0; i < count && lattices; i++) {
        const char *const file = ffd_lattice_file(&lattices[i]);
        if (file && ffd_file_same(path, file))
            return true;
    }
    return false;
}

ffd_status ffd_job_check_mesh_files(const char *output, const ffd_source *source,
                                    const mesh_document *document, ffd_error *error)
{
    ffd_format format;
    mesh_names names = {0};
    if (ffd_file_is_stream(source->path) || source->bytes.data || ffd_source_format(source, &format, NULL))
        return FFD_OK;
    const mesh_format *const table = ffd_format_table(format);
    const bool may = may_name(table, output);
    ffd_status status = FFD_OK;
    if (document)
        TRY_END(ffd_mesh_list_linked(document, &names.linked, error));
    if ((!may && names.linked.count == 0) || !replaces(output))
        goto end;
    if (may)
        TRY_END(document && table->sidecars ? list_by_document(document, &names, error)
                                            : list_by_bytes(table, source, &names, error));
    const char *const role = role_of(table, &names, output);
    if (role)
        TRY_END(ffd_fail_file(error, FFD_E_EXISTS, output, "is %s %s and is not overwritten", role,
                              source->path));
end:
    ffd_paths_free(&names.named);
    ffd_paths_free(&names.resources);
    ffd_paths_free(&names.linked);
    return status;
}

ffd_status ffd_job_check_box(const char *output, const path_list *box_files,
                             const ffd_lattice_source *lattice, ffd_error *error)
{
    return holds(box_files, output)
               ? ffd_fail_file(error, FFD_E_EXISTS, output,
                               "is a file of the meshes that the box of %s goes round and is not overwritten",
                               ffd_lattice_name(lattice))
               : FFD_OK;
}

ffd_status ffd_job_check_box_files(const char *output, const lattice_chain *chain,
                                   const ffd_lattice_source *lattices, ffd_error *error)
{
    for (size_t i = 0; i < chain->count; i++)
        TRY(ffd_job_check_box(output, &chain->links[i].box_files, &lattices[i], error));
    return FFD_OK;
}
