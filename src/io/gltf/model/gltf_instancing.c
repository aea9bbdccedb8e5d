/* gltf_instancing.c - nodes with EXT_mesh_gpu_instancing. They show one mesh under many transforms, so that
   the instances cannot have results of their own: their vertices stay, and their bounds tell whether the
   lattice reaches them. */
#include "io/gltf/model/gltf_instancing.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "base/vector/vec.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_scene.h"
#include "io/gltf/read/gltf_elements.h"
#include <math.h>
#include <string.h>

#define EXTENSION "EXT_mesh_gpu_instancing"
/* The maximum number of instances, of all nodes together, whose bounds are computed. */
#define MOST_INSTANCES ((uint64_t)1 << 24)
/* Relative to a box's sides; larger than the rounding errors of its corners. */
#define SLACK 1e-9

/* State of the survey of the nodes. */
typedef struct survey {
    gltf_document *document;
    ffd_bounds *accessors; /* per POSITION accessor; min > max: not computed yet */
    uint64_t instances;
} survey;

static const ffd_bounds empty_bounds = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};

static void join(ffd_bounds *box, const ffd_bounds *other)
{
    for (int a = 0; a < 3; a++) {
        box->min[a] = minimum_number(box->min[a], other->min[a]);
        box->max[a] = maximum_number(box->max[a], other->max[a]);
    }
}

static bool is_float(const gltf_accessor *accessor)
{
    return accessor->component == GLTF_FLOAT;
}

/* Rotations may be normalized signed integers (EXT_mesh_gpu_instancing). */
static bool is_rotation(const gltf_accessor *accessor)
{
    return is_float(accessor) ||
           (accessor->normalized && (accessor->component == GLTF_I8 || accessor->component == GLTF_I16));
}

static ffd_status find_attribute(const gltf_document *d, uint32_t attributes, const char *key, int rows,
                                 bool (*allowed)(const gltf_accessor *), size_t *found, uint64_t *count,
                                 ffd_error *error)
{
    const uint32_t value = ffd_json_tree_member(&d->tree, attributes, key);
    *found = GLTF_NONE;
    if (value == JSON_NONE)
        return FFD_OK;
    const size_t index = ffd_gltf_index(d, value, d->model.accessor_count);
    if (index == GLTF_NONE)
        return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_INVALID, error,
                                  "is not the number of an accessor, of which there are %zu",
                                  d->model.accessor_count);
    const gltf_accessor *accessor = &d->model.accessors[index];
    if (accessor->columns != 1 || accessor->rows != rows || !allowed(accessor))
        return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_INVALID, error,
                                  "accessor %zu is not a VEC%d of an allowed component type", index, rows);
    if (*count != UINT64_MAX && accessor->count != *count)
        return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_INVALID, error,
                                  "accessor %zu has %llu %s, another attribute has %llu", index,
                                  (unsigned long long)accessor->count,
                                  ffd_plural(accessor->count, "element", "elements"),
                                  (unsigned long long)*count);
    *found = index;
    *count = accessor->count;
    return FFD_OK;
}

static ffd_status find_instances(const gltf_document *d, size_t node, gltf_instanced_node *found,
                                 ffd_error *error)
{
    const uint32_t extension = ffd_gltf_extension(d, d->node_values.values[node], EXTENSION);
    const uint32_t attributes = ffd_json_tree_member(&d->tree, extension, "attributes");
    found->count = UINT64_MAX;
    ffd_status status;
    TRY_END(
        find_attribute(d, attributes, "TRANSLATION", 3, is_float, &found->translation, &found->count, error));
    TRY_END(
        find_attribute(d, attributes, "ROTATION", 4, is_rotation, &found->rotation, &found->count, error));
    TRY_END(find_attribute(d, attributes, "SCALE", 3, is_float, &found->scale, &found->count, error));
end:
    /* Only these attributes move vertices; without any of them the node has one instance. */
    if (found->count == UINT64_MAX)
        found->count = 1;
    return status;
}

