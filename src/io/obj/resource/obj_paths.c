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
    char *beside = NULL;
    *path = NULL;
    if (is_absolute(name))
        return FFD_OK;
    beside = ffd_path_beside(base, name);
    if (beside) {
        ffd_folder_turn_slashes(folder, beside);
        *path = ffd_path_normalize(beside);
    }
    ffd_free(beside);
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
    ffd_status status = ffd_obj_find_path(folder, library, name, path, error);
    if (status || !*path || is_there(folder, *path))
        return status;
    status = ffd_obj_find_path(folder, "", name, &other, error);
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
