#include "io/obj/resource/resource_names.h"

ffd_status ffd_obj_add_name(intern_table *names, const char *name, size_t size, const char *file,
                            ffd_error *error)
{
    uint32_t number;
    if (!ffd_intern(names, name, size, &number))
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
