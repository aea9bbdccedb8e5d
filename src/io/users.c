#include "io/users.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/formats.h"
#include <string.h>

/* Adds a model with each file that it names. */
static ffd_status add_model(const mesh_format *format, const char *path, path_list *pairs, ffd_error *error)
{
    file_input bytes;
    path_list named = {0};
    if (ffd_file_load(path, &bytes, NULL))
        return FFD_OK;
    ffd_status status;
    TRY_END(format->resources->find_named(path, &bytes, &(mesh_named){.files = &named}, error));
    for (size_t i = 0; i < named.count; i++) {
        TRY_END(ffd_paths_add(pairs, path, error));
        TRY_END(ffd_paths_add(pairs, named.paths[i], error));
    }
end:
    ffd_file_unload(&bytes);
    ffd_paths_free(&named);
    return status;
}

ffd_status ffd_users_list(const char *folder, path_list *pairs, ffd_error *error)
{
    path_list names = {0};
    ffd_status status;
    TRY_END(ffd_folder_list(folder, &names, error));
    for (size_t i = 0; i < names.count; i++) {
        const mesh_format *const format = ffd_format_table(ffd_format_from_name(names.paths[i]));
        if (!format || !format->sidecars || !format->sidecars->count)
            continue;
        char *const path =
            strcmp(folder, ".") == 0 ? ffd_text_copy(names.paths[i]) : ffd_path_join(folder, names.paths[i]);
        status = path ? add_model(format, path, pairs, error) : ffd_fail_memory(error);
        ffd_free(path);
        TRY_END(status);
    }
end:
    ffd_paths_free(&names);
    return status;
}
