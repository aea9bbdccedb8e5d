#include "base/file/path_list.h"
#include "base/file/path.h"
#include "base/memory/memory.h"

ffd_status ffd_paths_add(path_list *list, const char *path, ffd_error *error)
{
    char *copy = ffd_text_copy(path);
    if (!copy || !ffd_grow((void **)&list->paths, &list->capacity, list->count + 1, sizeof *list->paths)) {
        ffd_free(copy);
        return ffd_fail_memory(error);
    }
    list->paths[list->count++] = copy;
    return FFD_OK;
}

void ffd_paths_free(path_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        ffd_free(list->paths[i]);
    ffd_free(list->paths);
    *list = (path_list){0};
}
