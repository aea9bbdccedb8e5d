#include "job/quality.h"
#include "base/vec.h"
#include <float.h>

/* A polygon's normal by Newell's sum, of no particular length: differences to the first corner are divided by
   the largest of them, so that nothing overflows. False where the polygon has no area beyond what the
   coordinates' rounding can make, or a corner is not finite. */
static bool polygon_normal(const double *xyz, const uint32_t *corners, size_t count, double normal[3])
{
    const double *first = xyz + 3 * (size_t)corners[0];
    double extent = 0, largest = 0, before[3] = {0, 0, 0}, lengths = 0;
    for (size_t i = 0; i < count; i++) {
        const double *p = xyz + 3 * (size_t)corners[i];
        if (!vec_is_finite(p))
            return false;
        for (int a = 0; a < 3; a++) {
            extent = fmax(extent, fabs(p[a]));
            largest = fmax(largest, fabs(p[a] - first[a]));
        }
    }
    if (!(largest > 0 && isfinite(largest)))
        return false;
    normal[0] = normal[1] = normal[2] = 0;
    for (size_t i = 1; i < count; i++) {
        const double *p = xyz + 3 * (size_t)corners[i];
        double now[3], cross[3];
        for (int a = 0; a < 3; a++)
            now[a] = (p[a] - first[a]) / largest;
        vec_cross(before, now, cross);
        for (int a = 0; a < 3; a++) {
            normal[a] += cross[a];
            before[a] = now[a];
        }
        lengths += vec_length(now);
    }
    /* Coordinates that are off by eps extent move a product of two differences by twice that times the other
       difference's length; twice again for good measure. */
    return vec_length(normal) > 4 * DBL_EPSILON * (extent / largest) * lengths;
}

static bool is_flipped(const uint32_t *corners, size_t count, const double *rest, const double *deformed,
                       const double *gradients)
{
    double before[3], after[3], carried[3], mean[9] = {0};
    if (count < 3 || !polygon_normal(rest, corners, count, before) ||
        !polygon_normal(deformed, corners, count, after))
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
        flipped += is_flipped(faces->corners + faces->start[f], faces->start[f + 1] - faces->start[f],
                              faces->positions, deformed, gradients);
    return flipped;
}
