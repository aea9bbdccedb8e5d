/* check_animations.c - animations that load give finite poses between their keys. */
#include "check_animations.h"
#include "io/gltf/model/gltf_pose.h"
#include "promise.h"
#include <math.h>

#define WIDEST 64 /* numbers of a value that are looked at */

static void check_samples(const gltf_animation *animation, double time)
{
    for (size_t c = 0; c < animation->channel_count; c++) {
        const gltf_channel *const channel = &animation->channels[c];
        double value[WIDEST];
        if (!ffd_gltf_channel_drives(channel) || animation->samplers[channel->sampler].width > WIDEST)
            continue;
        ffd_gltf_sample(&animation->samplers[channel->sampler], channel->path == GLTF_ROTATION, time, value);
        for (size_t i = 0; i < animation->samplers[channel->sampler].width; i++)
            PROMISE(isfinite(value[i]), "number %zu is %g at %g", i, value[i], time);
    }
}

static void check_animation(gltf_document *d, gltf_animation *animation, gltf_pose *pose)
{
    const uint64_t before = d->base.budget.taken;
    if (ffd_gltf_load_animation(d, animation, NULL) == FFD_OK) {
        PROMISE(animation->begin <= animation->end, "it ends at %g, before %g", animation->end,
                animation->begin);
        for (int i = -1; i <= 5; i++) {
            const double time = animation->begin + (animation->end - animation->begin) * i / 4;
            check_samples(animation, time);
            ffd_gltf_set_pose(d, animation, time, pose);
        }
        ffd_gltf_unload_animation(d, animation);
    }
    PROMISE(d->base.budget.taken == before, "the budget has lost memory");
}

void check_animations(mesh_document *document)
{
    gltf_document *const d = (gltf_document *)document;
    gltf_animations animations = {0};
    gltf_pose pose = {0};
    const uint64_t before = d->base.budget.taken;
    if (ffd_gltf_list_animations(d, &animations, NULL) == FFD_OK &&
        ffd_gltf_make_pose(d, &pose, NULL) == FFD_OK) {
        for (size_t a = 0; a < animations.count; a++)
            check_animation(d, &animations.list[a], &pose);
    }
    ffd_gltf_free_pose(&pose);
    ffd_gltf_free_animations(d, &animations);
    PROMISE(d->base.budget.taken == before, "the budget has lost memory");
}