static const ffd_bounds *accessor_bounds(survey *s, size_t accessor)
{
    ffd_bounds *box = &s->accessors[accessor];
    if (box->min[0] <= box->max[0])
        return box;
    for (size_t i = 0; i < s->document->model.accessors[accessor].count; i++) {
        ffd_bounds point;
        ffd_gltf_read(s->document, accessor, i, 1, 3, point.min);
        memcpy(point.max, point.min, sizeof point.max);
        join(box, &point);
    }
    return box;
}

static bool is_finite(const ffd_bounds *box)
{
    return vec_is_finite(box->min) && vec_is_finite(box->max);
}

/* Finds the bounds of a mesh in its own space; returns false if it cannot be read. */
static bool find_mesh_bounds(survey *s, size_t mesh, ffd_bounds *box)
{
    *box = empty_bounds;
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(s->document, mesh, p));) {
        const int accessor = p->accessor[GLTF_POSITION];
        if (accessor < 0)
            continue;
        if (!s->document->layouts[accessor].readable)
            return false;
        join(box, accessor_bounds(s, (size_t)accessor));
    }
    return box->min[0] > box->max[0] || is_finite(box);
}

static bool can_read(const gltf_document *d, size_t accessor)
{
    return accessor == GLTF_NONE || d->layouts[accessor].readable;
}

static ffd_status describe_instanced_node(survey *s, size_t node, gltf_instanced_node *instanced,
                                          ffd_error *error)
{
    const gltf_document *d = s->document;
    *instanced = (gltf_instanced_node){.node = node};
    TRY(find_instances(d, node, instanced, error));
    s->instances += instanced->count;
    instanced->unknown_bounds =
        !find_mesh_bounds(s, (size_t)d->model.nodes[node].mesh, &instanced->mesh_bounds) ||
        d->model.nodes[node].skin >= 0 || s->instances > MOST_INSTANCES ||
        !can_read(d, instanced->translation) || !can_read(d, instanced->rotation) ||
        !can_read(d, instanced->scale);
    return FFD_OK;
}

/* Deselects all instances of a node, so that their vertices stay. */
static void skip_node(gltf_document *d, size_t node)
{
    const size_t mesh = (size_t)d->model.nodes[node].mesh;
    gltf_mesh_uses *uses = &d->mesh_uses[mesh];
    const size_t use = ffd_gltf_find_use(uses, node);
    uses->used_outside_scene = true; /* the node keeps its mesh */
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));)
        ffd_gltf_instances(d, p)[use].selected = false;
}

static bool is_instanced(const gltf_document *d, size_t node)
{
    return d->space == FFD_SPACE_SCENE && d->in_scene[node] && d->model.nodes[node].mesh >= 0 &&
           ffd_gltf_has_extension(d, d->node_values.values[node], EXTENSION);
}

static ffd_status describe_instanced_nodes(survey *s, ffd_error *error)
{
    gltf_document *d = s->document;
    ffd_status status = FFD_OK;
    for (size_t n = 0; n < d->model.node_count; n++)
        if (is_instanced(d, n)) {
            skip_node(d, n);
            TRY_END(describe_instanced_node(s, n, &d->instanced_nodes[d->instanced_node_count++], error));
        }
end:
    for (size_t i = 0; i < d->base.part_count; i++)
        d->mesh_parts[i].skipped = ffd_gltf_instanced_node(d, d->parts[i].node) != NULL;
    return status;
}

ffd_status ffd_gltf_find_instanced_nodes(gltf_document *d, ffd_error *error)
{
    survey s = {.document = d};
    size_t count = 0;
    for (size_t n = 0; n < d->model.node_count; n++)
        count += is_instanced(d, n);
    if (count == 0)
        return FFD_OK;
    s.accessors = ffd_alloc(d->model.accessor_count, sizeof *s.accessors);
    d->instanced_nodes = ffd_alloc(count, sizeof *d->instanced_nodes);
    for (size_t a = 0; s.accessors && a < d->model.accessor_count; a++)
        s.accessors[a] = empty_bounds;
    const ffd_status status =
        s.accessors && d->instanced_nodes ? describe_instanced_nodes(&s, error) : ffd_fail_memory(error);
    ffd_free(s.accessors);
    return status;
}

