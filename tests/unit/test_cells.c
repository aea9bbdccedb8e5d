/* test_cells.c - cells of volume meshes: exact signs of tetrahedra, hexahedra beside their Jacobian at many
   places, quadratic cells beside the gradient of a map, polyhedra, scaled Jacobians worked out by hand,
   arrays of any layout, what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "base/memory/memory.h"
#include "cells/cell_types.h"
#include "cells/exact_volume.h"
#include <ffd/ffd.h>
#include <math.h>
#include <string.h>

#define MOST 27
#define CASES 3000

static const uint32_t in_order[MOST] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13,
                                        14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26};
static const double cube[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

/* The values of one cell. */
typedef struct values {
    uint8_t inverted, unknown;
    double jacobian, scaled;
} values;

static ffd_cells_desc describe(const char *kind, const double (*points)[3], size_t count)
{
    ffd_cells_desc desc;
    ffd_cells_desc_init(&desc, sizeof desc);
    desc.kind = kind;
    desc.points = (ffd_span){(void *)(uintptr_t)points, count, FFD_FLOAT64, 0, 0};
    desc.cells = in_order;
    desc.count = 1;
    return desc;
}

static values measure(ffd_cells_desc desc)
{
    values v = {9, 9, 9, 9};
    ffd_error error = {0};
    desc.inverted = &v.inverted;
    desc.unknown = &v.unknown;
    desc.jacobian = &v.jacobian;
    desc.scaled_jacobian = &v.scaled;
    if (ffd_cells_measure(&desc, NULL, &error))
        fail_msg("%s", error.message);
    assert_false(v.inverted && v.unknown);
    return v;
}

static values of(const char *kind, const double (*points)[3])
{
    return measure(describe(kind, points, (size_t)ffd_cells_kind_points(kind)));
}

static void assert_near(double value, double expected, double error)
{
    if (!(fabs(value - expected) <= error))
        fail_msg("%.17g is not %.17g", value, expected);
}

/* Tetrahedra */

static int64_t draw_whole(draw *d, int64_t most)
{
    return (int64_t)(draw_bits(d) % (uint64_t)(2 * most + 1)) - most;
}

/* The determinant in whole numbers, none of which overflows. */
static int64_t exact(int64_t e[3][3])
{
    int64_t sum = 0;
    for (int i = 0; i < 3; i++)
        sum += e[0][i] * (e[1][(i + 1) % 3] * e[2][(i + 2) % 3] - e[1][(i + 2) % 3] * e[2][(i + 1) % 3]);
    return sum;
}

/* Most of these lie in a plane, or next to one, so that rounding decides otherwise. */
static void signs_of_tetrahedra_are_exact(void **state)
{
    draw d = {draw_seed()};
    unsigned zeros = 0;
    (void)state;
    for (int c = 0; c < CASES; c++) {
        int64_t e[3][3], a = draw_whole(&d, 7), b = draw_whole(&d, 7);
        double p[4][3];
        const double scale = ldexp(1, draw_int(&d, -1000, 900));
        for (int i = 0; i < 3; i++) {
            const int64_t origin = draw_whole(&d, 1 << 30);
            e[0][i] = draw_whole(&d, 1 << 16);
            e[1][i] = draw_whole(&d, 1 << 16);
            e[2][i] = a * e[0][i] + b * e[1][i] + draw_whole(&d, 1) * (c % 3 > 0);
            for (int k = 0; k < 4; k++)
                p[k][i] = (double)(origin + (k ? e[k - 1][i] : 0)) * scale;
        }
        const int64_t sum = exact(e);
        const double volume = ffd_exact_volume(p[0], p[1], p[2], p[3]);
        zeros += sum == 0;
        assert_int_equal((volume > 0) - (volume < 0), (sum > 0) - (sum < 0));
        if (fabs(scale) > 0x1p-300 && scale < 0x1p300)
            assert_near(volume / scale / scale / scale, (double)sum, 1e-9 * fabs((double)sum));
    }
    assert_true(zeros > CASES / 10);
}

