/* test_fold.c - the proof that a deformed volume does not fold, and the witness if it does. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/bspline_reference.h"
#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "../support/repetitions.h"
#include "base/vector/vec.h"
#include "fold/bernstein.h"
#include "fold/cell.h"
#include <ffd/fold.h>
#include <float.h>
#include <stdint.h>

/* Lattices */

static ffd_lattice *parsed(const char *format, ...)
{
    char text[4096];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    assert_in_range(length, 1, sizeof text - 1);
    ffd_lattice *lattice = NULL;
    ffd_error error;
    if (ffd_lattice_parse(text, (size_t)length, "test", &lattice, &error))
        fail_msg("%s", error.message);
    return lattice;
}

/* Sets rest control points to the images of their Greville abscissae, as fractions of the domain. */
static ffd_lattice *mapped(const lattice_kinds *shape, point_map map)
{
    ffd_lattice *lattice = lattice_of_kinds(shape);
    lattice_map(lattice, map);
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    return lattice;
}

static void finish(ffd_lattice *lattice)
{
    ffd_error error;
    if (finish_by_hand(lattice, &error))
        fail_msg("%s", error.message);
}

static void identity(const double g[3], double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = g[a];
}

static void mirror(const double g[3], double out[3])
{
    identity(g, out);
    out[0] = -g[0];
}

/* A map without folds, whose det J varies between about 1/3 and 3. */
static void warp(const double g[3], double out[3])
{
    out[0] = g[0] + 0.3 * g[1] * g[1] - 0.1 * g[0] * g[2];
    out[1] = g[1] - 0.25 * g[2] * g[0] + 0.1 * g[1] * g[1];
    out[2] = g[2] * (1 + 0.4 * g[0] * g[1]) + 0.2 * g[0];
}

/* A ring with v round the axis; the phase keeps control points off the coordinate axes. */
static void ring_at(double radius, const double g[3], double out[3])
{
    const double turn = 6.283185307179586 * g[1] + 0.7;
    out[0] = 3 + radius * cos(turn);
    out[1] = radius * sin(turn) - 2;
    out[2] = g[2];
}

static void tube(const double g[3], double out[3])
{
    ring_at(0.5 + g[0], g, out);
}

static void rod(const double g[3], double out[3])
{
    ring_at(g[0], g, out);
}

/* Closed along v and w. */
static void torus(const double g[3], double out[3])
{
    const double v = 6.283185307179586 * g[1], w = 6.283185307179586 * g[2], small = 0.2 + 0.3 * g[0];
    const double large = 2 + small * cos(w);
    out[0] = large * cos(v);
    out[1] = -large * sin(v);
    out[2] = small * sin(w);
}

/* u is the radius, v goes round the axis, w from pole to pole. Exact: control points coincide at the centre
   and the poles. */
static void ball_with(double rim, const double g[3], double out[3])
{
    const double turn = 6.283185307179586 * g[1], rise = 3.141592653589793 * (g[2] - 0.5);
    const double across = g[2] == 0 || g[2] == 1 ? rim : cos(rise);
    out[0] = g[0] * across * cos(turn);
    out[1] = g[0] * across * sin(turn);
    out[2] = g[0] * sin(rise);
}

static void ball(const double g[3], double out[3])
{
    ball_with(0, g, out);
}

/* The poles from cos, up to rounding. */
static void rough_ball(const double g[3], double out[3])
{
    ball_with(6.1e-17, g, out);
}

/* An independent determinant */

typedef struct determinant {
    long double value;
    long double size; /* upper bound, for relative errors */
} determinant;

