#include "io/gltf/model/gltf_animation.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/read/gltf_index_table.h"
#include "io/gltf/read/gltf_views.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static gltf_path path_of(const char *text)
{
    static const char *const names[GLTF_NO_PATH] = {"translation", "rotation", "scale", "weights"};
    size_t path = 0;
    while (path < GLTF_NO_PATH && strcmp(text, names[path]) != 0)
        path++;
    return (gltf_path)path;
}

static gltf_interpolation interpolation_of(const gltf_document *d, uint32_t sampler)
{
    static const char *const names[GLTF_NO_INTERPOLATION] = {"STEP", "LINEAR", "CUBICSPLINE"};
    const uint32_t member = ffd_json_tree_member(&d->tree, sampler, "interpolation");
    size_t kind = 0;
    if (member == JSON_NONE)
        return GLTF_LINEAR;
    if (d->tree.values[member].kind != JSON_STRING)
        return GLTF_NO_INTERPOLATION;
    while (kind < GLTF_NO_INTERPOLATION && !ffd_json_tree_string_is(&d->tree, member, names[kind]))
        kind++;
    return (gltf_interpolation)kind;
}

static size_t accessor_of(const gltf_document *d, uint32_t sampler, const char *key)
{
    return ffd_gltf_index(d, ffd_json_tree_member(&d->tree, sampler, key), d->model.accessor_count);
}

/* Takes the node and the path of a pointer like "/nodes/3/rotation". */
static void follow_pointer(const gltf_document *d, gltf_channel *channel, uint32_t value)
{
    const char *rest = "";
    const size_t node = ffd_gltf_pointed(channel->pointer, "nodes", &rest);
    if (strncmp(channel->pointer, "/nodes/", 7) != 0)
        return;
    if (node >= d->model.node_count || *rest != '/') {
        channel->fault = value;
        return;
    }
    channel->path = path_of(rest + 1);
    channel->node = channel->path == GLTF_NO_PATH ? GLTF_NONE : node;
}

static ffd_status read_pointer(const gltf_document *d, uint32_t extension, gltf_channel *channel,
                               ffd_error *error)
{
    const uint32_t pointer = ffd_json_tree_member(&d->tree, extension, "pointer");
    channel->fault = pointer == JSON_NONE ? extension : pointer;
    if (pointer == JSON_NONE || d->tree.values[pointer].kind != JSON_STRING)
        return FFD_OK;
    channel->fault = JSON_NONE;
    channel->pointer = ffd_json_tree_string(&d->tree, pointer, NULL);
    if (!channel->pointer)
        return ffd_fail_memory(error);
    follow_pointer(d, channel, pointer);
    return FFD_OK;
}

/* Reads the path of a target without KHR_animation_pointer. A target without a node belongs to another
   extension: a channel that is not understood is left out, as the specification says. */
static ffd_status read_path(const gltf_document *d, uint32_t target, gltf_channel *channel, ffd_error *error)
{
    const uint32_t node = ffd_json_tree_member(&d->tree, target, "node");
    const uint32_t path = ffd_json_tree_member(&d->tree, target, "path");
    if (path == JSON_NONE || d->tree.values[path].kind != JSON_STRING) {
        channel->fault = path != JSON_NONE ? path : target != JSON_NONE ? target : channel->value;
        return FFD_OK;
    }
    const size_t index = ffd_gltf_node(d, node);
    if (node == JSON_NONE || index == GLTF_NONE) {
        channel->fault = node;
        return FFD_OK;
    }
    char *text = ffd_json_tree_string(&d->tree, path, NULL);
    if (!text)
        return ffd_fail_memory(error);
    channel->path = path_of(text);
    channel->node = channel->path == GLTF_NO_PATH ? GLTF_NONE : index;
    channel->fault = channel->path == GLTF_NO_PATH ? path : JSON_NONE;
    ffd_free(text);
    return FFD_OK;
}

/* Whether the keys of weights hold other numbers of them than the mesh has morph targets: exporters leave
   such channels behind when targets are removed or applied. What is not a row of weights for each time is an
   error that loading tells. */
static bool is_left_behind(const gltf_document *d, const gltf_animation *animation,
                           const gltf_channel *channel)
{
    const uint64_t targets = ffd_gltf_node_targets(d, channel->node);
    const gltf_animation_sampler *const sampler =
        channel->sampler == GLTF_NONE ? NULL : &animation->samplers[channel->sampler];
    if (targets == 0 || !sampler || sampler->input == GLTF_NONE || sampler->output == GLTF_NONE)
        return targets == 0;
    const gltf_accessor *const output = &d->model.accessors[sampler->output];
    const uint64_t rows = (uint64_t)d->model.accessors[sampler->input].count *
                          (sampler->interpolation == GLTF_CUBICSPLINE ? 3 : 1);
    return rows > 0 && output->rows == 1 && output->count > 0 && (uint64_t)output->count % rows == 0 &&
           (uint64_t)output->count / rows != targets;
}

