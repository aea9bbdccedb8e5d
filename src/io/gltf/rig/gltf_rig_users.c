#include "io/gltf/rig/gltf_rig_users.h"
#include "io/gltf/rig/gltf_rig.h"

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

void ffd_gltf_mark_rig_originals(const gltf_document *d, bool *used)
{
    for (size_t s = 0; s < d->skin_values.count; s++)
        if (d->skins[s].inverse_bind >= 0 && d->rig->skin_contents[s] == GLTF_NONE)
            used[d->skins[s].inverse_bind] = true;
    for (size_t a = 0; a < d->rig->animations.count; a++)
        mark_animation(&d->rig->animations.list[a], &d->rig->changes[a], used);
}
