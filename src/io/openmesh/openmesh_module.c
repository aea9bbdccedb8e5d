#include "io/openmesh/openmesh_module.h"
#include "base/system/deadline.h"
#include "base/system/exceptions.h"

FFD_API extern const openmesh_module ffd_module;

const openmesh_module ffd_module = {
    {OPENMESH_IDENTITY, ffd_exceptions_prepare, ffd_spell_members, ffd_deadline_ask},
    ffd_topology_compute,
    ffd_normals_of_groups,
};
