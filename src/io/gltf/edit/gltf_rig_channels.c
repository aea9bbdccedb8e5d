/* gltf_rig_channels.c - changes the animations of nodes that follow the deformation: the outputs of their
   channels. */
#include "base/memory/memory.h"
#include "base/vector/polar.h"
#include "base/vector/vec.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/model/gltf_scene.h"
#include "io/gltf/read/gltf_index_table.h"
#include <float.h>
#include <string.h>

/* How the values of an output change: everything that this depends on. All members are as wide as a double: a
   key has no padding. */
typedef struct change_key {
    double turn[4];                  /* rotations q become turn q */
    double carry[9], rest[3], to[3]; /* translations t become to + carry (t - rest) */
    uint64_t accessor, path, cubic;
} change_key;

_Static_assert(sizeof(change_key) == 22 * sizeof(double), "a key has no padding");

typedef struct channel_work {
    gltf_document *document;
    gltf_rig *rig;
    intern_table keys; /* the changes made so far */
    size_t *results;   /* per key: index of the content; GLTF_NONE: no value changes */
    size_t capacity;
    ffd_error *error;
} channel_work;

/* Whether a channel drives a property of its node that has changed. */
static bool is_concerned(const gltf_rig *rig, const gltf_channel *channel)
{
    if (!ffd_gltf_channel_drives(channel) || channel->sampler == GLTF_NONE)
        return false;
    const gltf_node_motion *const motion = &rig->motions[channel->node];
    const bool translates = motion->moved != GLTF_NONE && rig->nodes[motion->moved].translates;
    return channel->path == GLTF_ROTATION
               ? motion->turns
               : channel->path == GLTF_TRANSLATION && (motion->carries || translates);
}

static change_key describe(const channel_work *w, const gltf_channel *channel,
                           const gltf_animation_sampler *sampler)
{
    const gltf_node_motion *const motion = &w->rig->motions[channel->node];
    const gltf_node *const node = &w->document->model.nodes[channel->node];
    double linear[9];
    change_key key;
    memset(&key, 0, sizeof key);
    key.accessor = sampler->output;
    key.path = (uint64_t)channel->path;
    key.cubic = sampler->interpolation == GLTF_CUBICSPLINE;
    if (channel->path == GLTF_ROTATION) {
        memcpy(key.turn, motion->turn, sizeof key.turn);
        return key;
    }
    memcpy(key.carry, motion->carry, sizeof key.carry);
    if (!motion->carries)
        for (int i = 0; i < 9; i++)
            key.carry[i] = i % 4 == 0;
    ffd_gltf_local_matrix(node, linear, key.rest);
    memcpy(key.to, key.rest, sizeof key.to);
    if (motion->moved != GLTF_NONE && w->rig->nodes[motion->moved].translates)
        memcpy(key.to,
               node->has_matrix ? w->rig->nodes[motion->moved].matrix + 12
                                : w->rig->nodes[motion->moved].translation,
               sizeof key.to);
    return key;
}

/* is_tangent: a tangent of a cubic spline. It is a difference, so it is turned but not moved. */
static void change_value(const change_key *key, bool is_tangent, const double *value, double *made)
{
    double from[3];
    if (key->path == GLTF_ROTATION) {
        ffd_quaternion_multiply(key->turn, value, made);
        return;
    }
    for (int a = 0; a < 3; a++)
        from[a] = value[a] - (is_tangent ? 0 : key->rest[a]);
    mat_apply(key->carry, from, made);
    for (int a = 0; a < 3; a++)
        made[a] += is_tangent ? 0 : key->to[a];
}

/* Clamps the components of rotations, except tangents, to the range of unit quaternions. */
static float as_stored(const change_key *key, bool is_tangent, double value)
{
    if (key->path == GLTF_ROTATION && !is_tangent)
        value = value < -1 ? -1 : value > 1 ? 1 : value;
    return (float)value;
}

/* Fills the new elements of an output. *changes: whether any value differs. */
static ffd_status fill_values(const channel_work *w, const change_key *key,
                              const gltf_animation_sampler *sampler, const gltf_content *content,
                              bool *changes)
{
    const size_t width = content->width;
    *changes = false;
    for (size_t i = 0; i < content->count; i++) {
        const bool is_tangent = key->cubic && i % 3 != 1;
        const double *const old = sampler->values + width * i;
        float *const values = content->values + width * i;
        double made[4];
        change_value(key, is_tangent, old, made);
        for (size_t c = 0; c < width; c++) {
            if (!(fabs(made[c]) <= FLT_MAX))
                return ffd_json_tree_fail(
                    &w->document->tree, sampler->value, w->document->name, FFD_E_INVALID, w->error,
                    "with the deformation, element %zu of the sampler's output is too large for floats", i);
            values[c] = as_stored(key, is_tangent, made[c]);
            *changes = *changes || values[c] != (float)old[c];
        }
    }
    return FFD_OK;
}

static ffd_status make_content(const channel_work *w, const change_key *key,
                               const gltf_animation_sampler *sampler, size_t *index)
{
    gltf_content content = {.accessor = sampler->output,
                            .count = sampler->key_count * (key->cubic ? 3 : 1),
                            .width = key->path == GLTF_ROTATION ? 4 : 3};
    bool changes;
    *index = GLTF_NONE;
    TRY(ffd_gltf_make_elements(w->document->edit, &content, w->error));
    ffd_status status = fill_values(w, key, sampler, &content, &changes);
    if (status || !changes) {
        ffd_gltf_free_elements(w->document->edit, &content);
        return status;
    }
    *index = ffd_gltf_add_content(w->document->edit, &content);
    return *index == GLTF_NONE ? ffd_fail_memory(w->error) : FFD_OK;
}

