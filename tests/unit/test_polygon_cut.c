/* Polygons are cut into triangles that cover them exactly once. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/repetitions.h"
#include "base/memory/memory.h"
#include "mesh/polygon_cut.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static double area_of(const double *p, const double *q, const double *r)
{
    return ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])) / 2;
}

static double outline_area(const double (*outline)[2], size_t count)
{
    double area = 0;
    for (size_t i = 0; i < count; i++) {
        const double *p = outline[i], *q = outline[(i + 1) % count];
        area += (p[0] * q[1] - p[1] * q[0]) / 2;
    }
    return area;
}

/* A plane in space with orthogonal axes of equal length. */
static void place(const double flat[2], double point[3])
{
    point[0] = 5 + flat[0] * 2 - flat[1];
    point[1] = -3 + flat[0] * 2 + flat[1] * 2;
    point[2] = 1 - flat[0] + flat[1] * 2;
}

/* Cuts the outline in the planes x y, y z, z x, in a slanted plane, and reversed. All triangles must have its
   orientation, and their areas must add up to its own: then they cover it exactly once. */
static void check_cut(const double (*outline)[2], size_t count, bool flat_ones)
{
    const double area = outline_area(outline, count);
    double *points = calloc(count, 3 * sizeof *points);
    uint32_t *triangles = calloc(count, 3 * sizeof *triangles);
    polygon_cutter cutter = {0};
    assert_true(area > 0);
    for (int plane = 0; plane < 8; plane++) {
        const int right = plane % 4, up = (right + 1) % 3;
        double sum = 0;
        for (size_t i = 0; i < count; i++) {
            const size_t at = plane < 4 ? i : count - 1 - i;
            if (right == 3)
                place(outline[at], points + 3 * i);
            else {
                points[3 * i + (size_t)right] = outline[at][0];
                points[3 * i + (size_t)up] = outline[at][1];
                points[3 * i + (size_t)(3 - right - up)] = 7;
            }
        }
        assert_int_equal(ffd_polygon_cut(&cutter, points, count, triangles, NULL), FFD_OK);
        for (size_t t = 0; t + 2 < count; t++) {
            const double *corners[3];
            for (size_t c = 0; c < 3; c++) {
                assert_true(triangles[3 * t + c] < count);
                corners[c] = outline[plane < 4 ? triangles[3 * t + c] : count - 1 - triangles[3 * t + c]];
            }
            const double own = area_of(corners[0], corners[1], corners[2]) * (plane < 4 ? 1 : -1);
            assert_true(flat_ones ? own >= 0 : own > 0);
            sum += own;
        }
        assert_true(fabs(sum - area) <= 1e-12 * area);
    }
    ffd_polygon_cutter_free(&cutter);
    free(points);
    free(triangles);
}

static void convex_polygons_become_fans(void **state)
{
    (void)state;
    const double hexagon[][2] = {{2, 0}, {1, 2}, {-1, 2}, {-2, 0}, {-1, -2}, {1, -2}};
    check_cut(hexagon, COUNT(hexagon), false);
    double points[18];
    uint32_t triangles[12];
    polygon_cutter cutter = {0};
    for (size_t i = 0; i < 6; i++)
        place(hexagon[i], points + 3 * i);
    assert_int_equal(ffd_polygon_cut(&cutter, points, 6, triangles, NULL), FFD_OK);
    for (uint32_t t = 0; t < 4; t++) {
        assert_int_equal(triangles[3 * t], 0);
        assert_int_equal(triangles[3 * t + 1], t + 1);
        assert_int_equal(triangles[3 * t + 2], t + 2);
    }
    ffd_polygon_cutter_free(&cutter);
}

