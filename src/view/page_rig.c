#include "view/page_rig.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/text/buffer_binary.h"
#include "view/page_text.h"
#include <string.h>

/* Appends numbers as little-endian floats. */
static void put_floats(byte_buffer *to, const double *values, size_t count)
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
        put_floats(to, channel->times, channel->key_count);
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
    put_floats(values, channel->values, keys * per_key * channel->width);
}

/* Fills PAGE_CHANNELS, PAGE_TIMES, PAGE_VALUES and first_channel with the loaded animations of a side's
   skeleton. A channel that never changes is written with a single key. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
static ffd_status put_keys(page_rig_side *side, ffd_error *error)
{
    const mesh_skeleton *const skeleton = side->from->skeleton;
    time_table table = {0};
    size_t count = 0;
    side->first_channel = ffd_alloc(skeleton->animation_count + 1, sizeof *side->first_channel);
    ffd_status status;
    TRY_END(side->first_channel ? make_table(skeleton, &table, error) : ffd_fail_memory(error));
    for (size_t a = 0; a < skeleton->animation_count; a++) {
        const rig_animation *const animation = &skeleton->animations[a];
        side->first_channel[a] = count;
        for (size_t c = 0; c < animation->channel_count; c++)
            put_channel(side, &animation->channels[c], &table);
        count += animation->channel_count;
    }
    side->first_channel[skeleton->animation_count] = count;
    if (side->blocks[PAGE_VALUES].size > UINT32_MAX || count > UINT32_MAX)
        TRY_END(ffd_fail(error, FFD_E_LIMIT, "a page with so many keys of animations is not possible"));
end:
    ffd_free(table.places);
    return status;
}

#define SHARES 65535 /* what the weights of a vertex add up to in PAGE_FOLLOWS */

static const char *const block_names[PAGE_RIG_BLOCKS] = {
    "parent", "node", "bone", "bind", "weight", "channel", "time", "value", "follow", "anchor", "offset"};

static unsigned char *grow(byte_buffer *to, size_t size)
{
    char *const at = ffd_buffer_reserve(to, size);
    to->size += at ? size : 0;
    return (unsigned char *)at;
}

static void put_node(page_rig_side *side, const rig_node *node)
{
    static const double nothing[2] = {0, 0};
    unsigned char *const at = grow(&side->blocks[PAGE_PARENTS], 8);
    byte_buffer *const to = &side->blocks[PAGE_NODES];
    if (!at)
        return;
    store_u32(at, node->parent == RIG_NONE ? UINT32_MAX : (uint32_t)node->parent);
    store_u32(at + 4, (node->is_joint ? 1u : 0) | (node->has_matrix ? 2u : 0));
    if (node->has_matrix) {
        put_floats(to, node->matrix, 12);
        return;
    }
    put_floats(to, node->translation, 3);
    put_floats(to, node->rotation, 4);
    put_floats(to, node->scale, 3);
    put_floats(to, nothing, 2);
}

static void put_skeleton(page_rig_side *side)
{
    const mesh_skeleton *const s = side->from->skeleton;
    for (size_t n = 0; n < s->node_count; n++)
        put_node(side, &s->nodes[n]);
    for (size_t b = 0; b < s->bone_count; b++) {
        unsigned char *const at = grow(&side->blocks[PAGE_BONES_OF], 4);
        if (at)
            store_u32(at, (uint32_t)s->bones[b].node);
        put_floats(&side->blocks[PAGE_BINDS], s->bones[b].bind, 12);
    }
    put_floats(&side->blocks[PAGE_WEIGHTS], s->weights, s->weight_count);
}

/* Returns the index in a side's document of a vertex of the page. */
static size_t index_of(const page_mesh *mesh, const page_rig_side *side, size_t vertex)
{
    return ffd_view_vertex_of(mesh->scene, side->from == &mesh->scene->rigs[1], mesh->vertices[vertex]);
}

/* Chooses the bones of a vertex with the largest weights, in descending order. Returns their number. */
static size_t choose_bones(const mesh_skeleton *s, size_t vertex, rig_influence chosen[PAGE_BONES])
{
    size_t count = 0;
    for (size_t i = s->starts[vertex]; i < s->starts[vertex + 1]; i++) {
        size_t at = count < PAGE_BONES ? count++ : PAGE_BONES;
        for (; at > 0 && chosen[at - 1].weight < s->influences[i].weight; at--)
            if (at < PAGE_BONES)
                chosen[at] = chosen[at - 1];
        if (at < PAGE_BONES)
            chosen[at] = s->influences[i];
    }
    return count;
}

