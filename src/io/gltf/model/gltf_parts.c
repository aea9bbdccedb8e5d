#include "io/gltf/model/gltf_parts.h"
#include "base/memory/memory.h"
#include "base/memory/slots.h"
#include "base/vector/vec.h"
#include "io/gltf/model/gltf_skin.h"
#include "io/gltf/read/gltf_elements.h"
#include <string.h>

#define MOST_VERTICES ((uint64_t)UINT32_MAX - 1)

/* Memory that a primitive under a node takes while the file is open, plus what making the parts and saving
   need for it. */
#define INSTANCE_BYTES                                                                                       \
    (sizeof(gltf_instance) + sizeof(gltf_part) + sizeof(mesh_part) + 4 * sizeof(size_t) + SAVED_BYTES)
#define SAVED_BYTES 384

/* A hash table of the parts by POSITION accessor, node, with a skin influences, and the morph targets of
   positions that default weights show. */
typedef struct part_table {
    size_t *heads; /* the first part with a slot's key; GLTF_NONE: free */
    size_t mask;
    size_t *next; /* the next part with the same key */
} part_table;

static ffd_status count_instances(gltf_document *d, size_t *total, ffd_error *error)
{
    uint64_t targets = 0;
    *total = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        const uint64_t instances =
            (uint64_t)d->model.meshes[m].primitive_count * d->mesh_uses[m].node_count; /* each below 2^31 */
        d->mesh_uses[m].first_instance = *total;
        TRY(ffd_budget_take(&d->base.budget, instances, INSTANCE_BYTES, error));
        *total += (size_t)instances;
        for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, m, p));)
            targets += (uint64_t)p->target_count * d->mesh_uses[m].node_count;
        /* Each is looked at, and has an index in the end. */
        TRY(ffd_budget_check(&d->base.budget, targets, sizeof *d->targets, error));
    }
    return FFD_OK;
}

/* Whether two parts of one node have equal joints and weights. */
static bool same_influences(const gltf_part *a, const gltf_part *b)
{
    if (a->influence_count != b->influence_count)
        return false;
    for (size_t i = 0; i < a->influence_count; i++)
        if (a->influences[i].joints != b->influences[i].joints ||
            a->influences[i].weights != b->influences[i].weights)
            return false;
    return true;
}

/* What default weights show of a part's morph targets, from first to last. */
typedef struct shown_walk {
    const gltf_part *part;
    gltf_semantic semantic;
    size_t target;
    uint32_t weight;
} shown_walk;

static shown_walk begin_shown(const gltf_part *part, gltf_semantic semantic)
{
    return (shown_walk){part, semantic, 0, part->first_weight};
}

/* Goes on to the next target with offsets and a weight: its accessor; -1: there is none. */
static int next_shown(const gltf_document *d, shown_walk *walk, double *weight)
{
    const gltf_primitive *const primitive = walk->part->primitive;
    while (walk->target < primitive->target_count && walk->weight != JSON_NONE) {
        const int accessor = primitive->target_accessors[GLTF_DEFORMED * walk->target++ + walk->semantic];
        const uint32_t value = walk->weight;
        walk->weight = ffd_json_tree_after(&d->tree, value);
        if (accessor >= 0 && ffd_gltf_weight(d, value, weight) && *weight != 0)
            return accessor;
    }
    *weight = 0;
    return -1;
}

/* Whether default weights show two parts with the same offsets. */
static bool shown_alike(const gltf_document *d, const gltf_part *a, const gltf_part *b,
                        gltf_semantic semantic)
{
    shown_walk of_a = begin_shown(a, semantic), of_b = begin_shown(b, semantic);
    double weight, other;
    int accessor = 0;
    while (accessor >= 0) {
        accessor = next_shown(d, &of_a, &weight);
        if (next_shown(d, &of_b, &other) != accessor || weight < other || weight > other)
            return false;
    }
    return true;
}

