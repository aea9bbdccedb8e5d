/* openmesh_load.c - the functions of topology.h and normals.h, by the module, which is loaded at the first
   call. */
#include "io/openmesh/openmesh_module.h"

static ffd_status load(const openmesh_module **functions, ffd_error *error)
{
    static module openmesh = {OPENMESH_IDENTITY, "topology and normals from faces", NULL};
    const module_head *head;
    const ffd_status status = ffd_module_load(&openmesh, &head, error);
    *functions = (const openmesh_module *)head;
    return status;
}

ffd_status ffd_topology_compute(const mesh_faces *faces, mesh_topology *topology, ffd_error *error)
{
    const openmesh_module *functions;
    TRY(load(&functions, error));
    return functions->topology(faces, topology, error);
}

ffd_status ffd_normals_of_groups(const mesh_faces *faces, const double *positions, const uint32_t *groups,
                                 size_t group_count, const uint8_t *mirrored, double *directions,
                                 ffd_error *error)
{
    const openmesh_module *functions;
    TRY(load(&functions, error));
    return functions->normals(faces, positions, groups, group_count, mirrored, directions, error);
}
