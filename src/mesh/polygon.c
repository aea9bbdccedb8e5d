#include "mesh/polygon.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include <float.h>

bool ffd_polygon_normal(const double *xyz, const uint32_t *corners, size_t count, double normal[3],
                        double *extent)
{
    const double *first = xyz + 3 * (size_t)corners[0];
    double reach = 0, largest = 0, before[3] = {0, 0, 0}, lengths = 0;
    for (size_t i = 0; i < count; i++) {
        const double *p = xyz + 3 * (size_t)corners[i];
        if (!vec_is_finite(p))
            return false;
        for (int a = 0; a < 3; a++) {
            reach = larger_of(reach, fabs(p[a]));
            largest = larger_of(largest, fabs(p[a] - first[a]));
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
    if (extent)
        *extent = largest;
    /* Coordinates with errors of eps * reach change a product of two differences by twice that, times the
       length of the other difference; doubled as a margin. */
    return vec_length(normal) > 4 * DBL_EPSILON * (reach / largest) * lengths;
}

static const double *position(const double *xyz, const uint32_t *corners, size_t i)
{
    return xyz + 3 * (size_t)corners[i];
}

static bool same_position(const double a[3], const double b[3])
{
    return !(a[0] < b[0] || a[0] > b[0] || a[1] < b[1] || a[1] > b[1] || a[2] < b[2] || a[2] > b[2]);
}

/* Returns the angle from the edge to the next corner, round the normal, to the edge to the previous corner.
   Lengths are scaled to at most 1, so nothing overflows. */
static double interior_angle(const double before[3], const double p[3], const double next[3],
                             const double normal[3])
{
    double to[3], from[3], cross[3], largest = 0;
    for (int a = 0; a < 3; a++) {
        to[a] = next[a] - p[a];
        from[a] = before[a] - p[a];
        largest = maximum_number(largest, maximum_number(fabs(to[a]), fabs(from[a])));
    }
    for (int a = 0; a < 3; a++) {
        to[a] /= largest;
        from[a] /= largest;
    }
    vec_cross(to, from, cross);
    const double angle = ffd_arc_tangent(vec_length(cross), vec_dot(to, from));
    return vec_dot(cross, normal) < 0 ? ffd_arc_tangent(0, -1) * 2 - angle : angle;
}

/* Finds the first corner of each run of consecutive corners at the same position, cyclically. Returns the
   number of runs. */
static size_t find_runs(const double *xyz, const uint32_t *corners, size_t count, size_t *runs)
{
    size_t found = 0;
    for (size_t i = 0; i < count; i++)
        if (!same_position(position(xyz, corners, i), position(xyz, corners, (i + count - 1) % count)))
            runs[found++] = i;
    return found;
}

void ffd_polygon_angles(const double *xyz, const uint32_t *corners, size_t count, const double normal[3],
                        size_t *scratch, double *angles)
{
    const size_t runs = find_runs(xyz, corners, count, scratch);
    for (size_t i = 0; i < count && runs < 3; i++)
        angles[i] = 0;
    for (size_t r = 0; r < runs && runs >= 3; r++) {
        const size_t first = scratch[r], next = scratch[(r + 1) % runs];
        const size_t size = next > first ? next - first : next + count - first;
        const double angle =
            interior_angle(position(xyz, corners, scratch[(r + runs - 1) % runs]),
                           position(xyz, corners, first), position(xyz, corners, next), normal);
        for (size_t i = 0; i < size; i++)
            angles[(first + i) % count] = angle / (double)size;
    }
}