static double in_doubles(const double a[3], const double b[3], const double c[3], const double d[3])
{
    double e[3][3];
    for (int i = 0; i < 3; i++) {
        e[0][i] = b[i] - a[i];
        e[1][i] = c[i] - a[i];
        e[2][i] = d[i] - a[i];
    }
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
           e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

/* Points of a plane, but for rounding: an exact sign follows the order of the points, one in doubles does
   not. */
static void the_sign_follows_the_order_of_the_points(void **state)
{
    static const uint8_t orders[4][4] = {{1, 2, 0, 3}, {1, 0, 3, 2}, {3, 1, 0, 2}, {2, 3, 0, 1}};
    draw d = {draw_seed()};
    unsigned off = 0;
    (void)state;
    for (int c = 0; c < CASES; c++) {
        double p[4][3], u[3], v[3], sign = 0;
        for (int i = 0; i < 3; i++) {
            u[i] = draw_between(&d, -1, 1);
            v[i] = draw_between(&d, -1, 1);
        }
        for (int k = 0; k < 4; k++) {
            const double s = draw_between(&d, -1, 1), t = draw_between(&d, -1, 1);
            for (int i = 0; i < 3; i++)
                p[k][i] = 0.1 + s * u[i] + t * v[i];
        }
        const double volume = ffd_exact_volume(p[0], p[1], p[2], p[3]);
        sign = (volume > 0) - (volume < 0);
        for (int o = 0; o < 4; o++) {
            const uint8_t *const at = orders[o];
            const double other = ffd_exact_volume(p[at[0]], p[at[1]], p[at[2]], p[at[3]]);
            const double rough = in_doubles(p[at[0]], p[at[1]], p[at[2]], p[at[3]]);
            assert_true((other > 0) - (other < 0) == sign);
            off += (rough > 0) - (rough < 0) != sign;
        }
    }
    assert_true(off > 0);
}

static void tetrahedra_of_the_widest_range_have_their_sign(void **state)
{
    const double tiny = 0x1p-1074, huge = 1.7e308;
    const double p[4][3] = {{-huge, 0, 0}, {huge, 0, 0}, {0, tiny, 0}, {0, 0, tiny}};
    const double q[4][3] = {{0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}};
    const double r[4][3] = {{1, 1, 1}, {1 + 0x1p-52, 1, tiny}, {huge, huge, 1}, {huge, huge, 1 + 0x1p-52}};
    (void)state;
    assert_true(ffd_exact_volume(p[0], p[1], p[2], p[3]) > 0);
    assert_true(ffd_exact_volume(p[1], p[0], p[2], p[3]) < 0);
    assert_true(ffd_exact_volume(q[0], q[1], q[2], q[3]) > 0);
    assert_true(ffd_exact_volume(q[0], q[2], q[1], q[3]) < 0);
    assert_true(ffd_exact_volume(r[0], r[1], r[2], r[3]) > 0);
    assert_true(ffd_exact_volume(r[0], r[1], r[3], r[2]) < 0);
    assert_int_equal(of("tetra", q).inverted, 0);
    assert_near(of("tetra", q).scaled, sqrt(0.5), 1e-15);
    assert_int_equal(of("tetra", p).inverted, 0);
}

/* Hexahedra */

/* The Jacobian of the trilinear map, by the shape functions. */
static long double hexahedron_at(const double (*p)[3], const long double at[3])
{
    long double g[3][3] = {{0}};
    for (int v = 0; v < 8; v++)
        for (int r = 0; r < 3; r++) {
            long double slope = 1;
            for (int k = 0; k < 3; k++)
                slope *= k == r ? 2 * cube[v][k] - 1 : cube[v][k] > 0 ? at[k] : 1 - at[k];
            for (int k = 0; k < 3; k++)
                g[r][k] += slope * p[v][k];
        }
    return g[0][0] * (g[1][1] * g[2][2] - g[1][2] * g[2][1]) +
           g[0][1] * (g[1][2] * g[2][0] - g[1][0] * g[2][2]) +
           g[0][2] * (g[1][0] * g[2][1] - g[1][1] * g[2][0]);
}

static long double least_on_grid(const double (*p)[3], int steps, long double sign)
{
    long double least = HUGE_VALL;
    for (int i = 0; i <= steps; i++)
        for (int j = 0; j <= steps; j++)
            for (int k = 0; k <= steps; k++) {
                const long double at[3] = {(long double)i / steps, (long double)j / steps,
                                           (long double)k / steps};
                const long double value = sign * hexahedron_at(p, at);
                least = value < least ? value : least;
            }
    return least;
}

static long double least_looked_at(const double (*p)[3])
{
    const long double half = 1 / sqrtl(12);
    long double least = least_on_grid(p, 1, 1);
    for (int v = 0; v < 8; v++) {
        long double at[3];
        for (int k = 0; k < 3; k++)
            at[k] = 0.5L + (cube[v][k] > 0 ? half : -half);
        const long double value = hexahedron_at(p, at);
        least = value < least ? value : least;
    }
    return least;
}

static void what_is_said_of_hexahedra_holds_everywhere(void **state)
{
    draw d = {draw_seed()};
    unsigned valid = 0, turned = 0, unknown = 0;
    (void)state;
    for (int c = 0; c < CASES; c++) {
        double p[8][3];
        const double by = draw_between(&d, 0, 0.45), mirror = c % 4 ? 1 : -1;
        for (int v = 0; v < 8; v++)
            for (int k = 0; k < 3; k++)
                p[v][k] = (cube[v][k] + draw_between(&d, -by, by)) * (k ? 1e-3 : mirror);
        const double(*const points)[3] = (const double(*)[3])p;
        const values found = of("hexahedron", points);
        const long double least = least_looked_at(points);
        assert_near(found.jacobian, (double)least, 1e-18);
        /* Inverted: it is 0 or below at a corner or a Gauss point. */
        if (least <= -1e-18L)
            assert_true(found.inverted || (mirror < 0 && found.unknown));
        if (found.inverted)
            assert_true(least < 1e-18L);
        if (!found.inverted && !found.unknown)
            assert_true(least_on_grid(points, 8, 1) > -1e-18L);
        valid += !found.inverted && !found.unknown;
        turned += found.inverted;
        unknown += found.unknown;
    }
    assert_true(valid > CASES / 10 && turned > CASES / 10 && unknown < CASES / 10);
}

/* Corners and Gauss points of this cell have positive Jacobians, and so has all of it, but one of its
   coefficients is negative. */
static void a_hexahedron_that_coefficients_do_not_decide_is_unknown(void **state)
{
    draw d = {7};
    (void)state;
    for (;;) {
        double p[8][3];
        for (int v = 0; v < 8; v++)
            for (int k = 0; k < 3; k++)
                p[v][k] = cube[v][k] + draw_between(&d, -0.4, 0.4);
        const double(*const points)[3] = (const double(*)[3])p;
        const values found = of("hexahedron", points);
        if (!found.unknown || least_on_grid(points, 16, 1) <= 0)
            continue;
        assert_true(found.jacobian > 0);
        return;
    }
}

/* As the wedge below: the top is turned by half a turn and stretched, by (1 - 5 t) (1 - 1.25 t). */
static void a_hexahedron_that_turns_over_between_its_corners_is_inverted(void **state)
{
    double p[8][3];
    (void)state;
    memcpy(p, cube, sizeof p);
    for (int v = 4; v < 8; v++) {
        p[v][0] *= -4;
        p[v][1] *= -0.25;
    }
    const values found = of("hexahedron", (const double(*)[3])p);
    assert_true(found.inverted && found.jacobian < 0 && found.scaled > -1);
}

static void a_box_of_any_shape_and_place_is_decided(void **state)
{
    draw d = {draw_seed()};
    (void)state;
    for (int c = 0; c < 300; c++) {
        double p[8][3], side[3], low[3];
        for (int k = 0; k < 3; k++) {
            side[k] = ldexp(1, draw_int(&d, -30, 30));
            low[k] = side[k] * (double)draw_whole(&d, 1000);
        }
        for (int v = 0; v < 8; v++)
            for (int k = 0; k < 3; k++)
                p[v][k] = low[k] + cube[v][k] * side[k];
        const values found = of("hexahedron", (const double(*)[3])p);
        assert_true(!found.inverted && !found.unknown);
        assert_near(found.jacobian / (side[0] * side[1] * side[2]), 1, 1e-12);
        assert_near(found.scaled, 1, 1e-12);
    }
}

/* Quadratic cells */

/* A map whose gradient is known: x + a quadratic part, which is linear along z if `ruled`. */
typedef struct quadratic_map {
    double of[3][6]; /* of x x, y y, x y, x z, y z, z z */
    double by;
} quadratic_map;

static void apply(const quadratic_map *map, const double x[3], double out[3])
{
    const double terms[6] = {x[0] * x[0], x[1] * x[1], x[0] * x[1], x[0] * x[2], x[1] * x[2], x[2] * x[2]};
    for (int r = 0; r < 3; r++) {
        out[r] = x[r];
        for (int t = 0; t < 6; t++)
            out[r] += map->by * map->of[r][t] * terms[t];
    }
}

static double determinant(const quadratic_map *map, const double x[3])
{
    double g[3][3];
    for (int r = 0; r < 3; r++) {
        const double *const of = map->of[r];
        g[r][0] = (r == 0) + map->by * (2 * of[0] * x[0] + of[2] * x[1] + of[3] * x[2]);
        g[r][1] = (r == 1) + map->by * (2 * of[1] * x[1] + of[2] * x[0] + of[4] * x[2]);
        g[r][2] = (r == 2) + map->by * (of[3] * x[0] + of[4] * x[1] + 2 * of[5] * x[2]);
    }
    return g[0][0] * (g[1][1] * g[2][2] - g[1][2] * g[2][1]) +
           g[0][1] * (g[1][2] * g[2][0] - g[1][0] * g[2][2]) +
           g[0][2] * (g[1][0] * g[2][1] - g[1][1] * g[2][0]);
}

/* Where a place of the reference cell is: a pyramid narrows towards its apex. */
static void locate(const cell_type *type, double r, double s, double t, double x[3])
{
    const double z = type->family == FAMILY_PYRAMID ? 1 - t : 1;
    x[0] = z < 1 ? 0.5 + (r - 0.5) * z : r;
    x[1] = z < 1 ? 0.5 + (s - 0.5) * z : s;
    x[2] = t;
}

/* Gauss points, as rules of degree 5 in cubes, and of degree 2 in triangles and tetrahedra. */
static size_t list_gauss(const cell_type *type, double at[MOST][3])
{
    const double lines[3] = {0.5 - sqrt(0.15), 0.5, 0.5 + sqrt(0.15)};
    const double flat[3][2] = {{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}};
    const double near = (5 - sqrt(5)) / 20, far = (5 + 3 * sqrt(5)) / 20;
    size_t count = 0;
    if (type->family == FAMILY_TETRA) {
        for (; count < 4; count++)
            for (size_t k = 0; k < 3; k++)
                at[count][k] = k + 1 == count ? far : near;
        return count;
    }
    for (size_t k = 0; k < 3; k++)
        for (size_t j = 0; j < 3; j++) {
            if (type->family == FAMILY_WEDGE) {
                memcpy(at[count], flat[j], sizeof flat[j]);
                at[count++][2] = lines[k];
                continue;
            }
            for (size_t i = 0; i < 3; i++, count++)
                locate(type, lines[i], lines[j], lines[k], at[count]);
        }
    return count;
}

static void quadratic_cells_have_the_gradient_of_their_map(void **state)
{
    static const char *const kinds[] = {"tetra10", "hexahedron20", "hexahedron24", "hexahedron27", "wedge12",
                                        "wedge15", "wedge18",      "pyramid13",    "pyramid14"};
    draw d = {draw_seed()};
    (void)state;
    for (int c = 0; c < CASES; c++) {
        const char *const kind = kinds[c % 9];
        const cell_type *const type = ffd_cell_type_named(kind);
        quadratic_map map = {.by = draw_between(&d, 0, 0.8)};
        double p[MOST][3], gauss[MOST][3], least = HUGE_VAL, most = -HUGE_VAL;
        for (int i = 0; i < 18; i++)
            map.of[i / 6][i % 6] = i % 6 == 5 && type->points == 12 ? 0 : draw_between(&d, -1, 1);
        size_t count = list_gauss(type, gauss);
        for (size_t v = 0; v < type->points + count; v++) {
            double x[3];
            if (v < type->points)
                locate(type, type->places[v][0] * 0.5, type->places[v][1] * 0.5, type->places[v][2] * 0.5, x);
            else
                memcpy(x, gauss[v - type->points], sizeof x);
            const double value = determinant(&map, x);
            least = value < least ? value : least;
            most = value > most ? value : most;
            if (v < type->points)
                apply(&map, x, p[v]);
        }
        const values found = of(kind, (const double(*)[3])p);
        assert_near(found.jacobian, least, 1e-11);
        if (fabs(least) < 1e-9 || fabs(most) < 1e-9)
            continue;
        assert_int_equal(found.inverted, most < 0);
        assert_int_equal(found.unknown, least < 0 && most > 0);
    }
}

/* Other cells */

static void linear_wedges_and_pyramids_are_judged_at_corners_and_gauss_points(void **state)
{
    static const double wedge[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    static const double pyramid[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3, 0.4, 2}};
    double bent[6][3];
    (void)state;
    assert_near(of("wedge", wedge).jacobian, 1, 1e-14);
    assert_near(of("pyramid", pyramid).jacobian, 2, 1e-14);
    assert_int_equal(of("wedge", wedge).inverted + of("wedge", wedge).unknown, 0);
    assert_int_equal(of("pyramid", pyramid).inverted + of("pyramid", pyramid).unknown, 0);
    memcpy(bent, wedge, sizeof bent);
    bent[5][2] = -0.1; /* through the base */
    assert_true(of("wedge", (const double(*)[3])bent).inverted);
    memcpy(bent, pyramid, sizeof pyramid);
    bent[4][2] = 0; /* flat */
    const values flat = of("pyramid", (const double(*)[3])bent);
    assert_true(flat.inverted && flat.jacobian <= 0 && flat.jacobian >= 0);
    bent[4][2] = -1;
    assert_true(of("pyramid", (const double(*)[3])bent).inverted);
    assert_near(of("pyramid", (const double(*)[3])bent).scaled, 0, 0);
    /* The triangles are turned by half a turn and stretched: the corners are right-handed, and between them
       it turns over, by (1 - 5 t) (1 - 1.25 t). */
    memcpy(bent, wedge, sizeof bent);
    bent[4][0] = -4;
    bent[5][1] = -0.25;
    const values twisted = of("wedge", (const double(*)[3])bent);
    assert_true(twisted.inverted && twisted.jacobian < 0 && twisted.scaled > 0);
}

static void ideal_cells_have_a_scaled_jacobian_of_1(void **state)
{
    const double r = sqrt(3) / 2, h = sqrt(2. / 3), q = sqrt(0.5);
    const double tetra[4][3] = {{0, 0, 0}, {1, 0, 0}, {0.5, r, 0}, {0.5, r / 3, h}};
    const double wedge[6][3] = {{0, 0, 0}, {1, 0, 0}, {0.5, r, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, r, 1}};
    const double pyramid[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, q}};
    double p[8][3];
    (void)state;
    assert_near(of("tetra", tetra).scaled, 1, 1e-15);
    assert_near(of("wedge", wedge).scaled, 1, 1e-15);
    assert_near(of("pyramid", pyramid).scaled, 1, 1e-15);
    assert_near(of("hexahedron", cube).scaled, 1, 0);
    for (int v = 0; v < 8; v++)
        memcpy(p[v], cube[v ^ (v >> 1 & 1)], sizeof p[v]);
    assert_near(of("voxel", (const double(*)[3])p).scaled, 1, 0);
    for (int v = 0; v < 4; v++)
        memcpy(p[v], tetra[v < 2 ? v ^ 1 : v], sizeof p[v]);
    const values mirrored = of("tetra", (const double(*)[3])p);
    assert_near(mirrored.scaled, -1, 1e-15);
    assert_true(mirrored.inverted);
}

