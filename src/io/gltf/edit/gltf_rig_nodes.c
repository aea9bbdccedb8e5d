/* gltf_rig_nodes.c - computes the transforms of nodes that follow the deformation. */
#include "base/memory/memory.h"
#include "base/vector/polar.h"
#include "base/vector/vec.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/model/gltf_scene.h"
#include <string.h>

/* Tolerance for an entry of g^T g against the identity: beyond it, g would shear the node. */
#define SHEAR 1e-6

/* The progress of a node. */
enum { IS_WAITING, IS_BEGUN, IS_DONE };

typedef struct node_walk {
    const gltf_document *document;
    gltf_rig *rig;
    mesh_following *following;
    const mesh_place **places; /* per node; NULL: it keeps its local transform */
    mesh_place_move **moves;
    uint8_t *states;
    bool *changed;  /* per node: whether its world matrix differs */
    bool *singular; /* per node: whether its world matrix or an ancestor's has no usable inverse */
    size_t *climb;  /* a stack */
} node_walk;

static const double identity[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

static const double *world_of(const node_walk *w, size_t n)
{
    return n == GLTF_NONE ? identity : w->document->world + 12 * n;
}

static const double *made_of(const node_walk *w, size_t n)
{
    return n == GLTF_NONE ? identity : w->rig->world + 12 * n;
}

/* Whether a matrix has a usable inverse: with a scale of 0 it has none, with 1e-30 it has. */
static bool has_inverse(const double m[9])
{
    double det, inverse[9];
    return !ffd_mat_is_singular(m, &det) && mat_invert(m, inverse);
}

/* Where and how a place moves. */
typedef struct target {
    double place[3], turn[9]; /* D(x), R */
    double gradient[9];       /* F */
} target;

static target find_target(const mesh_place *place, const mesh_place_move *move)
{
    target t;
    const bool stays = place->stays || !move->moves;
    memcpy(t.place, stays ? place->at : move->to, sizeof t.place);
    for (int i = 0; i < 9; i++)
        t.gradient[i] = identity[i] + (stays ? 0 : move->gradient[i]);
    ffd_mat_rotation(t.gradient, t.turn);
    return t;
}

static bool is_still(const mesh_place *place, const target *t)
{
    return ffd_mat_is_near_identity(t->turn, 0) && memcmp(t->place, place->at, sizeof t->place) == 0 &&
           ffd_mat_is_near_identity(t->gradient, 0);
}

/* product = inverse * middle * outer. */
static void conjugate(const double inverse[9], const double middle[9], const double outer[9],
                      double product[9])
{
    double first[9];
    mat_multiply(inverse, middle, first);
    mat_multiply(first, outer, product);
}

static bool would_shear(const double g[9])
{
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            double sum = r == c ? -1 : 0;
            for (int k = 0; k < 3; k++)
                sum += g[3 * k + r] * g[3 * k + c];
            if (!(fabs(sum) <= SHEAR))
                return true;
        }
    return false;
}

/* Finds the local offset that brings a node to a place. Components that differ from the old ones only by
   rounding keep their old values. Returns whether any component differs. */
static bool find_offset(const double parent[12], const double inverse[9], const double place[3],
                        const double old[3], double offset[3])
{
    double from[3], size = 0;
    bool differs = false;
    for (int a = 0; a < 3; a++) {
        from[a] = place[a] - parent[9 + a];
        size = larger_of(size, larger_of(fabs(place[a]), fabs(parent[9 + a])));
    }
    mat_apply(inverse, from, offset);
    for (int a = 0; a < 3; a++) {
        const double row = fabs(inverse[3 * a]) + fabs(inverse[3 * a + 1]) + fabs(inverse[3 * a + 2]);
        const double rounding = RIG_PLACE_ROUNDING * (row * size + fabs(old[a]));
        if (fabs(offset[a] - old[a]) <= rounding)
            offset[a] = old[a];
        else
            differs = true;
    }
    return differs;
}

static double clamp(double value)
{
    return value < -1 ? -1 : value > 1 ? 1 : value;
}