static size_t *find_slot(const gltf_document *d, const part_table *table, const gltf_part *wanted)
{
    const size_t accessor = wanted->streams[GLTF_POSITION].accessor;
    size_t slot = accessor * 0x9e3779b1u + wanted->node * 0x85ebca6bu;
    for (size_t i = 0; i < wanted->influence_count; i++)
        slot = slot * 31 + (size_t)wanted->influences[i].joints + 7 * (size_t)wanted->influences[i].weights;
    shown_walk walk = begin_shown(wanted, GLTF_POSITION);
    double weight;
    for (int shown; (shown = next_shown(d, &walk, &weight)) >= 0;)
        slot = slot * 31 + (size_t)shown;
    slot &= table->mask;
    while (table->heads[slot] != GLTF_NONE) {
        const gltf_part *part = &d->parts[table->heads[slot]];
        if (part->streams[GLTF_POSITION].accessor == accessor && part->node == wanted->node &&
            same_influences(part, wanted) && shown_alike(d, part, wanted, GLTF_POSITION))
            break;
        slot = (slot + 1) & table->mask;
    }
    return &table->heads[slot];
}

static size_t readable_accessor(const gltf_document *d, const gltf_primitive *primitive,
                                gltf_semantic semantic)
{
    const int accessor = primitive->accessor[semantic];
    return accessor >= 0 && d->layouts[accessor].readable ? (size_t)accessor : GLTF_NONE;
}

/* Whether a part serves another one's primitive with an attribute. */
static bool has_stream(const gltf_document *d, const gltf_part *part, const gltf_part *wanted,
                       gltf_semantic semantic)
{
    const size_t accessor = wanted->streams[semantic].accessor;
    return accessor == GLTF_NONE ||
           (part->streams[semantic].accessor == accessor && shown_alike(d, part, wanted, semantic));
}

/* Whether a part serves another one's primitive. A tangent depends on its normal. */
static bool serves(const gltf_document *d, const gltf_part *part, const gltf_part *wanted)
{
    return has_stream(d, part, wanted, GLTF_NORMAL) && has_stream(d, part, wanted, GLTF_TANGENT);
}