static void a_corner_without_length_has_a_scaled_jacobian_of_0(void **state)
{
    static const char *const kinds[] = {"tetra", "pyramid", "wedge", "hexahedron", "tetra10", "hexahedron20"};
    double p[MOST][3] = {{0}};
    (void)state;
    for (size_t k = 0; k < 6; k++) {
        const values found = of(kinds[k], (const double(*)[3])p);
        assert_true(found.inverted && !found.unknown);
        assert_near(found.scaled, 0, 0);
        assert_near(found.jacobian, 0, 0);
    }
    memcpy(p, cube, sizeof cube);
    memcpy(p[1], p[0], sizeof p[1]);
    assert_true(of("hexahedron", (const double(*)[3])p).inverted);
    assert_near(of("hexahedron", (const double(*)[3])p).scaled, 0, 0);
}

static void a_coordinate_that_is_not_finite_leaves_a_cell_unknown(void **state)
{
    static const char *const kinds[] = {"tetra", "wedge", "hexahedron", "tetra10", "hexa_prism"};
    (void)state;
    for (size_t k = 0; k < 5; k++)
        for (int bad = 0; bad < 2; bad++) {
            double p[MOST][3] = {{0}};
            memcpy(p, cube, sizeof cube);
            p[3][1] = bad ? NAN : HUGE_VAL;
            const values found = of(kinds[k], (const double(*)[3])p);
            assert_true(found.unknown && !found.inverted);
            assert_true(isnan(found.jacobian) && isnan(found.scaled));
        }
}

