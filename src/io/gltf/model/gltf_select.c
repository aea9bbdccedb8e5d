/* gltf_select.c - finds the primitives and nodes that `--only` selects, and the vertices that these draw. */
#include "io/gltf/model/gltf_select.h"
#include "base/memory/memory.h"
#include "io/gltf/model/gltf_detail.h"
#include "io/gltf/model/gltf_faces.h"
#include "io/gltf/model/gltf_instancing.h"
#include <string.h>

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
    return ffd_json_span_member(&d->tree, 0, keys[kind]);
}

static ffd_status refuse_unknown(const gltf_document *d, const mesh_selector *selector, ffd_error *error)
{
    selector_nearest nearest = {.selector = selector};
    const uint32_t array = array_of(d, selector->kind);
    for (uint32_t v = ffd_json_span_first(&d->tree, array); v != JSON_NONE;
         v = ffd_json_span_after(&d->tree, v)) {
        const uint32_t member = ffd_json_span_member(&d->tree, v, "name");
        if (member == JSON_NONE || d->tree.values[member].kind != JSON_STRING)
            continue;
        size_t size;
        char *name = ffd_json_span_string(&d->tree, member, &size);
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

static void mark(const selecting *s, selector_kind kind, size_t number)
{
    size_t waiting = 0;
    if (kind == SELECT_NODE) {
        mark_node(s, number, &waiting);
        mark_below(s, waiting);
    } else if (kind == SELECT_MESH) {
        mark_mesh(s, number);
    } else {
        s->materials[number] = true;
    }
}

/* Marks all elements with the selector's name. */
static ffd_status mark_named(const selecting *s, const mesh_selector *selector, ffd_error *error)
{
    const gltf_document *d = s->document;
    const uint32_t array = array_of(d, selector->kind);
    size_t number = 0;
    bool found = false;
    for (uint32_t v = ffd_json_span_first(&d->tree, array); v != JSON_NONE;
         v = ffd_json_span_after(&d->tree, v), number++) {
        const uint32_t name = ffd_json_span_member(&d->tree, v, "name");
        if (name == JSON_NONE || !ffd_json_span_string_is(&d->tree, name, selector->name))
            continue;
        found = true;
        mark(s, selector->kind, number);
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

static bool has_material(const selecting *s, size_t m, size_t p)
{
    const gltf_document *d = s->document;
    double number;
    return ffd_json_span_number(&d->tree,
                                ffd_json_span_member(&d->tree, ffd_gltf_primitive_value(d, m, p), "material"),
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
        const ffd_status status = open_part(d, part, error);
        if (status)
            return status;
        for (size_t i = 0; i < count; i++)
            d->parts[part].selected[corners[i]] = 1;
        before = part;
    }
    return FFD_OK;
}

static ffd_status select_primitive(const selecting *s, size_t m, size_t p, ffd_error *error)
{
    gltf_document *d = s->document;
    const gltf_mesh_uses *uses = &d->mesh_uses[m];
    gltf_instance *instances = ffd_gltf_instances(d, m, p);
    const bool everywhere = s->meshes[m] || has_material(s, m, p);
    bool any = false;
    for (size_t n = 0; n < uses->node_count; n++) {
        const bool wanted = everywhere || (uses->nodes && s->nodes[uses->nodes[n]]);
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
    ffd_status status = ffd_gltf_read_corners(d, m, p, &corners, &count, error);
    for (size_t n = 0; n < uses->node_count && status == FFD_OK; n++)
        if (instances[n].selected)
            status = mark_vertices(d, &instances[n], corners, count, error);
    ffd_free(corners);
    return status;
}

static ffd_status select_all(selecting *s, ffd_error *error)
{
    gltf_document *d = s->document;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < s->count && status == FFD_OK; i++)
        status = mark_named(s, &s->selectors[i], error);
    if (status)
        return status;
    mark_meshes_of_nodes(s);
    for (size_t i = 0; i < d->base.part_count; i++)
        d->mesh_parts[i].skipped = true;
    for (size_t i = 0; i < d->instanced_node_count; i++)
        d->instanced_nodes[i].deselected = true;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count && status == FFD_OK; p++)
            status = select_primitive(s, m, p, error);
    return status;
}

ffd_status ffd_gltf_select(mesh_document *document, const mesh_selector *selectors, size_t count,
                           ffd_error *error)
{
    gltf_document *d = (gltf_document *)document;
    selecting s = {.document = d, .selectors = selectors, .count = count};
    const uint32_t materials = array_of(d, SELECT_MATERIAL);
    s.material_count = ffd_json_span_count(&d->tree, materials);
    s.nodes = ffd_alloc_zero(d->model.node_count, sizeof *s.nodes);
    s.pending = ffd_alloc(d->model.node_count, sizeof *s.pending);
    s.meshes = ffd_alloc_zero(d->model.mesh_count, sizeof *s.meshes);
    s.materials = ffd_alloc_zero(s.material_count, sizeof *s.materials);
    const bool allocated = s.nodes && s.pending && s.meshes && s.materials;
    const ffd_status status = allocated ? select_all(&s, error) : ffd_fail_memory(error);
    d->selected_nodes = s.nodes;
    ffd_free(s.pending);
    ffd_free(s.meshes);
    ffd_free(s.materials);
    return status;
}
