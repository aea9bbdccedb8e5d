/* gltf_places.c - lists what a file places in the scene besides its vertices, and what else than a position
   such a place has. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_instancing.h"
#include "io/gltf/model/gltf_references.h"
#include "io/gltf/model/gltf_skin.h"
#include "io/gltf/model/gltf_vrm.h"
#include "io/gltf/read/gltf_document.h"
#include <string.h>

/* Marks of a node. */
enum {
    IS_SHOWN = 1, /* it is in the scene, or a joint of a skin in the scene */
    IS_CHOSEN = 2,
    IS_JOINT = 4,
    IS_ANIMATED = 8,
    HAS_SHAPE = 16,
    HAS_SELECTED = 32, /* its mesh has selected primitives, */
    HAS_OTHERS = 64    /* and some that are not selected */
};

typedef struct survey {
    const gltf_document *document;
    uint8_t *nodes;  /* marks, per node */
    uint8_t *holds;  /* per node: a set of PLACE_HOLDS */
    size_t *pending; /* a stack with room for all nodes */
} survey;

static void mark_joints(const survey *s, const gltf_skin *skin, uint8_t mark)
{
    for (size_t j = 0; j < skin->joint_count; j++)
        s->nodes[skin->joints[j]] |= mark;
}

static void mark_shown(const survey *s)
{
    const gltf_document *d = s->document;
    for (size_t i = 0; i < d->skin_values.count; i++)
        mark_joints(s, &d->skins[i], IS_JOINT);
    for (size_t n = 0; n < d->model.node_count; n++) {
        const gltf_node *node = &d->model.nodes[n];
        if (!d->in_scene[n])
            continue;
        s->nodes[n] |= IS_SHOWN;
        if (node->mesh >= 0 && node->skin >= 0)
            mark_joints(s, &d->skins[node->skin], IS_SHOWN);
    }
}

/* Chooses a node and its descendants, down to nodes with meshes, which have a selection of their own. */
static void choose_below(const survey *s, size_t root)
{
    size_t waiting = 0;
    if (s->nodes[root] & IS_CHOSEN)
        return;
    s->nodes[root] |= IS_CHOSEN;
    s->pending[waiting++] = root;
    while (waiting > 0) {
        const gltf_node *node = &s->document->model.nodes[s->pending[--waiting]];
        for (size_t i = 0; i < node->child_count; i++) {
            const size_t child = (size_t)node->children[i];
            if (s->nodes[child] & IS_CHOSEN || s->document->model.nodes[child].mesh >= 0)
                continue;
            s->nodes[child] |= IS_CHOSEN;
            s->pending[waiting++] = child;
        }
    }
}

static void choose_instance(const survey *s, const gltf_instance *instance)
{
    const gltf_document *d = s->document;
    s->nodes[instance->node] |= instance->selected ? HAS_SELECTED : HAS_OTHERS;
    if (!instance->selected)
        return;
    const gltf_skin *const skin = ffd_gltf_skin_of(d, instance);
    choose_below(s, instance->node);
    for (size_t j = 0; skin && j < skin->joint_count; j++)
        choose_below(s, skin->joints[j]);
}

static void mark_chosen(const survey *s)
{
    const gltf_document *d = s->document;
    for (size_t n = 0; n < d->model.node_count; n++)
        if (!d->selected_nodes || d->selected_nodes[n])
            s->nodes[n] |= IS_CHOSEN;
    for (size_t i = 0; i < d->instance_count && d->selected_nodes; i++)
        choose_instance(s, &d->instances[i]);
}

static void mark_node(const survey *s, size_t node, uint8_t mark)
{
    if (node != GLTF_NONE)
        s->nodes[node] |= mark;
}

static ffd_status mark_target(const survey *s, uint32_t target, ffd_error *error)
{
    size_t node;
    uint32_t fault;
    const ffd_status status = ffd_gltf_animated_node(s->document, target, &node, &fault, error);
    mark_node(s, node, IS_ANIMATED);
    return status;
}