/* The faces of the cube, which look outwards. */
static const uint32_t cube_words[] = {6, 4, 0, 3, 2, 1, 4, 4, 5, 6, 7, 4, 0, 1, 5, 4,
                                      4, 1, 2, 6, 5, 4, 2, 3, 7, 6, 4, 3, 0, 4, 7};
#define CUBE_WORDS (sizeof cube_words / sizeof *cube_words)

static values polyhedron(const double (*points)[3], const uint32_t *words, uint64_t count)
{
    const uint64_t offsets[] = {0, count};
    ffd_cells_desc desc = describe("polyhedron", points, 8);
    desc.cells = words;
    desc.offsets = offsets;
    return measure(desc);
}

static void polyhedra_are_judged_by_tetrahedra_round_their_centre(void **state)
{
    double p[8][3];
    uint32_t inwards[CUBE_WORDS];
    (void)state;
    const values right = polyhedron(cube, cube_words, CUBE_WORDS);
    assert_true(!right.inverted && !right.unknown && isnan(right.scaled));
    assert_near(right.jacobian, 0.25, 1e-15); /* 24 equal tetrahedra, of 6 times their volume */
    memcpy(inwards, cube_words, sizeof inwards);
    for (size_t f = 0; f < 6; f++)
        for (size_t i = 0; i < 4; i++)
            inwards[2 + 5 * f + i] = cube_words[2 + 5 * f + 3 - i];
    const values wrong = polyhedron(cube, inwards, CUBE_WORDS);
    assert_true(wrong.inverted);
    assert_near(wrong.jacobian, -0.25, 1e-15);
    memcpy(p, cube, sizeof p);
    for (int k = 0; k < 3; k++)
        p[6][k] = -0.5; /* a corner is pushed through the others */
    assert_true(polyhedron((const double(*)[3])p, cube_words, CUBE_WORDS).inverted);
    inwards[2] = 0; /* one face of them looks outwards again */
    inwards[3] = 3;
    inwards[4] = 2;
    inwards[5] = 1;
    assert_true(polyhedron(cube, inwards, CUBE_WORDS).unknown);
    static const uint32_t nothing[] = {0};
    assert_true(polyhedron(cube, nothing, 1).unknown);
}

