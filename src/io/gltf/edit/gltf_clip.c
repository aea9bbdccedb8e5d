/* gltf_clip.c - animations of the weights of morph targets from clips. */
#include "base/memory/memory.h"
#include "base/text/buffer_binary.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include "io/gltf/edit/gltf_json_insert.h"
#include "io/gltf/edit/gltf_left_bytes.h"
#include "io/gltf/edit/gltf_morphs.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/read/gltf_users.h"
#include "json/json_text.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* KEEPS: a target that no clip drives. IS_ZERO: a further target that the clip does not name, so that its
   weight is 0. */
#define KEEPS UINT32_MAX
#define IS_ZERO (UINT32_MAX - 1)

typedef struct clip_writer {
    gltf_edit *file;
    memory_budget budget;
    const morph_clip *clip; /* the clip being written */
    size_t input;           /* accessor of its times; GLTF_NONE: not added yet */
    /* Per mesh: the sampler of its nodes without weights of their own; GLTF_NONE: not added yet. */
    size_t *samplers;
    size_t sampler_count, channel_count;
    byte_buffer sampler_text, channel_text;
    byte_buffer added;    /* new animations, with commas */
    gltf_values replaced; /* animations that clips have replaced so far; lent */
    ffd_error *error;
} clip_writer;

/* Adds the names of the targets of a mesh. Returns false if memory runs out. */
static bool list_names_of(const gltf_document *d, size_t mesh, intern_table *all)
{
    const size_t count = d->mesh_uses[mesh].target_count;
    uint32_t *const names = ffd_gltf_list_target_names(d, mesh);
    bool added = names;
    for (size_t t = 0; t < count && added; t++) {
        char *const name = names[t] == JSON_NONE ? NULL : ffd_json_tree_string(&d->tree, names[t], NULL);
        uint32_t index;
        if (name)
            added = ffd_intern(all, name, strlen(name), &index);
        ffd_free(name);
    }
    ffd_free(names);
    return added;
}

/* Adds the names of the targets of all meshes. */
static bool list_names(const gltf_document *d, intern_table *all)
{
    bool added = true;
    for (size_t m = 0; m < d->model.mesh_count && added; m++)
        added = list_names_of(d, m, all);
    return added;
}

ffd_status ffd_gltf_check_clips(const gltf_document *d, const morph_clip *clips, size_t count,
                                const char *const *names, size_t name_count, ffd_error *error)
{
    intern_table all = {0};
    uint32_t index;
    bool listed = true;
    for (size_t i = 0; i < name_count && listed; i++)
        listed = ffd_intern(&all, names[i], strlen(names[i]), &index);
    const ffd_status status = listed && list_names(d, &all) ? ffd_morph_clips_check(clips, count, &all, error)
                                                            : ffd_fail_memory(error);
    ffd_intern_free(&all);
    return status;
}

/* Appends a name as a JSON string. */
static void put_name(const char *name, byte_buffer *text)
{
    json_text json;
    ffd_json_begin(&json, text);
    ffd_json_string(&json, NULL, name);
}

/* Adds an accessor of count floats, which the caller appends next. extra: further members. Returns its
   number. */
static size_t add_accessor(clip_writer *w, size_t count, const char *extra)
{
    gltf_edit *const file = w->file;
    const gltf_document *const d = w->file->document;
    ffd_buffer_format(&file->accessors,
                      "%s{\"bufferView\":%zu,\"byteOffset\":%zu,\"componentType\":5126,\"count\":%zu,"
                      "\"type\":\"SCALAR\"%s}",
                      file->accessor_count > 0 ? "," : "", d->view_values.count, file->bytes.size, count,
                      extra);
    return d->model.accessor_count + file->accessor_count++;
}

static void add_times(clip_writer *w)
{
    const morph_clip *const clip = w->clip;
    char bounds[2 * FFD_NUMBER_CAPACITY + 32], least[FFD_NUMBER_CAPACITY + 1], most[FFD_NUMBER_CAPACITY + 1];
    least[ffd_number_format_float(clip->times[0], least)] = 0;
    most[ffd_number_format_float(clip->times[clip->key_count - 1], most)] = 0;
    snprintf(bounds, sizeof bounds, ",\"min\":[%s],\"max\":[%s]", least, most);
    w->input = add_accessor(w, clip->key_count, bounds);
    for (size_t k = 0; k < clip->key_count; k++)
        ffd_buffer_float(&w->file->bytes, (double)clip->times[k]);
}

