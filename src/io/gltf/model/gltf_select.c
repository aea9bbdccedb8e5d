/* gltf_select.c - the names of parts and of what `--only` takes, and the primitives and nodes that it
 * selects; which vertices a selector names. */
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/model/gltf_faces.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_instancing.h"
#include "io/gltf/model/gltf_joints.h"
#include "io/gltf/model/gltf_references.h"
#include "io/gltf/model/gltf_scene.h"
#include "io/gltf/read/gltf_document.h"
#include "mesh/listing.h"
#include <stdio.h>
#include <string.h>

/* Counts and clears the marks of a part. first: the index of its first vertex. */
static uint64_t count_part(const gltf_document *d, size_t part, size_t first, uint8_t *marks)
{
    uint64_t count = 0;
    for (size_t i = 0; i < d->mesh_parts[part].vertex_count; i++) {
        count += marks[first + i] != 0;
        marks[first + i] = 0;
    }
    return count;
}

/* The same for all parts of the node that a part is of, or of its mesh in mesh space. */
static uint64_t count_node(const gltf_document *d, const gltf_part *of, const size_t *first, uint8_t *marks)
{
    uint64_t count = 0;
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *const instance = &d->instances[i];
        const size_t part = instance->part[GLTF_POSITION];
        if (instance->node == of->node && instance->primitive->mesh == of->primitive->mesh &&
            part != GLTF_NONE)
            count += count_part(d, part, first[part], marks);
    }
    return count;
}

/* Writes "node:NAME". Returns false if the element has no name. */
static bool write_name(const gltf_document *d, const char *array, const char *kind, size_t index, char *name,
                       size_t capacity)
{
    uint32_t value = ffd_json_tree_first(&d->tree, ffd_json_tree_member(&d->tree, 0, array));
    for (size_t i = 0; i < index && value != JSON_NONE; i++)
        value = ffd_json_tree_after(&d->tree, value);
    const uint32_t member = value == JSON_NONE ? JSON_NONE : ffd_json_tree_member(&d->tree, value, "name");
    if (member == JSON_NONE || d->tree.values[member].kind != JSON_STRING)
        return false;
    char *const text = ffd_json_tree_string(&d->tree, member, NULL);
    const bool named = text && *text;
    if (named) {
        const size_t begun = (size_t)snprintf(name, capacity, "%s:", kind);
        ffd_name_shown(text, name + begun, capacity - begun);
    }
    ffd_free(text);
    return named;
}

uint64_t ffd_gltf_name_part(const mesh_document *document, uint64_t vertex, uint8_t *marks, char *name,
                            size_t capacity)
{
    const gltf_document *d = ffd_gltf_of(document);
    size_t *first, part = 0;
    *name = 0;
    if (ffd_first_vertices(document, &first, NULL))
        return 0; /* without memory the result has no name, which is not worth a failure */
    while (d->mesh_parts[part].repeats_positions || vertex >= first[part] + d->mesh_parts[part].vertex_count)
        part++;
    const gltf_part *const of = &d->parts[part];
    uint64_t count = 0;
    if ((of->node != GLTF_NONE && write_name(d, "nodes", "node", of->node, name, capacity)) ||
        write_name(d, "meshes", "mesh", of->primitive->mesh, name, capacity))
        count = count_node(d, of, first, marks);
    ffd_free(first);
    return count;
}

#define NO_NAME UINT32_MAX

/* The elements of one kind with their names. */
typedef struct kind_names {
    selector_kind kind;
    intern_table names;
    uint32_t *name; /* per element: the index of its name; NO_NAME: none */
    size_t count;
    size_t *next; /* per element: the next one with the same name; GLTF_NONE: none */
} kind_names;

typedef struct surveying {
    const gltf_document *document;
    mesh_listing *listing;
    size_t *pending;   /* a stack with room for all nodes */
    size_t *seen;      /* per node: the listed thing for which it was drawn last */
    size_t *materials; /* per primitive of all meshes; GLTF_NONE: none */
    ffd_error *error;
} surveying;