static void prisms_are_numbered_as_hexahedra_are(void **state)
{
    (void)state;
    for (int n = 5; n <= 6; n++) {
        const char *const kind = n == 5 ? "penta_prism" : "hexa_prism";
        double p[12][3];
        for (int v = 0; v < 2 * n; v++) {
            const double angle = 2 * acos(-1) * (v % n) / n;
            const double at[3] = {cos(angle), sin(angle), v / n};
            memcpy(p[v], at, sizeof at);
        }
        assert_true(!of(kind, (const double(*)[3])p).inverted && !of(kind, (const double(*)[3])p).unknown);
        for (int v = 0; v < 2 * n; v++)
            p[v][2] *= -1;
        assert_true(of(kind, (const double(*)[3])p).inverted);
    }
}

/* Arrays */

#define CELLS 20000
#define POINTS 5000

typedef struct array {
    double points[POINTS][3];
    float strided[POINTS][5];
    uint32_t cells[CELLS][8];
    uint8_t inverted[2][CELLS], unknown[2][CELLS];
    double jacobian[2][CELLS], scaled[2][CELLS];
} array;

static array all;

static void fill(ffd_cells_desc *desc, int which)
{
    desc->cells = all.cells[0];
    desc->count = CELLS;
    desc->inverted = all.inverted[which];
    desc->unknown = all.unknown[which];
    desc->jacobian = all.jacobian[which];
    desc->scaled_jacobian = all.scaled[which];
}