static void concave_polygons_come_out_right(void **state)
{
    (void)state;
    const double dart[][2] = {{0, 0}, {2, 1}, {0, 3}, {0.5, 1}};
    const double letter_l[][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    const double comb[][2] = {{0, 0}, {7, 0}, {7, 5}, {6, 1}, {5, 5},
                              {4, 1}, {3, 5}, {2, 1}, {1, 5}, {0.5, 1}};
    const double spiral[][2] = {{0, 0}, {6, 0}, {6, 6}, {1, 6}, {1, 2}, {4, 2}, {4, 4},
                                {3, 4}, {3, 3}, {2, 3}, {2, 5}, {5, 5}, {5, 1}, {0, 1}};
    check_cut(dart, COUNT(dart), false);
    check_cut(letter_l, COUNT(letter_l), false);
    check_cut(comb, COUNT(comb), false);
    check_cut(spiral, COUNT(spiral), false);
}

/* Any corner may be the first. */
static void any_corner_may_be_first(void **state)
{
    (void)state;
    const double arrow[][2] = {{0, 0}, {3, 1}, {5, -1}, {4, 2}, {6, 4}, {3, 3}, {1, 5}, {2, 2}};
    double turned[COUNT(arrow)][2];
    for (size_t first = 0; first < COUNT(arrow); first++) {
        for (size_t i = 0; i < COUNT(arrow); i++)
            for (int a = 0; a < 2; a++)
                turned[i][a] = arrow[(first + i) % COUNT(arrow)][a];
        check_cut((const double(*)[2])turned, COUNT(arrow), false);
    }
}

static void corners_in_a_line_are_allowed(void **state)
{
    (void)state;
    const double notched[][2] = {{0, 0}, {1, 0}, {2, 0}, {4, 0}, {4, 4}, {2, 2}, {0, 4}, {0, 2}};
    const double divided[][2] = {{0, 0}, {1, 0}, {2, 0}, {1, 1}, {0, 2}, {0, 1}};
    check_cut(notched, COUNT(notched), false);
    check_cut(divided, COUNT(divided), false);
}

/* A hole is connected to the outline by an edge that is used twice. */
static void holes_stay_open(void **state)
{
    (void)state;
    const double frame[][2] = {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0},
                               {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}};
    const double two[][2] = {{0, 0}, {9, 0}, {9, 6}, {0, 6}, {0, 0}, {1, 1}, {1, 3}, {3, 3},
                             {3, 1}, {5, 1}, {5, 5}, {7, 5}, {7, 1}, {5, 1}, {3, 1}, {1, 1}};
    check_cut(frame, COUNT(frame), false);
    check_cut(two, COUNT(two), true);
}

/* Random outlines, star-shaped about a point inside and far from convex; also far from the origin. */
static void random_stars_come_out_right(void **state)
{
    (void)state;
    enum { MOST = 200 };
    double star[MOST][2];
    uint32_t random = 12345;
    for (int run = 0; run < 60; run++) {
        const size_t count = 4 + (size_t)run * 3;
        for (size_t i = 0; i < count; i++) {
            random = random * 1664525u + 1013904223u;
            const double radius = 0.05 + (random >> 8) / 16777216.0,
                         turn = 6.283185307179586 * (double)i / (double)count;
            star[i][0] = radius * cos(turn);
            star[i][1] = radius * sin(turn);
        }
        check_cut((const double(*)[2])star, count, false);
    }
}

static void bent_quads_are_cut(void **state)
{
    (void)state;
    const double saddle[12] = {0, 0, 1, 1, 0, -1, 1, 1, 1, 0, 1, -1};
    /* Seen along z, the third corner is inside the triangle of the others: only one diagonal is valid. */
    const double dart[12] = {0, 0, 0, 4, 0, 1, 1, 1, 3, 0, 4, 1};
    uint32_t triangles[6];
    polygon_cutter cutter = {0};
    assert_int_equal(ffd_polygon_cut(&cutter, saddle, 4, triangles, NULL), FFD_OK);
    assert_int_equal(triangles[0] + triangles[1] + triangles[2], 3);
    assert_int_equal(ffd_polygon_cut(&cutter, dart, 4, triangles, NULL), FFD_OK);
    for (int t = 0; t < 2; t++) {
        bool has_first = false, has_third = false;
        for (int c = 0; c < 3; c++) {
            has_first = has_first || triangles[3 * t + c] == 0;
            has_third = has_third || triangles[3 * t + c] == 2;
        }
        assert_true(has_first && has_third);
    }
    ffd_polygon_cutter_free(&cutter);
}

