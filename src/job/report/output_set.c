#include "job/report/output_set.h"
#include "base/memory/memory.h"

ffd_status ffd_output_set_create(ffd_output_set **output_set, ffd_error *error)
{
    *output_set = ffd_alloc_zero(1, sizeof **output_set);
    return *output_set ? FFD_OK : ffd_fail_memory(error);
}

void ffd_known_users_free(known_users *known)
{
    ffd_users_free(&known->users);
    ffd_intern_free(&known->folders);
    *known = (known_users){0};
}

void ffd_output_set_destroy(ffd_output_set **output_set)
{
    if (!output_set || !*output_set)
        return;
    ffd_written_free(&(*output_set)->files);
    ffd_known_users_free(&(*output_set)->users);
    ffd_free(*output_set);
    *output_set = NULL;
}

ffd_status ffd_output_list_create(ffd_output_list **list, ffd_error *error)
{
    *list = ffd_alloc_zero(1, sizeof **list);
    return *list ? FFD_OK : ffd_fail_memory(error);
}

void ffd_output_list_destroy(ffd_output_list **list)
{
    if (!list || !*list)
        return;
    ffd_paths_free(&(*list)->names);
    ffd_free(*list);
    *list = NULL;
}

size_t ffd_output_list_count(const ffd_output_list *list)
{
    return list->names.count;
}

const char *ffd_output_list_name(const ffd_output_list *list, size_t index)
{
    return index < list->names.count ? list->names.paths[index] : NULL;
}
