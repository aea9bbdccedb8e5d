#include "io/obj/resource/obj_resources.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/obj/resource/mtl_file.h"
#include "io/obj/resource/obj_libraries.h"
#include "io/obj/resource/obj_linked.h"
#include "io/obj/resource/obj_paths.h"
#include "mesh/resource/image_file.h"
#include "mesh/resource/image_tiles.h"
#include "mesh/resource/left_out.h"
#include "mesh/resource/resource_copy.h"
#include <string.h>

/* Maps of a library that have tiles, each of which is looked for. */
#define TILED_MAX 256

static ffd_status add_file(const file_folder *mesh, resource_list *list, const char *library,
                           const char *name, ffd_error *error)
{
    char *path;
    TRY(ffd_obj_find_map(mesh, library, name, &path, error));
    return path ? ffd_resources_add(list, &ffd_resource_image, list->count, path, error) : FFD_OK;
}

/* Adds those tiles of a map that exist. */
static ffd_status add_tiles(const file_folder *mesh, resource_list *list, const char *library,
                            const char *name, ffd_error *error)
{
    const size_t before = list->count;
    for (size_t i = 0; i < IMAGE_TILES; i++) {
        char *path = NULL, *const tile = ffd_image_tile(name, i);
        const ffd_status status =
            tile ? ffd_obj_find_map(mesh, library, tile, &path, error) : ffd_fail_memory(error);
        ffd_free(tile);
        TRY(status);
        if (path && ffd_folder_has(mesh, path))
            TRY(ffd_resources_add(list, &ffd_resource_image, list->count, path, error));
        else
            ffd_free(path);
    }
    return list->count > before ? FFD_OK : add_file(mesh, list, library, name, error);
}

/* Adds a map of a library. */
static ffd_status add_map(const file_folder *mesh, resource_list *list, const char *library, const char *name,
                          ffd_error *error)
{
    return ffd_image_has_tiles(name) ? add_tiles(mesh, list, library, name, error)
                                     : add_file(mesh, list, library, name, error);
}

/* Adds the maps of a library that may be copied. */
static ffd_status add_maps(const file_folder *mesh, resource_list *list, const mesh_resource *library,
                           ffd_error *error)
{
    file_input bytes = {0};
    const char *left;
    ffd_error refused;
    intern_table names = {0};
    TRY(ffd_resource_load(mesh, library, &bytes, &left, &refused, error));
    if (left || refused.status)
        return FFD_OK;
    ffd_status status;
    TRY_END(ffd_mtl_list_maps(bytes.data, bytes.size, library->path, &names, error));
    size_t tiled = 0;
    for (uint32_t i = 0; i < names.count; i++) {
        tiled += ffd_image_has_tiles(ffd_intern_key(&names, i));
        TRY_END(tiled <= TILED_MAX ? add_map(mesh, list, library->path, ffd_intern_key(&names, i), error)
                                   : ffd_fail_file(error, FFD_E_LIMIT, library->path,
                                                   "names more than %d maps with tiles", TILED_MAX));
    }
end:
    ffd_intern_free(&names);
    ffd_file_unload(&bytes);
    return status;
}

/* Lists the libraries, and what they name (with_maps), in the order of their paths. */
static ffd_status list_all(const file_folder *mesh, const file_input *input, bool with_maps,
                           resource_list *list, ffd_error *error)
{
    intern_table names = {0};
    ffd_status status;
    TRY_END(ffd_obj_list_libraries(input, mesh, &names, error));
    for (uint32_t i = 0; i < names.count; i++) {
        char *path;
        TRY_END(ffd_obj_find_path(mesh, "", ffd_intern_key(&names, i), &path, error));
        if (path)
            TRY_END(ffd_resources_add(list, &ffd_resource_library, i, path, error));
    }
    for (size_t i = 0, libraries = list->count; i < libraries && with_maps; i++) {
        const mesh_resource library = list->resources[i]; /* the list moves as it grows */
        TRY_END(add_maps(mesh, list, &library, error));
        if (list->count > OBJ_RESOURCES_MAX)
            TRY_END(
                ffd_fail_file(error, FFD_E_LIMIT, mesh->file, "names more than %d maps", OBJ_RESOURCES_MAX));
    }
    ffd_resources_sort(list);
end:
    ffd_intern_free(&names);
    return status;
}

