/* draco_load.c - the functions of draco.h, by the module, which is loaded at the first decoding. */
#include "io/gltf/read/draco_module.h"

static module draco = {DRACO_IDENTITY, "Draco", NULL};

/* The functions of the loaded module: a mesh exists, so it is loaded. */
static const draco_module *loaded(void)
{
    return (const draco_module *)atomic_load(&draco.head);
}

ffd_status ffd_draco_decode(const unsigned char *bytes, size_t size, const draco_claim *claim,
                            const memory_budget *budget, draco_mesh **mesh, ffd_error *error)
{
    const module_head *head;
    const ffd_status status = ffd_module_load(&draco, &head, error);
    *mesh = NULL;
    return status ? status : loaded()->decode(bytes, size, claim, budget, mesh, error);
}

void ffd_draco_free(draco_mesh *mesh)
{
    if (mesh)
        loaded()->free(mesh);
}

size_t ffd_draco_point_count(const draco_mesh *mesh)
{
    return loaded()->point_count(mesh);
}

size_t ffd_draco_corner_count(const draco_mesh *mesh)
{
    return loaded()->corner_count(mesh);
}

ffd_status ffd_draco_attribute(const draco_mesh *mesh, uint32_t id, int component, int components,
                               size_t stride, unsigned char *bytes, ffd_error *error)
{
    return loaded()->attribute(mesh, id, component, components, stride, bytes, error);
}

double ffd_draco_step(const draco_mesh *mesh, uint32_t id)
{
    return loaded()->step(mesh, id);
}

ffd_status ffd_draco_indices(const draco_mesh *mesh, int component, unsigned char *bytes, ffd_error *error)
{
    return loaded()->indices(mesh, component, bytes, error);
}