static ffd_status draw_primitive(const surveying *s, const gltf_primitive *primitive, size_t first,
                                 size_t count)
{
    const gltf_document *d = s->document;
    const gltf_instance *const instances = ffd_gltf_instances(d, primitive);
    uint32_t *corners;
    size_t corner_count;
    if (count == 0 || instances[first].part[GLTF_POSITION] == GLTF_NONE)
        return FFD_OK;
    ffd_status status;
    TRY_END(ffd_gltf_read_corners(d, primitive, &corners, &corner_count, s->error));
    for (size_t n = first; n < first + count; n++) {
        ffd_listing_draw(s->listing, instances[n].part[GLTF_POSITION], corners, corner_count);
        ffd_listing_draw_faces(s->listing, ffd_gltf_count_triangles(d, primitive));
    }
end:
    ffd_free(corners);
    return status;
}

/* Draws a mesh for some of its uses. */
static ffd_status draw_mesh(const surveying *s, size_t m, size_t first, size_t count)
{
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(s->document, m, p));)
        TRY(draw_primitive(s, p, first, count));
    return FFD_OK;
}

static void add_pending(const surveying *s, size_t node, size_t *waiting)
{
    if (s->seen[node] == s->listing->count)
        return;
    s->seen[node] = s->listing->count;
    s->pending[(*waiting)++] = node;
}

/* Adds the nodes that stand for a node: they are selected with it. */
static void add_stand_ins(const surveying *s, size_t node, size_t *waiting)
{
    const gltf_document *d = s->document;
    gltf_stand_ins walk = ffd_gltf_stand_ins(d, node);
    for (size_t found; (found = ffd_gltf_next_stand_in(&walk)) != GLTF_NONE;)
        if (d->stands_in[found])
            add_pending(s, found, waiting);
}

/* Draws the pending nodes and all their descendants. */
static ffd_status draw_pending(const surveying *s, size_t waiting)
{
    const gltf_document *d = s->document;
    while (waiting > 0) {
        const size_t index = s->pending[--waiting];
        const gltf_node *const node = &d->model.nodes[index];
        const gltf_mesh_uses *const uses = node->mesh >= 0 ? &d->mesh_uses[node->mesh] : NULL;
        const size_t use = uses && uses->nodes ? ffd_gltf_find_use(uses, index) : 0;
        if (uses && use < uses->node_count)
            TRY(draw_mesh(s, (size_t)node->mesh, use, 1));
        for (size_t i = 0; i < node->child_count; i++)
            add_pending(s, (size_t)node->children[i], &waiting);
        add_stand_ins(s, index, &waiting);
    }
    return FFD_OK;
}

static ffd_status draw_node(const surveying *s, size_t node)
{
    size_t waiting = 0;
    add_pending(s, node, &waiting);
    return draw_pending(s, waiting);
}

/* Draws a mesh for all its uses, and the nodes that stand for its nodes. */
static ffd_status draw_uses(const surveying *s, size_t mesh)
{
    const gltf_mesh_uses *uses = &s->document->mesh_uses[mesh];
    const ffd_status status = draw_mesh(s, mesh, 0, uses->node_count);
    size_t waiting = 0;
    for (size_t i = 0; uses->nodes && i < uses->node_count; i++)
        s->seen[uses->nodes[i]] = s->listing->count;
    for (size_t i = 0; uses->nodes && i < uses->node_count; i++)
        add_stand_ins(s, uses->nodes[i], &waiting);
    return status ? status : draw_pending(s, waiting);
}

static ffd_status draw_material(const surveying *s, size_t material)
{
    const gltf_document *d = s->document;
    for (size_t i = 0; i < d->model.primitive_count; i++)
        if (s->materials[i] == material)
            TRY(draw_primitive(s, &d->model.primitives[i], 0,
                               d->mesh_uses[d->model.primitives[i].mesh].node_count));
    return FFD_OK;
}

static ffd_status draw(const surveying *s, selector_kind kind, size_t index)
{
    if (kind == SELECT_NODE)
        return draw_node(s, index);
    return kind == SELECT_MESH ? draw_uses(s, index) : draw_material(s, index);
}

/* Finds the index of an element's name. */
static bool read_name(const gltf_document *d, uint32_t element, kind_names *k, uint32_t *name)
{
    const uint32_t member = ffd_json_tree_member(&d->tree, element, "name");
    size_t size = 0;
    *name = NO_NAME;
    if (member == JSON_NONE || d->tree.values[member].kind != JSON_STRING)
        return true;
    char *const text = ffd_json_tree_string(&d->tree, member, &size);
    /* A name that cannot be a program's argument cannot be selected. */
    const bool usable = text && size > 0 && strlen(text) == size;
    const bool ok = text && (!usable || ffd_intern(&k->names, text, size, name));
    ffd_free(text);
    return ok;
}

