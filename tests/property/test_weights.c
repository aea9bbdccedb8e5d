/* test_weights.c - slopes of weights, and vertices at one position, beside the plainest ways to find them:
   random surfaces of any size, thin and empty triangles, seams, signed zeros, any number of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/repetitions.h"
#include "mesh/slopes.h"
#include "mesh/twins.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { MOST = 40000, MOST_TRIANGLES = 80000 };

typedef struct surface {
    double positions[3 * MOST], weights[MOST], slopes[3 * MOST], expected[3 * MOST], areas[MOST];
    uint32_t twins[MOST], triangles[3 * MOST_TRIANGLES];
    size_t count, triangle_count;
    double size; /* of its extent */
} surface;

static surface s;

static ffd_status walk(const void *context, mesh_triangle_visitor *visit, void *user, ffd_error *error)
{
    const surface *const from = context;
    (void)error;
    /* In pieces, as formats pass them. */
    for (size_t t = 0; t < from->triangle_count; t += 1000)
        visit(user, from->triangles + 3 * t,
              from->triangle_count - t < 1000 ? from->triangle_count - t : 1000);
    return FFD_OK;
}

/* As a format that is asked for positions. */
static void read_positions(const void *context, size_t first, size_t count, double *positions)
{
    const surface *const from = context;
    assert_true(first <= from->count && count <= from->count - first);
    memcpy(positions, from->positions + 3 * first, 3 * count * sizeof *positions);
}

static double greatest_magnitude(void)
{
    double greatest = 0;
    for (size_t i = 0; i < 3 * s.count; i++)
        greatest = fmax(greatest, fabs(s.positions[i]));
    return greatest;
}

/* reads: positions are asked for; else they are there. */
static void find_with(ffd_isa isa, int threads, bool reads, double *slopes)
{
    static double sums[SLOPE_STRIDE * MOST];
    slope_sums stored = {sums, 1};
    const weighted_surface found = {.positions = reads ? NULL : s.positions,
                                    .weights = s.weights,
                                    .vertex_count = s.count,
                                    .read = read_positions,
                                    .largest = greatest_magnitude(),
                                    .walk = walk,
                                    .surface = &s,
                                    .isa = isa};
    bool has_triangles = false;
    ffd_error error = {0};
    if (ffd_positions_twins(s.positions, s.count, threads, s.twins, &error) ||
        ffd_slopes_find(&found, s.twins, threads, &stored, &has_triangles, &error))
        fail_msg("%s", error.message);
    assert_int_equal(has_triangles, s.triangle_count > 0);
    for (size_t v = 0; v < s.count; v++)
        ffd_slope_at(&stored, v, slopes + 3 * v);
}

static void find(int threads, double *slopes)
{
    find_with(FFD_ISA_AUTO, threads, false, slopes);
}

/* A bent sheet of a random extent, whose vertices are moved a little, and some of which share places. */
static void make_sheet(draw *d, size_t side)
{
    s.size = ldexp(1, draw_int(d, -300, 300));
    s.count = side * side;
    s.triangle_count = 0;
    for (size_t v = 0; v < s.count; v++) {
        const double x = (double)(v % side) / (double)side, y = (double)(v / side) / (double)side,
                     off = 0.3 / (double)side;
        double *const p = s.positions + 3 * v;
        p[0] = s.size * (x + draw_between(d, -off, off));
        p[1] = s.size * (y + draw_between(d, -off, off));
        p[2] = s.size * 0.3 * sin(5 * x * y);
        s.weights[v] = draw_int(d, 0, 3) == 0 ? draw_int(d, 0, 1) : draw_unit(d);
    }
    for (size_t v = 0; v < s.count; v++)
        for (size_t k = 0; k < 2 && v % side + 1 < side && v + side < s.count; k++) {
            const size_t corners[2][3] = {{v, v + 1, v + side + 1}, {v, v + side + 1, v + side}};
            for (size_t c = 0; c < 3; c++)
                s.triangles[3 * s.triangle_count + c] = (uint32_t)corners[k][c];
            s.triangle_count++;
        }
}

static void make_surface(draw *d)
{
    make_sheet(d, (size_t)draw_int(d, 2, 60));
}

/* Gives some corners vertices of their own at the same places, also as the other zero, and adds triangles
   that have no area. */
static void make_seams(draw *d)
{
    const size_t whole = s.count;
    for (size_t i = 0; i < 3 * s.triangle_count && s.count < MOST; i++) {
        const size_t v = s.triangles[i];
        if (v >= whole || draw_int(d, 0, 5) > 0)
            continue;
        memcpy(s.positions + 3 * s.count, s.positions + 3 * v, 3 * sizeof *s.positions);
        for (size_t k = 0; k < 3; k++)
            if (s.positions[3 * v + k] == 0)
                s.positions[3 * s.count + k] = draw_int(d, 0, 1) ? -0.0 : 0.0;
        s.weights[s.count] = draw_int(d, 0, 9) ? s.weights[v] : draw_unit(d);
        s.triangles[i] = (uint32_t)s.count++;
    }
    for (int k = draw_int(d, 0, 5); k > 0; k--) {
        const uint32_t v = (uint32_t)draw_int(d, 0, (int)s.count - 1),
                       other = (uint32_t)draw_int(d, 0, (int)s.count - 1);
        const uint32_t empty[3] = {v, other, draw_int(d, 0, 1) ? v : other};
        memcpy(s.triangles + 3 * s.triangle_count++, empty, sizeof empty);
    }
}