/* is_stay: mesh and output are in one folder. */
static ffd_status bring(const resource_copier *c, const file_input *input, const mesh_save_options *options,
                        bool is_stay, ffd_error *error)
{
    const bool copies = options->resources != FFD_RESOURCES_REFERENCE;
    resource_list list = {0};
    ffd_status status;
    TRY_END(list_all(&c->mesh, input, copies || is_stay, &list, error));
    TRY_END(ffd_resources_bring(c, &list, copies, is_stay, options->path, error));
end:
    ffd_resources_free(&list);
    return status;
}

/* Adds the libraries that an output in folder `to` (both NULL: it is not a file) does not reach. name: of the
   mesh, for messages. */
static ffd_status leave_libraries(const file_input *input, const char *name, const char *output,
                                  const char *to, left_out *left, ffd_error *error)
{
    intern_table names = {0};
    const file_folder mesh = {.file = name}, there = {.file = output};
    ffd_status status;
    TRY_END(ffd_obj_list_libraries(input, &mesh, &names, error));
    for (uint32_t i = 0; i < names.count; i++)
        TRY_END(ffd_obj_leave_name(&there, ffd_intern_key(&names, i), to, left, "of mtllib", error));
end:
    ffd_intern_free(&names);
    return status;
}

/* Names what goes along with a file, but not with standard input. */
static ffd_status warn_of_stream(const file_input *input, bool names_files, const mesh_save_options *options,
                                 const mesh_log *log, ffd_error *error)
{
    const char *const mesh = ffd_file_display_name(options->input);
    left_out left = {0};
    const char *const output = options->to_sink ? NULL : options->path;
    char *const to = output ? ffd_path_folder(output) : NULL;
    const file_folder there = {.file = output};
    ffd_status status;
    TRY_END(to || !output ? leave_libraries(input, mesh, output, to, &left, error) : ffd_fail_memory(error));
    if (names_files)
        TRY_END(ffd_obj_leave_linked(input, mesh, &there, to, &left, error));
    ffd_left_out_log_stream(&left, log);
end:
    ffd_free(to);
    return status;
}

/* Names the files that are not copied, whatever they are. */
static ffd_status warn_of_linked(const resource_copier *c, const file_input *input, ffd_error *error)
{
    left_out left = {0};
    TRY(ffd_obj_leave_linked(input, c->mesh.file, &c->mesh, c->options->to_sink ? NULL : c->to, &left,
                             error));
    ffd_left_out_log(&left, "file that a statement names is not copied",
                     "files that statements name are not copied", c->log);
    return FFD_OK;
}

ffd_status ffd_obj_bring_resources(const file_input *input, const file_folder *folder, bool names_files,
                                   const mesh_save_options *options, file_output *output, const mesh_log *log,
                                   ffd_error *error)
{
    const char *const mesh = options->input;
    if (!mesh || ffd_output_is_stream(options->path))
        return FFD_OK;
    if (ffd_file_is_stream(mesh))
        return warn_of_stream(input, names_files, options, log, error);
    /* To look through a file that is in memory takes less than to ask the system for folders. */
    if ((!input->mapped && !names_files && !ffd_obj_names_libraries(input)) ||
        ffd_save_meets(options, mesh, options->path))
        return FFD_OK;
    char *const from = ffd_path_folder(mesh), *const to = ffd_path_folder(options->path);
    const resource_copier copier = {
        .mesh = *folder, .from = from, .to = to, .output = output, .log = log, .options = options};
    ffd_status status;
    TRY_END(from && to ? FFD_OK : ffd_fail_memory(error));
    const bool is_stay = ffd_save_meets(options, from, to);
    /* In its own folder an output of another ending meets none of the names. */
    if (!is_stay || ffd_mtl_has_name(options->path) || ffd_image_has_name(options->path))
        TRY_END(bring(&copier, input, options, is_stay, error));
    if (!is_stay && names_files)
        TRY_END(warn_of_linked(&copier, input, error));
end:
    ffd_free(from);
    ffd_free(to);
    return status;
}

ffd_status ffd_obj_find_named(const char *path, const file_input *bytes, const mesh_named *named,
                              ffd_error *error)
{
    resource_list list = {0};
    const file_folder mesh = {.file = path};
    ffd_status status;
    TRY_END(list_all(&mesh, bytes, true, &list, error));
    for (size_t i = 0; i < list.count; i++)
        if (!ffd_path_leads_out(list.resources[i].path))
            TRY_END(ffd_resource_add_named(path, list.resources[i].path, named, error));
end:
    ffd_resources_free(&list);
    return status;
}
