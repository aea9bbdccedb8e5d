/* gltf_join_uses.c - lets nodes share a mesh if their results differ only by rounding. */
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/write/gltf_plan.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* The maximum number of comparisons per group: thousands of nodes that all see something else would take
   quadratic time. */
#define MOST_COMPARED 100
/* Bound of a deformation's rounding in double, in eps of the world coordinates. It is large because the
   lattice's coordinates, from which u,v,w are computed, may be many times the mesh's. */
#define ROUNDINGS 1024

/* The content of a primitive's slot for one use. */
typedef struct slot_values {
    const gltf_document *document;
    size_t accessor;
    const gltf_version *version; /* NULL: the original content */
} slot_values;

static slot_values values_of(const gltf_document *d, const gltf_plan *plan, const gltf_primitive *primitive,
                             size_t slot, size_t use)
{
    const size_t version = ffd_gltf_version_at(d, plan, primitive, slot, use);
    return (slot_values){.document = d,
                         .accessor = (size_t)gltf_slot_accessor(primitive, slot),
                         .version = version == GLTF_NONE ? NULL : &plan->versions[version]};
}

/* Reads a vector with this number of components; the others become 0. */
static void read_vector(const slot_values *values, size_t i, size_t components, float vector[4])
{
    memset(vector, 0, 4 * sizeof *vector);
    if (values->version)
        memcpy(vector, values->version->values + components * i, components * sizeof *vector);
    else
        ffd_gltf_original(values->document, values->accessor, i, components, vector);
}

static float larger_size(float a, float b)
{
    a = fabsf(a);
    b = fabsf(b);
    return b > a ? b : a;
}

static float largest_of(const float v[4])
{
    return larger_size(larger_size(v[0], v[1]), larger_size(v[2], v[3]));
}

/* The distance from a float to the next one away from 0. */
static double ulp_of(float size)
{
    size = fabsf(size);
    return (double)next_float_above(size) - (double)size;
}

/* A mesh whose uses are compared. */
typedef struct shared_mesh {
    const gltf_document *document;
    const gltf_plan *plan;
    size_t index;
    double size; /* the largest coordinate of its vertices before the deformation */
} shared_mesh;

static shared_mesh describe(const gltf_document *d, const gltf_plan *plan, size_t mesh)
{
    shared_mesh made = {d, plan, mesh, 0};
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));) {
        if (ffd_gltf_instances(d, p)[0].part[GLTF_POSITION] == GLTF_NONE)
            continue;
        const size_t accessor = (size_t)gltf_slot_accessor(p, GLTF_POSITION);
        for (size_t i = 0; i < d->model.accessors[accessor].count; i++) {
            float at[3];
            ffd_gltf_original(d, accessor, i, 3, at);
            for (int c = 0; c < 3; c++)
                made.size = larger_of(made.size, fabs((double)at[c]));
        }
    }
    return made;
}

/* The allowed differences between the vectors of a slot for two uses. */
typedef struct slack {
    double step;                /* the step of integers; 0: the numbers are floats */
    bool along;                 /* the vectors are directions: rounding is relative to their length */
    double size;                /* the mesh's */
    const mesh_part *placed[2]; /* the part that transforms the vectors in each use; NULL: none */
} slack;

/* Bounds the effect of rounding in double on file coordinates: positions are transformed to the world and
   back. A deformation mixes the axes, so that the largest coordinate counts for all: a mesh that is flat at 0
   gets coordinates there that are nothing but rounding. */
static void find_rounding(const slack *allowed, const float x[4], const float y[4], double rounding[4])
{
    double size = allowed->size;
    for (int c = 0; c < 3; c++)
        size = larger_of(size, larger_of(fabs((double)x[c]), fabs((double)y[c])));
    for (int c = 0; c < 3; c++)
        rounding[c] = allowed->along ? 1 : size;
    rounding[3] = 1; /* quaternions are directions */
    for (int k = 0; k < 2 && !allowed->along; k++) {
        const mesh_part *const part = allowed->placed[k];
        double world = 0;
        if (!part || part->identity || part->skinned || part->singular)
            continue;
        for (int b = 0; b < 3; b++) {
            const double *const row = part->linear + 3 * b;
            world =
                larger_of(world, fabs(part->offset[b]) + (fabs(row[0]) + fabs(row[1]) + fabs(row[2])) * size);
        }
        for (int c = 0; c < 3; c++) {
            const double *const row = part->inverse + 3 * c;
            rounding[c] = larger_of(rounding[c], (fabs(row[0]) + fabs(row[1]) + fabs(row[2])) * world);
        }
    }
    for (int c = 0; c < 4; c++)
        rounding[c] *= ROUNDINGS * DBL_EPSILON;
}