/* The definition, triangle by triangle. */
static void expect(void)
{
    memset(s.expected, 0, sizeof s.expected);
    memset(s.areas, 0, sizeof s.areas);
    for (size_t t = 0; t < s.triangle_count; t++) {
        const uint32_t *const c = s.triangles + 3 * t;
        double e[2][3], g[3], ee = 0, ef = 0, ff = 0;
        for (int k = 0; k < 3; k++) {
            e[0][k] = (s.positions[3 * c[1] + k] - s.positions[3 * c[0] + k]) / s.size;
            e[1][k] = (s.positions[3 * c[2] + k] - s.positions[3 * c[0] + k]) / s.size;
            ee += e[0][k] * e[0][k];
            ef += e[0][k] * e[1][k];
            ff += e[1][k] * e[1][k];
        }
        const double square = ee * ff - ef * ef, first = s.weights[c[1]] - s.weights[c[0]],
                     second = s.weights[c[2]] - s.weights[c[0]];
        if (!(square > 1e-20 * ee * ff))
            continue;
        for (int k = 0; k < 3; k++)
            g[k] = ((first * ff - second * ef) * e[0][k] + (second * ee - first * ef) * e[1][k]) / square;
        for (int corner = 0; corner < 3; corner++) {
            const size_t at = s.twins[c[corner]];
            for (int k = 0; k < 3; k++)
                s.expected[3 * at + k] += sqrt(square) * g[k];
            s.areas[at] += sqrt(square);
        }
    }
    for (size_t v = 0; v < s.count; v++)
        for (int k = 0; k < 3; k++) {
            const size_t at = s.twins[v];
            s.expected[3 * v + k] =
                s.areas[at] > 0 ? s.expected[3 * at + k] / (at == v ? s.areas[at] : 1) : 0;
        }
}

static void slopes_are_those_of_the_definition(void **state)
{
    static double again[3 * MOST];
    draw d = {draw_seed()};
    (void)state;
    for (int n = 0; n < repetitions(200); n++) {
        make_surface(&d);
        make_seams(&d);
        find(1, s.slopes);
        expect();
        for (size_t i = 0; i < 3 * s.count; i++) {
            double most = 1;
            for (size_t k = 0; k < 3; k++)
                most = fmax(most, fabs(s.expected[i - i % 3 + k]));
            if (!(fabs(s.slopes[i] * s.size - s.expected[i]) <= 1e-9 * most))
                fail_msg("vertex %zu: %g, not %g", i / 3, s.slopes[i] * s.size, s.expected[i]);
        }
        const ffd_isa isa = (ffd_isa)draw_int(&d, FFD_ISA_AUTO, FFD_ISA_NEON);
        find_with(ffd_isa_available(isa) ? isa : FFD_ISA_SCALAR, draw_int(&d, 2, 9), draw_int(&d, 0, 1),
                  again);
        assert_memory_equal(again, s.slopes, 3 * s.count * sizeof *again);
    }
}

/* Orders in which few positions are near each other, many, or by their numbers from behind. */
static void reorder_triangles(draw *d, int order)
{
    for (size_t t = 0; t < s.triangle_count && order > 0; t++) {
        const size_t left = s.triangle_count - t;
        const size_t other =
            order == 1 ? s.triangle_count - 1 - t : t + (size_t)draw_int(d, 0, (int)left - 1);
        uint32_t kept[3];
        if (order == 1 && other <= t)
            break;
        memcpy(kept, s.triangles + 3 * t, sizeof kept);
        memcpy(s.triangles + 3 * t, s.triangles + 3 * other, sizeof kept);
        memcpy(s.triangles + 3 * other, kept, sizeof kept);
    }
}

/* A sheet of more vertices than are held at a time, in any order of its triangles. */
static void slopes_are_equal_however_positions_come(void **state)
{
    static double again[3 * MOST];
    draw d = {draw_seed()};
    (void)state;
    for (int n = 0; n < repetitions(6); n++) {
        make_sheet(&d, (size_t)draw_int(&d, 150, 195));
        reorder_triangles(&d, n % 3);
        if (draw_int(&d, 0, 1))
            make_seams(&d);
        find(1, s.slopes);
        find_with(FFD_ISA_AUTO, n < 3 ? 1 : draw_int(&d, 2, 9), true, again); /* a share may be held whole */
        assert_memory_equal(again, s.slopes, 3 * s.count * sizeof *again);
    }
}

