#include "io/obj/resource/obj_paths.h"
#include "base/file/path.h"
#include "base/memory/memory.h"

/* Whether a name leads to one file wherever it is read: "/x", "C:\x", "\\server\x". */
static bool is_absolute(const char *name)
{
    const char letter = (char)(name[0] | 0x20);
    return name[0] == '/' || name[0] == '\\' || (letter >= 'a' && letter <= 'z' && name[1] == ':');
}

ffd_status ffd_obj_find_path(const file_folder *folder, const char *base, const char *name, char **path,
                             ffd_error *error)
{
    char *sibling = NULL;
    *path = NULL;
    if (is_absolute(name))
        return FFD_OK;
    sibling = ffd_path_sibling(base, name);
    if (sibling) {
        ffd_folder_turn_slashes(folder, sibling);
        *path = ffd_path_normalize(sibling);
    }
    ffd_free(sibling);
    if (!*path)
        return ffd_fail_memory(error);
    if (**path == 0) {
        ffd_free(*path);
        *path = NULL;
    }
    return FFD_OK;
}

/* Whether there is a file at a path below the mesh's folder. */
static bool is_there(const file_folder *folder, const char *path)
{
    return !ffd_path_leads_out(path) && ffd_folder_has(folder, path);
}

ffd_status ffd_obj_find_map(const file_folder *folder, const char *library, const char *name, char **path,
                            ffd_error *error)
{
    char *other = NULL;
    TRY(ffd_obj_find_path(folder, library, name, path, error));
    if (!*path || is_there(folder, *path))
        return FFD_OK;
    ffd_status status = ffd_obj_find_path(folder, "", name, &other, error);
    if (status || !other || !is_there(folder, other)) {
        ffd_free(other);
        other = NULL;
    }
    if (status || other) {
        ffd_free(*path);
        *path = other;
    }
    return status;
}

ffd_status ffd_obj_add_name(intern_table *names, const char *name, size_t size, const char *file,
                            ffd_error *error)
{
    uint32_t index;
    if (!ffd_intern(names, name, size, &index))
        return ffd_fail_memory(error);
    if (names->count > OBJ_RESOURCES_MAX)
        return ffd_fail_file(error, FFD_E_LIMIT, file, "names more than %d material libraries or maps",
                             OBJ_RESOURCES_MAX);
    if (names->pool_size <= OBJ_RESOURCE_BYTES)
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_LIMIT, file,
                         "the names of its material libraries or maps have more than %zu bytes",
                         OBJ_RESOURCE_BYTES);
}
