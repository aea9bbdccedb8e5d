#include "io/gltf/model/gltf_scene.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "base/vector/vec.h"
#include "io/gltf/model/gltf_references.h"
#include <math.h>
#include <string.h>

static bool is_invisible(const gltf_document *d, size_t node)
{
    const uint32_t value = ffd_gltf_extension(d, d->node_values.values[node], "KHR_node_visibility");
    const uint32_t visible =
        value == JSON_NONE ? JSON_NONE : ffd_json_tree_member(&d->tree, value, "visible");
    return visible != JSON_NONE && d->tree.values[visible].kind == JSON_FALSE;
}

/* Fills document->hidden: an invisible node hides all its descendants. parents: per node; order: all nodes,
   parents before children. Errors: FFD_E_MEMORY. */
static ffd_status find_hidden(gltf_document *d, const size_t *parents, const size_t *order, ffd_error *error)
{
    for (size_t i = 0; i < d->model.node_count; i++) {
        const size_t n = order[i], parent = parents[n];
        if (!ffd_gltf_is_hidden(d, parent) && !is_invisible(d, n))
            continue;
        if (!d->hidden)
            d->hidden = ffd_alloc_zero(d->model.node_count, sizeof *d->hidden);
        if (!d->hidden)
            return ffd_fail_memory(error);
        d->hidden[n] = true;
    }
    return FFD_OK;
}

/* T R S, with the quaternion x,y,z,w (glTF 2.0, 3.5.3). */
void ffd_gltf_local_matrix(const gltf_node *node, double linear[9], double offset[3])
{
    if (node->has_matrix) {
        for (int r = 0; r < 3; r++) {
            for (int c = 0; c < 3; c++)
                linear[3 * r + c] = node->matrix[4 * c + r];
            offset[r] = node->matrix[12 + r];
        }
        return;
    }
    const double x = node->rotation[0], y = node->rotation[1], z = node->rotation[2], w = node->rotation[3];
    const double rotation[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                                2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                                2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++)
            linear[3 * r + c] = rotation[3 * r + c] * node->scale[c];
        offset[r] = node->translation[r];
    }
}

void ffd_gltf_join_matrix(const double parent[12], const double linear[9], const double offset[3],
                          double joined[12])
{
    mat_multiply(parent, linear, joined);
    mat_apply(parent, offset, joined + 9);
    for (int i = 0; i < 3; i++)
        joined[9 + i] += parent[9 + i];
}

static void set_world_matrix(gltf_document *d, size_t n, const double *parent)
{
    double *world = d->world + 12 * n;
    double linear[9], offset[3];
    ffd_gltf_local_matrix(&d->model.nodes[n], linear, offset);
    if (parent) {
        ffd_gltf_join_matrix(parent, linear, offset, world);
        return;
    }
    memcpy(world, linear, sizeof linear);
    memcpy(world + 9, offset, sizeof offset);
}

/* *twice: a node that its parent lists twice, which is harmless; GLTF_NONE: none. */
static void find_parents(gltf_document *d, size_t *twice)
{
    size_t *const parents = d->parents;
    *twice = d->shared_child = GLTF_NONE;
    for (size_t n = 0; n < d->model.node_count; n++)
        parents[n] = GLTF_NONE;
    for (size_t n = 0; n < d->model.node_count; n++)
        for (size_t i = 0; i < d->model.nodes[n].child_count; i++) {
            const size_t child = (size_t)d->model.nodes[n].children[i];
            if (parents[child] == GLTF_NONE) {
                parents[child] = n;
            } else if (parents[child] == n) {
                *twice = child;
            } else if (d->shared_child == GLTF_NONE) {
                d->shared_child = child;
                d->shared_by[0] = parents[child];
                d->shared_by[1] = n;
            }
        }
}

/* Refuses cycles. Each node has one parent, so a node is in or below a cycle exactly if it cannot be reached
   from a root. order becomes all nodes, parents before children. */
static ffd_status refuse_cycles(const gltf_document *d, const size_t *parents, size_t *order,
                                ffd_error *error)
{
    size_t reached = 0, waiting = 0;
    bool *seen = ffd_alloc_zero(d->model.node_count, sizeof *seen);
    if (!seen)
        return ffd_fail_memory(error);
    for (size_t n = 0; n < d->model.node_count; n++)
        if (parents[n] == GLTF_NONE) {
            order[waiting++] = n;
            seen[n] = true;
        }
    while (reached < waiting) {
        const size_t n = order[reached++];
        const gltf_node *node = &d->model.nodes[n];
        for (size_t i = 0; i < node->child_count; i++) {
            const size_t child = (size_t)node->children[i];
            if (parents[child] == n && !seen[child])
                order[waiting++] = child;
            seen[child] = seen[child] || parents[child] == n;
        }
    }
    ffd_status status = FFD_OK;
    for (size_t n = 0; n < d->model.node_count && reached < d->model.node_count; n++)
        if (!seen[n])
            TRY_END(ffd_json_tree_fail(&d->tree, d->node_values.values[n], d->name, FFD_E_INVALID, error,
                                       "the node is its own ancestor, or below one that is"));
end:
    ffd_free(seen);
    return status;
}

