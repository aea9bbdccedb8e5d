#include "mesh/polygon_cut.h"
#include "base/memory/memory.h"
#include <math.h>
#include <stdbool.h>

#define NOT_REFLEX UINT32_MAX

/* Looks at reflex corners that finding ears may take: more than any polygon of reason needs. */
#define LOOKS_FIRST ((uint64_t)1 << 20)
#define LOOKS_PER_CORNER 4096
#define MOST_LOOKS ((uint64_t)1 << 30)

/* How much is asked of an ear. Each step is taken when a whole round has found none. */
enum { EAR_CLEAR, EAR_TOUCHED, EAR_FLAT, EAR_ANY };

static ffd_status make_room(polygon_cutter *cutter, size_t count, ffd_error *error)
{
    if (count >= NOT_REFLEX)
        return ffd_fail(error, FFD_E_LIMIT, "a polygon has %zu corners, more than can be cut into triangles",
                        count);
    if (ffd_grow((void **)&cutter->plane, &cutter->plane_capacity, count, 2 * sizeof *cutter->plane) &&
        ffd_grow((void **)&cutter->previous, &cutter->previous_capacity, count, sizeof *cutter->previous) &&
        ffd_grow((void **)&cutter->next, &cutter->next_capacity, count, sizeof *cutter->next) &&
        ffd_grow((void **)&cutter->reflex, &cutter->reflex_capacity, count, sizeof *cutter->reflex) &&
        ffd_grow((void **)&cutter->reflex_slot, &cutter->reflex_slot_capacity, count,
                 sizeof *cutter->reflex_slot))
        return FFD_OK;
    return ffd_fail_memory(error);
}

/* Newell's sum over the edges: twice the area seen along each axis. Taken from the first corner, so that what
   is far from the origin loses nothing. */
static void add_normal(const double *points, size_t count, double normal[3])
{
    normal[0] = normal[1] = normal[2] = 0;
    for (size_t i = 1; i + 1 < count; i++)
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            const double *p = points + 3 * i, *q = p + 3;
            normal[a] += (p[b] - points[b]) * (q[c] - points[c]) - (p[c] - points[c]) * (q[b] - points[b]);
        }
}

/* Leaves out the axis along which the polygon shows most of its area; it then goes round to the left. */
static void project(polygon_cutter *cutter, const double *points, size_t count)
{
    double normal[3];
    add_normal(points, count, normal);
    int axis = fabs(normal[1]) > fabs(normal[0]) ? 1 : 0;
    axis = fabs(normal[2]) > fabs(normal[axis]) ? 2 : axis;
    const int right = (axis + (normal[axis] < 0 ? 2 : 1)) % 3, up = 3 - axis - right;
    for (size_t i = 0; i < count; i++) {
        cutter->plane[2 * i] = points[3 * i + (size_t)right] - points[right];
        cutter->plane[2 * i + 1] = points[3 * i + (size_t)up] - points[up];
    }
}

/* Twice the area of the triangle a b c: positive where it goes round to the left. */
static double area(const polygon_cutter *cutter, uint32_t a, uint32_t b, uint32_t c)
{
    const double *p = cutter->plane + 2 * (size_t)a, *q = cutter->plane + 2 * (size_t)b,
                 *r = cutter->plane + 2 * (size_t)c;
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

static bool same_position(const polygon_cutter *cutter, uint32_t a, uint32_t b)
{
    const double *p = cutter->plane + 2 * (size_t)a, *q = cutter->plane + 2 * (size_t)b;
    return !(p[0] < q[0] || p[0] > q[0] || p[1] < q[1] || p[1] > q[1]);
}

/* All corners turn left, and the edges turn from right to left and back once only: a star's turn left too. */
static bool is_convex(const polygon_cutter *cutter, uint32_t count)
{
    int turns = 0;
    bool leftwards = cutter->plane[0] < cutter->plane[2 * (size_t)(count - 1)];
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t j = i + 1 < count ? i + 1 : 0, k = j + 1 < count ? j + 1 : 0;
        if (!(area(cutter, i, j, k) > 0))
            return false;
        const double step = cutter->plane[2 * (size_t)j] - cutter->plane[2 * (size_t)i];
        const bool now = step < 0 || (!(step > 0) && leftwards);
        turns += now != leftwards;
        leftwards = now;
    }
    return turns <= 2;
}

static void set_reflex(polygon_cutter *cutter, uint32_t i)
{
    const bool reflex = !(area(cutter, cutter->previous[i], i, cutter->next[i]) > 0);
    if (reflex == (cutter->reflex_slot[i] != NOT_REFLEX))
        return;
    if (reflex) {
        cutter->reflex_slot[i] = (uint32_t)cutter->reflex_count;
        cutter->reflex[cutter->reflex_count++] = i;
        return;
    }
    const uint32_t last = cutter->reflex[--cutter->reflex_count];
    cutter->reflex[cutter->reflex_slot[i]] = last;
    cutter->reflex_slot[last] = cutter->reflex_slot[i];
    cutter->reflex_slot[i] = NOT_REFLEX;
}