static ffd_status mark_animated(const survey *s, ffd_error *error)
{
    const json_tree *tree = &s->document->tree;
    for (uint32_t a = ffd_gltf_first(s->document, 0, "animations"); a != JSON_NONE;
         a = ffd_json_tree_after(tree, a))
        for (uint32_t c = ffd_gltf_first(s->document, a, "channels"); c != JSON_NONE;
             c = ffd_json_tree_after(tree, c))
            TRY(mark_target(s, ffd_json_tree_member(tree, c, "target"), error));
    return FFD_OK;
}

static void mark_spring(const survey *s, size_t node)
{
    s->nodes[node] |= IS_ANIMATED;
    s->holds[node] |= PLACE_HOLDS_SPRING;
}

/* Marks a node and all its descendants, each once, so that cycles end. */
static void mark_springs_below(const survey *s, size_t root)
{
    size_t waiting = 0;
    if (s->holds[root] & PLACE_HOLDS_SPRING)
        return;
    mark_spring(s, root);
    s->pending[waiting++] = root;
    while (waiting > 0) {
        const gltf_node *const node = &s->document->model.nodes[s->pending[--waiting]];
        for (size_t i = 0; i < node->child_count; i++) {
            const size_t child = (size_t)node->children[i];
            if (s->holds[child] & PLACE_HOLDS_SPRING)
                continue;
            mark_spring(s, child);
            s->pending[waiting++] = child;
        }
    }
}

/* Nodes that springs, viewers or constraints turn count as animated, although no animation of the file does
   it. */
static void mark_vrm(void *context, size_t node, gltf_vrm_role role)
{
    const survey *const s = context;
    if (role == VRM_COLLIDER)
        s->nodes[node] |= HAS_SHAPE;
    else if (role == VRM_SPRING)
        mark_spring(s, node);
    else if (role == VRM_SPRING_ROOT)
        mark_springs_below(s, node);
    else if (role == VRM_EYES)
        s->holds[node] |= PLACE_HOLDS_EYES;
    else if (role != VRM_NAMED)
        s->nodes[node] |= IS_ANIMATED;
    if (role == VRM_AIM)
        s->holds[node] |= PLACE_HOLDS_AIM;
}

/* Whether a node has a reference of a kind from first to last. */
static bool refers(const gltf_document *d, size_t node, gltf_reference first, gltf_reference last)
{
    bool found = false;
    for (int i = (int)first; i <= (int)last && !found; i++)
        found = ffd_gltf_refers(d, ffd_gltf_reference(d, node, (gltf_reference)i), (gltf_reference)i);
    return found;
}

/* Returns the mesh that a physics shape is made of; GLTF_NONE: none. */
static size_t mesh_of_shape(const gltf_document *d, uint32_t shape)
{
    static const char *const kinds[] = {"trimesh", "convex"};
    uint32_t mesh = ffd_json_tree_member(&d->tree, shape, "mesh");
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds && mesh == JSON_NONE; k++)
        mesh = ffd_json_tree_member(&d->tree, ffd_json_tree_member(&d->tree, shape, kinds[k]), "mesh");
    return ffd_gltf_index(d, mesh, d->model.mesh_count);
}

/* Whether the scene shows a mesh where a node is, and nowhere else: it is deformed as the node wants it. */
static bool is_shown_at(const gltf_document *d, size_t mesh, size_t node)
{
    const gltf_mesh_uses *const uses = mesh == GLTF_NONE ? NULL : &d->mesh_uses[mesh];
    bool alike = uses && uses->nodes && uses->node_count > 0;
    for (size_t u = 0; alike && u < uses->node_count; u++)
        for (size_t i = 0; i < 12; i++)
            alike = alike && d->world[12 * uses->nodes[u] + i] == d->world[12 * node + i];
    return alike;
}