/* All nodes get a world matrix, because joints may be outside the scene. */
static void set_world_matrices(gltf_document *d, const size_t *parents, const size_t *order)
{
    for (size_t i = 0; i < d->model.node_count; i++) {
        const size_t n = order[i], parent = parents[n];
        set_world_matrix(d, n, parent == GLTF_NONE ? NULL : d->world + 12 * parent);
    }
}

/* Adds a root and all its descendants to the end of the scene. */
static void add_subtree(gltf_document *d, size_t root, const size_t *parents, size_t *pending)
{
    size_t waiting = 0;
    pending[waiting++] = root;
    d->in_scene[root] = true;
    while (waiting > 0) {
        const size_t n = pending[--waiting];
        const gltf_node *node = &d->model.nodes[n];
        d->scene_ranks[n] = d->nodes_in_scene++;
        for (size_t i = node->child_count; i-- > 0;) { /* reversed, so that the first child is taken next */
            const size_t child = (size_t)node->children[i];
            if (parents[child] != n || d->in_scene[child])
                continue;
            d->in_scene[child] = true;
            pending[waiting++] = child;
        }
    }
}

/* Whether a world matrix is the identity. */
static bool is_identity(const double world[12])
{
    static const double identity[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    for (int i = 0; i < 12; i++)
        if (world[i] < identity[i] || world[i] > identity[i])
            return false;
    return true;
}

/* Notes a root that is also a child. It is placed by its parent; viewers that place it as a root show the
   same if the parent's world matrix is the identity. */
static ffd_status note_child(gltf_document *d, size_t root, size_t parent, ffd_error *error)
{
    const uint32_t value = d->node_values.values[root];
    if (is_identity(d->world + 12 * parent))
        return ffd_gltf_flaw(d, value, error,
                             "a scene names the node as a root, but it is a child of node %zu", parent);
    return ffd_gltf_flaw(d, value, error,
                         "a scene names the node as a root, but it is a child of node %zu, which places it: "
                         "viewers differ in this",
                         parent);
}

/* Sets named[n] if the scene lists node n or an ancestor. */
static ffd_status mark_named(gltf_document *d, const gltf_scene *scene, const size_t *parents,
                             const size_t *order, bool *named, ffd_error *error)
{
    for (size_t i = 0; i < scene->node_count; i++) {
        const size_t root = (size_t)scene->nodes[i];
        if (named[root])
            TRY(ffd_gltf_flaw(d, d->node_values.values[root], error, "the scene names the node twice"));
        else if (parents[root] != GLTF_NONE)
            TRY(note_child(d, root, parents[root], error));
        named[root] = true;
    }
    for (size_t i = 0; i < d->model.node_count; i++)
        if (parents[order[i]] != GLTF_NONE)
            named[order[i]] = named[order[i]] || named[parents[order[i]]];
    return FFD_OK;
}

/* Adds the nodes that the scene lists, except those below another listed node. */
static ffd_status add_scene(gltf_document *d, const size_t *parents, size_t *pending, ffd_error *error)
{
    const gltf_scene *scene = &d->model.scenes[d->model.scene >= 0 ? d->model.scene : 0];
    bool *named = ffd_alloc_zero(d->model.node_count, sizeof *named);
    if (!named)
        return ffd_fail_memory(error);
    ffd_status status;
    TRY_END(mark_named(d, scene, parents, pending, named, error));
    for (size_t i = 0; i < scene->node_count; i++) {
        const size_t root = (size_t)scene->nodes[i];
        const bool is_below = parents[root] != GLTF_NONE && named[parents[root]];
        if (!is_below && !d->in_scene[root])
            add_subtree(d, root, parents, pending);
    }
end:
    ffd_free(named);
    return status;
}

/* Without scenes all roots are shown, except those that only replace others at a distance. */
static void add_roots(gltf_document *d, const size_t *parents, size_t *pending)
{
    const size_t count = d->model.node_count;
    for (size_t n = 0; n < count; n++) {
        gltf_stand_ins walk = ffd_gltf_stand_ins(d, n);
        for (size_t found; (found = ffd_gltf_next_stand_in(&walk)) != GLTF_NONE;)
            d->stands_in[found] = d->stands_in[found] || !walk.collides;
    }
    for (size_t n = 0; n < count; n++)
        if (parents[n] == GLTF_NONE && !d->stands_in[n])
            add_subtree(d, n, parents, pending);
    memset(d->stands_in, 0, count * sizeof *d->stands_in);
}

/* Adds a node to the scene that stands for another, placed by its parent. */
static void add_stand_in(gltf_document *d, size_t n, const size_t *parents, size_t *queue, size_t *added)
{
    if (d->collides[n])
        memcpy(d->world + 12 * n, d->world + 12 * parents[n], 12 * sizeof *d->world);
    else
        set_world_matrix(d, n, parents[n] == GLTF_NONE ? NULL : d->world + 12 * parents[n]);
    d->in_scene[n] = d->stands_in[n] = true;
    d->scene_ranks[n] = d->nodes_in_scene++;
    queue[(*added)++] = n;
}

/* Whether two nodes (GLTF_NONE: the scene itself) have equal world matrices. */
static bool stand_alike(const gltf_document *d, size_t a, size_t b)
{
    static const double scene[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    const double *const p = a == GLTF_NONE ? scene : d->world + 12 * a;
    const double *const q = b == GLTF_NONE ? scene : d->world + 12 * b;
    bool alike = true;
    for (int i = 0; i < 12; i++)
        alike = alike && p[i] == q[i];
    return alike;
}

/* Adds the shape of a node's collider or trigger, hidden. */
static ffd_status add_shape(gltf_document *d, size_t n, size_t shape, size_t *parents, size_t *queue,
                            size_t *added, ffd_error *error)
{
    if (d->in_scene[shape]) {
        d->shapes_shared += !stand_alike(d, shape, n);
        return FFD_OK;
    }
    if (!d->hidden)
        d->hidden = ffd_alloc_zero(d->model.node_count, sizeof *d->hidden);
    if (!d->hidden)
        return ffd_fail_memory(error);
    d->hidden[shape] = d->collides[shape] = true;
    parents[shape] = n;
    add_stand_in(d, shape, parents, queue, added);
    return FFD_OK;
}

/* Adds a coarser level of a node. It is placed as a child of the node's parent, whatever its own parent. */
static void add_detail(gltf_document *d, size_t n, size_t detail, size_t *parents, size_t *queue,
                       size_t *added)
{
    if (!d->in_scene[detail]) {
        parents[detail] = parents[n];
        add_stand_in(d, detail, parents, queue, added);
    } else if (d->stands_in[detail]) {
        d->details_shared += !stand_alike(d, parents[detail], parents[n]);
    }
}

/* Adds the nodes that stand for a node of the scene, and those below a node that does. */
static ffd_status add_below(gltf_document *d, size_t n, size_t *parents, size_t *queue, size_t *added,
                            ffd_error *error)
{
    const gltf_node *const node = &d->model.nodes[n];
    gltf_stand_ins walk = ffd_gltf_stand_ins(d, n);
    for (size_t c = 0; c < node->child_count && d->stands_in[n]; c++) {
        const size_t child = (size_t)node->children[c];
        if (parents[child] == n && !d->in_scene[child])
            add_stand_in(d, child, parents, queue, added);
    }
    for (size_t found; (found = ffd_gltf_next_stand_in(&walk)) != GLTF_NONE;)
        if (walk.collides)
            TRY(add_shape(d, n, found, parents, queue, added, error));
        else
            add_detail(d, n, found, parents, queue, added);
    return FFD_OK;
}

/* Adds the coarser levels of detail of all nodes in the scene, and the shapes of their colliders. No scene
   lists them, since they are not shown together with these nodes. */
static ffd_status add_stand_ins(gltf_document *d, size_t *parents, size_t *queue, ffd_error *error)
{
    size_t added = 0;
    for (size_t n = 0; n < d->model.node_count; n++)
        if (d->in_scene[n])
            queue[added++] = n;
    for (size_t i = 0; i < added; i++)
        if (!d->collides[queue[i]])
            TRY(add_below(d, queue[i], parents, queue, &added, error));
    return FFD_OK;
}

static ffd_status refuse_infinite(const gltf_document *d, ffd_error *error)
{
    for (size_t n = 0; n < d->model.node_count; n++)
        for (int i = 0; d->in_scene[n] && i < 12; i++)
            if (!isfinite(d->world[12 * n + i]))
                return ffd_json_tree_fail(&d->tree, d->node_values.values[n], d->name, FFD_E_INVALID, error,
                                          "the node's matrix in the scene is not finite");
    return FFD_OK;
}

/* Lists the nodes of the scene that use each mesh. */
static ffd_status list_nodes(gltf_document *d, ffd_error *error)
{
    const gltf_model *model = &d->model;
    size_t total = 0;
    for (size_t n = 0; n < model->node_count; n++) {
        if (model->nodes[n].mesh < 0)
            continue;
        gltf_mesh_uses *uses = &d->mesh_uses[model->nodes[n].mesh];
        uses->is_used = true;
        uses->node_count += d->in_scene[n];
        uses->used_outside_scene = uses->used_outside_scene || !d->in_scene[n];
        d->nodes_outside_scene += !d->in_scene[n];
        total += d->in_scene[n];
    }
    d->scene_nodes = ffd_alloc(total, sizeof *d->scene_nodes);
    if (!d->scene_nodes)
        return ffd_fail_memory(error);
    size_t *next = d->scene_nodes;
    for (size_t m = 0; m < model->mesh_count; m++) {
        d->mesh_uses[m].nodes = next;
        next += d->mesh_uses[m].node_count;
        d->mesh_uses[m].used_outside_scene =
            d->mesh_uses[m].used_outside_scene || d->mesh_uses[m].node_count == 0;
        d->mesh_uses[m].node_count = 0;
    }
    for (size_t n = 0; n < model->node_count; n++)
        if (model->nodes[n].mesh >= 0 && d->in_scene[n]) {
            gltf_mesh_uses *uses = &d->mesh_uses[model->nodes[n].mesh];
            uses->nodes[uses->node_count++] = n;
        }
    return FFD_OK;
}

static bool is_node_before(const void *element, const void *node)
{
    return *(const size_t *)element < *(const size_t *)node;
}

size_t ffd_gltf_find_use(const gltf_mesh_uses *uses, size_t node)
{
    const size_t use = lower_bound(&node, uses->nodes, uses->node_count, sizeof *uses->nodes, is_node_before);
    return use < uses->node_count && uses->nodes[use] == node ? use : uses->node_count;
}

static void use_meshes_alone(gltf_document *d)
{
    for (size_t m = 0; m < d->model.mesh_count; m++)
        d->mesh_uses[m].node_count = 1;
}

static void count_targets(gltf_document *d)
{
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const gltf_primitive *const primitive = &d->model.primitives[i];
        gltf_mesh_uses *const uses = &d->mesh_uses[primitive->mesh];
        if (primitive->target_count > uses->target_count)
            uses->target_count = uses->filed_targets = primitive->target_count;
    }
}

/* Notes primitives with fewer morph targets than others of their mesh. Viewers do not move them by a weight
   of a target that they lack. */
static ffd_status note_unequal_targets(gltf_document *d, ffd_error *error)
{
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const gltf_primitive *const primitive = &d->model.primitives[i];
        const size_t count = primitive->target_count, most = d->mesh_uses[primitive->mesh].target_count;
        if (count < most)
            TRY(ffd_gltf_flaw(d, primitive->value, error,
                              "the primitive has %zu %s, but another one of its mesh has %zu: the "
                              "further ones do not move it",
                              count, ffd_plural(count, "morph target", "morph targets"), most));
    }
    return FFD_OK;
}

