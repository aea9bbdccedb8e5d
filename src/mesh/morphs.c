#include "mesh/morphs.h"
#include "base/memory/memory.h"

void ffd_mesh_targets_free(mesh_targets *targets)
{
    for (size_t t = 0; t < targets->count; t++)
        ffd_free(targets->list[t].name);
    ffd_free(targets->list);
    *targets = (mesh_targets){0};
}
