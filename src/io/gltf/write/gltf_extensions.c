/* gltf_extensions.c - what no longer fits in extensions and extras: drops the extensions that the output no
   longer needs, and finds bounds of meshes. */
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/write/gltf_plan.h"
#include "io/gltf/write/gltf_saver.h"
#include <string.h>

#define TEXCOORD "TEXCOORD_"

/* Whether glTF 2.0 itself (3.7.2.1) does not allow this type for the attribute. */
static bool needs_quantization(const char *attribute, int component, bool normalized)
{
    if (component == GLTF_FLOAT)
        return false;
    for (int s = 0; s < GLTF_DEFORMED; s++)
        if (strcmp(attribute, ffd_gltf_semantic_names[s]) == 0)
            return true;
    return strncmp(attribute, TEXCOORD, sizeof TEXCOORD - 1) == 0 &&
           !(normalized && (component == GLTF_U8 || component == GLTF_U16));
}

/* The attributes of a primitive, or of one of its morph targets, for one use of its mesh. */
typedef struct attribute_set {
    const gltf_primitive *primitive;
    size_t use, first_slot;
    uint32_t attributes; /* a JSON value */
} attribute_set;

/* Returns the component type of an attribute in the output. accessor: its accessor in the input. */
static int output_component(const gltf_saver *saver, const attribute_set *set, const char *attribute,
                            const gltf_accessor *accessor)
{
    for (size_t s = 0; s < GLTF_DEFORMED; s++) {
        const size_t version =
            ffd_gltf_version_at(saver->document, &saver->plan, set->primitive, set->first_slot + s, set->use);
        if (strcmp(attribute, ffd_gltf_semantic_names[s]) == 0 && version != GLTF_NONE)
            return saver->plan.versions[version].component;
    }
    return accessor->component;
}

static bool are_quantized(gltf_saver *saver, const attribute_set *set)
{
    const gltf_document *d = saver->document;
    for (uint32_t v = ffd_json_tree_first(&d->tree, set->attributes); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v)) {
        double number;
        char *name = ffd_json_tree_key(&d->tree, v);
        if (!name || !ffd_json_tree_number(&d->tree, v, &number)) {
            saver->edits.failed = true;
            ffd_free(name);
            return true;
        }
        const gltf_accessor *accessor = &d->model.accessors[(size_t)number];
        const bool needed =
            needs_quantization(name, output_component(saver, set, name, accessor), accessor->normalized);
        ffd_free(name);
        if (needed)
            return true;
    }
    return false;
}

static bool is_quantized_mesh(gltf_saver *saver, size_t mesh, size_t use)
{
    const gltf_document *d = saver->document;
    for (const gltf_primitive *primitive = NULL; (primitive = ffd_gltf_next_primitive(d, mesh, primitive));) {
        const uint32_t targets = ffd_json_tree_member(&d->tree, primitive->value, "targets");
        attribute_set set = {primitive, use, 0,
                             ffd_json_tree_member(&d->tree, primitive->value, "attributes")};
        if (are_quantized(saver, &set))
            return true;
        for (uint32_t t = ffd_json_tree_first(&d->tree, targets); t != JSON_NONE;
             t = ffd_json_tree_after(&d->tree, t)) {
            set.first_slot += GLTF_DEFORMED;
            set.attributes = t;
            if (are_quantized(saver, &set))
                return true;
        }
    }
    return false;
}

/* Whether some accessor became floats and no other accessor needs the extension. */
static bool lost_quantization(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    bool lost = false;
    for (size_t i = 0; i < saver->plan.appended_count; i++) {
        const gltf_version *version = &saver->plan.versions[saver->plan.appended[i]];
        lost = lost ||
               (version->width == 0 && version->component != d->model.accessors[version->accessor].component);
    }
    for (size_t m = 0; m < d->model.mesh_count && lost; m++)
        lost = !is_quantized_mesh(saver, m, saver->plan.base_uses[m]);
    for (size_t i = 0; i < saver->plan.copy_count && lost; i++)
        lost = !is_quantized_mesh(saver, saver->plan.copies[i].mesh, saver->plan.copies[i].use);
    return lost;
}

/* Removes the names from a list. An empty list is not valid glTF: a list that would become empty is added to
   `empty` instead. Returns how many were added. */
