#include "mesh/polygon_cut.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Corners in a leaf of the tree. */
#define LEAF 16
/* Resolution of the grid by whose cells the corners are sorted. */
#define GRID 65535
/* Products of coordinates below this do not overflow. */
#define LARGEST 1e150

/* The budget of tests of corners and nodes for finding ears, more than any reasonable polygon needs. */
#define FIRST_TESTS ((uint64_t)1 << 20)
#define TESTS_PER_CORNER 4096
#define MOST_TESTS ((uint64_t)1 << 29)

/* The requirements for an ear, from strict to none. They are relaxed by one step when a whole round has found
   no ear. */
enum { EAR_CLEAR, EAR_TOUCHED, EAR_FLAT, EAR_ANY };

static size_t count_leaves(size_t count)
{
    size_t leaves = 1;
    while (leaves * LEAF < count)
        leaves *= 2;
    return leaves;
}

static ffd_status reserve(polygon_cutter *cutter, size_t count, ffd_error *error)
{
    if (count >= UINT32_MAX / 2)
        return ffd_fail(error, FFD_E_LIMIT, "a polygon has %zu corners, more than can be cut into triangles",
                        count);
    cutter->leaves = count_leaves(count);
    if (ffd_grow((void **)&cutter->plane, &cutter->plane_capacity, count, 2 * sizeof *cutter->plane) &&
        ffd_grow((void **)&cutter->corners, &cutter->corners_capacity, count, sizeof *cutter->corners) &&
        ffd_grow((void **)&cutter->order, &cutter->order_capacity, count, sizeof *cutter->order) &&
        ffd_grow((void **)&cutter->nodes, &cutter->nodes_capacity, 2 * cutter->leaves, sizeof *cutter->nodes))
        return FFD_OK;
    return ffd_fail_memory(error);
}

/* Newell's sum over the edges: twice the area projected along each axis. Relative to the first corner, so
   that no digits are lost far from the origin. */
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

/* Projects along the axis with the greatest projected area, with counter-clockwise orientation. */
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

/* Returns twice the signed area of the triangle a b c; positive if counter-clockwise. */
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

/* Returns whether all corners turn left and the edges change direction between left and right only twice; the
   corners of a star polygon turn left too. */
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

/* Spreads bits to every second position. */
static uint64_t spread(uint32_t bits)
{
    uint64_t all = bits;
    all = (all | all << 8) & 0x00ff00ff;
    all = (all | all << 4) & 0x0f0f0f0f;
    all = (all | all << 2) & 0x33333333;
    return (all | all << 1) & 0x55555555;
}

static int compare_keys(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Sorts the corners along a Z-order curve (G. M. Morton, 1966), so that the corners of a node are near each
   other. The order does not affect the triangles. */
static ffd_status order_corners(polygon_cutter *cutter, uint32_t count, ffd_error *error)
{
    double low[2] = {DBL_MAX, DBL_MAX}, extent = 0;
    for (size_t i = 0; i < 2 * (size_t)count; i++)
        low[i % 2] = minimum_number(low[i % 2], cutter->plane[i]);
    for (size_t i = 0; i < 2 * (size_t)count; i++)
        extent = maximum_number(extent, cutter->plane[i] - low[i % 2]);
    uint64_t *const keys = ffd_alloc(count, sizeof *keys);
    if (!keys)
        return ffd_fail_memory(error);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t cell[2] = {0, 0};
        for (size_t a = 0; a < 2 && extent > 0; a++)
            cell[a] = (uint32_t)((cutter->plane[2 * (size_t)i + a] - low[a]) / extent * GRID);
        keys[i] = (spread(cell[0]) | spread(cell[1]) << 1) << 32 | i;
    }
    qsort(keys, count, sizeof *keys, compare_keys);
    for (uint32_t i = 0; i < count; i++)
        cutter->order[i] = (uint32_t)keys[i];
    ffd_free(keys);
    return FFD_OK;
}

/* Leaves begin at nodes[leaves], with LEAF corners each, in order; the children of node n are 2 n and 2 n +
   1. */
