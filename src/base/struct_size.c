#include "base/struct_size.h"
#include <string.h>

ffd_status ffd_struct_check(size_t own_size, const void *callers, const char *name, ffd_error *error)
{
    size_t size;
    memcpy(&size, callers, sizeof size);
    if (size < sizeof size)
        return ffd_fail(error, FFD_E_ARGUMENT, "%s has no struct_size: %s_init or the caller must set it",
                        name, name);
    if (size > own_size)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "%s has %zu bytes, and this library knows %zu: it is older than the caller's header",
                        name, size, own_size);
    return FFD_OK;
}

ffd_status ffd_struct_take(void *own, size_t own_size, const void *callers, const char *name,
                           ffd_error *error)
{
    TRY(ffd_struct_check(own_size, callers, name, error));
    size_t size;
    memcpy(&size, callers, sizeof size);
    memcpy(own, callers, size);
    memcpy(own, &own_size, sizeof own_size);
    return FFD_OK;
}

void ffd_struct_give(const void *own, size_t own_size, void *callers, size_t size)
{
    memcpy(callers, own, size < own_size ? size : own_size);
    if (size >= sizeof size)
        memcpy(callers, &size, sizeof size);
}
