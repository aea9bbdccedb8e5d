/* gltf_listing.c - lists nodes with their descendants, meshes and materials by name, and what the scene shows
   of each. */
#include "io/gltf/model/gltf_listing.h"
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "io/gltf/model/gltf_detail.h"
#include "io/gltf/model/gltf_faces.h"
#include "io/gltf/model/gltf_scene.h"
#include "mesh/listing.h"
#include <string.h>

#define NO_NAME UINT32_MAX

/* The elements of one kind with their names. */
typedef struct kind_names {
    selector_kind kind;
    intern_table names;
    uint32_t *name; /* per element: the number of its name; NO_NAME: none */
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

static ffd_status draw_primitive(const surveying *s, size_t m, size_t p, size_t first, size_t count)
{
    const gltf_document *d = s->document;
    const gltf_instance *const instances = ffd_gltf_instances(d, m, p);
    uint32_t *corners;
    size_t corner_count;
    if (count == 0 || instances[first].part[GLTF_POSITION] == GLTF_NONE)
        return FFD_OK;
    const ffd_status status = ffd_gltf_read_corners(d, m, p, &corners, &corner_count, s->error);
    for (size_t n = first; n < first + count && status == FFD_OK; n++) {
        ffd_listing_draw(s->listing, instances[n].part[GLTF_POSITION], corners, corner_count);
        ffd_listing_draw_faces(s->listing, ffd_gltf_count_triangles(d, m, p));
    }
    ffd_free(corners);
    return status;
}

/* Draws a mesh for some of its uses. */
static ffd_status draw_mesh(const surveying *s, size_t m, size_t first, size_t count)
{
    ffd_status status = FFD_OK;
    for (size_t p = 0; p < s->document->model.meshes[m].primitive_count && status == FFD_OK; p++)
        status = draw_primitive(s, m, p, first, count);
    return status;
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
    ffd_status status = FFD_OK;
    while (waiting > 0 && status == FFD_OK) {
        const size_t number = s->pending[--waiting];
        const gltf_node *const node = &d->model.nodes[number];
        const gltf_mesh_uses *const uses = node->mesh >= 0 ? &d->mesh_uses[node->mesh] : NULL;
        const size_t use = uses && uses->nodes ? ffd_gltf_find_use(uses, number) : 0;
        if (uses && use < uses->node_count)
            status = draw_mesh(s, (size_t)node->mesh, use, 1);
        for (size_t i = 0; i < node->child_count; i++)
            add_pending(s, (size_t)node->children[i], &waiting);
        add_stand_ins(s, number, &waiting);
    }
    return status;
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
    ffd_status status = FFD_OK;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count && status == FFD_OK; p++)
            if (s->materials[d->first_primitive[m] + p] == material)
                status = draw_primitive(s, m, p, 0, d->mesh_uses[m].node_count);
    return status;
}

static ffd_status draw(const surveying *s, selector_kind kind, size_t number)
{
    if (kind == SELECT_NODE)
        return draw_node(s, number);
    return kind == SELECT_MESH ? draw_uses(s, number) : draw_material(s, number);
}

/* Finds the number of an element's name. */
static bool read_name(const gltf_document *d, uint32_t element, kind_names *k, uint32_t *name)
{
    const uint32_t member = ffd_json_span_member(&d->tree, element, "name");
    size_t size = 0;
    *name = NO_NAME;
    if (member == JSON_NONE || d->tree.values[member].kind != JSON_STRING)
        return true;
    char *const text = ffd_json_span_string(&d->tree, member, &size);
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
    ffd_status status = first ? FFD_OK : ffd_fail_memory(s->error);
    if (first)
        link_names(k, first);
    for (uint32_t n = 0; n < k->names.count && status == FFD_OK; n++) {
        const char *const name = ffd_intern_key(&k->names, n);
        status = ffd_listing_add(s->listing, k->kind, name, strlen(name), 0, s->error);
        for (size_t i = first[n]; i != GLTF_NONE && status == FFD_OK; i = k->next[i])
            status = draw(s, k->kind, i);
    }
    for (size_t i = 0; i < k->count && status == FFD_OK; i++) {
        if (k->name[i] != NO_NAME)
            continue;
        status = ffd_listing_add(s->listing, k->kind, NULL, 0, i, s->error);
        if (status == FFD_OK)
            status = draw(s, k->kind, i);
    }
    ffd_free(first);
    return status;
}

static void read_materials(const surveying *s)
{
    const gltf_document *d = s->document;
    for (size_t i = 0; i < d->primitive_values.count; i++) {
        double number;
        const uint32_t member = ffd_json_span_member(&d->tree, d->primitive_values.values[i], "material");
        const bool has = ffd_json_span_number(&d->tree, member, &number) && number >= 0 &&
                         number < (double)d->material_values.count;
        s->materials[i] = has ? (size_t)number : GLTF_NONE;
    }
}

static ffd_status list_all(const surveying *s)
{
    const gltf_document *d = s->document;
    const struct {
        selector_kind kind;
        const gltf_values *values;
    } kinds[] = {{SELECT_NODE, &d->node_values},
                 {SELECT_MESH, &d->mesh_values},
                 {SELECT_MATERIAL, &d->material_values}};
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds && status == FFD_OK; i++) {
        kind_names k = {.kind = kinds[i].kind};
        status = read_names(d, kinds[i].values, &k) ? list_names(s, &k) : ffd_fail_memory(s->error);
        ffd_intern_free(&k.names);
        ffd_free(k.name);
        ffd_free(k.next);
    }
    return status;
}

ffd_status ffd_gltf_list_parts(const mesh_document *document, mesh_listing *listing, ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    surveying s = {.document = d, .listing = listing, .error = error};
    s.pending = ffd_alloc(d->model.node_count, sizeof *s.pending);
    s.seen = ffd_alloc_zero(d->model.node_count, sizeof *s.seen);
    s.materials = ffd_alloc(d->primitive_values.count, sizeof *s.materials);
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