static ffd_status read_channel(const gltf_document *d, gltf_animation *animation, uint32_t value,
                               ffd_error *error)
{
    gltf_channel *const channel = &animation->channels[animation->channel_count++];
    const uint32_t target = ffd_json_tree_member(&d->tree, value, "target");
    const uint32_t extension = ffd_gltf_extension(d, target, "KHR_animation_pointer");
    *channel = (gltf_channel){.value = value,
                              .sampler = ffd_gltf_index(d, ffd_json_tree_member(&d->tree, value, "sampler"),
                                                        animation->sampler_count),
                              .path = GLTF_NO_PATH,
                              .node = GLTF_NONE,
                              .fault = JSON_NONE};
    const ffd_status status = extension == JSON_NONE ? read_path(d, target, channel, error)
                                                     : read_pointer(d, extension, channel, error);
    animation->pointer_count += channel->pointer && channel->path == GLTF_NO_PATH;
    if (channel->path == GLTF_WEIGHTS && is_left_behind(d, animation, channel)) {
        channel->path = GLTF_NO_PATH;
        channel->node = GLTF_NONE;
    }
    return status;
}

static size_t count_of(const gltf_document *d, uint32_t object, const char *key)
{
    const uint32_t array = ffd_json_tree_member(&d->tree, object, key);
    return array != JSON_NONE && d->tree.values[array].kind == JSON_ARRAY ? d->tree.values[array].count : 0;
}

/* Takes memory from the document's budget until the list is freed. */
static ffd_status take(gltf_document *d, uint64_t *taken, size_t count, size_t size, ffd_error *error)
{
    const uint64_t before = d->base.budget.taken;
    TRY(ffd_budget_take(&d->base.budget, count, size, error));
    *taken += d->base.budget.taken - before;
    return FFD_OK;
}

static ffd_status make_arrays(gltf_document *d, gltf_animations *of, gltf_animation *animation,
                              ffd_error *error)
{
    const size_t samplers = count_of(d, animation->value, "samplers");
    const size_t channels = count_of(d, animation->value, "channels");
    TRY(take(d, &of->taken, samplers, sizeof *animation->samplers, error));
    TRY(take(d, &of->taken, channels, sizeof *animation->channels, error));
    animation->samplers = ffd_alloc_zero(samplers, sizeof *animation->samplers);
    animation->sampler_count = animation->samplers ? samplers : 0;
    animation->channels = ffd_alloc_zero(channels, sizeof *animation->channels);
    return animation->samplers && animation->channels ? FFD_OK : ffd_fail_memory(error);
}

static ffd_status read_animation(gltf_document *d, gltf_animations *of, gltf_animation *animation,
                                 ffd_error *error)
{
    const json_tree *const tree = &d->tree;
    const uint32_t name = ffd_json_tree_member(tree, animation->value, "name");
    size_t s = 0;
    TRY(make_arrays(d, of, animation, error));
    if (name != JSON_NONE && tree->values[name].kind == JSON_STRING) {
        animation->name = ffd_json_tree_string(tree, name, NULL);
        if (!animation->name)
            return ffd_fail_memory(error);
    }
    for (uint32_t v = ffd_gltf_first(d, animation->value, "samplers"); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v))
        animation->samplers[s++] = (gltf_animation_sampler){.value = v,
                                                            .input = accessor_of(d, v, "input"),
                                                            .output = accessor_of(d, v, "output"),
                                                            .interpolation = interpolation_of(d, v)};
    for (uint32_t v = ffd_gltf_first(d, animation->value, "channels"); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v))
        TRY(read_channel(d, animation, v, error));
    return FFD_OK;
}

ffd_status ffd_gltf_list_animations(gltf_document *d, gltf_animations *animations, ffd_error *error)
{
    const size_t count = count_of(d, 0, "animations");
    *animations = (gltf_animations){0};
    TRY(take(d, &animations->taken, count, sizeof *animations->list, error));
    animations->list = ffd_alloc_zero(count, sizeof *animations->list);
    if (!animations->list)
        return ffd_fail_memory(error);
    for (uint32_t v = ffd_gltf_first(d, 0, "animations"); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v)) {
        gltf_animation *const animation = &animations->list[animations->count++];
        animation->value = v;
        TRY(read_animation(d, animations, animation, error));
    }
    return FFD_OK;
}

static void free_animation(gltf_document *d, gltf_animation *animation)
{
    ffd_gltf_unload_animation(d, animation);
    for (size_t c = 0; c < animation->channel_count; c++)
        ffd_free(animation->channels[c].pointer);
    ffd_free(animation->samplers);
    ffd_free(animation->channels);
    ffd_free(animation->name);
}