static long double determinant3(long double m[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
           m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* det J by the Cox-de Boor recursion and the quotient rule, relative to the cell's first control point. */
static determinant determinant_at(const ffd_lattice *lattice, ffd_volume volume, const double uvw[3])
{
    const double *points = ffd_lattice_get_points(lattice, volume),
                 *weights = ffd_lattice_get_weights(lattice, volume);
    size_t span[3];
    long double value[3][MAX_ORDER], slope[3][MAX_ORDER], rise[3][MAX_ORDER];
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &lattice->knots[a];
        span[a] = reference_span(knots->t, knots->functions, knots->degree, uvw[a]);
        for (size_t i = 0; i <= (size_t)knots->degree; i++) {
            long double rising, falling;
            const size_t function = span[a] - (size_t)knots->degree + i;
            value[a][i] = reference_value(knots->t, span[a], function, knots->degree, uvw[a]);
            reference_slopes(knots->t, span[a], function, knots->degree, uvw[a], &rising, &falling);
            slope[a][i] = rising - falling;
            rise[a][i] = rising + falling;
        }
    }
    long double w = 0, dw[3] = {0}, p[3] = {0}, dp[3][3] = {{0}}, size[3][3] = {{0}}, least = LDBL_MAX;
    const double *origin = NULL;
    for (size_t k = 0; k <= (size_t)lattice->knots[2].degree; k++)
        for (size_t j = 0; j <= (size_t)lattice->knots[1].degree; j++)
            for (size_t i = 0; i <= (size_t)lattice->knots[0].degree; i++) {
                const size_t local[3] = {i, j, k};
                size_t at[3];
                for (int a = 0; a < 3; a++)
                    at[a] = ffd_knots_point(&lattice->knots[a],
                                            span[a] - (size_t)lattice->knots[a].degree + local[a]);
                const size_t index = lattice_index(lattice, at[0], at[1], at[2]);
                const long double h = weights ? weights[index] : 1;
                origin = origin ? origin : points + 3 * index;
                least = h < least ? h : least;
                w += h * value[0][i] * value[1][j] * value[2][k];
                for (int a = 0; a < 3; a++) {
                    long double d = h, e = h;
                    for (int b = 0; b < 3; b++) {
                        d *= a == b ? slope[b][local[b]] : value[b][local[b]];
                        e *= a == b ? rise[b][local[b]] : value[b][local[b]];
                    }
                    dw[a] += d;
                    for (int r = 0; r < 3; r++) {
                        const long double x = (long double)points[3 * index + (size_t)r] - origin[r];
                        p[r] += a == 0 ? h * x * value[0][i] * value[1][j] * value[2][k] : 0;
                        dp[r][a] += d * x;
                        size[r][a] += fabsl(e * x);
                    }
                }
            }
    long double permanent = 0;
    for (int r = 0; r < 3; r++)
        for (int a = 0; a < 3; a++) {
            dp[r][a] = (dp[r][a] - dw[a] * p[r] / w) / w;
            size[r][a] *= 2 / least;
        }
    for (int a = 0; a < 3; a++)
        permanent += size[0][a] * (size[1][(a + 1) % 3] * size[2][(a + 2) % 3] +
                                   size[1][(a + 2) % 3] * size[2][(a + 1) % 3]);
    return (determinant){determinant3(dp), permanent};
}

/* Returns the least sign * determinant on a grid over all cells, and its place. */
static long double least_sampled(const ffd_lattice *lattice, int sign, int steps, double at[3])
{
    long double least = LDBL_MAX;
    const knot_vector *knots = lattice->knots;
    for (size_t cell = 0; cell < knots[0].span_count * knots[1].span_count * knots[2].span_count; cell++) {
        const size_t index[3] = {cell % knots[0].span_count, cell / knots[0].span_count % knots[1].span_count,
                                 cell / knots[0].span_count / knots[1].span_count};
        for (int step = 0; step < (steps + 1) * (steps + 1) * (steps + 1); step++) {
            const int t[3] = {step % (steps + 1), step / (steps + 1) % (steps + 1),
                              step / (steps + 1) / (steps + 1)};
            double uvw[3];
            for (int a = 0; a < 3; a++) {
                const double *knot = knots[a].t + knots[a].spans[index[a]];
                uvw[a] = t[a] == steps ? nextafter(knot[1], knot[0])
                                       : knot[0] + (knot[1] - knot[0]) * t[a] / steps;
            }
            const determinant det = determinant_at(lattice, FFD_VOLUME_DEFORMED, uvw);
            if (sign * det.value < least) {
                least = sign * det.value;
                memcpy(at, uvw, sizeof uvw);
            }
        }
    }
    return least;
}

/* The verdict */

static void assert_same(const ffd_folds *a, const ffd_folds *b)
{
    assert_int_equal(a->verdict, b->verdict);
    assert_int_equal(a->cells, b->cells);
    assert_int_equal(a->folded_cells, b->folded_cells);
    assert_int_equal(a->unknown_cells, b->unknown_cells);
    assert_memory_equal(&a->min_det, &b->min_det, sizeof a->min_det);
    assert_int_equal(a->witness.is_there, b->witness.is_there);
    assert_memory_equal(a->witness.uvw, b->witness.uvw, sizeof a->witness.uvw);
    assert_memory_equal(a->witness.xyz, b->witness.xyz, sizeof a->witness.xyz);
    assert_memory_equal(a->witness.rest, b->witness.rest, sizeof a->witness.rest);
    assert_memory_equal(&a->witness.det, &b->witness.det, sizeof a->witness.det);
}

static void check_witness(const ffd_lattice *lattice, const ffd_folds *folds, int sign)
{
    double lo[3], hi[3], point[3];
    ffd_lattice_get_domain(lattice, lo, hi);
    for (int a = 0; a < 3; a++)
        assert_true(folds->witness.uvw[a] >= lo[a] && folds->witness.uvw[a] <= hi[a]);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_DEFORMED, folds->witness.uvw, point, NULL);
    assert_memory_equal(point, folds->witness.xyz, sizeof point);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, folds->witness.uvw, point, NULL);
    assert_memory_equal(point, folds->witness.rest, sizeof point);
    assert_true(folds->witness.det <= 0);
    assert_true(folds->min_det <= folds->witness.det);
    const determinant det = determinant_at(lattice, FFD_VOLUME_DEFORMED, folds->witness.uvw);
    if (folds->witness.det < 0) {
        assert_true(sign * det.value <= 0);
    } else {
        assert_true(sign * det.value <= 1e-12L * det.size); /* a flat cell */
    }
}

/* sign: that of the rest volume. */
static ffd_folds find(const ffd_lattice *lattice, int sign)
{
    ffd_folds folds = {.struct_size = sizeof folds}, again = folds;
    ffd_error error;
    for (int threads = 1; threads <= 3; threads += is_memory_checked() ? 2 : 1) {
        if (ffd_folds_find(lattice, threads, threads == 1 ? &folds : &again, &error))
            fail_msg("%s", error.message);
        if (threads > 1)
            assert_same(&folds, &again);
    }
    uint64_t cells = 1;
    for (int a = 0; a < 3; a++)
        cells *= lattice->knots[a].span_count;
    assert_int_equal(folds.cells, cells);
    assert_true(folds.folded_cells + folds.unknown_cells <= cells);
    assert_int_equal(folds.witness.is_there, folds.verdict == FFD_FOLDS_SOME);
    assert_int_equal(folds.folded_cells > 0, folds.verdict == FFD_FOLDS_SOME);
    assert_int_equal(folds.unknown_cells > 0 && folds.folded_cells == 0, folds.verdict == FFD_FOLDS_UNKNOWN);
    if (folds.witness.is_there)
        check_witness(lattice, &folds, sign);
    return folds;
}

static ffd_folds assert_verdict(const ffd_lattice *lattice, int sign, ffd_fold_verdict verdict)
{
    const ffd_folds folds = find(lattice, sign);
    assert_int_equal(folds.verdict, verdict);
    if (verdict == FFD_FOLDS_NONE) {
        double at[3];
        assert_int_equal(folds.unknown_cells, 0);
        assert_true(folds.min_det >= 0);
        if (is_memory_checked()) /* samples check numbers, which other builds do */
            return folds;
        const long double least = least_sampled(lattice, sign, 2, at);
        assert_true(least >= -1e-12L * determinant_at(lattice, FFD_VOLUME_DEFORMED, at).size);
    }
    return folds;
}

/* At rest, a volume without collapsed faces does not fold, nor does it when scaled or translated. */
static void assert_none_at_rest(ffd_lattice *lattice, int sign)
{
    finish(lattice);
    const ffd_folds folds = assert_verdict(lattice, sign, FFD_FOLDS_NONE);
    assert_true(folds.min_det > 0 && folds.min_det <= 1);
    ffd_lattice_destroy(&lattice);
}

/* Volumes that do not fold */

