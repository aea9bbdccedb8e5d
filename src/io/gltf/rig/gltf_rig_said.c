#include "io/gltf/rig/gltf_rig_said.h"
#include "base/text/words.h"

/* Physics shapes at nodes that move: what they are made of is not scaled. */
static size_t count_shapes(const mesh_places *places, const gltf_rig *rig)
{
    size_t count = 0;
    for (size_t i = 0; i < places->count; i++)
        count += places->list[i].kinds & PLACE_BIT(FFD_BEHIND_PHYSICS_SHAPE) &&
                 rig->motions[places->list[i].number].moved != GLTF_NONE;
    return count;
}

/* Nodes that had no rotation and have one now. */
static size_t count_turned(const gltf_document *d, const gltf_rig *rig)
{
    size_t count = 0;
    for (size_t i = 0; i < rig->node_count; i++) {
        const double *const old = d->model.nodes[rig->nodes[i].node].rotation;
        count += rig->nodes[i].rotates && old[0] == 0 && old[1] == 0 && old[2] == 0;
    }
    return count;
}

static bool has(const gltf_document *d, const char *extension, const char *member, const char *inside)
{
    const uint32_t value = ffd_json_span_member(&d->tree, ffd_gltf_extension(d, 0, extension), member);
    return ffd_json_span_member(&d->tree, value, inside) != JSON_NONE;
}

static void warn_of_vrm(const gltf_document *d, const gltf_rig *rig, const mesh_log *log)
{
    const bool is_old = ffd_gltf_has_extension(d, 0, "VRM");
    const size_t turned = is_old ? count_turned(d, rig) : 0;
    if (turned)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%zu %s in the default pose, where VRM 0.x wants none: viewers may pose it wrongly",
                     turned, ffd_plural(turned, "node has a rotation now", "nodes have rotations now"));
    if (ffd_gltf_has_extension(d, 0, "VRMC_springBone") || has(d, "VRM", "secondaryAnimation", "boneGroups"))
        ffd_log_line(log, FFD_LOG_WARNING,
                     "spring bones go with their nodes, but radii and offsets of them and of their colliders "
                     "stay");
    if (has(d, "VRMC_vrm", "lookAt", "offsetFromHeadBone") ||
        has(d, "VRM", "firstPerson", "firstPersonBoneOffset"))
        ffd_log_line(log, FFD_LOG_WARNING, "the offset of the eyes from the head bone (VRM) stays");
}

/* What is written otherwise. */
static void tell(const gltf_document *d, const gltf_rig *rig, const mesh_log *log)
{
    size_t skins = 0, animations = 0;
    for (size_t s = 0; s < d->skin_values.count; s++)
        skins += rig->skin_contents[s] != GLTF_NONE;
    for (size_t a = 0; a < rig->animations.count; a++)
        animations += rig->changes[a].contents != NULL;
    ffd_log_line(log, FFD_LOG_INFO, "%zu %s the deformation, and with %s %zu %s and %zu %s", rig->node_count,
                 ffd_plural(rig->node_count, "node follows", "nodes follow"),
                 ffd_plural(rig->node_count, "it", "them"), skins, ffd_plural(skins, "skin", "skins"),
                 animations, ffd_plural(animations, "animation", "animations"));
}

void ffd_gltf_warn_of_rig(const gltf_document *d, const mesh_places *places, const gltf_rig *rig,
                          const mesh_log *log)
{
    const size_t shapes = count_shapes(places, rig);
    if (rig->node_count == 0)
        return;
    tell(d, rig, log);
    if (shapes)
        ffd_log_line(log, FFD_LOG_WARNING, "%zu physics %s", shapes,
                     ffd_plural(shapes, "shape goes with its node, but keeps its size",
                                "shapes go with their nodes, but keep their sizes"));
    warn_of_vrm(d, rig, log);
    if (rig->pointers_left)
        ffd_log_line(
            log, FFD_LOG_WARNING, "%zu %s", rig->pointers_left,
            ffd_plural(rig->pointers_left,
                       "channel of KHR_animation_pointer drives a node that has moved, and stays as it is",
                       "channels of KHR_animation_pointer drive nodes that have moved, and stay as "
                       "they are"));
}