static size_t take_out(gltf_saver *saver, const char *key, const char *const *names, size_t name_count,
                       uint32_t *empty)
{
    const json_tree *tree = &saver->document->tree;
    const uint32_t list = ffd_json_tree_member(tree, 0, key);
    if (list == JSON_NONE || tree->values[list].count == 0)
        return 0;
    uint32_t *gone = ffd_alloc(tree->values[list].count, sizeof *gone);
    size_t count = 0;
    if (!gone) {
        saver->edits.failed = true;
        return 0;
    }
    for (uint32_t v = ffd_json_tree_first(tree, list); v != JSON_NONE; v = ffd_json_tree_after(tree, v))
        for (size_t i = 0; i < name_count; i++)
            if (ffd_json_tree_string_is(tree, v, names[i])) {
                gone[count++] = v;
                break;
            }
    const bool all = count == tree->values[list].count;
    if (all)
        *empty = list;
    else
        ffd_edits_remove(&saver->edits, tree, list, gone, count);
    ffd_free(gone);
    return all;
}

void ffd_gltf_drop_extensions(gltf_saver *saver)
{
    static const struct {
        const char *name;
        bool (*is_lost)(gltf_saver *saver);
    } known[] = {{"KHR_mesh_quantization", lost_quantization},
                 {"KHR_draco_mesh_compression", ffd_gltf_lost_draco},
                 {"EXT_meshopt_compression", ffd_gltf_lost_ext_meshopt},
                 {"KHR_meshopt_compression", ffd_gltf_lost_khr_meshopt}};
    const char *names[sizeof known / sizeof *known];
    size_t name_count = 0, empty_count = 0;
    uint32_t empty[2];
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (known[i].is_lost(saver))
            names[name_count++] = known[i].name;
    if (name_count == 0)
        return;
    empty_count += take_out(saver, "extensionsUsed", names, name_count, &empty[empty_count]);
    empty_count += take_out(saver, "extensionsRequired", names, name_count, &empty[empty_count]);
    ffd_edits_remove(&saver->edits, &saver->document->tree, 0, empty, empty_count);
}

#define KEY_SIZE 64

typedef struct stale_search {
    const gltf_document *document;
    bool *meshes; /* per mesh: whether its shown shape changes */
    bool *nodes;  /* per node: whether it moves, or it or something below it shows a mesh that changes */
    bool any;
} stale_search;

/* Whether the positions of an instance change, as default weights show them. */
static bool is_instance_moved(const gltf_saver *saver, const gltf_instance *instance, size_t use)
{
    const gltf_document *const d = saver->document;
    const gltf_primitive *const primitive = instance->primitive;
    if (ffd_gltf_version_at(d, &saver->plan, primitive, GLTF_POSITION, use) != GLTF_NONE)
        return true;
    for (size_t k = 0; k < primitive->target_count; k++) {
        const size_t shape = d->targets[instance->first_target + k];
        const size_t slot = GLTF_DEFORMED * (k + 1) + GLTF_POSITION;
        if (shape != GLTF_NONE && d->shapes[shape - d->base.part_count].weight != 0 &&
            ffd_gltf_version_at(d, &saver->plan, primitive, slot, use) != GLTF_NONE)
            return true;
    }
    return false;
}

/* Marks a node and those above it. Levels of detail can form a cycle of parents. */
static void mark_node(stale_search *s, size_t n)
{
    for (; n != GLTF_NONE && !s->nodes[n]; n = s->document->parents[n])
        s->nodes[n] = true;
    s->any = true;
}

static void mark_all(stale_search *s, const gltf_saver *saver)
{
    const gltf_document *const d = s->document;
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *const instance = &d->instances[i];
        const size_t mesh = instance->primitive->mesh;
        const size_t use = (size_t)(instance - ffd_gltf_instances(d, instance->primitive));
        if (!is_instance_moved(saver, instance, use))
            continue;
        if (use == saver->plan.base_uses[mesh])
            s->meshes[mesh] = s->any = true;
        if (instance->node != GLTF_NONE)
            mark_node(s, instance->node);
    }
    /* In mesh space instances have no nodes. */
    for (size_t n = 0; n < d->model.node_count && d->space != FFD_SPACE_SCENE; n++)
        if (d->model.nodes[n].mesh >= 0 && s->meshes[d->model.nodes[n].mesh])
            mark_node(s, n);
    for (size_t i = 0; i < d->edit->rig.node_count; i++)
        mark_node(s, d->edit->rig.nodes[i].node);
}