static void mark_shapes(const survey *s)
{
    const gltf_document *d = s->document;
    for (size_t n = 0; n < d->model.node_count; n++)
        /* A shape made from a mesh of the scene goes along with it. */
        for (int i = GLTF_COLLIDER; i <= (int)GLTF_OLD_OMI_COLLIDER; i++) {
            const gltf_reference kind = (gltf_reference)i;
            const uint32_t value = ffd_gltf_reference(d, n, kind);
            const bool is_old = kind == GLTF_OLD_OMI_COLLIDER &&
                                ffd_gltf_has_extension(d, d->node_values.values[n], "OMI_collider");
            if ((is_old || ffd_gltf_refers(d, value, kind)) &&
                !is_shown_at(d, mesh_of_shape(d, ffd_gltf_referred(d, value, kind)), n))
                s->nodes[n] |= HAS_SHAPE;
        }
}

static unsigned kinds_of(const survey *s, size_t n)
{
    const gltf_document *d = s->document;
    const gltf_node *node = &d->model.nodes[n];
    unsigned kinds = s->nodes[n] & IS_JOINT ? PLACE_BIT(FFD_BEHIND_JOINT) : 0;
    if (refers(d, n, GLTF_CAMERA, GLTF_CAMERA))
        kinds |= PLACE_BIT(FFD_BEHIND_CAMERA);
    if (refers(d, n, GLTF_LIGHT, GLTF_LIGHT_PROFILE))
        kinds |= PLACE_BIT(FFD_BEHIND_LIGHT);
    if (kinds == 0 && s->nodes[n] & IS_ANIMATED)
        kinds |= PLACE_BIT(FFD_BEHIND_PIVOT);
    if (s->nodes[n] & HAS_SHAPE)
        kinds |= PLACE_BIT(FFD_BEHIND_PHYSICS_SHAPE);
    if (kinds == 0 && node->mesh < 0 && node->child_count == 0)
        kinds |= PLACE_BIT(FFD_BEHIND_SOCKET);
    return kinds;
}

/* Whether the node places a mesh of its own, or has an extension. */
static bool has_own(const gltf_document *d, size_t n)
{
    return ffd_gltf_places_mesh(d, n) ||
           ffd_json_tree_member(&d->tree, d->node_values.values[n], "extensions") != JSON_NONE;
}

/* Tolerance of is_uneven, relative. */
#define UNEVEN 1e-6

/* Whether a node with children has a world matrix M that does not scale evenly in all directions: M^T M is
   not a multiple of the identity. */
static bool is_uneven(const gltf_document *d, size_t n)
{
    const double *const m = d->world + 12 * n;
    const double square = (vec_dot(m, m) + vec_dot(m + 3, m + 3) + vec_dot(m + 6, m + 6)) / 3;
    for (int r = 0; r < 3 && d->model.nodes[n].child_count > 0; r++)
        for (int c = 0; c <= r; c++) {
            const double sum = m[r] * m[c] + m[3 + r] * m[3 + c] + m[6 + r] * m[6 + c];
            if (fabs(sum - (r == c ? square : 0)) > UNEVEN * square)
                return true;
        }
    return false;
}

/* Whether a node is one that --rig follow moves or holds in place. Fills place. */
static bool is_anchor(const survey *s, size_t n, mesh_place *place)
{
    const gltf_document *d = s->document;
    const unsigned parts = HAS_SELECTED | HAS_OTHERS;
    const bool chosen = s->nodes[n] & IS_CHOSEN, instanced = ffd_gltf_instanced_node(d, n);
    if (!(s->nodes[n] & IS_SHOWN) || d->collides[n])
        return false;
    place->kinds = kinds_of(s, n);
    const bool follows = place->kinds || has_own(d, n) || is_uneven(d, n);
    place->partial = chosen && ffd_gltf_places_mesh(d, n) && (s->nodes[n] & parts) == parts;
    place->unselected = !chosen || (ffd_gltf_places_mesh(d, n) && (s->nodes[n] & parts) == HAS_OTHERS);
    place->stays = !chosen || instanced || place->partial;
    if (!chosen)
        place->kinds = 0;
    return follows;
}

