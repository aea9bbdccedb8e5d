#include "job/measure/quality.h"
#include "base/vector/vec.h"
#include "mesh/polygon.h"

bool ffd_quality_is_flipped(const uint32_t *corners, size_t count, const double *rest, const double *deformed,
                            const double *gradients)
{
    double before[3], after[3], carried[3], mean[9] = {0};
    if (count < 3 || !ffd_polygon_normal(rest, corners, count, before, NULL) ||
        !ffd_polygon_normal(deformed, corners, count, after, NULL))
        return false;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 9; k++)
            mean[k] += gradients[9 * (size_t)corners[i] + k] / (double)count;
    mat_apply(mean, before, carried);
    for (int a = 0; a < 3; a++)
        carried[a] += before[a];
    return vec_dot(after, carried) < 0;
}

uint64_t ffd_quality_flipped(const mesh_faces *faces, const double *deformed, const double *gradients)
{
    uint64_t flipped = 0;
    for (size_t f = 0; f < faces->face_count; f++)
        flipped +=
            ffd_quality_is_flipped(faces->corners + faces->start[f], faces->start[f + 1] - faces->start[f],
                                   faces->positions, deformed, gradients);
    return flipped;
}