static void the_identity_and_its_mirror_have_no_folds(void **state)
{
    (void)state;
    const knot_kind kind[] = {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_UNIFORM};
    const int most = is_under_valgrind() ? 4 : 9;
    for (int degree = 1; degree <= most; degree += stride(3))
        for (int k = 0; k < 3; k++)
            for (int side = 0; side < 2; side++) {
                const size_t least = (size_t)degree + 1;
                const lattice_kinds shape = {{kind[k], kind[(k + 1) % 3], kind[(k + 2) % 3]},
                                             {degree, degree > 4 ? 2 : degree, degree > 4 ? 1 : degree},
                                             {least + 1, least, least + 2}};
                ffd_lattice *lattice = mapped(&shape, side ? mirror : identity);
                finish(lattice);
                const ffd_folds folds = assert_verdict(lattice, side ? -1 : 1, FFD_FOLDS_NONE);
                assert_true(folds.min_det > 1 - 1e-8 && folds.min_det <= 1);
                ffd_lattice_destroy(&lattice);
            }
    if (is_under_valgrind()) /* undeformed_shapes_have_no_folds covers such degrees */
        return;
    const lattice_kinds nine = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {9, 9, 9}, {10, 10, 10}};
    ffd_lattice *lattice = mapped(&nine, identity);
    finish(lattice);
    assert_true(assert_verdict(lattice, 1, FFD_FOLDS_NONE).min_det > 1 - 1e-8);
    ffd_lattice_destroy(&lattice);
}

static void undeformed_shapes_have_no_folds(void **state)
{
    (void)state;
    const lattice_kinds shapes[] = {
        {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {3, 3, 3}, {5, 6, 4}},
        {{KNOTS_OPEN, KNOTS_CLAMPED, KNOTS_UNIFORM}, {4, 2, 1}, {6, 5, 4}},
        {{KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_CLAMPED}, {5, 5, 5}, {6, 7, 6}},
        {{KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_CLAMPED}, {9, 9, 9}, {10, 10, 10}},
    };
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        assert_none_at_rest(mapped(&shapes[i], warp), 1);
    const lattice_kinds round[] = {
        {{KNOTS_CLAMPED, KNOTS_CLOSED, KNOTS_CLAMPED}, {3, 3, 3}, {4, 12, 4}},
        {{KNOTS_OPEN, KNOTS_CLOSED, KNOTS_CLAMPED}, {2, 4, 1}, {5, 9, 2}},
    };
    for (size_t i = 0; i < sizeof round / sizeof *round; i++)
        assert_none_at_rest(mapped(&round[i], tube), 1);
    const lattice_kinds twice = {{KNOTS_CLAMPED, KNOTS_CLOSED, KNOTS_CLOSED}, {2, 3, 3}, {4, 12, 9}};
    assert_none_at_rest(mapped(&twice, torus), -1);
}

/* C0 knots, with control points as in a lattice file. */
static void a_kink_at_a_c0_knot_folds_one_side_only(void **state)
{
    (void)state;
    ffd_lattice *lattice =
        parsed("{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[7,5,4],\"degree\":[3,2,1],"
               "\"knots\":[[-2,-2,-2,-2,1,1,1,5,5,5,5],[0,0,0,3,3,4,4,4],\"open\"],"
               "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[4,2,1]}},"
               "\"moves\":[{\"at\":[3,\"all\",\"all\"],\"by\":[0.3,0,0.2]},"
               "{\"twist\":{\"axis\":\"x\",\"degrees\":40}}]}");
    assert_verdict(lattice, 1, FFD_FOLDS_NONE);
    ffd_lattice_destroy(&lattice);
    /* A kink through which the volume returns: it folds on one side of the C0 knot only. */
    lattice = parsed("{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[3,2,2],\"degree\":[1,1,1],"
                     "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[4,2,1]}},"
                     "\"moves\":[{\"at\":[2,\"all\",\"all\"],\"by\":[-2.5,0,0]}]}");
    const ffd_folds folds = assert_verdict(lattice, 1, FFD_FOLDS_SOME);
    assert_int_equal(folds.folded_cells, 1);
    assert_true(folds.witness.uvw[0] >= 0.5);
    assert_true(fabs(folds.min_det + 0.25) < 1e-2 && folds.min_det <= -0.25);
    ffd_lattice_destroy(&lattice);
}

/* valgrind computes long double as double, so determinants around 1e200 overflow. */
static bool has_long_double(void)
{
    const volatile long double small = LDBL_EPSILON;
    return 1 + small != 1;
}

static void the_verdict_does_not_depend_on_size(void **state)
{
    (void)state;
    static const double box[][6] = {{0, 0, 0, 1e-6, 1, 1},
                                    {0, 0, 0, 2, 1e-6, 1e-6},
                                    {-1e9, -1e9, -1e9, 1e9, 1e9, 2e9},
                                    {1e6, 1e6, -1e6, 1000001, 1000002, -999999},
                                    {1e-30, 0, 0, 2e-30, 1e30, 1e-3},
                                    {-1e200, -1e200, -1e200, 1e200, 1e200, 1e200},
                                    {0, 0, 0, 1e-200, 1e-200, 1e-200}};
    const size_t count = sizeof box / sizeof *box - (has_long_double() ? 0 : 2);
    for (size_t i = 0; i < count; i++)
        for (int fold = 0; fold < 2; fold++) {
            const double *b = box[i];
            ffd_lattice *lattice = parsed("{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[5,4,4],"
                                          "\"units\":\"box\",\"rest\":{\"box\":"
                                          "{\"min\":[%.17g,%.17g,%.17g],\"max\":[%.17g,%.17g,%.17g]}},"
                                          "\"moves\":[{\"at\":[2,1,2],\"by\":[%g,0.05,-0.1]}]}",
                                          b[0], b[1], b[2], b[3], b[4], b[5], fold ? 8.0 : 0.2);
            const ffd_folds folds = assert_verdict(lattice, 1, fold ? FFD_FOLDS_SOME : FFD_FOLDS_NONE);
            assert_true(fold ? folds.min_det < -0.1 : folds.min_det > 0.1 && folds.min_det < 1);
            ffd_lattice_destroy(&lattice);
        }
}

/* A thin box that is not aligned with the coordinate axes. */
static void a_thin_turned_box_has_no_folds(void **state)
{
    (void)state;
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {3, 3, 3}, {5, 5, 5}};
    ffd_lattice *lattice = mapped(&shape, warp);
    static const double m[9] = {0.6e-6, 0.8, 0, -0.8e-6, 0.6, 0, 0.3e-6, 0.1, 1};
    for (size_t i = 0; i < lattice->count; i++) {
        mat_apply(m, lattice->rest + 3 * i, lattice->rest + 3 * i);
        memcpy(lattice->deformed + 3 * i, lattice->rest + 3 * i, 3 * sizeof(double));
    }
    assert_none_at_rest(lattice, 1);
}