static void put_follow(page_rig *rig, page_rig_side *side, size_t vertex)
{
    const mesh_skeleton *const s = side->from->skeleton;
    rig_influence chosen[PAGE_BONES];
    unsigned char *const at = grow(&side->blocks[PAGE_FOLLOWS], PAGE_BONES * 4);
    const size_t count = choose_bones(s, vertex, chosen), all = s->starts[vertex + 1] - s->starts[vertex];
    double total = 0;
    uint32_t left = SHARES;
    rig->reduced += all > PAGE_BONES;
    rig->most_bones = all > rig->most_bones ? all : rig->most_bones;
    if (!at)
        return;
    memset(at, 0, PAGE_BONES * 4);
    for (size_t i = 0; i < count; i++)
        total += (double)chosen[i].weight;
    /* The bone with the largest weight, the first, gets the remainder of the rounding. */
    for (size_t i = count; i-- > 0;) {
        const double share = total > 0 ? SHARES * (double)chosen[i].weight / total + 0.5 : 0;
        uint32_t part = i == 0 || !(share > 0) ? 0 : share > left ? left : (uint32_t)share;
        part = i == 0 ? left : part;
        left -= part;
        store_u16(at + 2 * i, (uint16_t)chosen[i].bone);
        store_u16(at + PAGE_BONES * 2 + 2 * i, (uint16_t)part);
    }
}

static ffd_status put_targets(const page_mesh *mesh, page_rig_side *side, ffd_error *error)
{
    const mesh_anchors *const anchors = &side->from->anchors;
    byte_buffer *const to = &side->blocks[PAGE_OFFSETS];
    const size_t count = side->from->skeleton->vertex_count;
    uint32_t *const places = ffd_alloc(count, sizeof *places);
    side->target_offsets = ffd_alloc_zero(anchors->target_count, sizeof *side->target_offsets);
    if (!places || !side->target_offsets) {
        ffd_free(places);
        return ffd_fail_memory(error);
    }
    for (size_t i = 0; i < count; i++)
        places[i] = VIEW_NONE;
    for (size_t v = 0; v < mesh->vertex_count; v++)
        places[index_of(mesh, side, v)] = (uint32_t)v;
    for (size_t t = 0; t < anchors->target_count; t++)
        for (size_t i = 0; i < anchors->targets[t].count; i++) {
            const double *const offset = anchors->targets[t].offsets + 3 * i;
            const uint32_t vertex = places[anchors->targets[t].first + i];
            const bool moves = offset[0] != 0 || offset[1] != 0 || offset[2] != 0;
            unsigned char *const at = moves && vertex != VIEW_NONE ? grow(to, 4) : NULL;
            if (!at)
                continue;
            store_u32(at, vertex);
            put_floats(to, offset, 3);
            side->target_offsets[t]++;
        }
    ffd_free(places);
    return FFD_OK;
}

static ffd_status put_vertices(page_rig *rig, page_rig_side *side, bool follows, ffd_error *error)
{
    const page_mesh *const mesh = rig->mesh;
    if (!side->from->skeleton->starts || !side->from->anchors.points)
        return FFD_OK;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        if (follows)
            put_follow(rig, side, index_of(mesh, side, v));
        put_floats(&side->blocks[PAGE_ANCHORS], side->from->anchors.points + 3 * index_of(mesh, side, v), 3);
    }
    return put_targets(mesh, side, error);
}

static ffd_status make_side(page_rig *rig, int index, ffd_error *error)
{
    page_rig_side *const side = &rig->sides[index];
    const view_rig *const from = &rig->mesh->scene->rigs[index];
    const bool is_lent = index == 1 && rig->is_shared;
    if (!from->skeleton)
        return FFD_OK;
    side->from = from;
    if (from->skeleton->bone_count > UINT16_MAX)
        return ffd_fail(error, FFD_E_LIMIT, "a page with %zu bones is not possible, only %d",
                        from->skeleton->bone_count, UINT16_MAX);
    if (!is_lent) {
        put_skeleton(side);
        TRY(put_keys(side, error));
    }
    TRY(put_vertices(rig, side, !is_lent, error));
    for (int b = 0; b < PAGE_RIG_BLOCKS; b++)
        if (side->blocks[b].failed)
            return ffd_fail_memory(error);
    return FFD_OK;
}