/* Finds the content that a channel needs as its sampler's output; GLTF_NONE: the original output. */
static ffd_status find_content(channel_work *w, const gltf_channel *channel,
                               const gltf_animation_sampler *sampler, size_t *content)
{
    uint32_t index;
    *content = GLTF_NONE;
    if (sampler->key_count == 0)
        return FFD_OK;
    const change_key key = describe(w, channel, sampler);
    const size_t known = w->keys.count;
    if (!ffd_intern(&w->keys, &key, sizeof key, &index) ||
        !ffd_grow((void **)&w->results, &w->capacity, w->keys.count, sizeof *w->results))
        return ffd_fail_memory(w->error);
    ffd_status status = FFD_OK;
    if (index == known)
        status = make_content(w, &key, sampler, &w->results[index]);
    *content = status ? GLTF_NONE : w->results[index];
    return status;
}

/* Chooses a sampler with this content as output: the channel's own if no earlier channel needs another output
   of it, else a copy. taken: per sampler, whether a channel uses it. */
static bool choose_sampler(const gltf_animation *animation, size_t own, size_t content, bool *taken,
                           intern_table *copies, gltf_rig_animation *change, size_t *chosen)
{
    const size_t key[] = {own, content};
    uint32_t index;
    if (!taken[own])
        change->contents[own] = content;
    taken[own] = true;
    *chosen = own;
    if (change->contents[own] == content)
        return true;
    if (!ffd_intern(copies, key, sizeof key, &index))
        return false;
    *chosen = animation->sampler_count + index;
    if (index < change->copy_count)
        return true;
    if (!ffd_grow((void **)&change->copies, &change->copy_capacity, change->copy_count + 1,
                  sizeof *change->copies))
        return false;
    change->copies[change->copy_count++] = (gltf_sampler_copy){own, content};
    return true;
}

/* Gives every channel a sampler with the output that it needs. */
static ffd_status follow_channels(channel_work *w, const gltf_animation *animation,
                                  gltf_rig_animation *change)
{
    bool *const taken = ffd_alloc_zero(animation->sampler_count, sizeof *taken);
    intern_table copies = {0};
    ffd_status status;
    TRY_END(taken ? FFD_OK : ffd_fail_memory(w->error));
    for (size_t c = 0; c < animation->channel_count; c++) {
        const gltf_channel *const channel = &animation->channels[c];
        size_t content = GLTF_NONE;
        change->channels[c] = channel->sampler;
        if (channel->sampler == GLTF_NONE)
            continue;
        if (is_concerned(w->rig, channel))
            TRY_END(find_content(w, channel, &animation->samplers[channel->sampler], &content));
        if (!choose_sampler(animation, channel->sampler, content, taken, &copies, change,
                            &change->channels[c]))
            TRY_END(ffd_fail_memory(w->error));
    }
end:
    ffd_intern_free(&copies);
    ffd_free(taken);
    return status;
}

static ffd_status follow_animation(channel_work *w, gltf_animation *animation, gltf_rig_animation *change)
{
    TRY(ffd_gltf_load_animation(w->document, animation, w->error));
    change->contents = ffd_alloc(animation->sampler_count, sizeof *change->contents);
    change->channels = ffd_alloc(animation->channel_count, sizeof *change->channels);
    ffd_status status = FFD_OK;
    if (!change->contents || !change->channels)
        TRY_END(ffd_fail_memory(w->error));
    for (size_t s = 0; s < animation->sampler_count; s++)
        change->contents[s] = GLTF_NONE;
    TRY_END(follow_channels(w, animation, change));
end:
    ffd_gltf_unload_animation(w->document, animation);
    return status;
}

/* Whether a channel has an unsupported pointer to the transform of a node that changes. */
static bool is_left(const gltf_document *d, const gltf_rig *rig, const gltf_channel *channel)
{
    static const char *const parts[] = {"/translation", "/rotation", "/scale", "/matrix"};
    const char *rest = "";
    if (!channel->pointer || channel->path != GLTF_NO_PATH)
        return false;
    const size_t node = ffd_gltf_pointed(channel->pointer, "nodes", &rest);
    bool found = false;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        found = found || strncmp(rest, parts[i], strlen(parts[i])) == 0;
    return found && node < d->model.node_count && rig->motions[node].moved != GLTF_NONE;
}

ffd_status ffd_gltf_follow_animations(gltf_document *d, ffd_error *error)
{
    gltf_rig *const rig = &d->edit->rig;
    channel_work w = {.document = d, .rig = rig, .error = error};
    TRY(ffd_gltf_list_animations(d, &rig->animations, error));
    rig->changes = ffd_alloc_zero(rig->animations.count, sizeof *rig->changes);
    if (!rig->changes)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (size_t a = 0; a < rig->animations.count; a++) {
        gltf_animation *const animation = &rig->animations.list[a];
        bool concerned = false;
        for (size_t c = 0; c < animation->channel_count; c++) {
            concerned = concerned || is_concerned(rig, &animation->channels[c]);
            rig->pointers_left += is_left(d, rig, &animation->channels[c]);
        }
        if (concerned)
            TRY_END(follow_animation(&w, animation, &rig->changes[a]));
    }
end:
    ffd_intern_free(&w.keys);
    ffd_free(w.results);
    return status;
}