/* Whatever the corners are, there are count - 2 triangles with valid corners. */
static void degenerate_polygons_end(void **state)
{
    (void)state;
    enum { COUNT_MOST = 400 };
    static double points[3 * COUNT_MOST];
    static uint32_t triangles[3 * COUNT_MOST];
    polygon_cutter cutter = {0};
    uint32_t random = 1;
    for (int kind = 0; kind < 5; kind++) {
        for (size_t i = 0; i < 3 * (size_t)COUNT_MOST; i++) {
            random = random * 1664525u + 1013904223u;
            points[i] = kind == 0   ? 1
                        : kind == 1 ? (double)(i / 3)
                        : kind == 2 ? (random >> 30)
                        : kind == 3 ? ((random >> 8) - 8388608.0) * 1e300
                                    : (double)((random >> 31) ? NAN : INFINITY);
        }
        for (size_t count = 3; count <= COUNT_MOST; count += 1 + count / 2) {
            for (size_t i = 0; i < 3 * count; i++)
                triangles[i] = UINT32_MAX;
            assert_int_equal(ffd_polygon_cut(&cutter, points, count, triangles, NULL), FFD_OK);
            for (size_t i = 0; i < 3 * count; i++)
                assert_true(i < 3 * (count - 2) ? triangles[i] < count : triangles[i] == UINT32_MAX);
        }
    }
    ffd_polygon_cutter_free(&cutter);
}

/* A tangle of many corners does not take quadratic time. */
static void tangles_end_soon(void **state)
{
    (void)state;
    const size_t count = (size_t)repetitions(20000);
    double *points = calloc(count, 3 * sizeof *points);
    uint32_t *triangles = calloc(count, 3 * sizeof *triangles);
    polygon_cutter cutter = {0};
    uint32_t random = 7;
    for (size_t i = 0; i < 2 * count; i++) {
        random = random * 1664525u + 1013904223u;
        points[3 * (i / 2) + i % 2] = random >> 8;
    }
    assert_int_equal(ffd_polygon_cut(&cutter, points, count, triangles, NULL), FFD_OK);
    assert_int_equal(cutter.hurried, 1);
    assert_int_equal(ffd_polygon_cut(&cutter, points, 4, triangles, NULL), FFD_OK);
    assert_int_equal(cutter.hurried, 1);
    ffd_polygon_cutter_free(&cutter);
    free(points);
    free(triangles);
}

/* More teeth than could all be compared with each other. */
static void a_comb_of_many_teeth_is_covered_once(void **state)
{
    (void)state;
    const size_t count = (size_t)repetitions(40000);
    double(*comb)[2] = calloc(count, sizeof *comb), sum = 0;
    double *points = calloc(count, 3 * sizeof *points);
    uint32_t *triangles = calloc(count, 3 * sizeof *triangles);
    polygon_cutter cutter = {0};
    for (size_t i = 0; i + 2 < count; i++) {
        comb[i][0] = (double)(count - i);
        comb[i][1] = i % 2 ? 11 : 1;
    }
    comb[count - 1][0] = (double)count;
    for (size_t i = 0; i < 2 * count; i++)
        points[3 * (i / 2) + i % 2] = comb[i / 2][i % 2];
    assert_int_equal(ffd_polygon_cut(&cutter, points, count, triangles, NULL), FFD_OK);
    for (size_t t = 0; t + 2 < count; t++) {
        const double own =
            area_of(comb[triangles[3 * t]], comb[triangles[3 * t + 1]], comb[triangles[3 * t + 2]]);
        assert_true(own >= 0);
        sum += own;
    }
    assert_true(fabs(sum - outline_area((const double(*)[2])comb, count)) <= 1e-9 * sum);
    ffd_polygon_cutter_free(&cutter);
    free(comb);
    free(points);
    free(triangles);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    double star[3 * 20] = {0};
    uint32_t triangles[3 * 18];
    for (int i = 0; i < 20; i++) {
        star[3 * i] = (i % 2 + 1) * cos(0.3 * i);
        star[3 * i + 1] = (i % 2 + 1) * sin(0.3 * i);
    }
    for (long successes = 0; successes < 5; successes++) {
        polygon_cutter cutter = {0};
        ffd_error error = {0};
        ffd_alloc_fail_after(successes);
        const ffd_status status = ffd_polygon_cut(&cutter, star, 20, triangles, &error);
        ffd_alloc_fail_after(-1);
        ffd_polygon_cutter_free(&cutter);
        assert_int_equal(status, FFD_E_MEMORY);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(convex_polygons_become_fans),
        cmocka_unit_test(concave_polygons_come_out_right),
        cmocka_unit_test(any_corner_may_be_first),
        cmocka_unit_test(corners_in_a_line_are_allowed),
        cmocka_unit_test(holes_stay_open),
        cmocka_unit_test(random_stars_come_out_right),
        cmocka_unit_test(bent_quads_are_cut),
        cmocka_unit_test(degenerate_polygons_end),
        cmocka_unit_test(tangles_end_soon),
        cmocka_unit_test(a_comb_of_many_teeth_is_covered_once),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
