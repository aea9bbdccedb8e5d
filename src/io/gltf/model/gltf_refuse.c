#include "io/gltf/model/gltf_refuse.h"
#include "base/memory/memory.h"
#include "io/gltf/model/gltf_required.h"
#include "io/gltf/read/gltf_draco.h"
#include "io/gltf/read/gltf_views.h"
#include <string.h>

static ffd_status refuse(const gltf_document *d, uint32_t value, ffd_error *error, const char *what)
{
    return ffd_json_span_fail(&d->tree, value, d->name, FFD_E_UNSUPPORTED, error, "%s", what);
}

ffd_status ffd_gltf_refuse_unreadable(const gltf_document *d, size_t mesh, size_t primitive, int accessor,
                                      ffd_error *error)
{
    ffd_status status = ffd_gltf_refuse_draco(d, mesh, primitive, error);
    if (status || d->layouts[accessor].readable)
        return status;
    const uint32_t value = d->accessor_values.values[accessor];
    if (d->unpacked[accessor].clash)
        return refuse(d, value, error,
                      "primitives read different values for the accessor, from Draco data and from "
                      "elsewhere: this is not supported");
    if (d->model.accessors[accessor].view >= 0)
        status = ffd_gltf_refuse_view(d, (size_t)d->model.accessors[accessor].view, error);
    return status ? status : refuse(d, value, error, "an accessor without bytes is not supported");
}

static ffd_status refuse_primitive(const gltf_document *d, size_t m, size_t p, ffd_error *error)
{
    const gltf_primitive *primitive = &d->model.meshes[m].primitives[p];
    if (primitive->accessor[GLTF_POSITION] < 0)
        return FFD_OK;
    ffd_status status = ffd_gltf_refuse_unreadable(d, m, p, primitive->accessor[GLTF_POSITION], error);
    for (size_t s = GLTF_DEFORMED; s < gltf_vector_slots(primitive) && status == FFD_OK; s++)
        if (gltf_slot_accessor(primitive, s) >= 0)
            status = ffd_gltf_refuse_unreadable(d, m, p, gltf_slot_accessor(primitive, s), error);
    return status;
}

/* Refuses a skin whose joints or weights cannot be read: they move the vertices of the node. */
static ffd_status refuse_skin(const gltf_document *d, size_t node, ffd_error *error)
{
    const size_t m = (size_t)d->model.nodes[node].mesh;
    const gltf_skin *skin = d->model.nodes[node].skin < 0 ? NULL : &d->skins[d->model.nodes[node].skin];
    ffd_status status = FFD_OK;
    for (size_t p = 0; skin && p < d->model.meshes[m].primitive_count && status == FFD_OK; p++) {
        const gltf_primitive *primitive = &d->model.meshes[m].primitives[p];
        if (primitive->accessor[GLTF_POSITION] < 0)
            continue; /* nothing to move, and nobody has checked its influences */
        if (skin->inverse_bind >= 0)
            status = ffd_gltf_refuse_unreadable(d, m, p, skin->inverse_bind, error);
        for (size_t i = 0; i < primitive->influence_count && status == FFD_OK; i++) {
            status = ffd_gltf_refuse_unreadable(d, m, p, primitive->influences[i].joints, error);
            if (status == FFD_OK)
                status = ffd_gltf_refuse_unreadable(d, m, p, primitive->influences[i].weights, error);
        }
    }
    return status;
}

static ffd_status refuse_shared_child(const gltf_document *d, ffd_error *error)
{
    if (d->shared_child == GLTF_NONE || d->space == FFD_SPACE_MESH)
        return FFD_OK;
    return ffd_json_span_fail(&d->tree, d->node_values.values[d->shared_child], d->name, FFD_E_INVALID, error,
                              "the node is a child of both node %zu and node %zu", d->shared_by[0],
                              d->shared_by[1]);
}

/* A reader of 2.0 can read any 2.x unless the file requires a newer version (glTF 2.0, 3.2). */
static ffd_status refuse_newer_version(const gltf_document *d, ffd_error *error)
{
    const uint32_t version =
        ffd_json_span_member(&d->tree, ffd_json_span_member(&d->tree, 0, "asset"), "minVersion");
    if (version == JSON_NONE)
        return FFD_OK;
    char *text = ffd_json_span_string(&d->tree, version, NULL);
    if (!text)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    if (strcmp(text, "2.0") != 0)
        status = ffd_json_span_fail(&d->tree, version, d->name, FFD_E_UNSUPPORTED, error,
                                    "the file needs glTF %s, but only 2.0 is supported", text);
    ffd_free(text);
    return status;
}

/* Refuses geometry that an extension holds, with or without --allow-extension. */
static ffd_status refuse_held(const gltf_document *d, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count && d->mesh_uses[m].node_count > 0; p++)
            if (status == FFD_OK)
                status = ffd_gltf_refuse_held(d, m, p, error);
    return status;
}

ffd_status ffd_gltf_refuse_read(const gltf_document *d, ffd_error *error)
{
    ffd_status status = refuse_newer_version(d, error);
    if (status == FFD_OK)
        status = refuse_shared_child(d, error);
    if (status == FFD_OK)
        status = refuse_held(d, error);
    if (status == FFD_OK)
        status = ffd_gltf_refuse_required(d, error);
    if (status == FFD_OK && d->skins_status) {
        if (error)
            *error = d->skins_error;
        return d->skins_status;
    }
    if (status == FFD_OK && d->instancing_status) {
        if (error)
            *error = d->instancing_error;
        return d->instancing_status;
    }
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        const gltf_mesh_uses *uses = &d->mesh_uses[m];
        for (size_t p = 0; p < d->model.meshes[m].primitive_count && uses->node_count > 0 && status == FFD_OK;
             p++)
            status = refuse_primitive(d, m, p, error);
        for (size_t n = 0; uses->nodes && n < uses->node_count && status == FFD_OK; n++)
            status = refuse_skin(d, uses->nodes[n], error);
    }
    return status;
}

/* Refuses accessors that cannot be read: results could be written neither in place nor into a copy. */
ffd_status ffd_gltf_refuse_store(const gltf_document *d, bool normals, bool tangents, ffd_error *error)
{
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        for (size_t p = 0; p < d->model.meshes[m].primitive_count && d->mesh_uses[m].node_count > 0; p++) {
            const gltf_primitive *primitive = &d->model.meshes[m].primitives[p];
            const bool wanted[GLTF_DEFORMED] = {true, normals,
                                                tangents && primitive->accessor[GLTF_NORMAL] >= 0};
            for (size_t s = 0; s < gltf_vector_slots(primitive) && primitive->accessor[GLTF_POSITION] >= 0;
                 s++) {
                const int accessor = gltf_slot_accessor(primitive, s);
                if (!wanted[s % GLTF_DEFORMED] || accessor < 0)
                    continue;
                const ffd_status status = ffd_gltf_refuse_unreadable(d, m, p, accessor, error);
                if (status)
                    return status;
            }
        }
    }
    return FFD_OK;
}