static void assert_equal_values(void)
{
    assert_memory_equal(all.inverted[0], all.inverted[1], sizeof all.inverted[0]);
    assert_memory_equal(all.unknown[0], all.unknown[1], sizeof all.unknown[0]);
    assert_memory_equal(all.jacobian[0], all.jacobian[1], sizeof all.jacobian[0]);
    assert_memory_equal(all.scaled[0], all.scaled[1], sizeof all.scaled[0]);
}

static void threads_and_layouts_change_no_bit(void **state)
{
    static const char *const kinds[] = {"tetra", "wedge", "hexahedron"};
    draw d = {3};
    (void)state;
    for (int p = 0; p < POINTS; p++)
        for (int k = 0; k < 3; k++) {
            all.strided[p][2 * k] = (float)draw_between(&d, -1, 1);
            all.points[p][k] = all.strided[p][2 * k];
        }
    for (int c = 0; c < CELLS; c++)
        for (int v = 0; v < 8; v++)
            all.cells[c][v] = draw_number(&d) % POINTS;
    for (int k = 0; k < 3; k++) {
        ffd_run_options options;
        ffd_error error = {0};
        ffd_cells_desc desc = describe(kinds[k], (const double(*)[3])all.points, POINTS);
        ffd_run_options_init(&options, sizeof options);
        fill(&desc, 0);
        options.threads = 1;
        assert_int_equal(ffd_cells_measure(&desc, &options, &error), FFD_OK);
        fill(&desc, 1);
        options.threads = 4;
        desc.points = (ffd_span){all.strided, POINTS, FFD_FLOAT32, sizeof all.strided[0], 2 * sizeof(float)};
        assert_int_equal(ffd_cells_measure(&desc, &options, &error), FFD_OK);
        assert_equal_values();
    }
}

