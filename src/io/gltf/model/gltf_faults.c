/* gltf_faults.c - finds values that glTF does not allow but that viewers can do without. */
#include "io/gltf/model/gltf_faults.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/model/gltf_references.h"
#include "io/gltf/read/gltf_document.h"
#include "io/gltf/read/gltf_textures.h"
#include <stdio.h>
#include <string.h>

#define SHOWN 3 /* faults per kind that are named */

/* Faults of one kind: their number and the text about the first ones. */
typedef struct fault_list {
    const gltf_document *document;
    size_t count;
    uint32_t first; /* the first value that was added */
    char shown[SHOWN][160];
} fault_list;

/* Adds a value as its JSON pointer. */
static void add_value(fault_list *list, uint32_t value)
{
    if (list->count == 0)
        list->first = value;
    if (list->count < SHOWN)
        ffd_json_tree_pointer(&list->document->tree, value, list->shown[list->count],
                              sizeof list->shown[list->count]);
    list->count++;
}

/* Writes "a, b, c and 2 more". */
static void write_list(const fault_list *list, char *text, size_t capacity)
{
    size_t length = 0;
    for (size_t i = 0; i < SHOWN && i < list->count; i++)
        length +=
            (size_t)snprintf(text + length, capacity - length, "%s%s", i > 0 ? ", " : "", list->shown[i]);
    if (list->count > SHOWN)
        snprintf(text + length, capacity - length, " and %zu more", list->count - SHOWN);
}

static void check_details(fault_list *list, uint32_t node)
{
    const gltf_document *const d = list->document;
    const uint32_t extension = ffd_gltf_extension(d, node, "MSFT_lod");
    const uint32_t ids = ffd_json_tree_member(&d->tree, extension, "ids");
    if (extension == JSON_NONE)
        return;
    if (ids == JSON_NONE || d->tree.values[ids].kind != JSON_ARRAY) {
        add_value(list, ids == JSON_NONE ? extension : ids);
        return;
    }
    for (uint32_t v = ffd_json_tree_first(&d->tree, ids); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v))
        if (ffd_gltf_node(d, v) == GLTF_NONE)
            add_value(list, v);
}

static void check_visibility(fault_list *list, uint32_t node)
{
    const json_tree *const tree = &list->document->tree;
    const uint32_t extension = ffd_gltf_extension(list->document, node, "KHR_node_visibility");
    const uint32_t visible = ffd_json_tree_member(tree, extension, "visible");
    if (extension == JSON_NONE)
        return;
    if (tree->values[extension].kind != JSON_OBJECT)
        add_value(list, extension);
    else if (visible != JSON_NONE && tree->values[visible].kind != JSON_TRUE &&
             tree->values[visible].kind != JSON_FALSE)
        add_value(list, visible);
}

static void check_nodes(fault_list *list)
{
    const gltf_document *const d = list->document;
    for (size_t n = 0; n < d->model.node_count; n++) {
        check_details(list, d->node_values.values[n]);
        check_visibility(list, d->node_values.values[n]);
        for (int i = 0; i < GLTF_REFERENCE_COUNT; i++) {
            const uint32_t value = ffd_gltf_reference(d, n, (gltf_reference)i);
            if (value != JSON_NONE && !ffd_gltf_refers(d, value, (gltf_reference)i))
                add_value(list, value);
        }
    }
}

static void check_textures(fault_list *list)
{
    const gltf_document *const d = list->document;
    for (size_t m = 0; m < d->material_values.count; m++) {
        const uint32_t material = d->material_values.values[m];
        for (uint32_t v = ffd_gltf_next_texture(d, material, material); v != JSON_NONE;
             v = ffd_gltf_next_texture(d, material, v)) {
            gltf_texture_use use;
            gltf_texture_faults faults = {.count = 0};
            ffd_gltf_read_texture(d, v, &use, &faults);
            for (size_t i = 0; i < faults.count; i++)
                add_value(list, faults.values[i]);
        }
    }
}

static ffd_status check_animations(fault_list *list, ffd_error *error)
{
    const gltf_document *const d = list->document;
    const json_tree *const tree = &d->tree;
    for (uint32_t a = ffd_gltf_first(d, 0, "animations"); a != JSON_NONE; a = ffd_json_tree_after(tree, a))
        for (uint32_t c = ffd_gltf_first(d, a, "channels"); c != JSON_NONE;
             c = ffd_json_tree_after(tree, c)) {
            size_t node;
            uint32_t fault;
            TRY(ffd_gltf_animated_node(d, ffd_json_tree_member(tree, c, "target"), &node, &fault, error));
            if (fault != JSON_NONE)
                add_value(list, fault);
        }
    return FFD_OK;
}

/* Whether an object's default weights, if any, are one number per target. */
static bool has_sound_weights(const gltf_document *d, uint32_t object, size_t targets)
{
    const uint32_t array = ffd_json_tree_member(&d->tree, object, "weights");
    double weight;
    if (array == JSON_NONE)
        return true;
    if (d->tree.values[array].kind != JSON_ARRAY || d->tree.values[array].count != targets)
        return false;
    for (uint32_t v = ffd_json_tree_first(&d->tree, array); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v))
        if (!ffd_gltf_weight(d, v, &weight))
            return false;
    return true;
}

static ffd_status note_weights(gltf_document *d, uint32_t object, size_t targets, ffd_error *error)
{
    if (has_sound_weights(d, object, targets))
        return FFD_OK;
    return ffd_gltf_flaw(d, ffd_json_tree_member(&d->tree, object, "weights"), error,
                         "the default weights are not one finite number for each morph target: a missing or "
                         "other one counts as 0");
}

ffd_status ffd_gltf_note_weights(gltf_document *d, ffd_error *error)
{
    for (size_t m = 0; m < d->model.mesh_count; m++)
        TRY(note_weights(d, d->mesh_values.values[m], d->mesh_uses[m].target_count, error));
    for (size_t n = 0; n < d->model.node_count; n++) {
        const int mesh = d->model.nodes[n].mesh;
        TRY(note_weights(d, d->node_values.values[n], mesh < 0 ? 0 : d->mesh_uses[mesh].target_count, error));
    }
    return FFD_OK;
}

ffd_status ffd_gltf_warn_of_faults(const mesh_document *document, const mesh_log *log, ffd_error *error)
{
    const gltf_document *const d = ffd_gltf_of(document);
    fault_list list = {.document = d};
    char places[sizeof list.shown + 60];
    check_nodes(&list);
    TRY(check_animations(&list, error));
    check_textures(&list);
    if (list.count == 0)
        return FFD_OK;
    if (d->base.flaws.strict)
        return ffd_json_tree_fail(&d->tree, list.first, d->name, FFD_E_INVALID, error,
                                  "is not what glTF allows there");
    write_list(&list, places, sizeof places);
    ffd_log_line(log, FFD_LOG_WARNING, "%zu %s not what glTF allows there, and %s ignored: %s", list.count,
                 ffd_plural(list.count, "value is", "values are"), ffd_plural(list.count, "is", "are"),
                 places);
    return FFD_OK;
}