static bool is_named_as_bounds(const json_tree *tree, const json_value *value)
{
    static const char *const words[] = {"bounds", "bounding", "bbox", "aabb"};
    char key[KEY_SIZE];
    size_t length = value->key_end - value->key_begin;
    if (length < KEY_SIZE)
        memcpy(key, tree->text + value->key_begin, length);
    else
        length = 0;
    for (size_t i = 0; i < length; i++)
        if (key[i] >= 'A' && key[i] <= 'Z')
            key[i] = (char)(key[i] - 'A' + 'a');
    key[length] = 0;
    for (size_t w = 0; w < sizeof words / sizeof *words; w++)
        if (strstr(key, words[w]))
            return true;
    return false;
}

static bool is_in_extension(const json_tree *tree, uint32_t value)
{
    for (uint32_t v = tree->values[value].parent; v != JSON_NONE; v = tree->values[v].parent)
        if (ffd_json_tree_key_is(tree, v, "extensions") || ffd_json_tree_key_is(tree, v, "extras"))
            return true;
    return false;
}

static bool is_value_before(const void *element, const void *value)
{
    return *(const uint32_t *)element < *(const uint32_t *)value;
}

/* Returns the index of an element of a list; GLTF_NONE if the list does not have it. */
static size_t index_in(const gltf_values *list, uint32_t element)
{
    const size_t i = lower_bound(&element, list->values, list->count, sizeof *list->values, is_value_before);
    return i < list->count && list->values[i] == element ? i : GLTF_NONE;
}

/* Whether what a value is of changes: the node or mesh that has it; for scenes and the rest, anything. */
static bool is_of_changed(const stale_search *s, uint32_t value)
{
    static const char *const flat[] = {"materials", "textures", "images", "samplers"};
    const json_tree *const tree = &s->document->tree;
    uint32_t element = value, list = tree->values[value].parent;
    for (; list != 0 && tree->values[list].parent != 0; list = tree->values[list].parent)
        element = list;
    const size_t node = index_in(&s->document->node_values, element);
    const size_t mesh = index_in(&s->document->mesh_values, element);
    if (node != GLTF_NONE)
        return s->nodes[node];
    if (mesh != GLTF_NONE)
        return s->meshes[mesh];
    for (size_t k = 0; k < sizeof flat / sizeof *flat; k++)
        if (list != 0 && ffd_json_tree_key_is(tree, list, flat[k]))
            return false;
    return s->any;
}

static void search(const stale_search *s, byte_buffer *found)
{
    const json_tree *const tree = &s->document->tree;
    for (uint32_t v = 1; v < tree->count;) {
        const json_value *const value = &tree->values[v];
        const bool holds =
            value->kind == JSON_ARRAY || value->kind == JSON_OBJECT || value->kind == JSON_NUMBER;
        const bool is_bounds = holds && is_named_as_bounds(tree, value) && is_in_extension(tree, v);
        if (is_bounds && is_of_changed(s, v))
            ffd_buffer_append(found, &v, sizeof v);
        v = is_bounds || ffd_gltf_is_replaced(s->document, v) ? value->next : v + 1;
    }
}

void ffd_gltf_warn_of_stale(gltf_saver *saver)
{
    const gltf_document *const d = saver->document;
    stale_search s = {.document = d};
    byte_buffer found = {0};
    s.meshes = ffd_alloc_zero(d->model.mesh_count, sizeof *s.meshes);
    s.nodes = ffd_alloc_zero(d->model.node_count, sizeof *s.nodes);
    if (s.meshes && s.nodes) {
        mark_all(&s, saver);
        if (s.any)
            search(&s, &found);
    } else {
        saver->edits.failed = true;
    }
    const size_t count = ffd_gltf_warn_of_values(
        saver, &found,
        "value in extensions and extras is named as bounds and stays as it was before the deformation",
        "values in extensions and extras are named as bounds and stay as they were before the deformation");
    if (saver->options->bounds_left)
        *saver->options->bounds_left = count;
    ffd_buffer_free(&found);
    ffd_free(s.meshes);
    ffd_free(s.nodes);
}