/* Finds the targets of a mesh that the clip drives, and their names in the clip. Returns whether there are
   any. */
static bool find_driven(clip_writer *w, size_t mesh, uint32_t *names, size_t count)
{
    const gltf_document *const d = w->file->document;
    uint32_t *const values = ffd_gltf_list_target_names(d, mesh);
    bool any = false, failed = !values;
    for (size_t t = 0; t < count; t++) {
        const bool named = values && values[t] != JSON_NONE;
        char *const name = named ? ffd_json_tree_string(&d->tree, values[t], NULL) : NULL;
        failed = failed || (named && !name);
        names[t] = KEEPS;
        if (name && ffd_intern_find(&w->clip->names, name, strlen(name), &names[t]))
            any = true;
        ffd_free(name);
    }
    ffd_free(values);
    w->file->edits.failed = w->file->edits.failed || failed;
    /* Further targets are known by their places: extras may have no room for their names. */
    for (size_t k = 0; k < d->morph_count; k++) {
        const size_t place = d->morphs[k].places[mesh];
        const char *const name = d->morphs[k].name;
        if (place >= count)
            continue;
        if (!ffd_intern_find(&w->clip->names, name, strlen(name), &names[place]))
            names[place] = IS_ZERO;
        any = true;
    }
    return any;
}

/* Finds the weights of targets that the clip does not drive. default_value: the JSON value of the first
   default weight. */
static void find_defaults(const gltf_document *d, const uint32_t *names, size_t count, uint32_t default_value,
                          double *row)
{
    for (size_t t = 0; t < count; t++) {
        row[t] = 0;
        if (default_value == JSON_NONE)
            continue;
        if (names[t] == KEEPS && !ffd_gltf_weight(d, default_value, &row[t]))
            row[t] = 0;
        default_value = ffd_json_tree_after(&d->tree, default_value);
    }
}

/* Appends the weights of all keys. Returns false if memory runs out. */
static bool put_weights(clip_writer *w, const uint32_t *names, size_t count, uint32_t default_value)
{
    const morph_clip *const clip = w->clip;
    double *const row = ffd_alloc(count, sizeof *row);
    double *const weights = ffd_alloc_zero(clip->names.count, sizeof *weights); /* of one key, by name */
    const bool done = row && weights;
    if (done)
        find_defaults(w->file->document, names, count, default_value, row);
    for (size_t k = 0; done && k < clip->key_count; k++) {
        for (size_t i = clip->starts[k]; i < clip->starts[k + 1]; i++)
            weights[clip->weights[i].target] = clip->weights[i].weight;
        for (size_t t = 0; t < count; t++)
            ffd_buffer_float(&w->file->bytes, names[t] < IS_ZERO ? weights[names[t]] : row[t]);
        for (size_t i = clip->starts[k]; i < clip->starts[k + 1]; i++)
            weights[clip->weights[i].target] = 0;
    }
    ffd_free(row);
    ffd_free(weights);
    return done;
}

/* Adds a sampler for the nodes of a mesh. */
static ffd_status add_sampler(clip_writer *w, const uint32_t *names, size_t count, uint32_t default_value)
{
    const uint64_t value_count = (uint64_t)w->clip->key_count * count;
    TRY(ffd_budget_take(&w->budget, value_count, sizeof(float), w->error));
    if (w->input == GLTF_NONE)
        add_times(w);
    const size_t output = add_accessor(w, (size_t)value_count, "");
    ffd_buffer_format(&w->sampler_text, "%s{\"input\":%zu,\"interpolation\":\"LINEAR\",\"output\":%zu}",
                      w->sampler_count++ > 0 ? "," : "", w->input, output);
    return put_weights(w, names, count, default_value) ? FFD_OK : ffd_fail_memory(w->error);
}