static void link_corners(polygon_cutter *cutter, uint32_t count)
{
    cutter->reflex_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        cutter->previous[i] = i > 0 ? i - 1 : count - 1;
        cutter->next[i] = i + 1 < count ? i + 1 : 0;
        cutter->reflex_slot[i] = NOT_REFLEX;
    }
    for (uint32_t i = 0; i < count; i++)
        set_reflex(cutter, i);
}

/* Whether corner p keeps the triangle a b c from being an ear. Corners at the same position as a, b or c do
   not: a hole that is joined to the outline by a double edge has such. */
static bool obstructs(const polygon_cutter *cutter, uint32_t p, const uint32_t abc[3], int demand)
{
    if (p == abc[0] || p == abc[1] || p == abc[2])
        return false;
    const double least = fmin(area(cutter, abc[0], abc[1], p),
                              fmin(area(cutter, abc[1], abc[2], p), area(cutter, abc[2], abc[0], p)));
    if (demand == EAR_CLEAR ? !(least >= 0) : !(least > 0))
        return false;
    return !same_position(cutter, p, abc[0]) && !same_position(cutter, p, abc[1]) &&
           !same_position(cutter, p, abc[2]);
}

static bool is_ear(const polygon_cutter *cutter, uint32_t i, int demand, uint64_t *looks)
{
    const uint32_t abc[3] = {cutter->previous[i], i, cutter->next[i]};
    if (demand == EAR_ANY)
        return true;
    const double own = area(cutter, abc[0], abc[1], abc[2]);
    if (demand == EAR_FLAT ? !(own >= 0) : !(own > 0))
        return false;
    if (demand == EAR_FLAT)
        return true;
    for (size_t r = 0; r < cutter->reflex_count; r++, (*looks)++)
        if (obstructs(cutter, cutter->reflex[r], abc, demand))
            return false;
    return true;
}

static void unlink_corner(polygon_cutter *cutter, uint32_t i)
{
    const uint32_t before = cutter->previous[i], behind = cutter->next[i];
    cutter->next[before] = behind;
    cutter->previous[behind] = before;
    if (cutter->reflex_slot[i] != NOT_REFLEX) {
        const uint32_t last = cutter->reflex[--cutter->reflex_count];
        cutter->reflex[cutter->reflex_slot[i]] = last;
        cutter->reflex_slot[last] = cutter->reflex_slot[i];
    }
    set_reflex(cutter, before);
    set_reflex(cutter, behind);
}

static void cut_ears(polygon_cutter *cutter, uint32_t count, uint32_t *triangles)
{
    const uint64_t wanted = LOOKS_FIRST + (uint64_t)count * LOOKS_PER_CORNER;
    const uint64_t most_looks = wanted < MOST_LOOKS ? wanted : MOST_LOOKS;
    uint64_t looks = 0;
    uint32_t i = 0, left = count, tried = 0;
    int demand = EAR_CLEAR;
    while (left > 2) {
        if (is_ear(cutter, i, looks > most_looks ? EAR_ANY : demand, &looks)) {
            *triangles++ = cutter->previous[i];
            *triangles++ = i;
            *triangles++ = cutter->next[i];
            unlink_corner(cutter, i);
            left--;
            tried = 0;
            demand = EAR_CLEAR;
        } else if (++tried >= left) {
            tried = 0;
            demand++;
        }
        i = cutter->next[i]; /* that of a corner just cut off is still there */
    }
}

ffd_status ffd_polygon_cut(polygon_cutter *cutter, const double *points, size_t count, uint32_t *triangles,
                           ffd_error *error)
{
    bool fan = count == 3;
    if (!fan) {
        const ffd_status status = make_room(cutter, count, error);
        if (status)
            return status;
        project(cutter, points, count);
        fan = is_convex(cutter, (uint32_t)count);
    }
    if (fan) {
        for (uint32_t i = 1; i + 1 < count; i++) {
            *triangles++ = 0;
            *triangles++ = i;
            *triangles++ = i + 1;
        }
        return FFD_OK;
    }
    link_corners(cutter, (uint32_t)count);
    cut_ears(cutter, (uint32_t)count, triangles);
    return FFD_OK;
}

void ffd_polygon_cutter_free(polygon_cutter *cutter)
{
    ffd_free(cutter->plane);
    ffd_free(cutter->previous);
    ffd_free(cutter->next);
    ffd_free(cutter->reflex);
    ffd_free(cutter->reflex_slot);
    *cutter = (polygon_cutter){0};
}
