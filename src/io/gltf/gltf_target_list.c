/* gltf_target_list.c - the morph targets of a file with their names, and the offsets of each in the scene. */
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_morphs.h"
#include "io/gltf/model/gltf_animation.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/model/gltf_results.h"
#include "io/gltf/read/gltf_elements.h"
#include "mesh/rig.h"

typedef struct list_work {
    const gltf_document *d;
    mesh_targets *targets;
    bool *is_done;    /* per part: whether its targets are listed */
    size_t *weights;  /* per node: the number of weights before its own, as gltf_pose has it */
    uint32_t **names; /* per mesh, once it is needed: ffd_gltf_list_target_names */
    ffd_error *error;
} list_work;

/* Names a target as the file does; NULL: it does not. */
static ffd_status name_target(list_work *w, size_t mesh, mesh_target *target)
{
    if (!w->names[mesh])
        w->names[mesh] = ffd_gltf_list_target_names(w->d, mesh);
    if (!w->names[mesh])
        return ffd_fail_memory(w->error);
    const uint32_t value = w->names[mesh][target->number];
    if (value == JSON_NONE)
        return FFD_OK;
    target->name = ffd_json_tree_string(&w->d->tree, value, NULL);
    return target->name ? FFD_OK : ffd_fail_memory(w->error);
}

static bool moves_positions(const gltf_document *d, size_t target)
{
    return target != GLTF_NONE && d->parts[target].streams[GLTF_POSITION].accessor != GLTF_NONE;
}

/* Lists the targets of an instance. A part that primitives share has those of the first. */
static ffd_status list_instance(list_work *w, const gltf_instance *instance)
{
    const gltf_document *const d = w->d;
    const size_t mesh = instance->primitive->mesh, part = instance->part[GLTF_POSITION];
    uint32_t weight = ffd_gltf_first_weight(d, mesh, instance->node);
    if (part == GLTF_NONE || w->is_done[part])
        return FFD_OK;
    w->is_done[part] = true;
    for (size_t t = 0; t < instance->primitive->target_count; t++) {
        const size_t source = d->targets[instance->first_target + t];
        mesh_target *const to = &w->targets->list[w->targets->count];
        const bool is_weighted = weight != JSON_NONE && t < d->mesh_uses[mesh].filed_targets;
        *to = (mesh_target){.mesh = mesh, .number = t, .part = part, .source = source};
        to->rig_weight = instance->node == GLTF_NONE ? RIG_NONE : w->weights[instance->node] + t;
        if (!is_weighted || !ffd_gltf_weight(d, weight, &to->weight))
            to->weight = 0;
        weight = is_weighted ? ffd_json_tree_after(&d->tree, weight) : weight;
        if (!moves_positions(d, source))
            continue;
        w->targets->count++;
        TRY(name_target(w, mesh, to));
    }
    return FFD_OK;
}

/* Memory of a target in the list, with its name. */
#define TARGET_BYTES (sizeof(mesh_target) + 64)

static ffd_status make_list(list_work *w)
{
    const gltf_document *const d = w->d;
    size_t count = 0, weights = 0;
    for (size_t i = 0; i < d->instance_count; i++)
        count += d->instances[i].primitive->target_count;
    TRY(ffd_budget_check(&d->base.budget, count, TARGET_BYTES, w->error));
    w->is_done = ffd_alloc_zero(d->base.part_count, sizeof *w->is_done);
    w->weights = ffd_alloc(d->model.node_count, sizeof *w->weights);
    w->names = ffd_alloc_zero(d->model.mesh_count, sizeof *w->names);
    w->targets->list = ffd_alloc(count, sizeof *w->targets->list);
    if (!w->is_done || !w->weights || !w->names || !w->targets->list)
        return ffd_fail_memory(w->error);
    for (size_t n = 0; n < d->model.node_count; n++) {
        w->weights[n] = weights;
        weights += ffd_gltf_node_targets(d, n);
    }
    for (size_t i = 0; i < d->instance_count && count > 0; i++)
        TRY(list_instance(w, &d->instances[i]));
    return FFD_OK;
}

ffd_status ffd_gltf_list_targets(const mesh_document *document, mesh_targets *targets, ffd_error *error)
{
    list_work w = {.d = ffd_gltf_of(document), .targets = targets, .error = error};
    const ffd_status status = make_list(&w);
    for (size_t m = 0; w.names && m < w.d->model.mesh_count; m++)
        ffd_free(w.names[m]);
    ffd_free(w.names);
    ffd_free(w.weights);
    ffd_free(w.is_done);
    return status;
}

/* Vertices whose transforms are read at a time. */
#define BLOCK ((size_t)128)

static void turn_skinned(const mesh_document *document, size_t part, size_t count, double *offsets)
{
    double transforms[12 * BLOCK];
    for (size_t first = 0; first < count; first += BLOCK) {
        const size_t size = count - first < BLOCK ? count - first : BLOCK;
        ffd_gltf_read_transforms(document, part, first, size, transforms, NULL);
        for (size_t i = 0; i < size; i++)
            mat_apply(transforms + 12 * i, offsets + 3 * (first + i), offsets + 3 * (first + i));
    }
}

/* The node of a part that is carried shows its results as (I + carry)^-1 of where they are in the space of
   the lattice. */
static void bring_back(const mesh_part *part, double *offsets)
{
    double carry[9], inverse[9];
    for (int i = 0; i < 9; i++)
        carry[i] = part->carry[i] + (i % 4 == 0 ? 1 : 0);
    if (!mat_invert(carry, inverse))
        return;
    for (size_t i = 0; i < part->vertex_count; i++)
        mat_apply(inverse, offsets + 3 * i, offsets + 3 * i);
}

void ffd_gltf_read_target(const mesh_document *document, const mesh_target *target, bool after,
                          double *offsets)
{
    const gltf_document *const d = ffd_gltf_of(document);
    const mesh_part *const part = &d->mesh_parts[target->part];
    const gltf_stream *const stream = &d->parts[target->source].streams[GLTF_POSITION];
    ffd_gltf_read(d, stream->accessor, 0, part->vertex_count, 3, offsets);
    if (after)
        ffd_gltf_put_results(stream, part->vertex_count, offsets);
    if (part->skinned)
        turn_skinned(document, target->part, part->vertex_count, offsets);
    for (size_t i = 0; i < part->vertex_count && !part->skinned && !part->identity; i++)
        mat_apply(part->linear, offsets + 3 * i, offsets + 3 * i);
    if (after && part->carried)
        bring_back(part, offsets);
}
