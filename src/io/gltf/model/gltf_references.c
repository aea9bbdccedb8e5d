#include "io/gltf/model/gltf_references.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_index_table.h"
#include <string.h>

/* Where a node refers to an element, and where the list of these elements is. */
typedef struct place {
    const char *extension, *inside[3]; /* members inside the node; NULL: the end */
    const char *list_extension, *list; /* of the file */
} place;

static const place places[GLTF_REFERENCE_COUNT] = {
    [GLTF_CAMERA] = {NULL, {"camera"}, NULL, "cameras"},
    [GLTF_LIGHT] = {"KHR_lights_punctual", {"light"}, "KHR_lights_punctual", "lights"},
    [GLTF_LIGHT_PROFILE] = {"EXT_lights_ies", {"light"}, "EXT_lights_ies", "lights"},
    [GLTF_COLLIDER] = {"KHR_physics_rigid_bodies",
                       {"collider", "geometry", "shape"},
                       "KHR_implicit_shapes",
                       "shapes"},
    [GLTF_TRIGGER] = {"KHR_physics_rigid_bodies",
                      {"trigger", "geometry", "shape"},
                      "KHR_implicit_shapes",
                      "shapes"},
    [GLTF_OMI_COLLIDER] = {"OMI_physics_body", {"collider", "shape"}, "OMI_physics_shape", "shapes"},
    [GLTF_OMI_TRIGGER] = {"OMI_physics_body", {"trigger", "shape"}, "OMI_physics_shape", "shapes"},
    [GLTF_OLD_OMI_COLLIDER] = {"OMI_collider", {"collider"}, "OMI_collider", "colliders"},
    [GLTF_COLLIDER_NODE] = {"KHR_physics_rigid_bodies", {"collider", "geometry", "node"}, NULL, "nodes"},
    [GLTF_TRIGGER_NODE] = {"KHR_physics_rigid_bodies", {"trigger", "geometry", "node"}, NULL, "nodes"},
};

uint32_t ffd_gltf_reference(const gltf_document *d, size_t node, gltf_reference reference)
{
    const place *const at = &places[reference];
    uint32_t value = d->node_values.values[node];
    if (at->extension)
        value = ffd_gltf_extension(d, value, at->extension);
    for (size_t i = 0; i < sizeof at->inside / sizeof *at->inside && at->inside[i]; i++)
        value = ffd_json_tree_member(&d->tree, value, at->inside[i]);
    return value;
}

/* Returns the list of the elements of a kind; JSON_NONE: there is none. */
static uint32_t list_of(const gltf_document *d, gltf_reference reference)
{
    const place *const at = &places[reference];
    const uint32_t parent = at->list_extension ? ffd_gltf_extension(d, 0, at->list_extension) : 0;
    const uint32_t list = ffd_json_tree_member(&d->tree, parent, at->list);
    return list != JSON_NONE && d->tree.values[list].kind == JSON_ARRAY ? list : JSON_NONE;
}

uint32_t ffd_gltf_referred(const gltf_document *d, uint32_t value, gltf_reference reference)
{
    const uint32_t list = list_of(d, reference);
    const size_t index = list == JSON_NONE ? GLTF_NONE : ffd_gltf_index(d, value, d->tree.values[list].count);
    return index == GLTF_NONE ? JSON_NONE : ffd_json_tree_element(&d->tree, list, index);
}

bool ffd_gltf_refers(const gltf_document *d, uint32_t value, gltf_reference reference)
{
    const uint32_t list = list_of(d, reference);
    return list != JSON_NONE && ffd_gltf_index(d, value, d->tree.values[list].count) != GLTF_NONE;
}

static bool is_transform(const char *path)
{
    return strcmp(path, "translation") == 0 || strcmp(path, "rotation") == 0 || strcmp(path, "scale") == 0;
}

/* Returns the node of a pointer of KHR_animation_pointer like "/nodes/3/rotation". *known is false if that
   node does not exist. */
static size_t pointed_node(const gltf_document *d, const char *pointer, bool *known)
{
    static const char nodes[] = "/nodes/";
    const char *rest = "";
    *known = true;
    if (strncmp(pointer, nodes, sizeof nodes - 1) != 0)
        return GLTF_NONE;
    const size_t node = ffd_gltf_pointed(pointer, "nodes", &rest);
    *known = node < d->model.node_count && *rest == '/';
    return *known && is_transform(rest + 1) ? node : GLTF_NONE;
}

ffd_status ffd_gltf_animated_node(const gltf_document *d, uint32_t target, size_t *node, uint32_t *fault,
                                  ffd_error *error)
{
    const uint32_t extension = ffd_gltf_extension(d, target, "KHR_animation_pointer");
    const uint32_t named = ffd_json_tree_member(&d->tree, target, "node");
    const uint32_t member = extension == JSON_NONE ? ffd_json_tree_member(&d->tree, target, "path")
                                                   : ffd_json_tree_member(&d->tree, extension, "pointer");
    *node = GLTF_NONE;
    *fault = member == JSON_NONE ? target : member;
    if (member == JSON_NONE || d->tree.values[member].kind != JSON_STRING)
        return FFD_OK;
    bool known = true;
    char *text = ffd_json_tree_string(&d->tree, member, NULL);
    if (!text)
        return ffd_fail_memory(error);
    if (extension != JSON_NONE) {
        *node = pointed_node(d, text, &known);
    } else if (named != JSON_NONE) {
        const size_t found = ffd_gltf_node(d, named);
        known = found != GLTF_NONE;
        *fault = named;
        *node = is_transform(text) ? found : GLTF_NONE;
    }
    *fault = known ? JSON_NONE : *fault;
    ffd_free(text);
    return FFD_OK;
}

gltf_stand_ins ffd_gltf_stand_ins(const gltf_document *d, size_t node)
{
    const uint32_t levels = ffd_gltf_extension(d, d->node_values.values[node], "MSFT_lod");
    return (gltf_stand_ins){.document = d, .node = node, .detail = ffd_gltf_first(d, levels, "ids")};
}

size_t ffd_gltf_next_stand_in(gltf_stand_ins *walk)
{
    static const gltf_reference shapes[] = {GLTF_COLLIDER_NODE, GLTF_TRIGGER_NODE};
    const gltf_document *const d = walk->document;
    while (walk->detail != JSON_NONE) {
        const size_t found = ffd_gltf_node(d, walk->detail);
        walk->detail = ffd_json_tree_after(&d->tree, walk->detail);
        if (found != GLTF_NONE)
            return found;
    }
    walk->collides = true;
    while (walk->shapes < 2) {
        const uint32_t value = ffd_gltf_reference(d, walk->node, shapes[walk->shapes++]);
        const size_t found = value == JSON_NONE ? GLTF_NONE : ffd_gltf_node(d, value);
        if (found != GLTF_NONE)
            return found;
    }
    return GLTF_NONE;
}

size_t ffd_gltf_count_stand_ins(const gltf_document *d, bool collide)
{
    size_t count = 0;
    for (size_t n = 0; n < d->model.node_count; n++)
        count += d->stands_in[n] && d->collides[n] == collide && d->model.nodes[n].mesh >= 0;
    return count;
}