static bool read_names(const gltf_document *d, const gltf_values *values, kind_names *k)
{
    bool ok = true;
    k->count = values->count;
    k->name = ffd_alloc(k->count, sizeof *k->name);
    k->next = ffd_alloc(k->count, sizeof *k->next);
    for (size_t i = 0; i < k->count && k->name && k->next && ok; i++)
        ok = read_name(d, values->values[i], k, &k->name[i]);
    return ok && k->name && k->next;
}

/* Links the elements of equal names. first: one per name. */
static void link_names(const kind_names *k, size_t *first)
{
    for (size_t n = 0; n < k->names.count; n++)
        first[n] = GLTF_NONE;
    for (size_t i = k->count; i-- > 0;)
        if (k->name[i] != NO_NAME) {
            k->next[i] = first[k->name[i]];
            first[k->name[i]] = i;
        }
}

static ffd_status list_names(const surveying *s, const kind_names *k)
{
    size_t *const first = ffd_alloc(k->names.count, sizeof *first);
    if (!first)
        return ffd_fail_memory(s->error);
    link_names(k, first);
    ffd_status status = FFD_OK;
    for (uint32_t n = 0; n < k->names.count; n++) {
        const char *const name = ffd_intern_key(&k->names, n);
        TRY_END(ffd_listing_add(s->listing, k->kind, name, strlen(name), 0, s->error));
        for (size_t i = first[n]; i != GLTF_NONE; i = k->next[i])
            TRY_END(draw(s, k->kind, i));
    }
    for (size_t i = 0; i < k->count; i++) {
        if (k->name[i] != NO_NAME)
            continue;
        TRY_END(ffd_listing_add(s->listing, k->kind, NULL, 0, i, s->error));
        TRY_END(draw(s, k->kind, i));
    }
end:
    ffd_free(first);
    return status;
}

static void read_materials(const surveying *s)
{
    const gltf_document *d = s->document;
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        double number;
        const uint32_t member = ffd_json_tree_member(&d->tree, d->model.primitives[i].value, "material");
        const bool has = ffd_json_tree_number(&d->tree, member, &number) && number >= 0 &&
                         number < (double)d->material_values.count;
        s->materials[i] = has ? (size_t)number : GLTF_NONE;
    }
}

static ffd_status list_kind(const surveying *s, selector_kind kind, const gltf_values *values)
{
    kind_names k = {.kind = kind};
    const ffd_status status =
        read_names(s->document, values, &k) ? list_names(s, &k) : ffd_fail_memory(s->error);
    ffd_intern_free(&k.names);
    ffd_free(k.name);
    ffd_free(k.next);
    return status;
}

static ffd_status list_all(const surveying *s)
{
    const gltf_document *d = s->document;
    TRY(list_kind(s, SELECT_NODE, &d->node_values));
    TRY(list_kind(s, SELECT_MESH, &d->mesh_values));
    return list_kind(s, SELECT_MATERIAL, &d->material_values);
}

ffd_status ffd_gltf_list_parts(const mesh_document *document, mesh_listing *listing, ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    surveying s = {.document = d, .listing = listing, .error = error};
    s.pending = ffd_alloc(d->model.node_count, sizeof *s.pending);
    s.seen = ffd_alloc_zero(d->model.node_count, sizeof *s.seen);
    s.materials = ffd_alloc(d->model.primitive_count, sizeof *s.materials);
    ffd_status status = FFD_OK;
    if (s.pending && s.seen && s.materials) {
        read_materials(&s);
        status = list_all(&s);
    } else {
        status = ffd_fail_memory(error);
    }
    ffd_free(s.pending);
    ffd_free(s.seen);
    ffd_free(s.materials);
    return status;
}

typedef struct selecting {
    gltf_document *document;
    const mesh_selector *selectors;
    size_t count;
    bool *nodes, *meshes, *materials; /* per element: whether it is selected */
    size_t *pending;                  /* a stack with room for all nodes */
    size_t material_count;
} selecting;

static uint32_t array_of(const gltf_document *d, selector_kind kind)
{
    static const char *const keys[SELECTOR_KINDS] = {
        [SELECT_NODE] = "nodes", [SELECT_MESH] = "meshes", [SELECT_MATERIAL] = "materials"};
    return ffd_json_tree_member(&d->tree, 0, keys[kind]);
}

