/* gltf_influences.c - finds the bones that each vertex of a file follows. */
#include "base/memory/memory.h"
#include "io/gltf/gltf_skeleton.h"
#include "io/gltf/read/gltf_read.h"

#define MOST 64 /* influences of a vertex in 16 sets */

typedef struct filler {
    const gltf_skeleton *rig;
    rig_influence *to;
    size_t count; /* so far */
} filler;

/* Returns the maximum number of influences of all vertices of a part together. */
static size_t most_of(const gltf_part *part, size_t vertices)
{
    return vertices * (part->skin ? 4 * part->influence_count : 1);
}

/* As in the default pose: weights are divided by their sum, and a vertex whose weights are all 0 follows its
   first joint. */
static void add_vertex(filler *f, size_t first_bone, const double *joints, const double *weights,
                       size_t count)
{
    double total = 0;
    const size_t begin = f->count;
    for (size_t i = 0; i < count; i++)
        total += weights[i];
    for (size_t i = 0; i < count && total > 0; i++)
        if (weights[i] != 0)
            f->to[f->count++] =
                (rig_influence){(uint32_t)(first_bone + (size_t)joints[i]), (float)(weights[i] / total)};
    if (f->count == begin)
        f->to[f->count++] = (rig_influence){(uint32_t)(first_bone + (size_t)joints[0]), 1};
}

static void add_skinned(filler *f, size_t p, size_t count, size_t *starts)
{
    const gltf_document *const d = f->rig->document;
    const gltf_part *const part = &d->parts[p];
    const size_t bone = f->rig->skin_bone[part->skin - d->skins], sets = part->influence_count;
    double joints[MOST], weights[MOST];
    for (size_t i = 0; i < count; i++) {
        for (size_t s = 0; s < sets; s++) {
            ffd_gltf_read(d, (size_t)part->influences[s].joints, i, 1, 4, joints + 4 * s);
            ffd_gltf_read(d, (size_t)part->influences[s].weights, i, 1, 4, weights + 4 * s);
        }
        for (size_t k = 0; k < 4 * sets; k++) /* beyond the skin: without a weight */
            joints[k] = joints[k] < (double)part->skin->joint_count ? joints[k] : 0;
        starts[i] = f->count;
        add_vertex(f, bone, joints, weights, 4 * sets);
    }
}

static void add_part(filler *f, size_t p, size_t *starts)
{
    const gltf_document *const d = f->rig->document;
    const size_t count = d->mesh_parts[p].vertex_count;
    if (d->parts[p].skin) {
        add_skinned(f, p, count, starts);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        starts[i] = f->count;
        f->to[f->count++] = (rig_influence){(uint32_t)f->rig->node_bone[d->parts[p].node], 1};
    }
}

ffd_status ffd_gltf_make_influences(gltf_skeleton *rig, ffd_error *error)
{
    const gltf_document *const d = rig->document;
    mesh_skeleton *const base = &rig->base;
    size_t most = 0, first = 0;
    base->vertex_count = (size_t)ffd_mesh_vertex_count(&d->base);
    for (size_t p = 0; p < d->base.part_count; p++)
        most += d->mesh_parts[p].repeats_positions ? 0 : most_of(&d->parts[p], d->mesh_parts[p].vertex_count);
    ffd_status status = ffd_gltf_skeleton_take(rig, most, sizeof *base->influences, error);
    if (!status)
        status = ffd_gltf_skeleton_take(rig, base->vertex_count + 1, sizeof *base->starts, error);
    if (status)
        return status;
    base->influences = ffd_alloc(most, sizeof *base->influences);
    base->starts = ffd_alloc(base->vertex_count + 1, sizeof *base->starts);
    if (!base->influences || !base->starts)
        return ffd_fail_memory(error);
    filler f = {.rig = rig, .to = base->influences};
    for (size_t p = 0; p < d->base.part_count; p++) {
        if (d->mesh_parts[p].repeats_positions)
            continue;
        add_part(&f, p, base->starts + first);
        first += d->mesh_parts[p].vertex_count;
    }
    base->starts[base->vertex_count] = f.count;
    return FFD_OK;
}
