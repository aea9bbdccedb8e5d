#include "io/ply/ply_textures.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "mesh/resource/image_file.h"
#include "mesh/resource/left_out.h"
#include "mesh/resource/resource_copy.h"
#include <string.h>

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

bool ffd_ply_texture_name(text_word note, text_word *name)
{
    static const char key[] = "TextureFile";
    const size_t length = sizeof key - 1;
    for (const char *at = note.first; at + length < note.last; at++) {
        if (memcmp(at, key, length) != 0 || !is_blank(at[length]))
            continue;
        *name = (text_word){at + length, note.last};
        while (name->first < name->last && is_blank(*name->first))
            name->first++;
        while (name->last > name->first && is_blank(name->last[-1]))
            name->last--;
        return name->first < name->last;
    }
    return false;
}

/* Adds an image by its name, which counts from the mesh's folder. An absolute name is not a file beside it.
 */
static ffd_status add(const file_folder *folder, text_word name, resource_list *list, ffd_error *error)
{
    const size_t size = (size_t)(name.last - name.first);
    char *const text = ffd_alloc(size + 1, 1);
    if (!text)
        return ffd_fail_memory(error);
    memcpy(text, name.first, size);
    text[size] = 0;
    ffd_status status = FFD_OK;
    ffd_folder_turn_slashes(folder, text);
    if (!ffd_path_is_absolute(text) && !memchr(text, 0, size)) {
        char *const path = ffd_path_normalize(text);
        status = path ? ffd_resources_add(list, &ffd_resource_image, list->count, path, error)
                      : ffd_fail_memory(error);
    }
    ffd_free(text);
    return status;
}

static ffd_status list_all(const ply_header *header, const file_folder *folder, resource_list *list,
                           ffd_error *error)
{
    text_word name;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < header->note_count; i++)
        if (ffd_ply_texture_name(header->notes[i], &name))
            TRY_END(add(folder, name, list, error));
end:
    ffd_resources_sort(list);
    return status;
}

/* Names the textures of a mesh from standard input. */
static ffd_status warn_of_stream(const ply_header *header, const mesh_save_options *options,
                                 const mesh_log *log, ffd_error *error)
{
    resource_list list = {0};
    left_out left = {0};
    char *const to = ffd_path_folder(options->path);
    const file_folder there = {.file = options->to_sink ? NULL : options->path};
    ffd_status status;
    TRY_END(to ? list_all(header, &there, &list, error) : ffd_fail_memory(error));
    for (size_t i = 0; i < list.count; i++)
        TRY_END(ffd_left_add_unreached(&left, options->to_sink ? NULL : to, list.resources[i].path,
                                       "of TextureFile", error));
    ffd_left_out_log_stream(&left, log);
end:
    ffd_resources_free(&list);
    ffd_free(to);
    return status;
}

ffd_status ffd_ply_bring_textures(const ply_header *header, const file_folder *folder,
                                  const mesh_save_options *options, file_output *output, const mesh_log *log,
                                  ffd_error *error)
{
    const char *const mesh = options->input;
    if (!mesh || header->note_count == 0 || ffd_output_is_stream(options->path))
        return FFD_OK;
    if (ffd_file_is_stream(mesh))
        return warn_of_stream(header, options, log, error);
    if (ffd_save_meets(options, mesh, options->path))
        return FFD_OK;
    char *const from = ffd_path_folder(mesh), *const to = ffd_path_folder(options->path);
    const resource_copier copier = {
        .mesh = *folder, .from = from, .to = to, .output = output, .log = log, .options = options};
    resource_list list = {0};
    ffd_status status;
    TRY_END(from && to ? list_all(header, folder, &list, error) : ffd_fail_memory(error));
    TRY_END(ffd_resources_bring(&copier, &list, options->resources != FFD_RESOURCES_REFERENCE,
                                ffd_save_meets(options, from, to), options->path, error));
end:
    ffd_resources_free(&list);
    ffd_free(from);
    ffd_free(to);
    return status;
}

/* Only images in the folder of the mesh or below are copied. */
ffd_status ffd_ply_find_named(const char *path, const file_input *bytes, const mesh_named *named,
                              ffd_error *error)
{
    ply_header header = {0};
    resource_list list = {0};
    const ffd_status read = ffd_ply_header_read(bytes, path, &header, NULL);
    const file_folder folder = {.file = path};
    ffd_status status;
    TRY_END(read != FFD_E_MEMORY ? FFD_OK : ffd_fail_memory(error));
    if (!read)
        TRY_END(list_all(&header, &folder, &list, error));
    for (size_t i = 0; i < list.count; i++)
        TRY_END(ffd_resource_add_named(path, list.resources[i].path, named, error));
end:
    ffd_resources_free(&list);
    ffd_ply_header_free(&header);
    return status;
}
