#include "io/gltf/model/gltf_joints.h"
#include "base/system/deadline.h"
#include "io/gltf/read/gltf_elements.h"

/* The most sets of joints and weights (gltf_skin.c). */
#define MOST_SETS ((size_t)16)
#define BLOCK ((size_t)32) /* vertices read at a time */

/* The influences of a block of vertices. */
typedef struct influence_block {
    size_t sets;
    double joints[MOST_SETS * 4 * BLOCK], weights[MOST_SETS * 4 * BLOCK];
} influence_block;

static void read_block(const gltf_document *d, size_t p, size_t first, size_t count, influence_block *block)
{
    const gltf_part *const part = &d->parts[p];
    block->sets = part->influence_count;
    for (size_t s = 0; s < block->sets; s++) {
        const gltf_influence *const influence = &part->influences[s];
        ffd_gltf_read(d, (size_t)influence->joints, first, count, 4, block->joints + 4 * BLOCK * s);
        ffd_gltf_read(d, (size_t)influence->weights, first, count, 4, block->weights + 4 * BLOCK * s);
    }
}

/* The node of an influence of vertex i of the block. */
static size_t node_of(const gltf_skin *skin, const influence_block *block, size_t i, size_t set, size_t k)
{
    const double joint = block->joints[4 * (BLOCK * set + i) + k];
    return skin->joints[joint >= 0 && joint < (double)skin->joint_count ? (size_t)joint : 0];
}

static double share_of(const gltf_skin *skin, const influence_block *block, size_t i, const bool *is_marked)
{
    double marked = 0, total = 0;
    for (size_t s = 0; s < block->sets; s++)
        for (size_t k = 0; k < 4; k++) {
            const double weight = block->weights[4 * (BLOCK * s + i) + k];
            marked += is_marked[node_of(skin, block, i, s, k)] ? weight : 0;
            total += weight;
        }
    return total != 0 ? marked / total : block->sets > 0 && is_marked[node_of(skin, block, i, 0, 0)];
}

ffd_status ffd_gltf_joint_shares(const gltf_document *d, size_t part, const bool *is_marked, double *shares,
                                 ffd_error *error)
{
    influence_block block;
    const size_t vertices = d->mesh_parts[part].vertex_count;
    for (size_t at = 0; at < vertices; at += BLOCK) {
        const size_t count = vertices - at < BLOCK ? vertices - at : BLOCK;
        TRY(ffd_deadline_check_at(at, error));
        read_block(d, part, at, count, &block);
        for (size_t i = 0; i < count; i++)
            shares[at + i] = share_of(d->parts[part].skin, &block, i, is_marked);
    }
    return FFD_OK;
}

/* What a joint has at least of a vertex that follows it alone. */
#define ALONE 0.99

static uint32_t leader_of(const gltf_skin *skin, const influence_block *block, size_t i, bool *blends)
{
    double total = 0;
    for (size_t s = 0; s < block->sets; s++)
        for (size_t k = 0; k < 4; k++)
            total += block->weights[4 * (BLOCK * s + i) + k];
    if (total == 0)
        return block->sets > 0 ? (uint32_t)node_of(skin, block, i, 0, 0) : UINT32_MAX;
    for (size_t s = 0; s < 4 * block->sets; s++) {
        const size_t node = node_of(skin, block, i, s / 4, s % 4);
        double own = 0;
        for (size_t t = 0; t < 4 * block->sets; t++)
            own += node_of(skin, block, i, t / 4, t % 4) == node
                       ? block->weights[4 * (BLOCK * (t / 4) + i) + t % 4]
                       : 0;
        if (!(own / total > 0.5))
            continue;
        if (blends && own / total < ALONE)
            blends[node] = true;
        return (uint32_t)node;
    }
    return UINT32_MAX;
}

ffd_status ffd_gltf_leading_joints(const gltf_document *d, size_t part, uint32_t *nodes, bool *blends,
                                   ffd_error *error)
{
    influence_block block;
    const size_t vertices = d->mesh_parts[part].vertex_count;
    for (size_t at = 0; at < vertices; at += BLOCK) {
        const size_t count = vertices - at < BLOCK ? vertices - at : BLOCK;
        TRY(ffd_deadline_check_at(at, error));
        read_block(d, part, at, count, &block);
        for (size_t i = 0; i < count; i++)
            nodes[at + i] = leader_of(d->parts[part].skin, &block, i, blends);
    }
    return FFD_OK;
}
