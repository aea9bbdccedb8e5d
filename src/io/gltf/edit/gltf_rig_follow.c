/* gltf_rig_follow.c - makes the nodes, skins and animations of a file follow the deformation. */
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_rig.h"
#include "io/gltf/model/gltf_functions.h"

/* Checks the memory of the arrays, which opening the file has not counted. */
static ffd_status check_memory(const gltf_document *d, ffd_error *error)
{
    return ffd_budget_check(&d->base.budget, d->model.node_count,
                            12 * sizeof(double) + sizeof(gltf_node_motion) + sizeof(gltf_moved_node), error);
}

ffd_status ffd_gltf_follow(mesh_document *document, const mesh_places *places, mesh_place_move *moves,
                           const mesh_log *log, mesh_following *following, ffd_error *error)
{
    gltf_document *const d = (gltf_document *)document;
    ffd_gltf_free_rig(d);
    *following = (mesh_following){0};
    ffd_status status = check_memory(d, error);
    if (status)
        return status;
    d->rig = ffd_alloc_zero(1, sizeof *d->rig);
    if (!d->rig)
        return ffd_fail_memory(error);
    d->rig->budget = &d->base.budget;
    status = ffd_gltf_follow_nodes(d, places, moves, d->rig, following, error);
    if (status == FFD_OK)
        status = ffd_gltf_follow_skins(d, places, moves, d->rig, error);
    if (status == FFD_OK)
        status = ffd_gltf_follow_animations(d, d->rig, error);
    if (status == FFD_OK)
        status = ffd_gltf_warn_of_rig(d, places, d->rig, log, following, error);
    if (status)
        ffd_gltf_free_rig(d);
    return status;
}
