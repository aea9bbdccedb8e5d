#include "io/gltf/read/gltf_weights.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_read.h"
#include <math.h>

#define BLOCK ((size_t)64) /* vertices read at a time */

/* Draco and meshopt round weights, so that sums are off in files that are valid. */
#define PACKED_ROUNDING 1e-2

/* The weights of a vertex, over all sets. */
typedef struct weight_sum {
    double total, least;
} weight_sum;

static ffd_status judge(gltf_document *d, size_t number, size_t vertex, const weight_sum *sum,
                        ffd_error *error)
{
    const uint32_t accessor = d->accessor_values.values[number];
    const double rounding = d->layouts[number].packing == GLTF_PLAIN ? WEIGHT_SUM_ROUNDING : PACKED_ROUNDING;
    ffd_status status = FFD_OK;
    if (!isfinite(sum->total))
        return ffd_gltf_flaw(d, accessor, error, "the weights of vertex %zu are not finite: it has no place",
                             vertex);
    if (sum->least < 0)
        status =
            ffd_gltf_flaw(d, accessor, error, "vertex %zu has a negative weight, %g", vertex, sum->least);
    if (status || fabs(sum->total - 1) <= rounding)
        return status;
    if (sum->total > 0)
        return ffd_gltf_flaw(d, accessor, error,
                             "the weights of vertex %zu sum to %.9g, not 1: they are divided by their sum",
                             vertex, sum->total);
    return ffd_gltf_flaw(d, accessor, error,
                         "the weights of vertex %zu sum to %g, not 1: it follows its first joint", vertex,
                         sum->total);
}

static ffd_status judge_block(gltf_document *d, const gltf_primitive *primitive, size_t first, size_t count,
                              ffd_error *error)
{
    weight_sum sums[BLOCK];
    double weights[4 * BLOCK];
    for (size_t i = 0; i < count; i++)
        sums[i] = (weight_sum){0, 0};
    for (size_t s = 0; s < primitive->influence_count; s++) {
        ffd_gltf_read(d, (size_t)primitive->influences[s].weights, first, count, 4, weights);
        for (size_t i = 0; i < 4 * count; i++) {
            sums[i / 4].total += weights[i];
            sums[i / 4].least = fmin(sums[i / 4].least, weights[i]);
        }
    }
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < count && status == FFD_OK; i++)
        status = judge(d, (size_t)primitive->influences[0].weights, first + i, &sums[i], error);
    return status;
}

static bool is_readable(const gltf_document *d, const gltf_primitive *primitive)
{
    bool readable = primitive->accessor[GLTF_POSITION] >= 0 && primitive->influence_count > 0;
    for (size_t s = 0; s < primitive->influence_count && readable; s++)
        readable = d->layouts[primitive->influences[s].weights].readable;
    return readable;
}

/* Primitives may share an accessor: judged tells which ones have had their turn. */
static ffd_status judge_mesh(gltf_document *d, size_t mesh, bool *judged, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t p = 0; p < d->model.meshes[mesh].primitive_count && status == FFD_OK; p++) {
        const gltf_primitive *const primitive = &d->model.meshes[mesh].primitives[p];
        if (!is_readable(d, primitive) || judged[primitive->influences[0].weights])
            continue;
        judged[primitive->influences[0].weights] = true;
        const size_t count = (size_t)d->model.accessors[primitive->influences[0].weights].count;
        for (size_t at = 0; at < count && status == FFD_OK; at += BLOCK)
            status = judge_block(d, primitive, at, count - at < BLOCK ? count - at : BLOCK, error);
    }
    return status;
}

ffd_status ffd_gltf_judge_weights(gltf_document *d, ffd_error *error)
{
    ffd_status status = FFD_OK;
    bool *const judged = ffd_alloc_zero(d->model.accessor_count, sizeof *judged);
    if (!judged)
        return ffd_fail_memory(error);
    for (size_t m = 0; m < d->model.mesh_count && status == FFD_OK; m++)
        if (ffd_gltf_has_skin(d, &d->mesh_uses[m]))
            status = judge_mesh(d, m, judged, error);
    ffd_free(judged);
    return status;
}
