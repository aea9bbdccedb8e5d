/* page_keys.c - the channels and keys of a page's animations. */
#include "base/memory/memory.h"
#include "base/text/buffer_binary.h"
#include "view/page_rig.h"

void ffd_page_floats_put(byte_buffer *to, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        ffd_buffer_float(to, values[i]);
}

/* Whether all keys have the same value. A cubic spline may still move between equal keys, so it never
   counts. */
static bool is_still(const rig_channel *channel)
{
    for (size_t i = channel->width; i < channel->key_count * channel->width; i++)
        if (channel->values[i] < channel->values[i - channel->width] ||
            channel->values[i] > channel->values[i - channel->width])
            return false;
    return channel->interpolation != RIG_CUBICSPLINE;
}

/* For each accessor of times: the index of its first time in PAGE_TIMES; SIZE_MAX: not written yet. So
   channels that share an accessor share their times. */
typedef struct time_table {
    size_t *places;
    size_t count;
} time_table;

static ffd_status make_table(const mesh_skeleton *skeleton, time_table *table, ffd_error *error)
{
    for (size_t a = 0; a < skeleton->animation_count; a++)
        for (size_t c = 0; c < skeleton->animations[a].channel_count; c++)
            if (skeleton->animations[a].channels[c].input >= table->count)
                table->count = skeleton->animations[a].channels[c].input + 1;
    table->places = ffd_alloc(table->count, sizeof *table->places);
    for (size_t i = 0; table->places && i < table->count; i++)
        table->places[i] = SIZE_MAX;
    return table->places ? FFD_OK : ffd_fail_memory(error);
}

static size_t put_times(page_rig_side *side, const rig_channel *channel, const time_table *table)
{
    byte_buffer *const to = &side->blocks[PAGE_TIMES];
    size_t *const place = &table->places[channel->input];
    if (*place == SIZE_MAX) {
        *place = to->size / 4;
        ffd_page_floats_put(to, channel->times, channel->key_count);
    }
    return *place;
}

static void put_channel(page_rig_side *side, const rig_channel *channel, const time_table *table)
{
    byte_buffer *const to = &side->blocks[PAGE_CHANNELS], *const values = &side->blocks[PAGE_VALUES];
    const size_t keys = is_still(channel) ? 1 : channel->key_count;
    const size_t per_key = channel->interpolation == RIG_CUBICSPLINE ? 3 : 1;
    ffd_buffer_u32(to, (uint32_t)(channel->path == RIG_WEIGHTS ? channel->first_weight : channel->node));
    ffd_buffer_u32(to, (uint32_t)channel->path);
    ffd_buffer_u32(to, (uint32_t)channel->interpolation);
    ffd_buffer_u32(to, (uint32_t)keys);
    ffd_buffer_u32(to, (uint32_t)channel->width);
    ffd_buffer_u32(to, (uint32_t)put_times(side, channel, table));
    ffd_buffer_u32(to, (uint32_t)(values->size / 4));
    ffd_page_floats_put(values, channel->values, keys * per_key * channel->width);
}

ffd_status ffd_page_keys_put(page_rig_side *side, ffd_error *error)
{
    const mesh_skeleton *const skeleton = side->from->skeleton;
    time_table table = {0};
    size_t count = 0;
    side->first_channel = ffd_alloc(skeleton->animation_count + 1, sizeof *side->first_channel);
    ffd_status status = side->first_channel ? make_table(skeleton, &table, error) : ffd_fail_memory(error);
    for (size_t a = 0; a < skeleton->animation_count && !status; a++) {
        const rig_animation *const animation = &skeleton->animations[a];
        side->first_channel[a] = count;
        for (size_t c = 0; c < animation->channel_count; c++)
            put_channel(side, &animation->channels[c], &table);
        count += animation->channel_count;
    }
    if (!status)
        side->first_channel[skeleton->animation_count] = count;
    if (!status && (side->blocks[PAGE_VALUES].size > UINT32_MAX || count > UINT32_MAX))
        status = ffd_fail(error, FFD_E_LIMIT, "a page with so many keys of animations is not possible");
    ffd_free(table.places);
    return status;
}