/* Weights that are linear in space have, on every triangle, the slope of their plane: exactly its direction
   in a flat sheet. Weights that are all equal have none, to the bit. */
static void linear_weights_have_their_slope(void **state)
{
    draw d = {draw_seed()};
    (void)state;
    for (int n = 0; n < repetitions(100); n++) {
        make_surface(&d);
        const double by[2] = {draw_between(&d, -0.3, 0.3), draw_between(&d, -0.3, 0.3)};
        for (size_t v = 0; v < s.count; v++) {
            s.positions[3 * v + 2] = 0;
            s.weights[v] = 0.5 + (by[0] * s.positions[3 * v] + by[1] * s.positions[3 * v + 1]) / s.size;
        }
        find(1, s.slopes);
        for (size_t v = 0; v < s.count; v++) {
            assert_true(fabs(s.slopes[3 * v] * s.size - by[0]) < 1e-9 &&
                        fabs(s.slopes[3 * v + 1] * s.size - by[1]) < 1e-9);
            assert_true(s.slopes[3 * v + 2] == 0);
        }
        const double all = draw_unit(&d);
        for (size_t v = 0; v < s.count; v++)
            s.weights[v] = all;
        find(1, s.slopes);
        for (size_t i = 0; i < 3 * s.count; i++)
            assert_true(s.slopes[i] == 0);
    }
}

/* A vertex without a weight takes no part, nor do the triangles at it. */
static void triangles_without_weights_do_not_count(void **state)
{
    draw d = {draw_seed()};
    (void)state;
    for (int n = 0; n < repetitions(50); n++) {
        make_surface(&d);
        for (int k = draw_int(&d, 1, 5); k > 0; k--)
            s.weights[draw_int(&d, 0, (int)s.count - 1)] = (double)NAN;
        find(2, s.slopes);
        size_t kept = 0;
        for (size_t t = 0; t < s.triangle_count; t++) {
            const uint32_t *const c = s.triangles + 3 * t;
            if (isnan(s.weights[c[0]]) || isnan(s.weights[c[1]]) || isnan(s.weights[c[2]]))
                continue;
            memmove(s.triangles + 3 * kept++, c, 3 * sizeof *c);
        }
        if (kept == 0)
            continue;
        s.triangle_count = kept;
        for (size_t v = 0; v < s.count; v++)
            s.weights[v] = isnan(s.weights[v]) ? 0 : s.weights[v];
        find(1, s.expected);
        assert_memory_equal(s.slopes, s.expected, 3 * s.count * sizeof *s.slopes);
    }
}

/* Places of a coarse grid, of which many are shared, in any order. */
static void twins_are_the_first_at_their_place(void **state)
{
    draw d = {draw_seed()};
    static uint32_t again[MOST];
    ffd_error error = {0};
    (void)state;
    for (int n = 0; n < repetitions(60); n++) {
        const int cells = draw_int(&d, 1, 40);
        const bool is_large = draw_int(&d, 0, 9) == 0;
        s.count = (size_t)draw_int(&d, 0, is_large ? MOST : 3000);
        for (size_t i = 0; i < 3 * s.count; i++) {
            s.positions[i] = draw_int(&d, -cells, cells) * 0.125;
            if (s.positions[i] == 0 && draw_int(&d, 0, 1))
                s.positions[i] = -0.0;
        }
        assert_int_equal(ffd_positions_twins(s.positions, s.count, 1, s.twins, &error), FFD_OK);
        assert_int_equal(ffd_positions_twins(s.positions, s.count, draw_int(&d, 2, 12), again, &error),
                         FFD_OK);
        assert_memory_equal(again, s.twins, s.count * sizeof *again);
        for (size_t v = 0; v < s.count; v++) {
            const double *const p = s.positions + 3 * v, *const q = s.positions + 3 * (size_t)s.twins[v];
            assert_true(s.twins[v] <= v && s.twins[s.twins[v]] == s.twins[v]);
            assert_true(p[0] == q[0] && p[1] == q[1] && p[2] == q[2]);
        }
        /* None before it is there. */
        for (int k = 0; k < 50 && s.count > 0; k++) {
            const size_t v = (size_t)draw_int(&d, 0, (int)s.count - 1);
            for (size_t u = 0; u < s.twins[v]; u++)
                assert_false(s.positions[3 * u] == s.positions[3 * v] &&
                             s.positions[3 * u + 1] == s.positions[3 * v + 1] &&
                             s.positions[3 * u + 2] == s.positions[3 * v + 2]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slopes_are_those_of_the_definition),
        cmocka_unit_test(slopes_are_equal_however_positions_come),
        cmocka_unit_test(linear_weights_have_their_slope),
        cmocka_unit_test(triangles_without_weights_do_not_count),
        cmocka_unit_test(twins_are_the_first_at_their_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