static void refused(const ffd_cells_desc *desc, ffd_status status, const char *words)
{
    ffd_error error = {0};
    assert_int_equal(ffd_cells_measure(desc, NULL, &error), status);
    if (!strstr(error.message, words))
        fail_msg("\"%s\" does not have \"%s\"", error.message, words);
}

static void what_cannot_be_measured_is_refused(void **state)
{
    static const uint32_t short_words[] = {6, 4, 0, 3, 2, 1}, far_words[] = {1, 3, 0, 1, 9};
    static const uint64_t offsets[] = {0, 6}, far_offsets[] = {0, 5}, falling[] = {6, 0};
    ffd_cells_desc desc = describe("hexahedron", cube, 7);
    (void)state;
    refused(&desc, FFD_E_ARGUMENT, "cell 0 has point 7, but there are 7");
    desc = describe("hexahedron8", cube, 8);
    refused(&desc, FFD_E_ARGUMENT, "\"hexahedron8\" is not a kind");
    desc = describe("polyhedronx", cube, 8);
    refused(&desc, FFD_E_ARGUMENT, "is not a kind");
    desc.kind = NULL;
    refused(&desc, FFD_E_ARGUMENT, "the kind of the cells is missing");
    desc = describe("tetra", cube, 8);
    desc.cells = NULL;
    refused(&desc, FFD_E_ARGUMENT, "there are no cells");
    desc = describe("polyhedron", cube, 8);
    refused(&desc, FFD_E_ARGUMENT, "offsets");
    desc.cells = short_words;
    desc.offsets = offsets;
    refused(&desc, FFD_E_ARGUMENT, "the faces of cell 0 do not fill its words");
    desc.offsets = falling;
    refused(&desc, FFD_E_ARGUMENT, "the offset of cell 0");
    desc.cells = far_words;
    desc.offsets = far_offsets;
    refused(&desc, FFD_E_ARGUMENT, "cell 0 has point 9");
    assert_int_equal(ffd_cells_kind_points("polyhedron12"), 0);
    assert_int_equal(ffd_cells_kind_points("triangle"), -1);
    assert_int_equal(ffd_cells_kind_points("wedge15"), 15);
}

