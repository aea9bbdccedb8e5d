/* meshopt_load.c - decodes and simplifies with the module, which is loaded on first use. */
#include "mesh/meshopt/meshopt_module.h"

static module meshopt = {MESHOPT_IDENTITY, "meshopt", NULL};

ffd_status ffd_meshopt_library_ready(ffd_error *error)
{
    const module_head *head;
    return ffd_module_load(&meshopt, &head, error);
}

ffd_status ffd_meshopt_library_decode(const meshopt_view *view, unsigned char *bytes, ffd_error *error)
{
    const module_head *head;
    TRY(ffd_module_load(&meshopt, &head, error));
    return ((const meshopt_module *)head)->decode(view, bytes, error);
}

ffd_status ffd_meshopt_simplify(const meshopt_mesh *mesh, size_t target, bool is_rough, uint32_t *result,
                                size_t *count, ffd_error *error)
{
    const module_head *head;
    TRY(ffd_module_load(&meshopt, &head, error));
    return ((const meshopt_module *)head)->simplify(mesh, target, is_rough, result, count, error);
}
