/* gltf_shapes.c - the morph targets of the parts, and attributes with their default weights applied. */
#include "base/memory/memory.h"
#include "base/memory/slots.h"
#include "base/vector/vec.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/read/gltf_elements.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* A morph target of a part. */
typedef struct part_target {
    size_t part;
    size_t accessors[GLTF_DEFORMED]; /* GLTF_NONE: absent */
} part_target;

/* Memory of a target under a node, with what making it needs (its hash table is half full). */
#define TARGET_BYTES                                                                                         \
    (sizeof(gltf_part) + sizeof(mesh_part) + sizeof(mesh_shape) + sizeof(part_target) + 5 * sizeof(size_t))

/* A hash table of the targets found so far, by content. */
typedef struct target_table {
    size_t *slots; /* GLTF_NONE: free */
    size_t mask;
    part_target *targets;
    size_t count;
} target_table;

static bool same_target(const part_target *a, const part_target *b)
{
    return a->part == b->part && memcmp(a->accessors, b->accessors, sizeof a->accessors) == 0;
}

static size_t find_target(target_table *table, const part_target *wanted)
{
    size_t slot = wanted->part * 0x9e3779b1u;
    for (int s = 0; s < GLTF_DEFORMED; s++)
        slot = slot * 31 + wanted->accessors[s];
    slot &= table->mask;
    while (table->slots[slot] != GLTF_NONE && !same_target(&table->targets[table->slots[slot]], wanted))
        slot = (slot + 1) & table->mask;
    if (table->slots[slot] == GLTF_NONE) {
        table->slots[slot] = table->count;
        table->targets[table->count++] = *wanted;
    }
    return table->slots[slot];
}

static ffd_status count_targets(gltf_document *d, size_t *total, ffd_error *error)
{
    *total = 0;
    for (size_t i = 0; i < d->instance_count; i++) {
        const size_t count = d->instances[i].primitive->target_count;
        d->instances[i].first_target = *total;
        TRY(ffd_budget_take(&d->base.budget, count, TARGET_BYTES, error));
        *total += count;
    }
    return FFD_OK;
}

/* Returns the part to which an instance's targets belong: that of its normals, or of its positions without
   normals. */
static size_t part_of_targets(const gltf_instance *instance)
{
    const size_t normals = instance->part[GLTF_NORMAL];
    return normals != GLTF_NONE ? normals : instance->part[GLTF_POSITION];
}

/* Returns the index of a target. Offsets of attributes that the primitive lacks are ignored; GLTF_NONE if no
   others remain. */
static size_t add_target(const gltf_document *d, target_table *table, const gltf_instance *instance,
                         const int *accessors)
{
    part_target wanted = {.part = part_of_targets(instance)};
    bool any = false;
    for (int s = 0; s < GLTF_DEFORMED; s++) {
        const bool has = accessors[s] >= 0 && instance->primitive->accessor[s] >= 0 &&
                         instance->part[s] != GLTF_NONE && d->layouts[accessors[s]].readable;
        wanted.accessors[s] = has ? (size_t)accessors[s] : GLTF_NONE;
        any = any || has;
    }
    return any && wanted.part != GLTF_NONE ? find_target(table, &wanted) : GLTF_NONE;
}

static void find_targets(gltf_document *d, target_table *table)
{
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *const instance = &d->instances[i];
        for (size_t t = 0; t < instance->primitive->target_count; t++)
            d->targets[instance->first_target + t] =
                add_target(d, table, instance, instance->primitive->target_accessors + GLTF_DEFORMED * t);
    }
}

/* Sorts the targets by part: shapes[i] becomes the index of the shape of target i. */
static void sort_targets(gltf_document *d, const target_table *table, size_t *shapes)
{
    for (size_t i = 0; i < table->count; i++)
        d->mesh_parts[table->targets[i].part].shape_count++;
    size_t next = 0;
    for (size_t i = 0; i < d->base.part_count; i++) {
        d->parts[i].first_shape = next;
        next += d->mesh_parts[i].shape_count;
        d->mesh_parts[i].shapes = d->shapes + d->parts[i].first_shape;
        d->mesh_parts[i].shape_count = 0;
    }
    for (size_t i = 0; i < table->count; i++) {
        const size_t part = table->targets[i].part;
        shapes[i] = d->parts[part].first_shape + d->mesh_parts[part].shape_count++;
    }
}

static void fill_shape(gltf_document *d, const part_target *from, size_t index)
{
    const size_t part = d->base.part_count + index;
    d->parts[part] = (gltf_part){.node = d->parts[from->part].node, .first_splat = GLTF_NONE};
    d->mesh_parts[part] = (mesh_part){.vertex_count = d->mesh_parts[from->part].vertex_count};
    for (int s = 0; s < GLTF_DEFORMED; s++) {
        d->parts[part].streams[s].accessor = from->accessors[s];
        d->parts[part].streams[s].components = 3;
        d->shapes[index].has[s] = from->accessors[s] != GLTF_NONE;
    }
    if (d->shapes[index].has[GLTF_POSITION])
        d->shapes[index].rounding = ffd_gltf_rounding(d, from->accessors[GLTF_POSITION]);
}

