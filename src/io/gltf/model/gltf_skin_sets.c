#include "io/gltf/model/gltf_skin_sets.h"
#include <stdio.h>

static bool is_whole(const gltf_influence *influence)
{
    return influence->joints >= 0 && influence->weights >= 0;
}

static ffd_status note_half(gltf_document *d, uint32_t primitive, const gltf_influence *influence, size_t set,
                            ffd_error *error)
{
    const bool joints = influence->joints >= 0;
    const uint32_t attributes = ffd_json_span_member(&d->tree, primitive, "attributes");
    char key[40];
    snprintf(key, sizeof key, "%s_%zu", joints ? "JOINTS" : "WEIGHTS", set);
    return ffd_gltf_flaw(d, ffd_json_span_member(&d->tree, attributes, key), error,
                         "%s_%zu without %s_%zu is ignored", joints ? "JOINTS" : "WEIGHTS", set,
                         joints ? "WEIGHTS" : "JOINTS", set);
}

/* Ends the sets of a primitive before the first one that is not whole. If a whole one follows, its meaning is
   not plain: ffd_gltf_prepare_skins refuses it. */
static ffd_status settle_sets(gltf_document *d, uint32_t value, gltf_primitive *primitive, ffd_error *error)
{
    static const gltf_influence none = {-1, -1};
    size_t whole = 0;
    while (whole < primitive->influence_count && is_whole(&primitive->influences[whole]))
        whole++;
    for (size_t i = whole; i < primitive->influence_count; i++)
        if (is_whole(&primitive->influences[i]))
            return FFD_OK;
    const gltf_influence first = primitive->influence_count ? primitive->influences[0] : none;
    ffd_status status = FFD_OK;
    for (size_t i = whole; i < primitive->influence_count && whole > 0 && status == FFD_OK; i++)
        status = note_half(d, value, &primitive->influences[i], i, error);
    primitive->influence_count = whole;
    if (whole == 0)
        status =
            ffd_gltf_flaw(d, value, error,
                          "a node uses it with a skin, but it has no %s: it is placed by its node, without "
                          "the skin",
                          first.joints >= 0    ? "WEIGHTS_0"
                          : first.weights >= 0 ? "JOINTS_0"
                                               : "JOINTS_0 and WEIGHTS_0");
    return status;
}

/* Takes the skins of the nodes of a mesh away if they move none of its primitives. */
static void settle_nodes(gltf_document *d, size_t m)
{
    const gltf_mesh_uses *const uses = &d->mesh_uses[m];
    for (size_t p = 0; p < d->model.meshes[m].primitive_count; p++)
        if (ffd_gltf_is_skinned(&d->model.meshes[m].primitives[p]))
            return;
    for (size_t n = 0; n < uses->node_count; n++)
        d->model.nodes[uses->nodes[n]].skin = -1;
}

ffd_status ffd_gltf_settle_skins(gltf_document *d, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t m = 0; m < d->model.mesh_count && status == FFD_OK; m++) {
        gltf_mesh *const mesh = &d->model.meshes[m];
        if (!ffd_gltf_has_skin(d, &d->mesh_uses[m]))
            continue;
        for (size_t p = 0; p < mesh->primitive_count && status == FFD_OK; p++)
            if (mesh->primitives[p].accessor[GLTF_POSITION] >= 0)
                status = settle_sets(d, ffd_gltf_primitive_value(d, m, p), &mesh->primitives[p], error);
        settle_nodes(d, m);
    }
    return status;
}

bool ffd_gltf_places_mesh(const gltf_document *d, size_t node)
{
    const gltf_node *const placed = &d->model.nodes[node];
    const gltf_mesh *const mesh = placed->mesh < 0 ? NULL : &d->model.meshes[placed->mesh];
    bool places = mesh && placed->skin < 0;
    for (size_t p = 0; mesh && p < mesh->primitive_count && !places; p++)
        places = !ffd_gltf_is_skinned(&mesh->primitives[p]);
    return places;
}