ffd_status ffd_page_rig_make(const page_mesh *mesh, page_rig *rig, ffd_error *error)
{
    const view_rig *const rigs = mesh->scene->rigs;
    *rig = (page_rig){.mesh = mesh, .is_shared = rigs[0].skeleton == rigs[1].skeleton};
    rig->has_after = rigs[0].skeleton && (!rig->is_shared || rigs[1].anchors.points);
    if (!rigs[0].skeleton)
        return FFD_OK;
    TRY(make_side(rig, 0, error));
    if (rig->has_after)
        TRY(make_side(rig, 1, error));
    return FFD_OK;
}

void ffd_page_rig_free(page_rig *rig)
{
    for (int s = 0; s < 2; s++) {
        for (int b = 0; b < PAGE_RIG_BLOCKS; b++)
            ffd_buffer_free(&rig->sides[s].blocks[b]);
        ffd_free(rig->sides[s].first_channel);
        ffd_free(rig->sides[s].target_offsets);
    }
    *rig = (page_rig){0};
}

/* Describes an animation's channels on a side as [first, count], or null where the side has no such
   animation. */
static void describe_channels(const page_rig *rig, int index, size_t animation, json_text *json)
{
    const page_rig_side *const side = &rig->sides[index == 1 && rig->is_shared ? 0 : index];
    if (!side->first_channel || animation == RIG_NONE) {
        ffd_json_null(json, NULL);
        return;
    }
    const double range[2] = {(double)side->first_channel[animation],
                             (double)(side->first_channel[animation + 1] - side->first_channel[animation])};
    ffd_json_vector(json, NULL, range, 2);
}

static void describe_animations(const page_rig *rig, json_text *json)
{
    const view_scene *const scene = rig->mesh->scene;
    size_t shown = 0, start = SIZE_MAX;
    ffd_json_array(json, "animations", false);
    for (size_t a = 0; a < scene->animation_count; a++) {
        const view_animation *const from = &scene->animations[a];
        if (from->of[0] == RIG_NONE)
            continue;
        char *const name = ffd_page_name(from->name);
        const rig_animation *const times = &scene->rigs[0].skeleton->animations[from->of[0]];
        ffd_json_object(json, NULL, true);
        json->out->failed = json->out->failed || !name;
        ffd_json_string(json, "name", name);
        ffd_json_number(json, "begin", times->begin);
        ffd_json_number(json, "end", times->end);
        ffd_json_array(json, "channels", true);
        for (int side = 0; side < 2; side++)
            describe_channels(rig, side, from->of[side], json);
        ffd_json_end(json, ']');
        ffd_json_end(json, '}');
        ffd_free(name);
        start = a == scene->animation ? shown : start;
        shown++;
    }
    ffd_json_end(json, ']');
    if (start != SIZE_MAX)
        ffd_json_count(json, "start", start);
}

static void describe_targets(const page_rig_side *side, json_text *json)
{
    const mesh_anchors *const anchors = &side->from->anchors;
    ffd_json_array(json, "targets", false);
    for (size_t t = 0; side->target_offsets && t < anchors->target_count; t++) {
        const double target[2] = {(double)anchors->targets[t].weight, (double)side->target_offsets[t]};
        ffd_json_vector(json, NULL, target, 2);
    }
    ffd_json_end(json, ']');
}

void ffd_page_rig_describe(const page_rig *rig, json_text *json)
{
    ffd_json_object(json, "rig", false);
    describe_animations(rig, json);
    ffd_json_bool(json, "isShared", rig->is_shared);
    ffd_json_bool(json, "hasAfter", rig->has_after);
    ffd_json_array(json, "sides", false);
    for (int s = 0; s < 2; s++) {
        if (!rig->sides[s].from) {
            ffd_json_null(json, NULL);
            continue;
        }
        ffd_json_object(json, NULL, false);
        describe_targets(&rig->sides[s], json);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
    ffd_json_end(json, '}');
}

static void fill(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    memcpy(bytes, ((const byte_buffer *)of)->data + first, count);
}

void ffd_page_rig_write(page_rig *rig, page_writer *w)
{
    for (int s = 0; s < 2; s++)
        for (int b = 0; b < PAGE_RIG_BLOCKS; b++) {
            byte_buffer *const block = &rig->sides[s].blocks[b];
            char id[40] = "data-rig-";
            if (block->size == 0)
                continue;
            strcat(id, s ? "after-" : "before-");
            strcat(id, block_names[b]);
            ffd_page_write_block(w, id, block->size, 1, fill, block);
            ffd_buffer_free(block);
        }
}