/* Weights */

static void verdicts_with_weights_agree_with_samples(void **state)
{
    (void)state;
    draw d = {5};
    const int degree[][3] = {{1, 1, 1}, {2, 3, 1}, {3, 3, 3}, {4, 2, 5}};
    int none = 0, some = 0;
    const int count = is_under_valgrind() ? 8 : is_memory_checked() ? 16 : 40; /* each degree with each map */
    for (int i = 0; i < count; i++) {
        const int *deg = degree[i % 4];
        const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_CLAMPED},
                                     {deg[0], deg[1], deg[2]},
                                     {(size_t)deg[0] + 2, (size_t)deg[1] + 1, (size_t)deg[2] + 2}};
        ffd_lattice *lattice = mapped(&shape, i % 8 < 4 ? identity : warp);
        const double spread = i % 3 ? 1.5 : 1000;
        lattice_add_weights(lattice);
        for (size_t p = 0; p < lattice->count; p++) {
            lattice->rest_weights[p] = draw_between(&d, 3, 3.1);
            lattice->deformed_weights[p] = draw_between(&d, 1, spread);
        }
        if (i % 3 == 0)
            lattice->deformed[3] += 0.9;
        finish(lattice);
        const ffd_folds folds = find(lattice, 1);
        double at[3];
        const long double least = is_memory_checked() ? 1 : least_sampled(lattice, 1, 5, at);
        if (folds.verdict == FFD_FOLDS_NONE) {
            none++;
            assert_true(least > 0 && folds.min_det > 0);
        }
        some += folds.verdict == FFD_FOLDS_SOME;
        assert_true(least > 0 || folds.verdict == FFD_FOLDS_SOME);
        assert_int_not_equal(folds.verdict, FFD_FOLDS_UNKNOWN);
        ffd_lattice_destroy(&lattice);
    }
    assert_true(none >= count / 4 && some >= count / 12);
}

/* Weights that are all equal have no effect. */
static void equal_weights_change_nothing(void **state)
{
    (void)state;
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_CLAMPED}, {3, 2, 3}, {5, 4, 4}};
    ffd_lattice *lattice = mapped(&shape, warp);
    finish(lattice);
    const ffd_folds without = find(lattice, 1);
    lattice_add_weights(lattice);
    for (size_t i = 0; i < lattice->count; i++) {
        lattice->rest_weights[i] = 0.7;
        lattice->deformed_weights[i] = 1e5;
    }
    finish(lattice);
    const ffd_folds with = find(lattice, 1);
    assert_int_equal(with.verdict, FFD_FOLDS_NONE);
    assert_true(fabs(with.min_det / without.min_det - 1) < 1e-9);
    ffd_lattice_destroy(&lattice);
}

/* Folds */

/* Ten cells a direction; one control point moved along x. With basis functions N of degrees 3, 2, 2 and
   spacing h, the least dx/du is 1 - move/h (2/3) (3/4)^2, in a single point of a single cell: 0 for move =
   8/3 h. */
static ffd_lattice *one_point_moved(double move, bool mirrored)
{
    const lattice_kinds shape = {{KNOTS_OPEN, KNOTS_OPEN, KNOTS_OPEN}, {3, 2, 2}, {13, 12, 12}};
    ffd_lattice *lattice = mapped(&shape, mirrored ? mirror : identity);
    lattice->deformed[3 * lattice_index(lattice, 6, 7, 4)] += mirrored ? -0.1 * move : 0.1 * move;
    finish(lattice);
    return lattice;
}

static void one_folded_cell_of_a_thousand_is_found(void **state)
{
    (void)state;
    for (int mirrored = 0; mirrored < 2; mirrored++)
        for (int i = 0; i < 4; i += stride(4)) {
            static const double beyond[] = {1e-3, 1e-6, 1e-9, 1e-11};
            ffd_lattice *lattice = one_point_moved(8.0 / 3 * (1 + beyond[i]), mirrored);
            const ffd_folds folds = assert_verdict(lattice, mirrored ? -1 : 1, FFD_FOLDS_SOME);
            assert_int_equal(folds.cells, 1000);
            assert_int_equal(folds.folded_cells, 1);
            assert_int_equal(folds.unknown_cells, 0);
            /* Control point 6 is at 0.5; the minimum is 2/3 of a spacing further. Along v and w point 7 and
               point 4: cells 6 and 3. */
            static const double lo[3] = {0.5, 0.6, 0.3};
            for (int a = 0; a < 3; a++)
                assert_true(folds.witness.uvw[a] >= lo[a] - 1e-15 &&
                            folds.witness.uvw[a] <= lo[a] + 0.1 + 1e-15);
            assert_true(folds.witness.det < 0 && folds.witness.det > -1.1 * beyond[i]);
            assert_true(folds.min_det <= -0.99 * beyond[i] && folds.min_det >= -1.02 * beyond[i] - 2e-12);
            ffd_lattice_destroy(&lattice);
        }
}

static void a_hair_before_folding_is_no_fold(void **state)
{
    (void)state;
    for (int mirrored = 0; mirrored < 2; mirrored++)
        for (int i = 0; i < 5; i += stride(5)) {
            static const double before[] = {0.3, 1e-3, 1e-6, 1e-9, 1e-11};
            ffd_lattice *lattice = one_point_moved(8.0 / 3 * (1 - before[i]), mirrored);
            const ffd_folds folds = assert_verdict(lattice, mirrored ? -1 : 1, FFD_FOLDS_NONE);
            assert_true(folds.min_det <= before[i] * (1 + 1e-9) + 1e-15);
            assert_true(folds.min_det >= 0.98 * before[i] - 2e-12);
            ffd_lattice_destroy(&lattice);
        }
}