void ffd_gltf_free_animations(gltf_document *d, gltf_animations *animations)
{
    for (size_t a = 0; a < animations->count; a++)
        free_animation(d, &animations->list[a]);
    ffd_budget_return(&d->base.budget, 1, animations->taken);
    ffd_free(animations->list);
    *animations = (gltf_animations){0};
}

/* Fails at a member of a sampler or a channel, or at the sampler or channel itself if the member is
   absent. */
static ffd_status refuse(const gltf_document *d, uint32_t value, const char *key, ffd_error *error,
                         const char *format, ...) FFD_PRINTF(5, 6);
static ffd_status refuse(const gltf_document *d, uint32_t value, const char *key, ffd_error *error,
                         const char *format, ...)
{
    const uint32_t member = ffd_json_tree_member(&d->tree, value, key);
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return ffd_json_tree_fail(&d->tree, member == JSON_NONE ? value : member, d->name, FFD_E_INVALID, error,
                              "%s", message);
}

static ffd_status check_accessor(const gltf_document *d, const gltf_animation_sampler *sampler,
                                 const char *key, size_t accessor, ffd_error *error)
{
    if (accessor == GLTF_NONE)
        return refuse(d, sampler->value, key, error, "the sampler's %s is none of the %zu accessors", key,
                      d->model.accessor_count);
    if (d->layouts[accessor].readable)
        return FFD_OK;
    const int view = d->model.accessors[accessor].view;
    const ffd_status status = view >= 0 ? ffd_gltf_refuse_view(d, (size_t)view, error) : FFD_OK;
    return status
               ? status
               : ffd_json_tree_fail(&d->tree, d->accessor_values.values[accessor], d->name, FFD_E_UNSUPPORTED,
                                    error, "an accessor without bytes is not supported");
}

static bool has_values(const gltf_accessor *accessor)
{
    return accessor->columns == 1 && accessor->rows != 2 &&
           (accessor->component == GLTF_FLOAT || (accessor->normalized && accessor->component != GLTF_U32));
}

/* Finds the number of components of a value: 3 or 4 for vectors, for weights the number of elements per
   key. */
static ffd_status measure(const gltf_document *d, gltf_animation_sampler *sampler, ffd_error *error)
{
    const gltf_accessor *const output = &d->model.accessors[sampler->output];
    const size_t count = (size_t)output->count, keys = sampler->key_count;
    const size_t per_key = sampler->interpolation == GLTF_CUBICSPLINE ? 3 : 1;
    if (!has_values(output))
        return refuse(
            d, sampler->value, "output", error,
            "accessor %zu does not hold values of an animation (SCALAR, VEC3 or VEC4 of floats or of "
            "normalized integers)",
            sampler->output);
    const bool is_vector = output->rows > 1;
    if (is_vector ? count / per_key != keys || count % per_key : count / per_key % keys || count % per_key)
        return refuse(d, sampler->value, "output", error, "accessor %zu has %zu %s for %zu %s, not %s each",
                      sampler->output, count, ffd_plural(count, "element", "elements"), keys,
                      ffd_plural(keys, "time", "times"),
                      per_key == 3 ? is_vector ? "3" : "3 or a multiple of it"
                      : is_vector  ? "1"
                                   : "1 or a multiple of it");
    sampler->width = is_vector ? (size_t)output->rows : count / per_key / keys;
    if (sampler->width == 0)
        return refuse(d, sampler->value, "output", error, "accessor %zu has no elements", sampler->output);
    return FFD_OK;
}

static ffd_status check_sampler(const gltf_document *d, gltf_animation_sampler *sampler, ffd_error *error)
{
    TRY(check_accessor(d, sampler, "input", sampler->input, error));
    TRY(check_accessor(d, sampler, "output", sampler->output, error));
    const gltf_accessor *const input = &d->model.accessors[sampler->input];
    if (input->columns * input->rows != 1 || input->component != GLTF_FLOAT)
        return refuse(d, sampler->value, "input", error,
                      "accessor %zu does not hold times (SCALAR of floats)", sampler->input);
    if (input->count == 0)
        return refuse(d, sampler->value, "input", error, "accessor %zu has no times", sampler->input);
    if (sampler->interpolation == GLTF_NO_INTERPOLATION)
        return refuse(d, sampler->value, "interpolation", error,
                      "an interpolation is \"STEP\", \"LINEAR\" or \"CUBICSPLINE\"");
    sampler->key_count = (size_t)input->count;
    return measure(d, sampler, error);
}