static ffd_status list_nodes(const survey *s, bool all, mesh_places *places, ffd_error *error)
{
    const gltf_document *d = s->document;
    places->list = ffd_alloc(d->model.node_count, sizeof *places->list);
    if (!places->list)
        return ffd_fail_memory(error);
    for (size_t n = 0; n < d->model.node_count; n++) {
        mesh_place *place = &places->list[places->count];
        *place = (mesh_place){.index = n, .holds = s->holds[n]};
        memcpy(place->at, d->world + 12 * n + 9, sizeof place->at);
        places->count += is_anchor(s, n, place) && (all || place->kinds);
    }
    return FFD_OK;
}

ffd_status ffd_gltf_list_places(const mesh_document *document, bool all, mesh_places *places,
                                ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    const size_t count = d->model.node_count;
    *places = (mesh_places){0};
    if (d->space == FFD_SPACE_MESH)
        return FFD_OK; /* mesh space has no nodes */
    survey s = {.document = d,
                .nodes = ffd_alloc_zero(count, sizeof *s.nodes),
                .holds = ffd_alloc_zero(count, sizeof *s.holds),
                .pending = ffd_alloc(count, sizeof *s.pending)};
    ffd_status status;
    TRY_END(s.nodes && s.holds && s.pending ? FFD_OK : ffd_fail_memory(error));
    mark_shown(&s);
    mark_chosen(&s);
    mark_shapes(&s);
    ffd_gltf_visit_vrm(d, mark_vrm, &s);
    TRY_END(mark_animated(&s, error));
    TRY_END(list_nodes(&s, all, places, error));
end:
    ffd_free(s.nodes);
    ffd_free(s.holds);
    ffd_free(s.pending);
    return status;
}

/* Whether a skin has a marked joint. joined: set for all of its joints. */
static bool has_mark(const gltf_skin *skin, const uint8_t *marked, bool *joined)
{
    bool has = false;
    for (size_t j = 0; j < skin->joint_count; j++) {
        has = has || marked[skin->joints[j]];
        joined[skin->joints[j]] = true;
    }
    return has;
}

ffd_status ffd_gltf_count_skins(const mesh_document *document, const mesh_places *places,
                                const uint8_t *marks, uint64_t *count, uint64_t *loose, ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    uint8_t *const marked = ffd_alloc_zero(d->model.node_count, sizeof *marked);
    bool *const shown = ffd_alloc_zero(d->skin_values.count, sizeof *shown);
    bool *const joined = ffd_alloc_zero(d->model.node_count, sizeof *joined);
    const bool allocated = marked && shown && joined;
    *count = *loose = 0;
    for (size_t i = 0; i < places->count && allocated; i++)
        marked[places->list[i].index] = marks[i];
    for (size_t n = 0; n < d->model.node_count && allocated; n++)
        if (d->in_scene[n] && d->model.nodes[n].mesh >= 0 && d->model.nodes[n].skin >= 0)
            shown[d->model.nodes[n].skin] = true;
    for (size_t i = 0; i < d->skin_values.count && allocated; i++)
        *count += shown[i] && has_mark(&d->skins[i], marked, joined);
    for (size_t n = 0; n < d->model.node_count && allocated; n++)
        *loose += marked[n] && !joined[n];
    ffd_free(marked);
    ffd_free(shown);
    ffd_free(joined);
    return allocated ? FFD_OK : ffd_fail_memory(error);
}

char *ffd_gltf_place_name(const mesh_document *document, size_t index)
{
    const gltf_document *d = ffd_gltf_of(document);
    const uint32_t name = ffd_json_tree_member(&d->tree, d->node_values.values[index], "name");
    byte_buffer text = {0};
    if (name != JSON_NONE && d->tree.values[name].kind == JSON_STRING &&
        d->tree.values[name].end - d->tree.values[name].begin > 2)
        return ffd_json_tree_string(&d->tree, name, NULL);
    ffd_buffer_format(&text, "node %zu", index);
    return ffd_buffer_finish(&text);
}