static bool is_of_node_before(const void *instanced, const void *node)
{
    return ((const gltf_instanced_node *)instanced)->node < *(const size_t *)node;
}

gltf_instanced_node *ffd_gltf_instanced_node(const gltf_document *d, size_t node)
{
    gltf_instanced_node *const list = d->instanced_nodes;
    const size_t count = d->instanced_node_count;
    const size_t found = lower_bound(&node, list, count, sizeof *list, is_of_node_before);
    return found < count && list[found].node == node ? &list[found] : NULL;
}

/* Whether the transformed box meets the reach, or would do so but for rounding. */
static bool meets(const ffd_bounds *box, const double world[12], const ffd_bounds *reach)
{
    double middle[3], half[3];
    for (int a = 0; a < 3; a++) {
        middle[a] = (box->min[a] + box->max[a]) / 2;
        half[a] = (box->max[a] - box->min[a]) / 2;
    }
    mat_apply(world, middle, middle);
    for (int r = 0; r < 3; r++) {
        const double *row = world + 3 * r, offset = world[9 + r];
        const double side = fabs(row[0]) * half[0] + fabs(row[1]) * half[1] + fabs(row[2]) * half[2];
        const double wide = side + SLACK * (side + fabs(middle[r]) + fabs(offset));
        const double least = middle[r] + offset - wide, largest = middle[r] + offset + wide;
        if (least > reach->max[r] || largest < reach->min[r])
            return false;
    }
    return true; /* also for NaN */
}

static void instance_matrix(const gltf_document *d, const gltf_instanced_node *instanced, size_t i,
                            double world[12])
{
    gltf_node instance = {.rotation = {0, 0, 0, 1}, .scale = {1, 1, 1}};
    double linear[9], offset[3];
    if (instanced->translation != GLTF_NONE)
        ffd_gltf_read(d, instanced->translation, i, 1, 3, instance.translation);
    if (instanced->rotation != GLTF_NONE)
        ffd_gltf_read(d, instanced->rotation, i, 1, 4, instance.rotation);
    if (instanced->scale != GLTF_NONE)
        ffd_gltf_read(d, instanced->scale, i, 1, 3, instance.scale);
    ffd_gltf_local_matrix(&instance, linear, offset);
    ffd_gltf_join_matrix(d->world + 12 * instanced->node, linear, offset, world);
}

static bool is_reached(const gltf_document *d, const gltf_instanced_node *instanced, const ffd_bounds *reach)
{
    if (instanced->deselected || instanced->unknown_bounds)
        return !instanced->deselected;
    bool met = false;
    for (size_t i = 0;
         i < instanced->count && instanced->mesh_bounds.min[0] <= instanced->mesh_bounds.max[0] && !met;
         i++) {
        double world[12];
        instance_matrix(d, instanced, i, world);
        met = meets(&instanced->mesh_bounds, world, reach);
    }
    return met;
}

ffd_status ffd_gltf_check_reach(const mesh_document *document, const ffd_bounds *reach, ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    for (size_t i = 0; i < d->instanced_node_count; i++)
        if (is_reached(d, &d->instanced_nodes[i], reach))
            return ffd_json_tree_fail(
                &d->tree, ffd_gltf_extension(d, d->node_values.values[d->instanced_nodes[i].node], EXTENSION),
                d->name, FFD_E_UNSUPPORTED, error,
                EXTENSION
                " is not supported where the lattice reaches the instances ({input.space=mesh} deforms "
                "the mesh itself)");
    return FFD_OK;
}