/* The least determinant is at a corner: decided down to the rounding of one coefficient. */
static void a_hair_at_a_corner_is_decided(void **state)
{
    (void)state;
    static const double hair[] = {1e-6, 1e-10, 1e-12, 5e-13};
    for (int i = 0; i < 8; i++)
        for (int degree = 1; degree <= 3; degree++) {
            const lattice_kinds shape = {
                {KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {degree, degree, degree}, {5, 5, 5}};
            ffd_lattice *lattice = mapped(&shape, identity);
            const double step = lattice->rest[3] - lattice->rest[0], sign = i < 4 ? 1 : -1;
            /* C_u at the corner points to the next control point. */
            lattice->deformed[0] = step - sign * hair[i % 4] * step;
            finish(lattice);
            const ffd_folds folds = assert_verdict(lattice, 1, i < 4 ? FFD_FOLDS_NONE : FFD_FOLDS_SOME);
            assert_true(fabs(folds.min_det - sign * hair[i % 4]) < 0.01 * hair[i % 4] + 1e-12);
            ffd_lattice_destroy(&lattice);
        }
}

/* det = 0 in one point, and positive around it: it cannot be decided, but the verdict is never "none". */
static void exactly_on_the_edge_is_never_called_free(void **state)
{
    (void)state;
    ffd_lattice *lattice = one_point_moved(8.0 / 3, false);
    ffd_folds folds = find(lattice, 1);
    assert_int_equal(folds.verdict, FFD_FOLDS_UNKNOWN);
    assert_int_equal(folds.unknown_cells, 1);
    assert_true(folds.min_det <= 0 && folds.min_det > -1e-6);
    ffd_lattice_destroy(&lattice);
    /* At a corner the coefficient is exactly 0. */
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {3, 3, 3}, {5, 5, 5}};
    lattice = mapped(&shape, identity);
    lattice->deformed[0] = lattice->deformed[3];
    finish(lattice);
    folds = find(lattice, 1);
    assert_int_not_equal(folds.verdict, FFD_FOLDS_NONE);
    ffd_lattice_destroy(&lattice);
}

static void too_few_boxes_leave_a_cell_unknown(void **state)
{
    (void)state;
    ffd_lattice *lattice = one_point_moved(8.0 / 3 * (1 - 1e-6), false);
    fold_plan plan;
    cell_verdict verdict;
    assert_int_equal(ffd_fold_plan_make(lattice, &plan, NULL), FFD_OK);
    fold_scratch *scratch = ffd_fold_scratch_create(&plan);
    assert_non_null(scratch);
    const size_t cell = 5 + 10 * (6 + 10 * 3);
    ffd_cell_decide(&plan, cell, 20, scratch, &verdict);
    assert_int_equal(verdict.verdict, FFD_FOLDS_UNKNOWN);
    assert_true(verdict.lower <= 0);
    ffd_cell_decide(&plan, cell, 2000, scratch, &verdict);
    assert_int_equal(verdict.verdict, FFD_FOLDS_NONE);
    assert_true(verdict.lower > 0);
    ffd_fold_scratch_destroy(scratch);
    ffd_fold_plan_free(&plan);
    ffd_lattice_destroy(&lattice);
}

/* A quarter of a ring, rounded to 1/100, with one heavy layer. Its boxes beside the end of v were halved
   until their ends were no doubles, and then for ever. */
static void every_search_ends(void **state)
{
    (void)state;
    static const double scale[] = {1, 1e154, 1e300, 1e-200, 1e-310};
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {1, 2, 1}, {4, 5, 2}};
    for (size_t s = 0; s < sizeof scale / sizeof *scale; s++) {
        ffd_lattice *lattice = mapped(&shape, identity);
        lattice_add_weights(lattice);
        for (size_t i = 0; i < lattice->count; i++) {
            static const double x[4] = {1, 0.8355, 0.3962, -0.1734}, y[4] = {0, 0.5494, 0.9181, 0.9849};
            double *p = lattice->rest + 3 * i, *q = lattice->deformed + 3 * i;
            const double radius = 100 + 30 * p[1];
            if (i / 4 % 5 == 0)
                lattice->rest_weights[i] = lattice->deformed_weights[i] = 256;
            q[0] = round(radius * x[i % 4]) / 100 * scale[s];
            q[1] = round(radius * y[i % 4]) / 100 * scale[s];
            q[2] = p[2] * scale[s];
            for (int r = 0; r < 3; r++)
                p[r] *= scale[s];
        }
        finish(lattice);
        const ffd_folds folds = find(lattice, 1);
        assert_int_equal(folds.verdict, FFD_FOLDS_SOME);
        assert_true(folds.min_det <= folds.witness.det);
        ffd_lattice_destroy(&lattice);
    }
}

/* Coordinates and weights of all sizes together. */
static void searches_of_mixed_sizes_end(void **state)
{
    (void)state;
    static const double sizes[] = {1e154, 1e-200, 5e-324, 1e-310, 1e300, 1, 1e102, 1e-103};
    draw d = {17};
    int found = 0;
    for (int i = 0; i < 24; i += stride(5)) {
        const int degree = 1 + i % 3;
        const lattice_kinds shape = {{KNOTS_CLAMPED, i % 2 ? KNOTS_OPEN : KNOTS_CLAMPED, KNOTS_CLAMPED},
                                     {degree, 2, 1},
                                     {(size_t)degree + 2, 3, 3}};
        ffd_lattice *lattice = mapped(&shape, identity);
        if (i % 4 > 1)
            lattice_add_weights(lattice);
        for (size_t p = 0; p < lattice->count; p++) {
            for (size_t r = 0; r < 3; r++) {
                const double size = sizes[draw_int(&d, 0, 7)], along = sizes[(i + (int)r) % 8];
                lattice->rest[3 * p + r] *= i % 3 == 0 ? size : along;
                lattice->deformed[3 * p + r] = draw_between(&d, -1, 1) * (i % 3 == 1 ? along : size);
            }
            if (i % 4 > 1)
                lattice->rest_weights[p] = lattice->deformed_weights[p] =
                    pow(10, draw_between(&d, -8, 8) * (i % 8));
        }
        if (finish_by_hand(lattice, NULL) == FFD_OK) { /* else too large to compute with */
            ffd_folds folds = {.struct_size = sizeof folds};
            assert_int_equal(ffd_folds_find(lattice, 2, &folds, NULL), FFD_OK);
            assert_true(!folds.witness.is_there || folds.min_det <= folds.witness.det);
            found++;
        }
        ffd_lattice_destroy(&lattice);
    }
    assert_true(found >= 3);
}

