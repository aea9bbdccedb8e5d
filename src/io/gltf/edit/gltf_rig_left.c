#include "io/gltf/edit/gltf_rig_left.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "io/gltf/read/gltf_read.h"

/* Vertices that are read at a time. */
#define BLOCK ((size_t)64)

/* Fills the distances by which the joints of a skin have moved; 0 where that is rounding. Returns whether any
   has. */
static bool measure(const gltf_document *d, const gltf_rig *rig, const gltf_skin *skin, double *distances)
{
    bool any = false;
    for (size_t j = 0; j < skin->joint_count; j++) {
        const double *const old = d->world + 12 * skin->joints[j] + 9;
        const double *const made = rig->world + 12 * skin->joints[j] + 9;
        const double off[3] = {made[0] - old[0], made[1] - old[1], made[2] - old[2]};
        const double by = vec_length(off);
        distances[j] = by > RIG_PLACE_ROUNDING * (vec_length(old) + vec_length(made)) ? by : 0;
        any = any || distances[j] > 0;
    }
    return any;
}

/* Returns the largest distance of a joint that has a weight in a set. */
static double farthest(const gltf_document *d, const gltf_influence *set, size_t vertices,
                       const double *distances, size_t joint_count)
{
    double joints[4 * BLOCK], weights[4 * BLOCK], most = 0;
    for (size_t first = 0; first < vertices; first += BLOCK) {
        const size_t count = vertices - first < BLOCK ? vertices - first : BLOCK;
        ffd_gltf_read(d, (size_t)set->joints, first, count, 4, joints);
        ffd_gltf_read(d, (size_t)set->weights, first, count, 4, weights);
        for (size_t i = 0; i < 4 * count; i++)
            if (weights[i] > 0 && joints[i] < (double)joint_count)
                most = larger_of(most, distances[(size_t)joints[i]]);
    }
    return most;
}

ffd_status ffd_gltf_left_by_joints(const gltf_document *d, const gltf_rig *rig, size_t part, double *distance,
                                   ffd_error *error)
{
    const gltf_part *const p = &d->parts[part];
    *distance = 0;
    if (!p->skin || !d->mesh_parts[part].skipped || p->skin->joint_count == 0)
        return FFD_OK;
    double *const distances = ffd_alloc(p->skin->joint_count, sizeof *distances);
    if (!distances)
        return ffd_fail_memory(error);
    const bool moved = measure(d, rig, p->skin, distances);
    for (size_t s = 0; moved && s < p->influence_count; s++)
        *distance = larger_of(*distance, farthest(d, &p->influences[s], d->mesh_parts[part].vertex_count,
                                                  distances, p->skin->joint_count));
    ffd_free(distances);
    return FFD_OK;
}