static bool are_equal(const float a[4], const float b[4])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
}

/* Returns how far the file's own rounding may part coordinate c of two results: one step. This does not apply
   if one of them is the original, because a vertex that does not move keeps its bits. */
static double file_rounding(const slack *allowed, const float x[4], const float y[4], int c)
{
    if (allowed->step > 0)
        return allowed->step * (1 + 1e-6);
    return ulp_of(allowed->along ? larger_size(largest_of(x), largest_of(y)) : larger_size(x[c], y[c]));
}

static bool agree_at(const slot_values *a, const slot_values *b, size_t i, const slack *allowed)
{
    const size_t components = a->version ? a->version->components : b->version->components;
    const slot_values file = {a->document, a->accessor, NULL};
    float x[4], y[4], original[4];
    double rounding[4];
    read_vector(a, i, components, x);
    read_vector(b, i, components, y);
    if (are_equal(x, y))
        return true;
    read_vector(&file, i, components, original);
    const bool stays = are_equal(x, original) || are_equal(y, original);
    find_rounding(allowed, x, y, rounding);
    for (int c = 0; c < (int)components; c++) {
        const double most = rounding[c] + (stays ? 0 : file_rounding(allowed, x, y, c));
        if (!(fabs((double)x[c] - (double)y[c]) <= most))
            return false;
    }
    return true;
}

static int component_of(const gltf_document *d, const slot_values *values)
{
    return values->version ? values->version->component : d->model.accessors[values->accessor].component;
}

static const mesh_part *part_of(const shared_mesh *mesh, const gltf_primitive *primitive, size_t use)
{
    const gltf_instance *const instance = &ffd_gltf_instances(mesh->document, primitive)[use];
    const size_t part = instance->part[GLTF_POSITION];
    return part == GLTF_NONE ? NULL : &mesh->document->mesh_parts[part];
}

/* Whether a slot has nearly the same content for two uses that have different versions of it. */
static bool agree_in_slot(const shared_mesh *mesh, const gltf_primitive *primitive, size_t slot,
                          const size_t use[2])
{
    const gltf_document *const d = mesh->document;
    const slot_values a = values_of(d, mesh->plan, primitive, slot, use[0]),
                      b = values_of(d, mesh->plan, primitive, slot, use[1]);
    const gltf_accessor *const accessor = &d->model.accessors[a.accessor];
    const int component = component_of(d, &a);
    const size_t vectors = gltf_vector_slots(primitive);
    const slack allowed = {.step = component == GLTF_FLOAT ? 0 : ffd_gltf_step(accessor),
                           .along = slot % GLTF_DEFORMED != GLTF_POSITION || slot >= vectors,
                           .size = mesh->size,
                           .placed = {part_of(mesh, primitive, use[0]), part_of(mesh, primitive, use[1])}};
    if (component != component_of(d, &b))
        return false;
    for (size_t i = 0; i < accessor->count; i++)
        if (!agree_at(&a, &b, i, &allowed))
            return false;
    return true;
}

/* Whether two uses of a mesh see the same shape up to rounding. Uses that are not selected keep their
   bits. */
static bool agree(const shared_mesh *mesh, const size_t use[2])
{
    const gltf_document *const d = mesh->document;
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh->index, p));) {
        const gltf_instance *const instances = ffd_gltf_instances(d, p);
        if (!instances[use[0]].selected || !instances[use[1]].selected)
            return false;
        for (size_t s = 0; s < gltf_slot_count(p); s++)
            if (ffd_gltf_version_at(d, mesh->plan, p, s, use[0]) !=
                    ffd_gltf_version_at(d, mesh->plan, p, s, use[1]) &&
                !agree_in_slot(mesh, p, s, use))
                return false;
    }
    return true;
}

/* Lists the groups in the order of the scene: groups[0] is the mesh itself, the others are its copies.
   Returns their number. If nodes outside the scene show the mesh, its content is not a result and stays:
   groups[0] is left out. */