/* A fold across the seam of a closed direction. */
static void folds_at_the_seam_are_found(void **state)
{
    (void)state;
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLOSED, KNOTS_CLAMPED}, {2, 2, 1}, {3, 10, 2}};
    for (size_t j = 0; j < 10; j++) {
        ffd_lattice *lattice = mapped(&shape, tube);
        for (size_t k = 0; k < 2; k++)
            for (size_t i = 0; i < 3; i++) {
                const double *other = lattice->rest + 3 * lattice_index(lattice, i, (j + 5) % 10, k);
                memcpy(lattice->deformed + 3 * lattice_index(lattice, i, j, k), other, 3 * sizeof(double));
            }
        finish(lattice);
        assert_verdict(lattice, 1, FFD_FOLDS_SOME);
        ffd_lattice_destroy(&lattice);
    }
}

static void flat_and_mirrored_volumes_fold_everywhere(void **state)
{
    (void)state;
    static const struct {
        const char *move;
        double least, greatest; /* range of min_det */
    } cases[] = {
        {"{\"scale\":{\"factor\":[1,1,0]}}", 0, 0},
        {"{\"scale\":{\"factor\":[0,0,0]}}", 0, 0},
        {"{\"matrix\":[1,0,0,0, 0,1,0,0, 0.3,0.7,0,0, 0,0,0,1]}", -1e-9, 0},
        {"{\"matrix\":[1,0,1,5, 0,1,1,0, 1,1,2,0, 0,0,0,1]}", -1e-9, 0},
        {"{\"scale\":{\"factor\":[-1,1,1]}}", -1.01, -1},
        {"{\"scale\":{\"factor\":[2,2,-3]}}", -12.12, -12},
        {"{\"matrix\":[0,1,0,0, 1,0,0,0, 0,0,1,0, 0,0,0,1]}", -1.01, -1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int rational = 0; rational < 2; rational++) {
            if (is_under_valgrind() && (i + (size_t)rational) % 2)
                continue;
            ffd_lattice *lattice =
                parsed("{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[6,5,4],"
                       "\"rest\":{\"box\":{\"min\":[0.1,0,0],\"max\":[3,2.1,1]}},\"moves\":[%s]}",
                       cases[i].move);
            if (rational) {
                lattice_add_weights(lattice);
                lattice->rest_weights[7] = lattice->deformed_weights[7] = 1.1;
                finish(lattice);
            }
            const ffd_folds folds = assert_verdict(lattice, 1, FFD_FOLDS_SOME);
            assert_int_equal(folds.folded_cells, folds.cells);
            if (!rational)
                assert_true(folds.min_det >= cases[i].least * (1 + 1e-9) &&
                            folds.min_det <= cases[i].greatest);
            ffd_lattice_destroy(&lattice);
        }
}

static void random_control_points_are_found_to_fold(void **state)
{
    (void)state;
    draw d = {3};
    for (int i = 0; i < 6; i += stride(3)) { /* 3 is prime to 4 */
        const int degree = 1 + i % 4;
        const lattice_kinds shape = {
            {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_CLAMPED}, {degree, degree, degree}, {7, 7, 7}};
        ffd_lattice *lattice = mapped(&shape, identity);
        for (size_t p = 0; p < 3 * lattice->count; p++)
            lattice->deformed[p] = draw_between(&d, 0, 1);
        finish(lattice);
        const ffd_folds folds = assert_verdict(lattice, 1, FFD_FOLDS_SOME);
        assert_true(folds.unknown_cells * 20 < folds.cells);
        ffd_lattice_destroy(&lattice);
    }
}

/* Collapsed axes */

/* Each cell is decided after few boxes. */
static void assert_quick(const ffd_lattice *lattice, long boxes)
{
    fold_plan plan;
    assert_int_equal(ffd_fold_plan_make(lattice, &plan, NULL), FFD_OK);
    fold_scratch *scratch = ffd_fold_scratch_create(&plan);
    assert_non_null(scratch);
    for (size_t cell = 0; cell < plan.cell_count; cell++) {
        cell_verdict verdict;
        ffd_cell_decide(&plan, cell, boxes, scratch, &verdict);
        assert_int_equal(verdict.verdict, FFD_FOLDS_NONE);
    }
    ffd_fold_scratch_destroy(scratch);
    ffd_fold_plan_free(&plan);
}

static const char *const cylinder_text =
    "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,9,5],%s\"rest\":{\"cylinder\":{\"center\":[%g,2,3]"
    ","
    "\"axis\":[1,%d,3],\"radius\":[0,2],\"height\":5,\"angle\":[0,360]}},\"moves\":[%s]}";

static void a_collapsed_axis_is_no_fold(void **state)
{
    (void)state;
    static const char *const moves[] = {
        "",
        "{\"twist\":{\"axis\":[1,2,3],\"degrees\":70}}",
        "{\"bend\":{\"axis\":[1,2,3],\"toward\":[1,0,0],\"degrees\":60}}",
        "{\"taper\":{\"axis\":[1,2,3],\"factor\":0.5}}",
        "{\"at\":[\"all\",\"all\",2],\"by\":[0.3,0.2,-0.1]}",
        "{\"at\":[0,\"all\",[1,3]],\"by\":[0.2,0.1,0.1]}",
        "{\"rotate\":{\"axis\":[1,5,3],\"degrees\":33}},{\"scale\":{\"factor\":[1,2,3]}}",
    };
    static const char *const shapes[] = {
        "", "\"degree\":[1,2,3],", "\"knots\":[\"clamped\",\"closed\",\"open\"],",
        "\"knots\":[\"open\",\"closed\",\"clamped\"],", "\"knots\":[\"uniform\",\"clamped\",\"clamped\"],"};
    for (size_t i = 0; i < sizeof moves / sizeof *moves; i++)
        for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
            for (int far = 0; far < 2; far++) {
                if (k >= 3 && (i == 4 || i == 5)) /* with these knots no single ring of points is the axis */
                    continue;
                if (is_under_valgrind() && (i + k + (size_t)far) % 9)
                    continue;
                ffd_lattice *lattice = parsed(cylinder_text, shapes[k], far ? 1e6 : 1.0, 2, moves[i]);
                const ffd_folds folds = assert_verdict(lattice, 1, FFD_FOLDS_NONE);
                if (i == 0 || i == 6) /* one affine map */
                    assert_true(folds.min_det <= (i ? 6 : 1) && folds.min_det > (i ? 6 - 1e-4 : 1 - 1e-15));
                else
                    assert_true(folds.min_det >= 0 && folds.min_det < 1e-6);
                assert_quick(lattice, 64);
                ffd_lattice_destroy(&lattice);
            }
}

static void a_torn_axis_is_a_fold(void **state)
{
    (void)state;
    static const char *const moves[] = {
        "{\"at\":[0,0,2],\"by\":[0.2,0.1,0]}",
        "{\"at\":[0,3,\"all\"],\"by\":[1e-4,2e-4,0]}",
        "{\"at\":[0,\"all\",0],\"by\":[0,0,3]}",
        "{\"at\":[0,\"all\",\"all\"],\"by\":[5,0,0]}",
    };
    for (size_t i = 0; i < sizeof moves / sizeof *moves; i++) {
        ffd_lattice *lattice = parsed(cylinder_text, "", 1.0, 2, moves[i]);
        const ffd_folds folds = assert_verdict(lattice, 1, FFD_FOLDS_SOME);
        assert_true(folds.min_det < 0);
        ffd_lattice_destroy(&lattice);
    }
}

/* The ring at the axis is turned inside out, or opened to a tube: by a lot, and by a hair. */
static void an_axis_folds_inside_out_but_not_opened(void **state)
{
    (void)state;
    static const double radius[] = {0.2, -0.2, 1e-6, -1e-6, 1e-9, -1e-9, 1e-11, -1e-11};
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLOSED, KNOTS_CLAMPED}, {3, 3, 2}, {4, 9, 4}};
    for (size_t i = 0; i < sizeof radius / sizeof *radius; i++) {
        ffd_lattice *lattice = mapped(&shape, rod);
        for (size_t k = 0; k < 4; k++)
            for (size_t j = 0; j < 9; j++) {
                const size_t last = lattice_index(lattice, 3, j, k), first = lattice_index(lattice, 0, j, k);
                for (size_t r = 0; r < 3; r++)
                    lattice->deformed[3 * first + r] =
                        lattice->rest[3 * first + r] +
                        radius[i] * (lattice->rest[3 * last + r] - lattice->rest[3 * first + r]);
            }
        finish(lattice);
        const ffd_folds folds = assert_verdict(lattice, 1, radius[i] > 0 ? FFD_FOLDS_NONE : FFD_FOLDS_SOME);
        assert_true(radius[i] > 0 ? folds.min_det > 0 : folds.min_det < 0);
        ffd_lattice_destroy(&lattice);
    }
    /* By too little to decide: neither proven nor refuted. */
    ffd_lattice *lattice = mapped(&shape, rod);
    lattice->deformed[0] = nextafter(lattice->deformed[0], 0);
    finish(lattice);
    assert_int_not_equal(find(lattice, 1).verdict, FFD_FOLDS_NONE);
    ffd_lattice_destroy(&lattice);
}

