#include "io/gltf/edit/gltf_rig.h"
#include "base/memory/memory.h"

static void mark(size_t accessor, bool *used)
{
    if (accessor != GLTF_NONE)
        used[accessor] = true;
}

static void mark_animation(const gltf_animation *animation, const gltf_rig_animation *change, bool *used)
{
    for (size_t s = 0; s < animation->sampler_count; s++) {
        mark(animation->samplers[s].input, used);
        if (!change->contents || change->contents[s] == GLTF_NONE)
            mark(animation->samplers[s].output, used);
    }
    for (size_t i = 0; i < change->copy_count; i++)
        if (change->copies[i].content == GLTF_NONE)
            mark(animation->samplers[change->copies[i].sampler].output, used);
}

void ffd_gltf_mark_rig_originals(const gltf_document *d, const gltf_rig *rig, bool *used)
{
    for (size_t s = 0; s < d->skin_values.count; s++)
        if (d->skins[s].inverse_bind >= 0 && rig->skin_contents[s] == GLTF_NONE)
            used[d->skins[s].inverse_bind] = true;
    for (size_t a = 0; a < rig->animations.count; a++)
        mark_animation(&rig->animations.list[a], &rig->changes[a], used);
}

void ffd_gltf_free_rig(gltf_document *d, gltf_rig *rig)
{
    for (size_t a = 0; rig->changes && a < rig->animations.count; a++) {
        ffd_free(rig->changes[a].contents);
        ffd_free(rig->changes[a].channels);
        ffd_free(rig->changes[a].copies);
    }
    ffd_gltf_free_animations(d, &rig->animations);
    ffd_free(rig->changes);
    ffd_free(rig->skin_contents);
    ffd_free(rig->world);
    ffd_free(rig->motions);
    ffd_free(rig->nodes);
    for (size_t i = 0; d->mesh_parts && i < d->base.part_count; i++)
        d->mesh_parts[i].carried = false;
}