static ffd_status refuse_unknown(const gltf_document *d, const mesh_selector *selector, ffd_error *error)
{
    selector_nearest nearest = {.selector = selector};
    const uint32_t array = array_of(d, selector->kind);
    for (uint32_t v = ffd_json_tree_first(&d->tree, array); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v)) {
        const uint32_t member = ffd_json_tree_member(&d->tree, v, "name");
        if (member == JSON_NONE || d->tree.values[member].kind != JSON_STRING)
            continue;
        size_t size;
        char *name = ffd_json_tree_string(&d->tree, member, &size);
        if (!name)
            return ffd_fail_memory(error);
        ffd_selector_offer(&nearest, name, size);
        ffd_free(name);
    }
    return ffd_selector_unknown(&nearest, d->name, error);
}

static void mark_node(const selecting *s, size_t node, size_t *waiting)
{
    if (s->nodes[node])
        return;
    s->nodes[node] = true;
    s->pending[(*waiting)++] = node;
}

/* Marks the nodes that stand for a node. */
static void mark_stand_ins(const selecting *s, size_t node, size_t *waiting)
{
    const gltf_document *d = s->document;
    gltf_stand_ins walk = ffd_gltf_stand_ins(d, node);
    for (size_t found; (found = ffd_gltf_next_stand_in(&walk)) != GLTF_NONE;)
        if (d->stands_in[found])
            mark_node(s, found, waiting);
}

/* Marks the descendants of the waiting nodes, and the nodes that stand for any of them. */
static void mark_below(const selecting *s, size_t waiting)
{
    while (waiting > 0) {
        const size_t n = s->pending[--waiting];
        const gltf_node *node = &s->document->model.nodes[n];
        for (size_t i = 0; i < node->child_count; i++)
            mark_node(s, (size_t)node->children[i], &waiting);
        mark_stand_ins(s, n, &waiting);
    }
}

/* Marks a mesh, and the nodes that stand for its nodes. */
static void mark_mesh(const selecting *s, size_t mesh)
{
    const gltf_mesh_uses *uses = &s->document->mesh_uses[mesh];
    size_t waiting = 0;
    s->meshes[mesh] = true;
    for (size_t i = 0; uses->nodes && i < uses->node_count; i++)
        mark_stand_ins(s, uses->nodes[i], &waiting);
    mark_below(s, waiting);
}

static void mark(const selecting *s, selector_kind kind, size_t index)
{
    size_t waiting = 0;
    if (kind == SELECT_NODE) {
        mark_node(s, index, &waiting);
        mark_below(s, waiting);
    } else if (kind == SELECT_MESH) {
        mark_mesh(s, index);
    } else {
        s->materials[index] = true;
    }
}

/* Marks all elements with the selector's name. */
static ffd_status mark_named(const selecting *s, const mesh_selector *selector, ffd_error *error)
{
    const gltf_document *d = s->document;
    const uint32_t array = array_of(d, selector->kind);
    size_t index = 0;
    bool found = false;
    for (uint32_t v = ffd_json_tree_first(&d->tree, array); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v), index++) {
        const uint32_t name = ffd_json_tree_member(&d->tree, v, "name");
        if (name == JSON_NONE || !ffd_json_tree_string_is(&d->tree, name, selector->name))
            continue;
        found = true;
        mark(s, selector->kind, index);
    }
    return found ? FFD_OK : refuse_unknown(d, selector, error);
}

/* In mesh space, selecting a node selects its mesh. */
static void mark_meshes_of_nodes(const selecting *s)
{
    const gltf_model *model = &s->document->model;
    for (size_t n = 0; n < model->node_count && s->document->space == FFD_SPACE_MESH; n++)
        if (s->nodes[n] && model->nodes[n].mesh >= 0)
            s->meshes[model->nodes[n].mesh] = true;
}

static bool has_material(const selecting *s, const gltf_primitive *primitive)
{
    const gltf_document *d = s->document;
    double number;
    return ffd_json_tree_number(&d->tree, ffd_json_tree_member(&d->tree, primitive->value, "material"),
                                &number) &&
           number >= 0 && number < (double)s->material_count && s->materials[(size_t)number];
}