static void fill_nodes(polygon_cutter *cutter, uint32_t count)
{
    for (size_t n = 1; n < 2 * cutter->leaves; n++)
        cutter->nodes[n] = (cut_node){{DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX}, 0};
    for (uint32_t i = 0; i < count; i++) {
        cut_node *const leaf = &cutter->nodes[cutter->leaves + i / LEAF];
        const double *const p = cutter->plane + 2 * (size_t)cutter->order[i];
        cutter->corners[cutter->order[i]].place = i;
        for (int a = 0; a < 2; a++) {
            leaf->low[a] = minimum_number(leaf->low[a], p[a]);
            leaf->high[a] = maximum_number(leaf->high[a], p[a]);
        }
    }
    for (size_t n = cutter->leaves - 1; n > 0; n--)
        for (int a = 0; a < 2; a++) {
            cutter->nodes[n].low[a] =
                minimum_number(cutter->nodes[2 * n].low[a], cutter->nodes[2 * n + 1].low[a]);
            cutter->nodes[n].high[a] =
                maximum_number(cutter->nodes[2 * n].high[a], cutter->nodes[2 * n + 1].high[a]);
        }
}

static void mark(polygon_cutter *cutter, uint32_t i, bool is_reflex)
{
    cut_corner *const corner = &cutter->corners[i];
    if (corner->is_reflex == is_reflex)
        return;
    corner->is_reflex = is_reflex;
    for (size_t n = cutter->leaves + corner->place / LEAF; n > 0; n /= 2)
        cutter->nodes[n].reflex_count += is_reflex ? 1 : UINT32_MAX; /* subtracts 1 */
}

static void set_reflex(polygon_cutter *cutter, uint32_t i)
{
    mark(cutter, i, !(area(cutter, cutter->corners[i].previous, i, cutter->corners[i].next) > 0));
}

static ffd_status link_corners(polygon_cutter *cutter, uint32_t count, ffd_error *error)
{
    bool is_plain = count <= LEAF;
    for (size_t i = 0; i < 2 * (size_t)count && !is_plain; i++)
        is_plain = !(fabs(cutter->plane[i]) < LARGEST);
    for (uint32_t i = 0; i < count; i++)
        cutter->order[i] = i;
    cutter->has_boxes = !is_plain;
    TRY(is_plain ? FFD_OK : order_corners(cutter, count, error));
    for (uint32_t i = 0; i < count; i++)
        cutter->corners[i] = (cut_corner){i > 0 ? i - 1 : count - 1, i + 1 < count ? i + 1 : 0, 0, false};
    fill_nodes(cutter, count);
    for (uint32_t i = 0; i < count; i++)
        set_reflex(cutter, i);
    return FFD_OK;
}

/* Returns whether corner p prevents the triangle a b c from being an ear. Corners at the position of a, b or
   c do not: they exist if a hole is joined to the outline by a double edge. */
static bool obstructs(const polygon_cutter *cutter, uint32_t p, const uint32_t abc[3], int demand)
{
    if (p == abc[0] || p == abc[1] || p == abc[2])
        return false;
    const double least =
        minimum_number(area(cutter, abc[0], abc[1], p),
                       minimum_number(area(cutter, abc[1], abc[2], p), area(cutter, abc[2], abc[0], p)));
    if (demand == EAR_CLEAR ? !(least >= 0) : !(least > 0))
        return false;
    return !same_position(cutter, p, abc[0]) && !same_position(cutter, p, abc[1]) &&
           !same_position(cutter, p, abc[2]);
}

/* Returns whether no corner in a box can obstruct the triangle. The bound uses the operations of area() in
   the same order; because rounding is monotone, no corner has a greater area. */
static bool is_clear_of(const polygon_cutter *cutter, const cut_node *node, const uint32_t abc[3])
{
    const bool is_point = !(node->low[0] < node->high[0] || node->low[1] < node->high[1]);
    for (int k = 0; k < 3; k++) {
        const double *const p = cutter->plane + 2 * (size_t)abc[k], *const q = cutter->plane +
                                                                               2 * (size_t)abc[(k + 1) % 3];
        const double dx = q[0] - p[0], dy = q[1] - p[1];
        const double y = dx > 0 ? node->high[1] : node->low[1], x = dy > 0 ? node->low[0] : node->high[0];
        if (dx * (y - p[1]) - dy * (x - p[0]) < 0)
            return true;
        if (is_point && !(p[0] < x || p[0] > x || p[1] < y || p[1] > y))
            return true;
    }
    return false;
}