/* Adds a channel for a node if the clip drives targets of its mesh. names: room for one per target. */
static ffd_status add_channel(clip_writer *w, size_t node, uint32_t *names)
{
    const gltf_document *const d = w->file->document;
    if (d->model.nodes[node].mesh < 0)
        return FFD_OK;
    const size_t mesh = (size_t)d->model.nodes[node].mesh, count = d->mesh_uses[mesh].target_count;
    const bool own = ffd_gltf_weights_of(d, d->node_values.values[node]) != JSON_NONE;
    size_t sampler = own ? GLTF_NONE : w->samplers[mesh];
    if (sampler == GLTF_NONE) {
        if (!find_driven(w, mesh, names, count))
            return FFD_OK;
        sampler = w->sampler_count;
        TRY(add_sampler(w, names, count, ffd_gltf_first_weight(d, mesh, node)));
        if (!own)
            w->samplers[mesh] = sampler;
    }
    ffd_buffer_format(&w->channel_text, "%s{\"sampler\":%zu,\"target\":{\"node\":%zu,\"path\":\"weights\"}}",
                      w->channel_count++ > 0 ? "," : "", sampler, node);
    return FFD_OK;
}

/* Returns the animation of the clip's name; JSON_NONE: none. */
static uint32_t find_animation(const clip_writer *w, uint32_t animations)
{
    const json_tree *const tree = &w->file->document->tree;
    for (uint32_t v = ffd_json_tree_first(tree, animations); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v)) {
        const uint32_t name = ffd_json_tree_member(tree, v, "name");
        if (name != JSON_NONE && ffd_json_tree_string_is(tree, name, w->clip->name))
            return v;
    }
    return JSON_NONE;
}

/* Counts the bytes that nothing but this animation and others that are replaced uses. Returns false if memory
   runs out. */
static bool count_own_bytes(const gltf_document *d, uint32_t animation, const gltf_values *replaced,
                            uint64_t *bytes)
{
    unsigned char *const users = ffd_gltf_count_users(d, replaced);
    bool *const own = ffd_alloc_zero(d->model.accessor_count, sizeof *own);
    if (users && own)
        ffd_gltf_mark_animation(d, animation, own);
    const bool counted = users && own && ffd_gltf_count_left_bytes(d, own, users, bytes);
    ffd_free(users);
    ffd_free(own);
    return counted;
}

/* Warns that an animation is replaced, with the bytes that nothing uses any more. */
static ffd_status warn_of_replaced(clip_writer *w, uint32_t old, const char *name)
{
    char left[80] = "";
    uint64_t bytes;
    w->replaced.count++;
    if (!count_own_bytes(w->file->document, old, &w->replaced, &bytes))
        return ffd_fail_memory(w->error);
    w->file->bytes_left += bytes;
    if (bytes > 0)
        snprintf(left, sizeof left, "; %" PRIu64 " bytes that only it used stay in the file", bytes);
    ffd_log_line(w->file->log, FFD_LOG_WARNING, "has an animation \"%s\" already: it is replaced%s", name,
                 left);
    return FFD_OK;
}

/* Replaces the animation of the clip's name, or adds the clip to the new animations. */
static ffd_status place_clip(clip_writer *w, uint32_t animations)
{
    gltf_edit *const file = w->file;
    const json_tree *const tree = &file->document->tree;
    const uint32_t old = find_animation(w, animations);
    char shown[80];
    byte_buffer text = {0};
    file->any = true;
    ffd_name_shown(w->clip->name, shown, sizeof shown);
    TRY(old == JSON_NONE ? FFD_OK : warn_of_replaced(w, old, shown));
    ffd_buffer_text(&text, old == JSON_NONE && w->added.size > 0 ? ",{\"name\":" : "{\"name\":");
    put_name(w->clip->name, &text);
    ffd_buffer_text(&text, ",\"channels\":[");
    ffd_buffer_append(&text, w->channel_text.data, w->channel_text.size);
    ffd_buffer_text(&text, "],\"samplers\":[");
    ffd_buffer_append(&text, w->sampler_text.data, w->sampler_text.size);
    ffd_buffer_text(&text, "]}");
    text.failed = text.failed || w->channel_text.failed || w->sampler_text.failed;
    if (old != JSON_NONE && !text.failed)
        ffd_edits_replace(&file->edits, tree->values[old].begin, tree->values[old].end, text.data, text.size);
    else if (!text.failed)
        ffd_buffer_append(&w->added, text.data, text.size);
    file->edits.failed = file->edits.failed || text.failed || w->added.failed;
    ffd_log_line(file->log, FFD_LOG_INFO, "animation \"%s\": %zu %s of %zu %s", shown, w->clip->key_count,
                 ffd_plural(w->clip->key_count, "key", "keys"), w->channel_count,
                 ffd_plural(w->channel_count, "node", "nodes"));
    ffd_buffer_free(&text);
    return FFD_OK;
}