/* Allocates a part's selection, empty. */
static ffd_status open_part(gltf_document *d, size_t part, ffd_error *error)
{
    if (d->parts[part].selected)
        return FFD_OK;
    d->parts[part].selected = ffd_alloc_zero(d->mesh_parts[part].vertex_count, 1);
    if (!d->parts[part].selected)
        return ffd_fail_memory(error);
    d->mesh_parts[part].selected = d->parts[part].selected;
    d->mesh_parts[part].skipped = false;
    return FFD_OK;
}

/* Marks the vertices that a primitive draws in the parts of one instance. */
static ffd_status mark_vertices(gltf_document *d, const gltf_instance *instance, const uint32_t *corners,
                                size_t count, ffd_error *error)
{
    size_t before = GLTF_NONE;
    for (int s = 0; s < GLTF_DEFORMED; s++) {
        const size_t part = instance->part[s];
        if (part == GLTF_NONE || part == before)
            continue;
        TRY(open_part(d, part, error));
        for (size_t i = 0; i < count; i++)
            d->parts[part].selected[corners[i]] = 1;
        before = part;
    }
    return FFD_OK;
}

/* Whether the selectors name a use of a primitive's mesh. everywhere: they name the mesh or the material. */
static bool is_wanted(const selecting *s, const gltf_mesh_uses *uses, size_t use, bool everywhere)
{
    return everywhere || (uses->nodes && s->nodes[uses->nodes[use]]);
}

static ffd_status select_primitive(const selecting *s, const gltf_primitive *primitive, ffd_error *error)
{
    gltf_document *d = s->document;
    const gltf_mesh_uses *uses = &d->mesh_uses[primitive->mesh];
    gltf_instance *instances = ffd_gltf_instances(d, primitive);
    const bool everywhere = s->meshes[primitive->mesh] || has_material(s, primitive);
    bool any = false;
    for (size_t n = 0; n < uses->node_count; n++) {
        const bool wanted = is_wanted(s, uses, n, everywhere);
        gltf_instanced_node *instanced = uses->nodes ? ffd_gltf_instanced_node(d, uses->nodes[n]) : NULL;
        instances[n].selected = wanted && !instanced;
        if (wanted && instanced)
            instanced->deselected = false;
        any = any || (instances[n].selected && instances[n].part[GLTF_POSITION] != GLTF_NONE);
    }
    if (!any)
        return FFD_OK;
    uint32_t *corners;
    size_t count;
    ffd_status status;
    TRY_END(ffd_gltf_read_corners(d, primitive, &corners, &count, error));
    for (size_t n = 0; n < uses->node_count; n++)
        if (instances[n].selected)
            TRY_END(mark_vertices(d, &instances[n], corners, count, error));
end:
    ffd_free(corners);
    return status;
}

static ffd_status select_all(selecting *s, ffd_error *error)
{
    gltf_document *d = s->document;
    for (size_t i = 0; i < s->count; i++)
        TRY(mark_named(s, &s->selectors[i], error));
    mark_meshes_of_nodes(s);
    for (size_t i = 0; i < d->base.part_count; i++)
        d->mesh_parts[i].skipped = true;
    for (size_t i = 0; i < d->instanced_node_count; i++)
        d->instanced_nodes[i].deselected = true;
    for (size_t i = 0; i < d->model.primitive_count; i++)
        TRY(select_primitive(s, &d->model.primitives[i], error));
    return FFD_OK;
}

static ffd_status begin(gltf_document *d, const mesh_selector *selectors, size_t count, selecting *s,
                        ffd_error *error)
{
    *s = (selecting){.document = d, .selectors = selectors, .count = count};
    s->material_count = ffd_json_tree_count(&d->tree, array_of(d, SELECT_MATERIAL));
    s->nodes = ffd_alloc_zero(d->model.node_count, sizeof *s->nodes);
    s->pending = ffd_alloc(d->model.node_count, sizeof *s->pending);
    s->meshes = ffd_alloc_zero(d->model.mesh_count, sizeof *s->meshes);
    s->materials = ffd_alloc_zero(s->material_count, sizeof *s->materials);
    return s->nodes && s->pending && s->meshes && s->materials ? FFD_OK : ffd_fail_memory(error);
}

/* Frees all but nodes. */
static void end(const selecting *s)
{
    ffd_free(s->pending);
    ffd_free(s->meshes);
    ffd_free(s->materials);
}

ffd_status ffd_gltf_select(mesh_document *document, const mesh_selector *selectors, size_t count,
                           ffd_error *error)
{
    gltf_document *d = (gltf_document *)document;
    selecting s;
    const ffd_status begun = begin(d, selectors, count, &s, error);
    const ffd_status status = begun ? begun : select_all(&s, error);
    d->selected_nodes = s.nodes;
    end(&s);
    return status;
}