static size_t list_groups(const gltf_document *d, size_t mesh, size_t first_copy, size_t first_change,
                          const gltf_plan *plan, gltf_use_group *groups, size_t *order)
{
    const gltf_mesh_uses *const uses = &d->mesh_uses[mesh];
    const size_t count = 1 + plan->copy_count - first_copy;
    size_t change = first_change, listed = 0;
    for (size_t g = 0; g < count; g++)
        groups[g] = (gltf_use_group){.rank = SIZE_MAX, .leader = g, .target = g ? g - 1 : GLTF_NONE};
    for (size_t use = 0; use < uses->node_count; use++) {
        const size_t node = uses->nodes[use], rank = d->scene_ranks[node];
        const bool is_changed = change < plan->change_count && plan->changes[change].node == node;
        const size_t g = is_changed ? 1 + plan->changes[change++].copy - first_copy : 0;
        if (rank < groups[g].rank) {
            groups[g].rank = rank;
            groups[g].use = use;
        }
    }
    for (size_t g = plan->base_uses[mesh] == GLTF_NONE ? 1 : 0; g < count; g++) {
        size_t at = groups[g].rank < SIZE_MAX ? listed++ : listed;
        if (at == listed)
            continue;
        for (; at > 0 && groups[order[at - 1]].rank > groups[g].rank; at--)
            order[at] = order[at - 1];
        order[at] = g;
    }
    return listed;
}

/* Sets the leader of each group: the first group before it in the scene that it agrees with, or itself.
   Returns whether any group has another leader. */
static bool find_leaders(const gltf_document *d, size_t index, const gltf_plan *plan, gltf_use_group *groups,
                         const size_t *order, size_t count)
{
    const shared_mesh mesh = describe(d, plan, index);
    bool any = false;
    for (size_t i = 1; i < count; i++) {
        gltf_use_group *const group = &groups[order[i]];
        size_t compared = 0;
        for (size_t k = 0; k < i && compared < MOST_COMPARED && group->leader == order[i]; k++) {
            const size_t use[2] = {groups[order[k]].use, group->use};
            if (groups[order[k]].leader != order[k])
                continue;
            compared++;
            if (agree(&mesh, use))
                group->leader = order[k];
        }
        any = any || group->leader != order[i];
    }
    return any;
}

/* Keeps only the copies that are targets, and points the nodes to them. */
static void drop_joined(size_t mesh, size_t first_copy, size_t first_change, gltf_plan *plan,
                        gltf_use_group *groups)
{
    const size_t copies = plan->copy_count - first_copy;
    size_t kept = first_copy, changed = first_change;
    for (size_t c = 0; c < copies; c++) {
        const gltf_use_group *const leader = &groups[groups[1 + c].leader];
        if (leader->target != c)
            continue;
        groups[1 + c].copy = kept;
        plan->copies[kept++] = (gltf_mesh_copy){mesh, leader->use};
    }
    for (size_t i = first_change; i < plan->change_count; i++) {
        const gltf_node_change change = plan->changes[i];
        const size_t target = groups[groups[1 + change.copy - first_copy].leader].target;
        if (target != GLTF_NONE)
            plan->changes[changed++] = (gltf_node_change){change.node, groups[1 + target].copy};
    }
    plan->copy_count = kept;
    plan->change_count = changed;
}

void ffd_gltf_join_uses(const gltf_document *d, size_t mesh, size_t first_copy, size_t first_change,
                        gltf_plan *plan, gltf_use_group *groups, size_t *order)
{
    const size_t copies = plan->copy_count - first_copy;
    if (copies == 0)
        return;
    const size_t count = list_groups(d, mesh, first_copy, first_change, plan, groups, order);
    if (!find_leaders(d, mesh, plan, groups, order, count))
        return;
    /* A leader's bits go to the mesh itself if groups[0] follows it, else to the first copy that does. */
    for (size_t g = copies + 1; g-- > 0;)
        groups[groups[g].leader].target = g ? g - 1 : GLTF_NONE;
    if (plan->base_uses[mesh] != GLTF_NONE)
        plan->base_uses[mesh] = groups[groups[0].leader].use;
    drop_joined(mesh, first_copy, first_change, plan, groups);
}