ffd_status ffd_gltf_make_scene(gltf_document *d, ffd_error *error)
{
    const size_t count = d->model.node_count;
    size_t twice;
    size_t *pending = ffd_alloc(count, sizeof *pending);
    d->parents = ffd_alloc(count, sizeof *d->parents);
    d->world = ffd_alloc_zero(count, 12 * sizeof *d->world);
    d->in_scene = ffd_alloc_zero(count, sizeof *d->in_scene);
    d->scene_ranks = ffd_alloc_zero(count, sizeof *d->scene_ranks);
    d->stands_in = ffd_alloc_zero(count, sizeof *d->stands_in);
    d->collides = ffd_alloc_zero(count, sizeof *d->collides);
    d->mesh_uses = ffd_alloc_zero(d->model.mesh_count, sizeof *d->mesh_uses);
    ffd_status status = FFD_OK;
    if (!d->parents || !pending || !d->world || !d->in_scene || !d->stands_in || !d->collides ||
        !d->scene_ranks || !d->mesh_uses)
        TRY_END(ffd_fail_memory(error));
    count_targets(d);
    find_parents(d, &twice);
    TRY_END(note_unequal_targets(d, error));
    if (twice != GLTF_NONE)
        TRY_END(ffd_gltf_flaw(d, d->node_values.values[twice], error,
                              "node %zu names the node twice as its child", d->parents[twice]));
    TRY_END(refuse_cycles(d, d->parents, pending, error));
    if (d->space == FFD_SPACE_MESH) {
        use_meshes_alone(d);
        goto end;
    }
    set_world_matrices(d, d->parents, pending);
    TRY_END(find_hidden(d, d->parents, pending, error));
    if (d->model.scene_count > 0)
        TRY_END(add_scene(d, d->parents, pending, error));
    else
        add_roots(d, d->parents, pending);
    TRY_END(add_stand_ins(d, d->parents, pending, error));
    TRY_END(refuse_infinite(d, error));
    TRY_END(list_nodes(d, error));
end:
    ffd_free(pending);
    return status;
}
