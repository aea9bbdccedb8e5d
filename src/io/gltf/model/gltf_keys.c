/* gltf_keys.c - loads the keys of an animation, and checks them (glTF 2.0, 3.11). */
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/model/gltf_animation.h"
#include "io/gltf/read/gltf_read.h"
#include "io/gltf/read/gltf_views.h"
#include <math.h>
#include <stdio.h>

/* Fails at a member of a sampler or a channel, or at the sampler or channel itself if the member is
   absent. */
static ffd_status refuse(const gltf_document *d, uint32_t value, const char *key, ffd_error *error,
                         const char *format, ...) FFD_PRINTF(5, 6);
static ffd_status refuse(const gltf_document *d, uint32_t value, const char *key, ffd_error *error,
                         const char *format, ...)
{
    const uint32_t member = ffd_json_span_member(&d->tree, value, key);
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return ffd_json_span_fail(&d->tree, member == JSON_NONE ? value : member, d->name, FFD_E_INVALID, error,
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
               : ffd_json_span_fail(&d->tree, d->accessor_values.values[accessor], d->name, FFD_E_UNSUPPORTED,
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
    ffd_status status = check_accessor(d, sampler, "input", sampler->input, error);
    if (status == FFD_OK)
        status = check_accessor(d, sampler, "output", sampler->output, error);
    if (status)
        return status;
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
    ffd_status status = sampler->times ? FFD_OK : check_sampler(d, sampler, error);
    if (status || sampler->times)
        return status;
    const size_t elements = (size_t)d->model.accessors[sampler->output].count;
    const size_t rows = (size_t)d->model.accessors[sampler->output].rows, keys = sampler->key_count;
    const uint64_t before = d->base.budget.taken;
    status = ffd_budget_take(&d->base.budget, keys, sizeof *sampler->times, error);
    if (status == FFD_OK)
        status = ffd_budget_take(&d->base.budget, elements, rows * sizeof *sampler->values, error);
    animation->taken += d->base.budget.taken - before;
    if (status)
        return status;
    sampler->times = ffd_alloc(keys, sizeof *sampler->times);
    sampler->values = ffd_alloc(elements, rows * sizeof *sampler->values);
    if (!sampler->times || !sampler->values)
        return ffd_fail_memory(error);
    ffd_gltf_read(d, sampler->input, 0, keys, 1, sampler->times);
    ffd_gltf_read(d, sampler->output, 0, elements, rows, sampler->values);
    status = check_times(d, sampler, error);
    return status ? status : check_values(d, sampler, elements * rows, error);
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
    const ffd_status status = load_sampler(d, animation, sampler, error);
    return status ? status : check_width(d, channel, sampler, error);
}

/* Finds the times of the first and the last key. */
static void find_span(gltf_animation *animation)
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
    for (size_t c = 0; c < animation->channel_count && status == FFD_OK; c++)
        if (ffd_gltf_channel_drives(&animation->channels[c]))
            status = load_channel(d, animation, &animation->channels[c], error);
    if (status == FFD_OK)
        find_span(animation);
    else
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
