/* gltf_names.c - the names of animations, morph targets, joints, cameras and scenes, for `ffd info`. */
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_morphs.h"
#include "io/gltf/model/gltf_animation.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/read/gltf_document.h"
#include "io/gltf/read/gltf_elements.h"
#include <math.h>
#include <string.h>

/* Times that are read at once. */
#define BLOCK 256

/* Writes a text, or null for another value. */
static ffd_status write_text(const gltf_document *d, uint32_t value, const char *key, json_text *json,
                             ffd_error *error)
{
    if (value == JSON_NONE || d->tree.values[value].kind != JSON_STRING) {
        ffd_json_null(json, key);
        return FFD_OK;
    }
    char *const text = ffd_json_tree_string(&d->tree, value, NULL);
    if (!text)
        return ffd_fail_memory(error);
    ffd_json_string(json, key, text);
    ffd_free(text);
    return FFD_OK;
}

static ffd_status write_name(const gltf_document *d, uint32_t thing, const char *key, json_text *json,
                             ffd_error *error)
{
    return write_text(d, ffd_json_tree_member(&d->tree, thing, "name"), key, json, error);
}

/* Writes the names of all things of a list of the file. */
static ffd_status write_names(const gltf_document *d, const char *list, json_text *json, ffd_error *error)
{
    ffd_json_array(json, list, true);
    for (uint32_t v = ffd_gltf_first(d, 0, list); v != JSON_NONE; v = ffd_json_tree_after(&d->tree, v))
        TRY(write_name(d, v, NULL, json, error));
    ffd_json_end(json, ']');
    return FFD_OK;
}

/* Returns the latest of the times of an accessor; NAN if they cannot be read, or there is none. */
static double read_last(const gltf_document *d, size_t accessor)
{
    const gltf_accessor *const input = &d->model.accessors[accessor];
    double times[BLOCK], last = NAN;
    if (!d->layouts[accessor].readable || input->rows * input->columns != 1 || input->component != GLTF_FLOAT)
        return last;
    for (size_t first = 0; first < (size_t)input->count; first += BLOCK) {
        const size_t left = (size_t)input->count - first, count = left < BLOCK ? left : BLOCK;
        ffd_gltf_read(d, accessor, first, count, 1, times);
        for (size_t i = 0; i < count; i++)
            if (isfinite(times[i]) && !(times[i] <= last))
                last = times[i];
    }
    return last;
}

/* Returns the latest time of an animation. lasts: of each accessor, -INFINITY before it was read: many
   samplers share their times. */
static double find_last(const gltf_document *d, const gltf_animation *animation, double *lasts)
{
    double last = NAN;
    for (size_t s = 0; s < animation->sampler_count; s++) {
        const size_t input = animation->samplers[s].input;
        if (input == GLTF_NONE)
            continue;
        if (isinf(lasts[input]))
            lasts[input] = read_last(d, input);
        if (!isnan(lasts[input]) && !(lasts[input] <= last))
            last = lasts[input];
    }
    return last;
}

/* An animation lasts from 0 to its last key; its seconds are not known without keys. */
static ffd_status write_animations(gltf_document *d, json_text *json, ffd_error *error)
{
    const size_t accessors = d->model.accessor_count;
    double *const lasts = ffd_alloc(accessors, sizeof *lasts);
    gltf_animations animations;
    ffd_status status;
    TRY_END(ffd_gltf_list_animations(d, &animations, error));
    TRY_END(lasts ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < accessors; i++)
        lasts[i] = -INFINITY;
    ffd_json_array(json, "animations", false);
    for (size_t a = 0; a < animations.count; a++) {
        const gltf_animation *const animation = &animations.list[a];
        ffd_json_object(json, NULL, true);
        TRY_END(write_name(d, animation->value, "name", json, error));
        ffd_json_number(json, "seconds", find_last(d, animation, lasts));
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
end:
    ffd_gltf_free_animations(d, &animations);
    ffd_free(lasts);
    return status;
}

/* A name that a mesh before has is not repeated: one weight of a clip drives both. */
static ffd_status write_targets_of(const gltf_document *d, size_t mesh, intern_table *known, json_text *json,
                                   ffd_error *error)
{
    uint32_t *const names = ffd_gltf_list_target_names(d, mesh);
    ffd_status status;
    TRY_END(names ? FFD_OK : ffd_fail_memory(error));
    for (size_t t = 0; t < d->mesh_uses[mesh].target_count; t++) {
        uint32_t index = 0;
        const size_t before = known->count;
        char *const name = names[t] == JSON_NONE ? NULL : ffd_json_tree_string(&d->tree, names[t], NULL);
        if (names[t] != JSON_NONE && !name)
            TRY_END(ffd_fail_memory(error));
        const bool is_kept = !name || ffd_intern(known, name, strlen(name), &index);
        if (!name || known->count > before)
            ffd_json_string(json, NULL, name);
        ffd_free(name);
        TRY_END(is_kept ? FFD_OK : ffd_fail_memory(error));
    }
end:
    ffd_free(names);
    return status;
}

static ffd_status write_targets(const gltf_document *d, json_text *json, ffd_error *error)
{
    intern_table known = {0};
    ffd_status status = FFD_OK;
    ffd_json_array(json, "morph_targets", true);
    for (size_t mesh = 0; mesh < d->model.mesh_count && !status; mesh++)
        status = write_targets_of(d, mesh, &known, json, error);
    ffd_json_end(json, ']');
    ffd_intern_free(&known);
    return status;
}

/* Marks the nodes that a skin names as joints. */
static void mark_joints(const gltf_document *d, uint32_t skin, bool *is_joint)
{
    for (uint32_t v = ffd_gltf_first(d, skin, "joints"); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v)) {
        double node;
        if (ffd_json_tree_number(&d->tree, v, &node) && node >= 0 && node < (double)d->node_values.count &&
            node == floor_of(node))
            is_joint[(size_t)node] = true;
    }
}

static ffd_status write_joints(const gltf_document *d, json_text *json, ffd_error *error)
{
    bool *const is_joint = ffd_alloc_zero(d->node_values.count, sizeof *is_joint);
    ffd_status status;
    TRY_END(is_joint ? FFD_OK : ffd_fail_memory(error));
    for (uint32_t v = ffd_gltf_first(d, 0, "skins"); v != JSON_NONE; v = ffd_json_tree_after(&d->tree, v))
        mark_joints(d, v, is_joint);
    ffd_json_array(json, "joints", true);
    for (size_t n = 0; n < d->node_values.count; n++)
        if (is_joint[n])
            TRY_END(write_name(d, d->node_values.values[n], NULL, json, error));
    ffd_json_end(json, ']');
end:
    ffd_free(is_joint);
    return status;
}

ffd_status ffd_gltf_list_names(const mesh_document *document, json_text *json, ffd_error *error)
{
    gltf_document *const d = (gltf_document *)document;
    TRY(write_animations(d, json, error));
    TRY(write_targets(d, json, error));
    TRY(write_joints(d, json, error));
    TRY(write_names(d, "cameras", json, error));
    return write_names(d, "scenes", json, error);
}