static void set_part_transform(const gltf_document *d, const gltf_part *from, mesh_part *part)
{
    static const double unit[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    const double *world = from->node == GLTF_NONE ? unit : d->world + 12 * from->node;
    part->skinned = from->skin != NULL;
    if (part->skinned)
        return;
    part->identity = true;
    for (int i = 0; i < 12; i++)
        part->identity = part->identity && !(world[i] < unit[i] || world[i] > unit[i]);
    memcpy(part->linear, world, sizeof part->linear);
    memcpy(part->offset, world + 9, sizeof part->offset);
    part->singular = !mat_invert(part->linear, part->inverse);
}

static size_t add_part(gltf_document *d, const gltf_part *part, size_t repeated)
{
    const size_t index = d->base.part_count++;
    mesh_part *made = &d->mesh_parts[index];
    d->parts[index] = *part;
    made->vertex_count = (size_t)d->model.accessors[part->streams[GLTF_POSITION].accessor].count;
    made->rounding = ffd_gltf_rounding(d, part->streams[GLTF_POSITION].accessor);
    made->normal_count = part->streams[GLTF_NORMAL].accessor == GLTF_NONE ? 0 : made->vertex_count;
    made->has_tangents = part->streams[GLTF_TANGENT].accessor != GLTF_NONE;
    made->repeats_positions = repeated != GLTF_NONE;
    made->repeats = repeated;
    made->hidden = ffd_gltf_is_hidden(d, part->node);
    made->owner = part->node;
    set_part_transform(d, part, made);
    return index;
}

/* Returns the part that a primitive under a node needs. */
static gltf_part describe_part(const gltf_document *d, const gltf_primitive *primitive, size_t node)
{
    gltf_part part = {.node = node,
                      .primitive = primitive,
                      .first_weight = ffd_gltf_first_weight(d, primitive->mesh, node),
                      .first_splat = GLTF_NONE};
    for (int s = 0; s < GLTF_DEFORMED; s++) {
        part.streams[s].accessor = readable_accessor(d, primitive, (gltf_semantic)s);
        part.streams[s].components = 3;
    }
    if (part.streams[GLTF_NORMAL].accessor == GLTF_NONE)
        part.streams[GLTF_TANGENT].accessor = GLTF_NONE; /* ignored without normals (glTF 2.0, 3.7.2.1) */
    if (node != GLTF_NONE && d->model.nodes[node].skin >= 0 && ffd_gltf_is_skinned(primitive)) {
        part.skin = &d->skins[d->model.nodes[node].skin];
        part.influences = primitive->influences;
        part.influence_count = primitive->influence_count;
    }
    return part;
}

static void add_instance(gltf_document *d, const part_table *table, const gltf_primitive *primitive,
                         size_t node)
{
    const gltf_part wanted = describe_part(d, primitive, node);
    gltf_instance *const instance = &d->instances[d->instance_count++];
    instance->primitive = primitive;
    instance->node = node;
    for (int s = 0; s < GLTF_DEFORMED; s++)
        instance->part[s] = GLTF_NONE;
    instance->selected = true;
    instance->first_splat = GLTF_NONE;
    if (wanted.streams[GLTF_POSITION].accessor == GLTF_NONE)
        return;
    size_t *const head = find_slot(d, table, &wanted);
    size_t part = *head, last = GLTF_NONE;
    while (part != GLTF_NONE && !serves(d, &d->parts[part], &wanted)) {
        last = part;
        part = table->next[part];
    }
    if (part == GLTF_NONE) {
        part = add_part(d, &wanted, *head);
        table->next[part] = GLTF_NONE;
        if (last == GLTF_NONE)
            *head = part;
        else
            table->next[last] = part;
    }
    instance->part[GLTF_POSITION] = *head;
    for (int s = GLTF_NORMAL; s < GLTF_DEFORMED; s++)
        if (wanted.streams[s].accessor != GLTF_NONE)
            instance->part[s] = part;
}

static ffd_status limit_vertices(const gltf_document *d, ffd_error *error)
{
    uint64_t vertices = 0;
    for (size_t i = 0; i < d->base.part_count; i++) {
        vertices += d->mesh_parts[i].repeats_positions ? 0 : d->mesh_parts[i].vertex_count;
        if (vertices > MOST_VERTICES)
            return ffd_fail_file(error, FFD_E_LIMIT, d->name, "its scene has more than %llu vertices",
                                 (unsigned long long)MOST_VERTICES);
    }
    /* Any pass over all vertices takes at least this for each. */
    return ffd_budget_check(&d->base.budget, vertices, sizeof(float[3]), error);
}

ffd_status ffd_gltf_make_parts(gltf_document *d, ffd_error *error)
{
    size_t total;
    ffd_status status = count_instances(d, &total, error);
    if (status)
        return status;
    part_table table = {.next = ffd_alloc(total, sizeof *table.next)};
    table.heads = ffd_slots_make(total, sizeof *table.heads, &table.mask);
    d->instances = ffd_alloc(total, sizeof *d->instances);
    d->parts = ffd_alloc_zero(total, sizeof *d->parts);
    d->mesh_parts = ffd_alloc_zero(total, sizeof *d->mesh_parts);
    if (!table.heads || !table.next || !d->instances || !d->parts || !d->mesh_parts)
        TRY_END(ffd_fail_memory(error));
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const gltf_mesh_uses *const uses = &d->mesh_uses[d->model.primitives[i].mesh];
        for (size_t n = 0; n < uses->node_count; n++)
            add_instance(d, &table, &d->model.primitives[i], uses->nodes ? uses->nodes[n] : GLTF_NONE);
    }
    d->base.parts = d->mesh_parts;
    status = limit_vertices(d, error);
end:
    ffd_free(table.heads);
    ffd_free(table.next);
    return status;
}