static void each_allocation_can_fail(void **state)
{
    float narrow[MOST][3] = {{0}};
    ffd_cells_desc desc = describe("hexahedron27", cube, MOST);
    (void)state;
    desc.points = (ffd_span){narrow, MOST, FFD_FLOAT32, 0, 0};
    long allowed = 0;
    for (;; allowed++) {
        ffd_error error = {0};
        ffd_alloc_fail_after(allowed);
        const ffd_status status = ffd_cells_measure(&desc, NULL, &error);
        ffd_alloc_fail_after(-1);
        if (status == FFD_OK)
            break;
        assert_int_equal(status, FFD_E_MEMORY);
    }
    assert_true(allowed >= 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(signs_of_tetrahedra_are_exact),
        cmocka_unit_test(the_sign_follows_the_order_of_the_points),
        cmocka_unit_test(tetrahedra_of_the_widest_range_have_their_sign),
        cmocka_unit_test(what_is_said_of_hexahedra_holds_everywhere),
        cmocka_unit_test(a_hexahedron_that_coefficients_do_not_decide_is_unknown),
        cmocka_unit_test(a_hexahedron_that_turns_over_between_its_corners_is_inverted),
        cmocka_unit_test(a_box_of_any_shape_and_place_is_decided),
        cmocka_unit_test(quadratic_cells_have_the_gradient_of_their_map),
        cmocka_unit_test(linear_wedges_and_pyramids_are_judged_at_corners_and_gauss_points),
        cmocka_unit_test(ideal_cells_have_a_scaled_jacobian_of_1),
        cmocka_unit_test(a_corner_without_length_has_a_scaled_jacobian_of_0),
        cmocka_unit_test(a_coordinate_that_is_not_finite_leaves_a_cell_unknown),
        cmocka_unit_test(polyhedra_are_judged_by_tetrahedra_round_their_centre),
        cmocka_unit_test(prisms_are_numbered_as_hexahedra_are),
        cmocka_unit_test(threads_and_layouts_change_no_bit),
        cmocka_unit_test(what_cannot_be_measured_is_refused),
        cmocka_unit_test(each_allocation_can_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