/* Sets the new local transform: g times the old linear part, and the offset. turn: g as a quaternion. */
static void set_local(const gltf_node *node, const double g[9], const double turn[4], const double offset[3],
                      gltf_moved_node *made)
{
    double linear[9], old[3], product[9];
    if (node->has_matrix) {
        ffd_gltf_local_matrix(node, linear, old);
        mat_multiply(g, linear, product);
        memcpy(made->matrix, node->matrix, sizeof made->matrix);
        for (int r = 0; r < 3; r++) {
            for (int c = 0; c < 3 && made->rotates; c++)
                made->matrix[4 * c + r] = product[3 * r + c];
            made->matrix[12 + r] = offset[r];
        }
        return;
    }
    memcpy(made->translation, offset, sizeof made->translation);
    memcpy(made->rotation, node->rotation, sizeof made->rotation);
    if (made->rotates)
        ffd_quaternion_multiply(turn, node->rotation, made->rotation);
    for (int i = 0; i < 4; i++)
        made->rotation[i] = clamp(made->rotation[i]);
}

/* Computes the node's new world matrix. made: its new local transform, NULL: the old one. */
static void join_world(const node_walk *w, size_t n, const gltf_moved_node *made)
{
    gltf_node node = w->document->model.nodes[n];
    double linear[9], offset[3];
    if (made) {
        memcpy(node.matrix, made->matrix, sizeof node.matrix);
        memcpy(node.translation, made->translation, sizeof node.translation);
        memcpy(node.rotation, made->rotation, sizeof node.rotation);
    }
    ffd_gltf_local_matrix(&node, linear, offset);
    ffd_gltf_join_matrix(made_of(w, w->document->parents[n]), linear, offset, w->rig->world + 12 * n);
}

static void carry_along(const node_walk *w, size_t n)
{
    const size_t p = w->document->parents[n];
    w->changed[n] = p != GLTF_NONE && w->changed[p];
    if (w->document->collides[n])
        memcpy(w->rig->world + 12 * n, made_of(w, p), sizeof identity);
    else if (w->changed[n])
        join_world(w, n, NULL);
    else
        memcpy(w->rig->world + 12 * n, w->document->world + 12 * n, 12 * sizeof *w->rig->world);
}

/* Stores how animated rotations and translations of a node change. */
static void note_motion(const double g[9], const double turn[4], const double along[9],
                        gltf_node_motion *motion)
{
    motion->turns = !ffd_mat_is_near_identity(g, RIG_TURN_ROUNDING);
    motion->carries = !ffd_mat_is_near_identity(along, RIG_TURN_ROUNDING);
    memcpy(motion->turn, turn, sizeof motion->turn);
    memcpy(motion->carry, along, sizeof motion->carry);
}

