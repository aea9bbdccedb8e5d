/* gltf_followed.c - the nodes, inverse bind matrices and keys of a skeleton whose rig follows the
   deformation. */
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/gltf_skeleton.h"
#include "io/gltf/model/gltf_scene.h"
#include "io/gltf/model/gltf_skin.h"
#include <string.h>

static const gltf_rig *rig_of(const gltf_skeleton *skeleton)
{
    return skeleton->follows ? &skeleton->document->edit->rig : NULL;
}

const double *ffd_gltf_skeleton_world(const gltf_skeleton *skeleton, size_t node)
{
    const gltf_rig *const rig = rig_of(skeleton);
    return (rig ? rig->world : skeleton->document->world) + 12 * node;
}

ffd_status ffd_gltf_follow_transforms(gltf_skeleton *skeleton, ffd_error *error)
{
    const gltf_rig *const rig = rig_of(skeleton);
    const size_t count = skeleton->document->model.node_count;
    if (!rig || count == 0)
        return FFD_OK;
    skeleton->nodes = ffd_alloc(count, sizeof *skeleton->nodes);
    if (!skeleton->nodes)
        return ffd_fail_memory(error);
    memcpy(skeleton->nodes, skeleton->document->model.nodes, count * sizeof *skeleton->nodes);
    for (size_t i = 0; i < rig->node_count; i++) {
        const gltf_moved_node *const moved = &rig->nodes[i];
        gltf_node *const node = &skeleton->nodes[moved->node];
        if (node->has_matrix) {
            memcpy(node->matrix, moved->matrix, sizeof node->matrix);
            continue;
        }
        if (moved->translates)
            memcpy(node->translation, moved->translation, sizeof node->translation);
        if (moved->rotates)
            memcpy(node->rotation, moved->rotation, sizeof node->rotation);
    }
    return FFD_OK;
}

ffd_status ffd_gltf_skeleton_binds(const gltf_skeleton *skeleton, size_t skin, const double *unmoved,
                                   double *binds, ffd_error *error)
{
    const gltf_rig *const rig = rig_of(skeleton);
    const gltf_skin *const of = &skeleton->document->skins[skin];
    if (!rig || rig->skin_contents[skin] == GLTF_NONE)
        return ffd_gltf_joint_matrices(skeleton->document, of, unmoved, binds, error);
    const float *const values = skeleton->document->edit->contents[rig->skin_contents[skin]].values;
    for (size_t j = 0; j < of->joint_count; j++)
        for (size_t r = 0; r < 3; r++) {
            for (size_t c = 0; c < 3; c++)
                binds[12 * j + 3 * r + c] = values[16 * j + 4 * c + r];
            binds[12 * j + 9 + r] = values[16 * j + 12 + r];
        }
    return FFD_OK;
}

static void put_content(const gltf_content *content, double *values)
{
    for (size_t i = 0; i < content->count * content->width; i++)
        values[i] = content->values[i];
}

static size_t value_count(const gltf_animation_sampler *keys)
{
    return keys->key_count * keys->width * (keys->interpolation == GLTF_CUBICSPLINE ? 3 : 1);
}

/* Copies a sampler with its keys. */
static ffd_status copy_sampler(gltf_skeleton *skeleton, const gltf_animation_sampler *from,
                               gltf_animation_sampler *to, ffd_error *error)
{
    const size_t count = value_count(from);
    *to = *from;
    to->times = to->values = NULL;
    if (!from->times)
        return FFD_OK;
    TRY(ffd_gltf_skeleton_take(skeleton, count + from->key_count, sizeof(double), error));
    to->times = ffd_alloc(from->key_count, sizeof *to->times);
    to->values = ffd_alloc(count, sizeof *to->values);
    if (!to->times || !to->values)
        return ffd_fail_memory(error);
    memcpy(to->times, from->times, from->key_count * sizeof *to->times);
    memcpy(to->values, from->values, count * sizeof *to->values);
    return FFD_OK;
}

static ffd_status add_copies(gltf_skeleton *skeleton, const gltf_rig_animation *change,
                             gltf_animation *animation, ffd_error *error)
{
    const size_t own = animation->sampler_count;
    TRY(ffd_gltf_skeleton_take(skeleton, change->copy_count, sizeof *animation->samplers, error));
    gltf_animation_sampler *const samplers =
        ffd_realloc(animation->samplers, own + change->copy_count, sizeof *samplers);
    if (!samplers)
        return ffd_fail_memory(error);
    animation->samplers = samplers;
    for (size_t i = 0; i < change->copy_count; i++) {
        animation->sampler_count++; /* a copy that fails is freed too */
        TRY(copy_sampler(skeleton, &samplers[change->copies[i].sampler], &samplers[own + i], error));
    }
    return FFD_OK;
}

ffd_status ffd_gltf_follow_keys(gltf_skeleton *skeleton, size_t index, ffd_error *error)
{
    const gltf_rig *const rig = rig_of(skeleton);
    gltf_animation *const animation = &skeleton->animations.list[index];
    const gltf_rig_animation *const change = rig ? &rig->changes[index] : NULL;
    const size_t own = animation->sampler_count;
    if (!change || !change->contents)
        return FFD_OK;
    TRY(add_copies(skeleton, change, animation, error));
    for (size_t s = 0; s < animation->sampler_count; s++) {
        const size_t content = s < own ? change->contents[s] : change->copies[s - own].content;
        if (content != GLTF_NONE && animation->samplers[s].values)
            put_content(&skeleton->document->edit->contents[content], animation->samplers[s].values);
    }
    for (size_t c = 0; c < animation->channel_count; c++)
        if (animation->channels[c].sampler != GLTF_NONE)
            animation->channels[c].sampler = change->channels[c];
    return FFD_OK;
}
