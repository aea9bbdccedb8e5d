/* gltf_anchors.c - places the vertices of a file and the offsets of its morph targets in a skeleton. */
#include "base/memory/memory.h"
#include "io/gltf/gltf_skeleton.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/model/gltf_results.h"
#include "io/gltf/model/gltf_scene.h"
#include "io/gltf/read/gltf_elements.h"
#include <string.h>

typedef struct anchor_work {
    const gltf_skeleton *rig;
    mesh_state state;
    bool after;
    mesh_anchors *anchors;
    size_t *first; /* per part: the index of its first vertex */
    bool *driven;  /* per node: whether a loaded animation drives its weights */
    bool *is_done; /* per part: whether its targets are done */
    ffd_error *error;
} anchor_work;

/* Returns the matrix from a part's vertices to their anchors. */
static const double *rest_of(const anchor_work *w, size_t part)
{
    static const double identity[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    const gltf_document *const d = w->rig->document;
    const gltf_skin *const skin = d->parts[part].skin;
    if (skin)
        return w->rig->skin_rest + 12 * (skin - d->skins);
    const double *const world = ffd_gltf_skeleton_world(w->rig, d->parts[part].node);
    double inverse[9];
    return mat_invert(world, inverse) ? world : identity;
}

static void place_part(const anchor_work *w, size_t part)
{
    const gltf_document *const d = w->rig->document;
    const size_t count = d->mesh_parts[part].vertex_count;
    double *const points = w->anchors->points + 3 * w->first[part];
    const double *const rest = rest_of(w, part);
    ffd_gltf_read_shown(d, part, GLTF_POSITION, w->state, 0, count, 3, points);
    if (w->after)
        ffd_gltf_put_results(&d->parts[part].streams[GLTF_POSITION], count, points);
    for (size_t i = 0; i < count; i++)
        ffd_point_transform(rest, rest + 9, points + 3 * i);
}

/* Whether the targets of any part have results. */
static bool has_results(const gltf_document *d)
{
    for (size_t i = 0; i < d->shape_count; i++)
        if (d->parts[d->base.part_count + i].streams[GLTF_POSITION].result)
            return true;
    return false;
}

static ffd_status add_target(anchor_work *w, size_t part, size_t target, size_t weight)
{
    const gltf_document *const d = w->rig->document;
    const size_t count = d->mesh_parts[part].vertex_count;
    const double *const rest = rest_of(w, part);
    rig_target *const to = &w->anchors->targets[w->anchors->target_count];
    *to = (rig_target){.first = w->first[part],
                       .count = count,
                       .weight = weight,
                       .offsets = ffd_alloc(count, 3 * sizeof *to->offsets)};
    if (!to->offsets)
        return ffd_fail_memory(w->error);
    w->anchors->target_count++;
    ffd_gltf_read(d, d->parts[target].streams[GLTF_POSITION].accessor, 0, count, 3, to->offsets);
    if (w->after)
        ffd_gltf_put_results(&d->parts[target].streams[GLTF_POSITION], count, to->offsets);
    for (size_t i = 0; i < count; i++)
        mat_apply(rest, to->offsets + 3 * i, to->offsets + 3 * i);
    return FFD_OK;
}

/* Returns the part to which an instance's weights apply. If primitives share it, the weights of the first one
   count. */
static size_t take_part(anchor_work *w, const gltf_instance *instance)
{
    const size_t part = instance->part[GLTF_POSITION];
    if (!w->driven[instance->node] || part == GLTF_NONE || w->is_done[part])
        return GLTF_NONE;
    w->is_done[part] = true;
    return part;
}

static bool has_positions(const gltf_document *d, size_t target)
{
    return target != GLTF_NONE && d->parts[target].streams[GLTF_POSITION].accessor != GLTF_NONE;
}

typedef ffd_status target_visit(anchor_work *w, size_t part, size_t target, size_t weight);

static ffd_status visit_targets(anchor_work *w, target_visit *visit)
{
    const gltf_document *const d = w->rig->document;
    memset(w->is_done, 0, d->base.part_count * sizeof *w->is_done);
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *const instance = &d->instances[i];
        const size_t part = take_part(w, instance);
        for (size_t t = 0; part != GLTF_NONE && t < instance->primitive->target_count; t++) {
            const size_t target = d->targets[instance->first_target + t];
            if (has_positions(d, target))
                TRY(visit(w, part, target, w->rig->pose.first_weight[instance->node] + t));
        }
    }
    return FFD_OK;
}

/* Counts a target and takes its memory. */
static ffd_status count_target(anchor_work *w, size_t part, size_t target, size_t weight)
{
    (void)target;
    (void)weight;
    w->anchors->target_count++;
    return ffd_gltf_skeleton_take((gltf_skeleton *)w->rig, w->rig->document->mesh_parts[part].vertex_count,
                                  3 * sizeof(double), w->error);
}

static ffd_status make_targets(anchor_work *w)
{
    TRY(visit_targets(w, count_target));
    const size_t count = w->anchors->target_count;
    w->anchors->target_count = 0;
    w->anchors->targets = ffd_alloc(count, sizeof *w->anchors->targets);
    if (!w->anchors->targets)
        return ffd_fail_memory(w->error);
    w->anchors->keeps_offsets = w->after && count > 0 && !has_results(w->rig->document);
    return visit_targets(w, add_target);
}

static void mark_driven(const anchor_work *w)
{
    const gltf_skeleton *const rig = w->rig;
    for (size_t a = 0; a < rig->animations.count; a++)
        for (size_t c = 0; rig->base.animations[a].channels && c < rig->animations.list[a].channel_count; c++)
            if (rig->animations.list[a].channels[c].path == GLTF_WEIGHTS)
                w->driven[rig->animations.list[a].channels[c].node] = true;
}

static ffd_status make_anchors(anchor_work *w)
{
    const gltf_document *const d = w->rig->document;
    const size_t count = w->rig->base.vertex_count;
    w->driven = ffd_alloc_zero(d->model.node_count, sizeof *w->driven);
    w->is_done = ffd_alloc_zero(d->base.part_count, sizeof *w->is_done);
    if (!w->driven || !w->is_done)
        return ffd_fail_memory(w->error);
    TRY(ffd_gltf_skeleton_take((gltf_skeleton *)w->rig, count, 3 * sizeof(double), w->error));
    TRY(ffd_first_vertices(&d->base, &w->first, w->error));
    w->anchors->points = ffd_alloc(count, 3 * sizeof(double));
    if (!w->anchors->points)
        return ffd_fail_memory(w->error);
    for (size_t p = 0; p < d->base.part_count; p++)
        if (!d->mesh_parts[p].repeats_positions)
            place_part(w, p);
    mark_driven(w);
    return make_targets(w);
}

ffd_status ffd_gltf_read_anchors(const mesh_skeleton *skeleton, mesh_state state, bool after,
                                 mesh_anchors *anchors, ffd_error *error)
{
    anchor_work w = {.rig = (const gltf_skeleton *)skeleton,
                     .state = state,
                     .after = after,
                     .anchors = anchors,
                     .error = error};
    *anchors = (mesh_anchors){0};
    const ffd_status status = make_anchors(&w);
    ffd_free(w.first);
    ffd_free(w.driven);
    ffd_free(w.is_done);
    return status;
}