static void a_ball_folds_only_when_its_pole_is_pushed_in(void **state)
{
    (void)state;
    const lattice_kinds shapes[] = {
        {{KNOTS_CLAMPED, KNOTS_CLOSED, KNOTS_CLAMPED}, {2, 3, 2}, {3, 10, 6}},
        {{KNOTS_CLAMPED, KNOTS_CLOSED, KNOTS_CLAMPED}, {3, 2, 3}, {5, 8, 7}},
        {{KNOTS_CLAMPED, KNOTS_CLOSED, KNOTS_CLAMPED}, {1, 2, 3}, {3, 9, 6}},
    };
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        for (int rough = 0; rough < 2; rough++) {
            if (is_under_valgrind() && i > 0 && (i + (size_t)rough) % 2)
                continue;
            ffd_lattice *lattice = mapped(&shapes[i], rough ? rough_ball : ball);
            for (size_t p = 0; p < lattice->count; p++) {
                double *q = lattice->deformed + 3 * p;
                q[0] += 0.2 * q[1] + 0.1 * q[2] * q[2];
                q[2] *= 1.3;
            }
            finish(lattice);
            const ffd_folds folds = assert_verdict(lattice, 1, FFD_FOLDS_NONE);
            assert_true(folds.min_det >= 0 && folds.min_det < 1e-3);
            /* The pole is pushed into the ball. */
            for (size_t u = 1; u < lattice->size[0]; u++)
                for (size_t v = 0; v < lattice->size[1]; v++)
                    lattice->deformed[3 * lattice_index(lattice, u, v, lattice->size[2] - 1) + 2] -= 3;
            finish(lattice);
            assert_verdict(lattice, 1, FFD_FOLDS_SOME);
            ffd_lattice_destroy(&lattice);
        }
}

/* A quarter of a solid cylinder, exact with weights. Its axis is not a line of equal homogeneous points. */
static void a_rational_quarter_folds_only_when_its_axis_tears(void **state)
{
    (void)state;
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {1, 2, 1}, {2, 3, 2}};
    static const double x[3] = {1, 1, 0}, y[3] = {0, 1, 1};
    for (int fold = 0; fold < 2; fold++) {
        ffd_lattice *lattice = mapped(&shape, identity);
        lattice_add_weights(lattice);
        for (size_t k = 0; k < 2; k++)
            for (size_t j = 0; j < 3; j++)
                for (size_t i = 0; i < 2; i++) {
                    const size_t at = lattice_index(lattice, i, j, k);
                    const double p[3] = {0.3 + 2 * (double)i * x[j], 0.7 + 2 * (double)i * y[j], (double)k};
                    memcpy(lattice->rest + 3 * at, p, sizeof p);
                    memcpy(lattice->deformed + 3 * at, p, sizeof p);
                    lattice->rest_weights[at] = lattice->deformed_weights[at] = j == 1 ? sqrt(0.5) : 1;
                }
        if (fold)
            lattice->deformed[3 * lattice_index(lattice, 0, 1, 0)] += 0.1;
        finish(lattice);
        const ffd_folds folds = assert_verdict(lattice, 1, fold ? FFD_FOLDS_SOME : FFD_FOLDS_NONE);
        if (!fold) {
            assert_true(folds.min_det == 0);
            assert_quick(lattice, 64);
        }
        ffd_lattice_destroy(&lattice);
    }
}

/* The rest volume is also 0 across an inner plane, which is not a border. */
static void a_volume_that_is_zero_inside_is_never_called_free(void **state)
{
    (void)state;
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {1, 1, 1}, {2, 3, 2}};
    ffd_lattice *lattice = mapped(&shape, identity);
    for (size_t k = 0; k < 2; k++) {
        double *inner = lattice->rest + 3 * lattice_index(lattice, 0, 1, k);
        memcpy(inner + 3, inner, 3 * sizeof(double));
    }
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    finish(lattice);
    assert_int_not_equal(find(lattice, 1).verdict, FFD_FOLDS_NONE);
    ffd_lattice_destroy(&lattice);
}