/* Enlarges the parts by count elements, for the results of targets. */
static bool grow_parts(gltf_document *d, size_t count)
{
    const size_t all = d->base.part_count + count;
    gltf_part *parts = ffd_realloc(d->parts, all, sizeof *parts);
    if (!parts)
        return false;
    d->parts = parts;
    mesh_part *mesh_parts = ffd_realloc(d->mesh_parts, all, sizeof *mesh_parts);
    if (!mesh_parts)
        return false;
    d->mesh_parts = mesh_parts;
    d->base.parts = mesh_parts;
    d->shapes = ffd_alloc_zero(count, sizeof *d->shapes);
    return d->shapes;
}

static ffd_status add_shapes(gltf_document *d, const target_table *table, size_t total, ffd_error *error)
{
    size_t *shapes = ffd_alloc(table->count, sizeof *shapes);
    if (!shapes || !grow_parts(d, table->count)) {
        ffd_free(shapes);
        return ffd_fail_memory(error);
    }
    sort_targets(d, table, shapes);
    for (size_t i = 0; i < table->count; i++)
        fill_shape(d, &table->targets[i], shapes[i]);
    d->shape_count = table->count;
    for (size_t i = 0; i < total; i++)
        if (d->targets[i] != GLTF_NONE)
            d->targets[i] = d->base.part_count + shapes[d->targets[i]];
    ffd_free(shapes);
    return FFD_OK;
}

uint32_t ffd_gltf_weights_of(const gltf_document *d, uint32_t object)
{
    const uint32_t array = ffd_json_tree_member(&d->tree, object, "weights");
    return array != JSON_NONE && d->tree.values[array].kind == JSON_ARRAY ? array : JSON_NONE;
}

uint32_t ffd_gltf_first_weight(const gltf_document *d, size_t mesh, size_t node)
{
    const uint32_t of_node =
        node == GLTF_NONE ? JSON_NONE : ffd_gltf_weights_of(d, d->node_values.values[node]);
    const uint32_t array =
        of_node == JSON_NONE ? ffd_gltf_weights_of(d, d->mesh_values.values[mesh]) : of_node;
    return ffd_json_tree_first(&d->tree, array);
}

bool ffd_gltf_weight(const gltf_document *d, uint32_t value, double *weight)
{
    return ffd_json_tree_number(&d->tree, value, weight) && fabs(*weight) <= FLT_MAX;
}

/* Adds a primitive's weights to the shapes of its part; several of its targets may be the same shape. Those
   that the file does not have weigh nothing. */
static void add_weights(gltf_document *d, const gltf_instance *instance)
{
    const gltf_primitive *const primitive = instance->primitive;
    const size_t filed = d->mesh_uses[primitive->mesh].filed_targets;
    uint32_t weight = ffd_gltf_first_weight(d, primitive->mesh, instance->node);
    for (size_t t = 0; t < primitive->target_count && t < filed && weight != JSON_NONE;
         t++, weight = ffd_json_tree_after(&d->tree, weight)) {
        const size_t part = d->targets[instance->first_target + t];
        double number;
        if (part != GLTF_NONE && ffd_gltf_weight(d, weight, &number))
            d->shapes[part - d->base.part_count].weight += number;
    }
}

static void note_shown(gltf_document *d)
{
    for (size_t i = 0; i < d->base.part_count; i++)
        for (size_t s = 0; s < d->mesh_parts[i].shape_count; s++)
            d->mesh_parts[i].shows_shapes =
                d->mesh_parts[i].shows_shapes || d->mesh_parts[i].shapes[s].weight != 0;
}

/* Primitives that share a part are shown alike: the first one decides. */
static ffd_status set_weights(gltf_document *d, ffd_error *error)
{
    bool *is_set = ffd_alloc_zero(d->base.part_count, sizeof *is_set);
    if (!is_set)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < d->instance_count; i++) {
        const size_t part = part_of_targets(&d->instances[i]);
        if (part == GLTF_NONE || is_set[part])
            continue;
        is_set[part] = true;
        add_weights(d, &d->instances[i]);
    }
    note_shown(d);
    ffd_free(is_set);
    return FFD_OK;
}

