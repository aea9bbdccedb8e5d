#include "mesh/resource/resource_list.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "mesh/resource/image_file.h"
#include <stdlib.h>
#include <string.h>

const resource_kind ffd_resource_image = {.name = "image",
                                          .has_name = ffd_image_has_name,
                                          .has_content = ffd_image_has_content,
                                          .other_name = "does not have the ending of an image",
                                          .other_content = "does not have the content of an image"};

ffd_status ffd_resources_add(resource_list *list, const resource_kind *kind, size_t index, char *path,
                             ffd_error *error)
{
    uint32_t key;
    const bool interned = ffd_intern(&list->known, path, strlen(path), &key);
    const bool is_new = interned && key == list->count;
    if (!is_new ||
        !ffd_grow((void **)&list->resources, &list->capacity, list->count + 1, sizeof *list->resources)) {
        ffd_free(path);
        return interned && !is_new ? FFD_OK : ffd_fail_memory(error);
    }
    list->resources[list->count++] = (mesh_resource){path, kind, index};
    return FFD_OK;
}

static int compare(const void *a, const void *b)
{
    return strcmp(((const mesh_resource *)a)->path, ((const mesh_resource *)b)->path);
}

void ffd_resources_sort(resource_list *list)
{
    if (list->count > 0)
        qsort(list->resources, list->count, sizeof *list->resources, compare);
}

void ffd_resources_free(resource_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        ffd_free(list->resources[i].path);
    ffd_free(list->resources);
    ffd_intern_free(&list->known);
    *list = (resource_list){0};
}

ffd_status ffd_resource_add_named(const char *path, const char *relative, const mesh_named *named,
                                  ffd_error *error)
{
    char *const file = ffd_path_sibling(path, relative);
    ffd_status status;
    TRY_END(file ? FFD_OK : ffd_fail_memory(error));
    if (named->files)
        TRY_END(ffd_paths_add(named->files, file, error));
    if (named->copies && !ffd_path_leads_out(relative))
        TRY_END(ffd_paths_add(named->copies, file, error));
end:
    ffd_free(file);
    return status;
}
