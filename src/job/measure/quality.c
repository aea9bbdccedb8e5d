#include "job/measure/quality.h"
#include "base/inline.h"
#include "base/vector/vec.h"
#include "mesh/polygon.h"

static bool is_collapsed(const uint32_t *corners, size_t count, const uint8_t *collapsed)
{
    for (size_t i = 0; i < count && collapsed; i++)
        if (!collapsed[corners[i]])
            return false;
    return collapsed;
}

bool ffd_quality_is_flipped(const uint32_t *corners, size_t count, const face_motion *motion)
{
    const double *const gradients = motion->gradients;
    double before[3], after[3], carried[3], mean[9] = {0};
    if (count < 3 || is_collapsed(corners, count, motion->collapsed) ||
        !ffd_polygon_normal(motion->rest, corners, count, before, NULL) ||
        !ffd_polygon_normal(motion->deformed, corners, count, after, NULL))
        return false;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 9; k++)
            mean[k] += gradients[9 * (size_t)corners[i] + k] / (double)count;
    mat_apply(mean, before, carried);
    for (int a = 0; a < 3; a++)
        carried[a] += before[a];
    return vec_dot(after, carried) < 0;
}

/* What n' . (F n) of a face must exceed, relative to its edges, so that it is positive however it is
   rounded, with entries of F - I up to the second number; and the least size that does not underflow. */
#define CERTAIN 1e-4
#define LARGEST_GRADIENT 1e6
#define LEAST_SIZE 1e-250

/* Returns the sum of the squares of the edges from the first corner. normal: receives the sum of their cross
   products. */
static ALWAYS_INLINE double take_edges(const double *xyz, const uint32_t *corners, size_t count,
                                       double normal[3])
{
    const double *const p = xyz + 3 * (size_t)corners[0];
    double ax = 0, ay = 0, az = 0, size = 0;
    normal[0] = normal[1] = normal[2] = 0;
    for (size_t i = 1; i < count; i++) {
        const double *const q = xyz + 3 * (size_t)corners[i];
        const double bx = q[0] - p[0], by = q[1] - p[1], bz = q[2] - p[2];
        normal[0] += ay * bz - az * by;
        normal[1] += az * bx - ax * bz;
        normal[2] += ax * by - ay * bx;
        size += bx * bx + by * by + bz * bz;
        ax = bx;
        ay = by;
        az = bz;
    }
    return size;
}

/* Whether a face is not flipped for certain, as nearly all are: in few operations. No entry of the gradients
   is too large. */
static ALWAYS_INLINE bool is_upright(const uint32_t *corners, size_t count, const double *rest,
                                     const double *deformed, const double *gradients)
{
    double n[3], after[3], sum[9] = {0}, dot = 0;
    const double size = take_edges(rest, corners, count, n) * take_edges(deformed, corners, count, after);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 9; k++)
            sum[k] += gradients[9 * (size_t)corners[i] + k];
    for (int r = 0; r < 3; r++)
        dot += after[r] *
               ((double)count * n[r] + sum[3 * r] * n[0] + sum[3 * r + 1] * n[1] + sum[3 * r + 2] * n[2]);
    return size > LEAST_SIZE && dot > CERTAIN * (double)count * size;
}

/* Whether no gradient is too large for is_upright. */
static bool are_moderate(const double *gradients, size_t count)
{
    double largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = larger_of(largest, fabs(gradients[i]));
    return largest < LARGEST_GRADIENT;
}

uint64_t ffd_quality_flipped(const mesh_faces *faces, const face_motion *motion)
{
    const double *const rest = motion->rest, *const deformed = motion->deformed;
    const double *const gradients = motion->gradients;
    const bool moderate = faces->face_count > 0 && are_moderate(gradients, 9 * faces->vertex_count);
    uint64_t flipped = 0;
    for (size_t f = 0; f < faces->face_count; f++) {
        const uint32_t *const corners = faces->corners + faces->start[f];
        const size_t count = faces->start[f + 1] - faces->start[f];
        const bool upright = moderate && (count == 3   ? is_upright(corners, 3, rest, deformed, gradients)
                                          : count == 4 ? is_upright(corners, 4, rest, deformed, gradients)
                                                       : false);
        if (!upright)
            flipped += ffd_quality_is_flipped(corners, count, motion);
    }
    return flipped;
}