/* Forgets the shapes, and the splats, whose parts follow theirs. */
static void drop_shapes(gltf_document *d)
{
    for (size_t i = d->base.part_count; i < ffd_gltf_part_count(d); i++)
        for (int s = 0; s < GLTF_DEFORMED; s++)
            ffd_gltf_free_result(&d->parts[i].streams[s]);
    for (size_t i = 0; i < d->base.part_count; i++) {
        d->parts[i].first_splat = GLTF_NONE;
        d->mesh_parts[i].shape_count = 0;
    }
    for (size_t i = 0; i < d->instance_count; i++)
        d->instances[i].first_splat = GLTF_NONE;
    ffd_free(d->shapes);
    ffd_free(d->targets);
    d->shapes = NULL;
    d->targets = NULL;
    d->shape_count = d->splat_groups = 0;
}

ffd_status ffd_gltf_make_shapes(gltf_document *d, ffd_error *error)
{
    size_t total;
    drop_shapes(d);
    TRY(count_targets(d, &total, error));
    if (total == 0)
        return FFD_OK;
    target_table table = {.targets = ffd_alloc(total, sizeof *table.targets)};
    table.slots = ffd_slots_make(total, sizeof *table.slots, &table.mask);
    d->targets = ffd_alloc(total, sizeof *d->targets);
    ffd_status status;
    TRY_END(table.slots && table.targets && d->targets ? FFD_OK : ffd_fail_memory(error));
    find_targets(d, &table);
    TRY_END(add_shapes(d, &table, total, error));
    TRY_END(set_weights(d, error));
end:
    ffd_free(table.slots);
    ffd_free(table.targets);
    return status;
}

/* Vectors read at a time. */
#define BLOCK ((size_t)64)

/* Adds offsets of up to four components to values of `stride` numbers each. */
static void add_offsets(const gltf_document *d, size_t accessor, double weight, size_t first, size_t count,
                        size_t components, size_t stride, double *values)
{
    double offsets[4 * BLOCK];
    for (size_t at = 0; at < count; at += BLOCK) {
        const size_t size = count - at < BLOCK ? count - at : BLOCK;
        ffd_gltf_read(d, accessor, first + at, size, components, offsets);
        for (size_t i = 0; i < size; i++)
            for (size_t c = 0; c < components; c++)
                values[stride * (at + i) + c] += weight * offsets[components * i + c];
    }
}

static void make_units(size_t count, size_t components, double *values)
{
    for (size_t i = 0; i < count; i++, values += components) {
        const double length = vec_length(values);
        for (int c = 0; c < 3 && length > 0; c++)
            values[c] /= length;
    }
}

void ffd_gltf_read_shown(const gltf_document *d, size_t part, gltf_semantic semantic, mesh_state state,
                         size_t first, size_t count, size_t components, double *values)
{
    const mesh_part *const shown = &d->mesh_parts[part];
    bool any = false;
    ffd_gltf_read(d, d->parts[part].streams[semantic].accessor, first, count, components, values);
    if (state == MESH_STORED || !shown->shows_shapes)
        return;
    for (size_t s = 0; s < shown->shape_count; s++) {
        const gltf_part *const target = &d->parts[d->base.part_count + d->parts[part].first_shape + s];
        if (!shown->shapes[s].has[semantic] || shown->shapes[s].weight == 0)
            continue;
        any = true;
        add_offsets(d, target->streams[semantic].accessor, shown->shapes[s].weight, first, count, 3,
                    components, values);
    }
    if (any && semantic != GLTF_POSITION)
        make_units(count, components, values);
}

/* Returns the accessor of a morph target's attribute; GLTF_NONE if it is absent or does not fit. */
static size_t find_offsets(const gltf_document *d, uint32_t target, const char *name, size_t count,
                           size_t components)
{
    double number;
    if (!ffd_json_tree_number(&d->tree, ffd_json_tree_member(&d->tree, target, name), &number) ||
        !(number >= 0) || !(number < (double)d->model.accessor_count))
        return GLTF_NONE;
    const size_t a = (size_t)number;
    const gltf_accessor *const accessor = &d->model.accessors[a];
    const bool fits = accessor->columns == 1 && (size_t)accessor->rows >= components &&
                      accessor->count >= count && d->layouts[a].readable;
    return fits ? a : GLTF_NONE;
}

bool ffd_gltf_add_shapes(const gltf_document *d, const gltf_primitive *primitive, size_t node,
                         const char *name, size_t count, size_t components, size_t stride, double *values)
{
    const uint32_t targets = ffd_json_tree_member(&d->tree, primitive->value, "targets");
    uint32_t weight = ffd_gltf_first_weight(d, primitive->mesh, node);
    bool any = false;
    for (uint32_t target = ffd_json_tree_first(&d->tree, targets); target != JSON_NONE && weight != JSON_NONE;
         target = ffd_json_tree_after(&d->tree, target), weight = ffd_json_tree_after(&d->tree, weight)) {
        const size_t a = find_offsets(d, target, name, count, components);
        double number;
        if (a == GLTF_NONE || !ffd_gltf_weight(d, weight, &number) || number == 0)
            continue;
        any = true;
        if (values)
            add_offsets(d, a, number, 0, count, components, stride, values);
    }
    return any;
}