/* Two keys may have the same time: programs write a jump so, and every viewer plays it. */
static ffd_status check_times(const gltf_document *d, const gltf_animation_sampler *sampler, ffd_error *error)
{
    for (size_t i = 0; i < sampler->key_count; i++) {
        if (!isfinite(sampler->times[i]))
            return refuse(d, sampler->value, "input", error, "time %zu of accessor %zu is not finite", i,
                          sampler->input);
        if (i > 0 && sampler->times[i] < sampler->times[i - 1])
            return refuse(d, sampler->value, "input", error,
                          "time %zu of accessor %zu, %.9g, is before the one before it, %.9g", i,
                          sampler->input, sampler->times[i], sampler->times[i - 1]);
    }
    return FFD_OK;
}

static ffd_status check_values(const gltf_document *d, const gltf_animation_sampler *sampler, size_t count,
                               ffd_error *error)
{
    const size_t rows = (size_t)d->model.accessors[sampler->output].rows;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(sampler->values[i]))
            return refuse(d, sampler->value, "output", error, "element %zu of accessor %zu is not finite",
                          i / rows, sampler->output);
    return FFD_OK;
}

static ffd_status load_sampler(gltf_document *d, gltf_animation *animation, gltf_animation_sampler *sampler,
                               ffd_error *error)
{
    TRY(sampler->times ? FFD_OK : check_sampler(d, sampler, error));
    if (sampler->times)
        return FFD_OK;
    const size_t elements = (size_t)d->model.accessors[sampler->output].count;
    const size_t rows = (size_t)d->model.accessors[sampler->output].rows, keys = sampler->key_count;
    TRY(take(d, &animation->taken, keys, sizeof *sampler->times, error));
    TRY(take(d, &animation->taken, elements, rows * sizeof *sampler->values, error));
    sampler->times = ffd_alloc(keys, sizeof *sampler->times);
    sampler->values = ffd_alloc(elements, rows * sizeof *sampler->values);
    if (!sampler->times || !sampler->values)
        return ffd_fail_memory(error);
    ffd_gltf_read(d, sampler->input, 0, keys, 1, sampler->times);
    ffd_gltf_read(d, sampler->output, 0, elements, rows, sampler->values);
    TRY(check_times(d, sampler, error));
    return check_values(d, sampler, elements * rows, error);
}

/* Checks that the values of a channel's sampler have as many numbers as the property it drives. Channels of
   other numbers of weights than there are morph targets drive nothing. */
static ffd_status check_width(const gltf_document *d, const gltf_channel *channel,
                              const gltf_animation_sampler *sampler, ffd_error *error)
{
    static const char *const names[] = {"VEC3, for a translation", "VEC4, for a rotation",
                                        "VEC3, for a scale", "SCALAR, for weights"};
    static const size_t widths[] = {3, 4, 3, 1};
    const size_t rows = (size_t)d->model.accessors[sampler->output].rows;
    return rows == widths[channel->path]
               ? FFD_OK
               : refuse(d, sampler->value, "output", error, "accessor %zu is not a %s", sampler->output,
                        names[channel->path]);
}

static ffd_status load_channel(gltf_document *d, gltf_animation *animation, const gltf_channel *channel,
                               ffd_error *error)
{
    if (channel->sampler == GLTF_NONE)
        return refuse(d, channel->value, "sampler", error, "the channel's sampler is none of the %zu",
                      animation->sampler_count);
    gltf_animation_sampler *const sampler = &animation->samplers[channel->sampler];
    TRY(load_sampler(d, animation, sampler, error));
    return check_width(d, channel, sampler, error);
}

/* Finds the times of the first and the last key. */
static void find_range(gltf_animation *animation)
{
    bool any = false;
    animation->begin = animation->end = 0;
    for (size_t s = 0; s < animation->sampler_count; s++) {
        const gltf_animation_sampler *const sampler = &animation->samplers[s];
        if (!sampler->times)
            continue;
        const double first = sampler->times[0], last = sampler->times[sampler->key_count - 1];
        animation->begin = any && animation->begin < first ? animation->begin : first;
        animation->end = any && animation->end > last ? animation->end : last;
        any = true;
    }
}

ffd_status ffd_gltf_load_animation(gltf_document *d, gltf_animation *animation, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t c = 0; c < animation->channel_count; c++)
        if (ffd_gltf_channel_drives(&animation->channels[c]))
            TRY_END(load_channel(d, animation, &animation->channels[c], error));
    find_range(animation);
end:
    if (status)
        ffd_gltf_unload_animation(d, animation);
    ffd_gltf_forget(d);
    return status;
}

void ffd_gltf_unload_animation(gltf_document *d, gltf_animation *animation)
{
    for (size_t s = 0; s < animation->sampler_count; s++) {
        ffd_free(animation->samplers[s].times);
        ffd_free(animation->samplers[s].values);
        animation->samplers[s].times = animation->samplers[s].values = NULL;
    }
    ffd_budget_return(&d->base.budget, 1, animation->taken);
    animation->taken = 0;
}