static bool is_finite(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

/* Moves a node that has a place; its ancestors are done. Returns false if its transform would not be finite:
   it then keeps its local transform. */
static bool move_node(const node_walk *w, size_t n, const target *t)
{
    const size_t p = w->document->parents[n];
    const gltf_node *const node = &w->document->model.nodes[n];
    const double *const parent = made_of(w, p);
    gltf_moved_node made = {.node = n};
    double inverse[9], g[9], along[9], rotation[9], turn[4], linear[9], old[3], offset[3];
    if (!mat_invert(parent, inverse))
        return false;
    conjugate(inverse, t->turn, world_of(w, p), g);
    conjugate(inverse, t->gradient, world_of(w, p), along);
    const bool shears = would_shear(g);
    if (shears || ffd_mat_is_near_identity(g, RIG_TURN_ROUNDING))
        memcpy(g, identity, sizeof g);
    ffd_mat_rotation(g, rotation);
    ffd_mat_quaternion(rotation, turn);
    ffd_gltf_local_matrix(node, linear, old);
    made.translates = find_offset(parent, inverse, t->place, old, offset);
    made.rotates = !ffd_mat_is_near_identity(g, 0);
    set_local(node, g, turn, offset, &made);
    join_world(w, n, made.translates || made.rotates ? &made : NULL);
    if (!is_finite(offset, 3) || !is_finite(along, 9) || !is_finite(made_of(w, n), 12))
        return false;
    w->following->sheared += shears;
    note_motion(g, turn, along, &w->rig->motions[n]);
    if (made.translates || made.rotates) {
        w->rig->motions[n].moved = w->rig->node_count;
        w->rig->nodes[w->rig->node_count++] = made;
        w->following->written++;
    }
    w->changed[n] = memcmp(made_of(w, n), world_of(w, n), sizeof identity) != 0;
    return true;
}

/* Whether a node, or what it places, stays although it would move: it is not selected. */
static bool is_left(const node_walk *w, size_t n)
{
    const mesh_place *const place = w->places[n];
    return place->unselected && !w->singular[n] &&
           (place->stays ? w->rig->motions[n].moved != GLTF_NONE : w->changed[n]);
}

/* Notes such a node. */
static void note_left(const node_walk *w, size_t n)
{
    const mesh_place *const place = w->places[n];
    const size_t p = w->document->parents[n];
    double linear[9], carried[3], off[3];
    ffd_gltf_local_matrix(&w->document->model.nodes[n], linear, carried);
    if (place->stays)
        ffd_point_transform(made_of(w, p), made_of(w, p) + 9, carried);
    else
        memcpy(carried, made_of(w, n) + 9, sizeof carried);
    for (int a = 0; a < 3; a++)
        off[a] = carried[a] - place->at[a];
    double by = vec_length(off);
    if (by <= RIG_PLACE_ROUNDING * (vec_length(carried) + vec_length(place->at)))
        by = 0; /* it only turns */
    w->following->unselected++;
    if (w->rig->left != GLTF_NONE && !(by > w->following->unselected_by))
        return;
    w->following->unselected_by = by;
    w->rig->left = w->rig->left_below = n;
    while (w->rig->left_below != GLTF_NONE &&
           (!w->places[w->rig->left_below] || w->places[w->rig->left_below]->stays))
        w->rig->left_below = w->document->parents[w->rig->left_below];
}

static void do_node(const node_walk *w, size_t n)
{
    const size_t p = w->document->parents[n];
    const mesh_place *const place = w->places[n];
    const bool is_below = p != GLTF_NONE && w->singular[p];
    bool is_tried = false;
    w->singular[n] = is_below || !has_inverse(w->document->world + 12 * n);
    w->states[n] = IS_DONE;
    w->following->partial += place && place->partial;
    if (place && !w->singular[n]) {
        const target t = find_target(place, w->moves[n]);
        const bool is_below_changed = p != GLTF_NONE && w->changed[p];
        is_tried = !is_still(place, &t) || is_below_changed;
        w->singular[n] = is_tried && !move_node(w, n, &t);
    }
    w->following->singular += place && w->singular[n] && w->moves[n]->moves;
    if (!is_tried || w->singular[n])
        carry_along(w, n);
    if (place && is_left(w, n))
        note_left(w, n);
    if (place)
        memcpy(w->moves[n]->became, w->rig->world + 12 * n + 9, sizeof w->moves[n]->became);
}

/* Processes a node after its ancestors. Nodes that replace others at a distance can form a cycle of parents:
   the walk ends there. */
static void do_chain(const node_walk *w, size_t n)
{
    size_t count = 0;
    while (n != GLTF_NONE && w->states[n] == IS_WAITING) {
        w->states[n] = IS_BEGUN;
        w->climb[count++] = n;
        n = w->document->parents[n];
    }
    while (count > 0)
        do_node(w, w->climb[--count]);
}

static bool allocate(node_walk *w, size_t count)
{
    gltf_rig *const rig = w->rig;
    w->places = ffd_alloc_zero(count, sizeof *w->places);
    w->moves = ffd_alloc_zero(count, sizeof *w->moves);
    w->states = ffd_alloc_zero(count, sizeof *w->states);
    w->changed = ffd_alloc_zero(count, sizeof *w->changed);
    w->singular = ffd_alloc_zero(count, sizeof *w->singular);
    w->climb = ffd_alloc(count, sizeof *w->climb);
    rig->world = ffd_alloc_zero(count, 12 * sizeof *rig->world);
    rig->motions = ffd_alloc_zero(count, sizeof *rig->motions);
    rig->nodes = ffd_alloc(count, sizeof *rig->nodes);
    return w->places && w->moves && w->states && w->changed && w->singular && w->climb && rig->world &&
           rig->motions && rig->nodes;
}

ffd_status ffd_gltf_follow_nodes(const gltf_document *d, const mesh_places *places, mesh_place_move *moves,
                                 mesh_following *following, ffd_error *error)
{
    const size_t count = d->model.node_count;
    gltf_rig *const rig = &d->edit->rig;
    node_walk w = {.document = d, .rig = rig, .following = following};
    const bool allocated = allocate(&w, count);
    rig->left = rig->left_below = GLTF_NONE;
    for (size_t i = 0; i < places->count && allocated; i++) {
        w.places[places->list[i].index] = &places->list[i];
        w.moves[places->list[i].index] = &moves[i];
    }
    for (size_t n = 0; n < count && allocated; n++)
        rig->motions[n].moved = GLTF_NONE;
    for (size_t n = 0; n < count && allocated; n++)
        do_chain(&w, n);
    ffd_free(w.places);
    ffd_free(w.moves);
    ffd_free(w.states);
    ffd_free(w.changed);
    ffd_free(w.singular);
    ffd_free(w.climb);
    return allocated ? FFD_OK : ffd_fail_memory(error);
}