static bool is_obstructed(const polygon_cutter *cutter, const uint32_t abc[3], int demand, uint64_t *tests)
{
    size_t stack[64] = {1}, depth = 1;
    while (depth > 0) {
        const size_t n = stack[--depth];
        const cut_node *const node = &cutter->nodes[n];
        ++*tests;
        if (node->reflex_count == 0 || (cutter->has_boxes && is_clear_of(cutter, node, abc)))
            continue;
        if (n < cutter->leaves) {
            stack[depth++] = 2 * n;
            stack[depth++] = 2 * n + 1;
            continue;
        }
        uint32_t left = node->reflex_count;
        for (size_t r = (n - cutter->leaves) * LEAF; left > 0; r++) {
            const uint32_t p = cutter->order[r];
            if (!cutter->corners[p].is_reflex)
                continue;
            if (obstructs(cutter, p, abc, demand))
                return true;
            left--;
            ++*tests;
        }
    }
    return false;
}

static bool is_ear(const polygon_cutter *cutter, uint32_t i, int demand, uint64_t *tests)
{
    const uint32_t abc[3] = {cutter->corners[i].previous, i, cutter->corners[i].next};
    ++*tests;
    if (demand == EAR_ANY)
        return true;
    const double own = area(cutter, abc[0], abc[1], abc[2]);
    if (demand == EAR_FLAT ? !(own >= 0) : !(own > 0))
        return false;
    return demand == EAR_FLAT || !is_obstructed(cutter, abc, demand, tests);
}

static void unlink_corner(polygon_cutter *cutter, uint32_t i)
{
    const uint32_t before = cutter->corners[i].previous, behind = cutter->corners[i].next;
    cutter->corners[before].next = behind;
    cutter->corners[behind].previous = before;
    mark(cutter, i, false);
    set_reflex(cutter, before);
    set_reflex(cutter, behind);
}

static void cut_ears(polygon_cutter *cutter, uint32_t count, uint32_t *triangles)
{
    const uint64_t wanted = FIRST_TESTS + (uint64_t)count * TESTS_PER_CORNER;
    const uint64_t most_tests = wanted < MOST_TESTS ? wanted : MOST_TESTS;
    uint64_t tests = 0;
    uint32_t i = 0, left = count, tried = 0;
    int demand = EAR_CLEAR;
    while (left > 2) {
        if (is_ear(cutter, i, tests > most_tests ? EAR_ANY : demand, &tests)) {
            *triangles++ = cutter->corners[i].previous;
            *triangles++ = i;
            *triangles++ = cutter->corners[i].next;
            unlink_corner(cutter, i);
            left--;
            tried = 0;
            demand = EAR_CLEAR;
        } else if (++tried >= left) {
            tried = 0;
            demand++;
        }
        i = cutter->corners[i].next; /* `next` of a corner that was just cut off is still valid */
    }
    if (tests > most_tests)
        cutter->hurried++;
}

ffd_status ffd_polygon_cut(polygon_cutter *cutter, const double *points, size_t count, uint32_t *triangles,
                           ffd_error *error)
{
    bool fan = count == 3;
    if (!fan) {
        TRY(reserve(cutter, count, error));
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
    TRY(link_corners(cutter, (uint32_t)count, error));
    cut_ears(cutter, (uint32_t)count, triangles);
    return FFD_OK;
}

void ffd_polygon_cut_warn(uint64_t hurried, const mesh_log *log)
{
    if (hurried)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%llu %s so many corners that finding a cut without overlaps takes too long: triangles "
                     "may overlap",
                     (unsigned long long)hurried, ffd_plural(hurried, "polygon has", "polygons have"));
}

void ffd_polygon_cutter_free(polygon_cutter *cutter)
{
    ffd_free(cutter->plane);
    ffd_free(cutter->corners);
    ffd_free(cutter->order);
    ffd_free(cutter->nodes);
    *cutter = (polygon_cutter){0};
}