/* Polynomials */

static double random_size(draw *d)
{
    return draw_between(d, -1, 1);
}

static void bernstein_products_and_parts_keep_their_values(void **state)
{
    (void)state;
    draw d = {11};
    for (int round = 0; round < 50; round++) {
        double a[64], b[64], c[343], lower[343], scratch[343], weighted_a[64], weighted_b[64];
        int order_a[3], order_b[3], order[3];
        for (int i = 0; i < 3; i++) {
            order_a[i] = draw_int(&d, 1, 4);
            order_b[i] = draw_int(&d, 1, 4);
            order[i] = order_a[i] + order_b[i] - 1;
        }
        for (int i = 0; i < 64; i++) {
            a[i] = random_size(&d);
            b[i] = random_size(&d);
        }
        ffd_bernstein_weight(a, order_a, weighted_a);
        ffd_bernstein_weight(b, order_b, weighted_b);
        memset(c, 0, sizeof c);
        ffd_bernstein_multiply(weighted_a, order_a, weighted_b, order_b, -3, c);
        ffd_bernstein_unweight(c, order, 0.5);
        const int direction = draw_int(&d, 0, 2);
        double t[3], half[3];
        for (int i = 0; i < 3; i++)
            half[i] = t[i] = draw_unit(&d);
        const double value = -1.5 * ffd_bernstein_value(a, order_a, t) * ffd_bernstein_value(b, order_b, t);
        assert_true(fabs(ffd_bernstein_value(c, order, t) - value) < 1e-14);

        double part[343];
        const double lo[3] = {0.25, 0, 0.5}, hi[3] = {0.5, 1, 0.625};
        memcpy(part, c, sizeof c);
        ffd_bernstein_restrict(part, order, lo, hi, scratch);
        double inside[3];
        for (int i = 0; i < 3; i++)
            inside[i] = lo[i] + (hi[i] - lo[i]) * t[i];
        assert_true(fabs(ffd_bernstein_value(part, order, t) - ffd_bernstein_value(c, order, inside)) <
                    1e-13);

        double whole[343];
        memcpy(whole, c, sizeof c);
        ffd_bernstein_halve(c, order, direction, lower);
        half[direction] = 0.5 * t[direction];
        assert_true(fabs(ffd_bernstein_value(lower, order, t) - ffd_bernstein_value(whole, order, half)) <
                    1e-14);
        half[direction] += 0.5;
        assert_true(fabs(ffd_bernstein_value(c, order, t) - ffd_bernstein_value(whole, order, half)) < 1e-14);
    }
}

/* Errors */

static void no_bounds_and_negative_threads_are_refused(void **state)
{
    (void)state;
    ffd_lattice *lattice = parsed("{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,4,4],"
                                  "\"rest\":{\"box\":\"mesh\"}}");
    ffd_folds folds = {.struct_size = sizeof folds};
    ffd_error error;
    assert_int_equal(ffd_folds_find(lattice, 0, &folds, &error), FFD_E_ARGUMENT);
    assert_true(error.message[0]);
    const double min[3] = {0, 0, 0}, max[3] = {1, 1, 1};
    assert_int_equal(ffd_lattice_fit(lattice, min, max, &error), FFD_OK);
    assert_int_equal(ffd_folds_find(lattice, -1, &folds, &error), FFD_E_ARGUMENT);
    assert_int_equal(ffd_folds_find(lattice, 0, &folds, &error), FFD_OK);
    assert_int_equal(folds.verdict, FFD_FOLDS_NONE);
    ffd_lattice_destroy(&lattice);
}

static void each_failed_allocation_is_reported(void **state)
{
    (void)state;
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_CLAMPED}, {3, 2, 1}, {9, 9, 9}};
    ffd_lattice *lattice = mapped(&shape, warp);
    finish(lattice);
    const ffd_folds all = find(lattice, 1);
    ffd_folds folds = {.struct_size = sizeof folds};
    ffd_status status = FFD_E_MEMORY;
    long failing = 0;
    for (; status; failing++) {
        assert_true(failing < 1000);
        ffd_alloc_fail_after(failing);
        status = ffd_folds_find(lattice, 2, &folds, NULL);
        ffd_alloc_fail_after(-1);
        if (status)
            assert_int_equal(status, FFD_E_MEMORY);
    }
    assert_true(failing > 5);
    assert_same(&all, &folds); /* with fewer workers */
    ffd_lattice_destroy(&lattice);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bernstein_products_and_parts_keep_their_values),
        cmocka_unit_test(the_identity_and_its_mirror_have_no_folds),
        cmocka_unit_test(undeformed_shapes_have_no_folds),
        cmocka_unit_test(a_kink_at_a_c0_knot_folds_one_side_only),
        cmocka_unit_test(the_verdict_does_not_depend_on_size),
        cmocka_unit_test(a_thin_turned_box_has_no_folds),
        cmocka_unit_test(verdicts_with_weights_agree_with_samples),
        cmocka_unit_test(equal_weights_change_nothing),
        cmocka_unit_test(one_folded_cell_of_a_thousand_is_found),
        cmocka_unit_test(a_hair_before_folding_is_no_fold),
        cmocka_unit_test(a_hair_at_a_corner_is_decided),
        cmocka_unit_test(exactly_on_the_edge_is_never_called_free),
        cmocka_unit_test(too_few_boxes_leave_a_cell_unknown),
        cmocka_unit_test(every_search_ends),
        cmocka_unit_test(searches_of_mixed_sizes_end),
        cmocka_unit_test(folds_at_the_seam_are_found),
        cmocka_unit_test(flat_and_mirrored_volumes_fold_everywhere),
        cmocka_unit_test(random_control_points_are_found_to_fold),
        cmocka_unit_test(a_collapsed_axis_is_no_fold),
        cmocka_unit_test(a_torn_axis_is_a_fold),
        cmocka_unit_test(an_axis_folds_inside_out_but_not_opened),
        cmocka_unit_test(a_ball_folds_only_when_its_pole_is_pushed_in),
        cmocka_unit_test(a_rational_quarter_folds_only_when_its_axis_tears),
        cmocka_unit_test(a_volume_that_is_zero_inside_is_never_called_free),
        cmocka_unit_test(no_bounds_and_negative_threads_are_refused),
        cmocka_unit_test(each_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