/* Sets the marks of the vertices that the wanted uses of a primitive draw. first: of each part. */
static ffd_status mark_drawn(const selecting *s, const gltf_primitive *primitive, const size_t *first,
                             uint8_t *marks, ffd_error *error)
{
    const gltf_document *const d = s->document;
    const gltf_mesh_uses *const uses = &d->mesh_uses[primitive->mesh];
    const gltf_instance *const instances = ffd_gltf_instances(d, primitive);
    const bool everywhere = s->meshes[primitive->mesh] || has_material(s, primitive);
    uint32_t *corners = NULL;
    size_t count = 0;
    for (size_t n = 0; n < uses->node_count; n++) {
        const size_t part = instances[n].part[GLTF_POSITION];
        if (part == GLTF_NONE || !is_wanted(s, uses, n, everywhere))
            continue;
        if (!corners)
            TRY(ffd_gltf_read_corners(d, primitive, &corners, &count, error));
        for (size_t i = 0; i < count; i++)
            marks[first[part] + corners[i]] = 1;
    }
    ffd_free(corners);
    return FFD_OK;
}

/* Marks the joints of a name. */
static ffd_status mark_joints(const selecting *s, ffd_error *error)
{
    const gltf_document *const d = s->document;
    selector_nearest nearest = {.selector = s->selectors};
    bool found = false;
    for (size_t k = 0; k < d->skin_values.count; k++)
        for (size_t j = 0; j < d->skins[k].joint_count; j++) {
            const size_t node = d->skins[k].joints[j];
            const uint32_t member = ffd_json_tree_member(&d->tree, d->node_values.values[node], "name");
            if (member == JSON_NONE || d->tree.values[member].kind != JSON_STRING)
                continue;
            size_t size;
            char *const name = ffd_json_tree_string(&d->tree, member, &size);
            if (!name)
                return ffd_fail_memory(error);
            s->nodes[node] = ffd_selector_is(s->selectors, name, size);
            found = found || s->nodes[node];
            ffd_selector_offer(&nearest, name, size);
            ffd_free(name);
        }
    return found ? FFD_OK : ffd_selector_unknown(&nearest, d->name, error);
}

/* Sets the marks of the vertices that follow marked joints with more than half of their weight. */
static ffd_status mark_followers(const selecting *s, const size_t *first, uint8_t *marks, ffd_error *error)
{
    const gltf_document *const d = s->document;
    double *shares = NULL;
    ffd_status status = FFD_OK;
    for (size_t p = 0; p < d->base.part_count; p++) {
        const size_t count = d->mesh_parts[p].vertex_count;
        if (!d->parts[p].skin || d->mesh_parts[p].repeats_positions)
            continue;
        ffd_free(shares);
        shares = ffd_alloc(count, sizeof *shares);
        TRY_END(shares ? FFD_OK : ffd_fail_memory(error));
        TRY_END(ffd_gltf_joint_shares(d, p, s->nodes, shares, error));
        for (size_t v = 0; v < count; v++)
            marks[first[p] + v] = shares[v] > 0.5;
    }
end:
    ffd_free(shares);
    return status;
}

static ffd_status mark_all(const selecting *s, const size_t *first, uint8_t *marks, ffd_error *error)
{
    const gltf_document *const d = s->document;
    if (s->selectors->kind == SELECT_JOINT) {
        TRY(mark_joints(s, error));
        return mark_followers(s, first, marks, error);
    }
    TRY(mark_named(s, s->selectors, error));
    mark_meshes_of_nodes(s);
    for (size_t i = 0; i < d->model.primitive_count; i++)
        TRY(mark_drawn(s, &d->model.primitives[i], first, marks, error));
    return FFD_OK;
}

ffd_status ffd_gltf_mark(mesh_document *document, const mesh_selector *selector, uint8_t *marks,
                         ffd_error *error)
{
    selecting s;
    size_t *first = NULL;
    ffd_status status;
    TRY_END(begin((gltf_document *)document, selector, 1, &s, error));
    TRY_END(ffd_first_vertices(document, &first, error));
    status = mark_all(&s, first, marks, error);
end:
    end(&s);
    ffd_free(s.nodes);
    ffd_free(first);
    return status;
}