static ffd_status add_clip(clip_writer *w, const morph_clip *clip, uint32_t *names, uint32_t animations)
{
    const gltf_document *const d = w->file->document;
    char shown[80];
    w->clip = clip;
    w->input = GLTF_NONE;
    w->sampler_count = w->channel_count = w->sampler_text.size = w->channel_text.size = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        w->samplers[m] = GLTF_NONE;
    for (size_t n = 0; n < d->model.node_count; n++)
        TRY(add_channel(w, n, names));
    ffd_name_shown(clip->name, shown, sizeof shown);
    if (w->channel_count > 0)
        return place_clip(w, animations);
    ffd_log_line(w->file->log, FFD_LOG_WARNING,
                 "no node has a morph target for the animation \"%s\": it is left out", shown);
    return FFD_OK;
}

/* Notes the animations that clips replace: those of their names, unless a clip drives nothing. names: room
   for one per target of a mesh. */
static void find_replaced(clip_writer *w, uint32_t *names, uint32_t animations)
{
    gltf_document *const d = w->file->document;
    for (size_t c = 0; c < d->clip_count; c++) {
        bool any = false;
        w->clip = &d->clips[c];
        const uint32_t old = find_animation(w, animations);
        for (size_t n = 0; n < d->model.node_count && old != JSON_NONE && !any; n++) {
            const int mesh = d->model.nodes[n].mesh;
            any = mesh >= 0 && find_driven(w, (size_t)mesh, names, d->mesh_uses[mesh].target_count);
        }
        if (any)
            d->replaced.values[d->replaced.count++] = old;
    }
}

static ffd_status add_all(clip_writer *w, uint32_t *names)
{
    gltf_document *const d = w->file->document;
    const uint32_t animations = ffd_json_tree_member(&d->tree, 0, "animations");
    find_replaced(w, names, animations);
    w->replaced.values = d->replaced.values;
    ffd_gltf_extend_weights(w->file);
    for (size_t c = 0; c < d->clip_count; c++)
        TRY(add_clip(w, &d->clips[c], names, animations));
    if (animations == JSON_NONE)
        ffd_gltf_add_elements(d, &(gltf_values){0}, "animations", &w->added, &w->file->edits);
    else if (w->added.size > 0)
        ffd_gltf_insert_last(d, animations, &w->added, &w->file->edits);
    return w->file->bytes.failed ? ffd_fail_memory(w->error) : FFD_OK;
}

ffd_status ffd_gltf_animate_weights(gltf_edit *edit, ffd_error *error)
{
    gltf_document *const d = edit->document;
    clip_writer w = {.file = edit, .budget = d->base.budget, .error = error};
    size_t most = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        most = d->mesh_uses[m].target_count > most ? d->mesh_uses[m].target_count : most;
    uint32_t *const names = ffd_alloc(most, sizeof *names);
    w.samplers = ffd_alloc(d->model.mesh_count, sizeof *w.samplers);
    d->replaced.values = ffd_alloc(d->clip_count, sizeof *d->replaced.values);
    const ffd_status status =
        names && w.samplers && d->replaced.values ? add_all(&w, names) : ffd_fail_memory(error);
    ffd_free(names);
    ffd_free(w.samplers);
    ffd_buffer_free(&w.sampler_text);
    ffd_buffer_free(&w.channel_text);
    ffd_buffer_free(&w.added);
    return status;
}
