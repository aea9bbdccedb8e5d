/* Splines with random knots, degrees and points: the laws of basis functions, of Bezier form, of volumes. */
#include "../support/another_case.h"
#include "../support/bspline_reference.h"
#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "spline/basis.h"
#include "spline/bezier.h"
#include "spline/knots.h"
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define EPS DBL_EPSILON
#define MAX_POINTS 24
#define MAX_LIST (MAX_POINTS + MAX_ORDER)
#define PARAMETERS 12

static const knot_kind all_kinds[] = {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_UNIFORM,
                                      KNOTS_CLOSED,  KNOTS_LIST, KNOTS_CLOSED_LIST};
#define KIND_COUNT (sizeof all_kinds / sizeof *all_kinds)

static uint64_t seed;

typedef struct rounds {
    long made;
    double began;
} rounds;

/* Whether a property is tried once more: the least number of times, and then for a tenth of a second. */
static bool next_round(rounds *r, long least, const char *property)
{
    if (!another_case(r->made, &r->began, least, 1000000, 0.1)) {
        print_message("%s: %ld rounds\n", property, r->made);
        return false;
    }
    r->made++;
    return true;
}

/* Non-decreasing knots of any range, repeated first, inside and last; what this makes need not be valid. */
static void draw_list(draw *random, int degree, size_t count, double *list)
{
    const double scale = draw_between(random, 0.001, 1000);
    const bool clamp_last = draw_int(random, 0, 1);
    double value = scale * draw_between(random, -3, 3);
    for (size_t i = 0; i < count;) {
        int repeat = draw_int(random, 0, 2) ? 1 : draw_int(random, 1, degree + (i == 0));
        if (clamp_last && i > 0 && count - i <= (size_t)degree + 1)
            repeat = degree + 1;
        for (; repeat > 0 && i < count; repeat--)
            list[i++] = value;
        value += scale * draw_between(random, 0.05, 1);
    }
}

/* Draws until the knots are accepted, which the caller must free. */
static knot_vector draw_knots(draw *random, knot_kind kind, int degree)
{
    for (int attempt = 0; attempt < 1000; attempt++) {
        const size_t points = (size_t)degree + 1 + (size_t)draw_int(random, 0, MAX_POINTS - MAX_ORDER);
        double list[MAX_LIST];
        const bool is_list = kind == KNOTS_LIST || kind == KNOTS_CLOSED_LIST;
        const size_t count = points + (kind == KNOTS_LIST ? (size_t)degree + 1 : 1);
        if (is_list)
            draw_list(random, degree, count, list);
        knot_vector knots;
        if (!ffd_knots_make(kind, degree, points, is_list ? list : NULL, is_list ? count : 0, 'u', &knots,
                            NULL))
            return knots;
    }
    fail_msg("no valid knots of kind %d, degree %d in 1000 attempts", (int)kind, degree);
    abort();
}

/* A parameter of the domain: a knot, the number before one, an end, or anything. */
static double draw_parameter(draw *random, const knot_vector *knots)
{
    const double first = ffd_knots_first(knots), last = ffd_knots_last(knots);
    const double knot = knots->t[draw_int(random, knots->degree, (int)knots->functions)];
    switch (draw_int(random, 0, 5)) {
    case 0:
        return knot;
    case 1:
        return knot > first ? nextafter(knot, first) : first;
    case 2:
        return draw_int(random, 0, 1) ? first : last;
    default: {
        const double u = draw_between(random, first, last);
        return u < last ? u : last;
    }
    }
}

/* Calls check for knots of every kind and degree. */
static void for_all_knots(void (*check)(draw *random, const knot_vector *knots))
{
    draw random = {seed};
    for (rounds made = {0}; next_round(&made, 60, "knots of every kind and degree");)
        for (size_t kind = 0; kind < KIND_COUNT; kind++)
            for (int degree = 1; degree <= MAX_DEGREE; degree++) {
                knot_vector knots = draw_knots(&random, all_kinds[kind], degree);
                check(&random, &knots);
                ffd_knots_free(&knots);
            }
}

static void check_partition(draw *random, const knot_vector *knots)
{
    for (int i = 0; i < PARAMETERS; i++) {
        const double u = draw_parameter(random, knots);
        const int span = ffd_knots_span(knots, u);
        double value[MAX_ORDER], derivative[MAX_ORDER];
        ffd_basis_derivatives(knots, span, u, value, derivative);
        double sum = 0, slope = 0, slope_size = 0;
        for (int j = 0; j <= knots->degree; j++) {
            assert_true(value[j] >= 0);
            sum += value[j];
            slope += derivative[j];
            slope_size += fabs(derivative[j]);
        }
        assert_true(fabs(sum - 1) <= 8 * (knots->degree + 1) * EPS);
        assert_true(fabs(slope) <= 8 * (knots->degree + 1) * EPS * slope_size);
    }
}

static void basis_values_sum_to_one(void **state)
{
    (void)state;
    for_all_knots(check_partition);
}

static void check_recursion(draw *random, const knot_vector *knots)
{
    const int d = knots->degree;
    const double bound = 8 * (d + 1) * EPS;
    for (int n = 0; n < PARAMETERS / 3; n++) {
        const double u = draw_parameter(random, knots);
        const size_t span = reference_span(knots->t, knots->functions, d, u);
        assert_int_equal(ffd_knots_span(knots, u), span);
        double value[MAX_ORDER], derivative[MAX_ORDER];
        ffd_basis_derivatives(knots, (int)span, u, value, derivative);
        for (size_t i = 0; i < knots->functions; i++) {
            const bool here = i + (size_t)d >= span && i <= span;
            const size_t j = here ? i + (size_t)d - span : 0;
            const long double expected = reference_value(knots->t, span, i, d, u);
            long double rising, falling;
            reference_slopes(knots->t, span, i, d, u, &rising, &falling);
            if (!here) { /* local support: nothing that is not in the d + 1 values */
                assert_true(expected == 0 && rising == 0 && falling == 0);
                continue;
            }
            assert_true(fabsl(value[j] - expected) <= bound * expected);
            assert_true(fabsl(derivative[j] - (rising - falling)) <= bound * (rising + falling));
        }
    }
}

static void values_and_slopes_match_the_recursion(void **state)
{
    (void)state;
    for_all_knots(check_recursion);
}

/* Central differences inside one span; with h of its width the third derivative's part is below (2 d
 * h/width)^2. */
static void check_differences(draw *random, const knot_vector *knots)
{
    const int d = knots->degree;
    const int span = knots->spans[draw_int(random, 0, (int)knots->span_count - 1)];
    const double width = knots->t[span + 1] - knots->t[span];
    const double u = knots->t[span] + width * draw_between(random, 0.1, 0.9);
    const double below = u - 1e-5 * width, above = u + 1e-5 * width;
    double value[MAX_ORDER], derivative[MAX_ORDER], before[MAX_ORDER], after[MAX_ORDER];
    ffd_basis_derivatives(knots, span, u, value, derivative);
    ffd_basis_values(knots, span, below, before);
    ffd_basis_values(knots, span, above, after);
    for (int j = 0; j <= d; j++) {
        const double difference = (after[j] - before[j]) / (above - below);
        assert_true(fabs(difference - derivative[j]) <= 1e-6 * d / width);
    }
}

static void derivative_is_the_limit_of_differences(void **state)
{
    (void)state;
    for_all_knots(check_differences);
}

static void check_greville(draw *random, const knot_vector *knots)
{
    const int d = knots->degree;
    const double size = fmax(fabs(knots->t[0]), fabs(knots->t[knots->functions + (size_t)d]));
    for (size_t i = 0; i < knots->functions; i++) {
        const double g = ffd_knots_greville(knots, i);
        assert_true(knots->t[i + 1] <= g && g <= knots->t[i + (size_t)d]);
    }
    for (int n = 0; n < PARAMETERS; n++) {
        const double u = draw_parameter(random, knots);
        const int span = ffd_knots_span(knots, u);
        double value[MAX_ORDER], sum = 0;
        ffd_basis_values(knots, span, u, value);
        for (int j = 0; j <= d; j++)
            sum += value[j] * ffd_knots_greville(knots, (size_t)(span - d + j));
        assert_true(fabs(sum - u) <= 16 * (d + 1) * EPS * size);
    }
}

static void greville_points_reproduce_the_parameter(void **state)
{
    (void)state;
    for_all_knots(check_greville);
}

static long double de_casteljau(const long double *points, int degree, long double x)
{
    long double p[MAX_ORDER];
    memcpy(p, points, (size_t)(degree + 1) * sizeof *p);
    for (int level = degree; level > 0; level--)
        for (int i = 0; i < level; i++)
            p[i] = (1 - x) * p[i] + x * p[i + 1];
    return p[0];
}

/* The curve with random control values and its Bezier form agree all over every span, both ends included. */
static void check_bezier(draw *random, const knot_vector *knots)
{
    const int d = knots->degree;
    for (size_t s = 0; s < knots->span_count; s++) {
        const int span = knots->spans[s];
        double control[MAX_ORDER], matrix[MAX_ORDER * MAX_ORDER];
        long double bezier[MAX_ORDER];
        for (int j = 0; j <= d; j++)
            control[j] = draw_between(random, -1, 1);
        ffd_bezier_extraction(knots, span, matrix);
        for (int r = 0; r <= d; r++) {
            double sum = 0;
            bezier[r] = 0;
            for (int j = 0; j <= d; j++) {
                const double entry = matrix[r * (d + 1) + j];
                assert_true(entry >= 0);
                sum += entry;
                bezier[r] += (long double)entry * control[j];
            }
            assert_true(fabs(sum - 1) <= 8 * (d + 1) * EPS);
        }
        const double first = knots->t[span], last = knots->t[span + 1];
        for (int n = 0; n < 5; n++) {
            const double u = n == 0 ? first : n == 1 ? last : fmin(last, draw_between(random, first, last));
            double value[MAX_ORDER];
            long double expected = 0;
            ffd_basis_values(knots, span, u, value);
            for (int j = 0; j <= d; j++)
                expected += (long double)value[j] * control[j];
            const long double x = ((long double)u - first) / ((long double)last - first);
            assert_true(fabsl(de_casteljau(bezier, d, x) - expected) <= 16 * (d + 1) * EPS);
        }
    }
}

static void bezier_form_is_the_curve(void **state)
{
    (void)state;
    for_all_knots(check_bezier);
}

static void check_wrap(draw *random, const knot_vector *knots)
{
    const double first = ffd_knots_first(knots), last = ffd_knots_last(knots);
    const double size = fmax(fabs(first), fabs(last));
    const bool closed = ffd_knots_closed(knots);
    for (int n = 0; n < PARAMETERS; n++) {
        const double u = draw_parameter(random, knots);
        const double inside = ffd_knots_wrap(knots, u);
        if (!closed || u < last)
            assert_memory_equal(&inside, &u, sizeof u);
        else
            assert_true(inside == first);
        const double far = u + draw_int(random, -3, 3) * (last - first);
        const double back = ffd_knots_wrap(knots, far);
        assert_true(first <= back && (closed ? back < last : back <= last));
        assert_true(ffd_knots_wrap(knots, back) == back);
        if (closed) {
            const double gap = fabs(back - inside);
            assert_true(fmin(gap, last - first - gap) <= 32 * EPS * (size + (last - first)));
        } else {
            assert_true(back == fmin(fmax(far, first), last));
        }
    }
}

static void wrap_brings_parameters_into_the_domain(void **state)
{
    (void)state;
    for_all_knots(check_wrap);
}

/* Random control points and, half the time, weights within 1/4 .. 4. */
static void draw_points(draw *random, ffd_lattice *lattice)
{
    for (size_t i = 0; i < 3 * lattice->count; i++) {
        lattice->rest[i] = draw_between(random, -1, 1);
        lattice->deformed[i] = draw_between(random, -1, 1);
    }
    if (draw_int(random, 0, 1)) {
        lattice_add_weights(lattice);
        for (size_t i = 0; i < lattice->count; i++)
            lattice->rest_weights[i] = draw_between(random, 0.25, 4);
    }
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
}

static ffd_lattice *draw_lattice(draw *random)
{
    knot_vector knots[3];
    for (int a = 0; a < 3; a++)
        knots[a] = draw_knots(random, all_kinds[draw_int(random, 0, KIND_COUNT - 1)], draw_int(random, 1, 4));
    ffd_lattice *const lattice = lattice_of_knots(knots);
    draw_points(random, lattice);
    return lattice;
}

/* The triple sum over ALL basis functions, straight from src/maths.md 1, with the derivative in direction a
   (or none, a = 3) as a sum too: A and W in sum[0..2] and sum[3]. */
static void sum_all(const ffd_lattice *lattice, const double uvw[3], int a, long double sum[4])
{
    long double value[3][MAX_POINTS + MAX_ORDER];
    for (int b = 0; b < 3; b++) {
        const knot_vector *const knots = &lattice->knots[b];
        const size_t span = reference_span(knots->t, knots->functions, knots->degree, uvw[b]);
        for (size_t i = 0; i < knots->functions; i++) {
            long double rising, falling;
            reference_slopes(knots->t, span, i, knots->degree, uvw[b], &rising, &falling);
            value[b][i] =
                a == b ? rising - falling : reference_value(knots->t, span, i, knots->degree, uvw[b]);
        }
    }
    memset(sum, 0, 4 * sizeof *sum);
    for (size_t k = 0; k < lattice->knots[2].functions; k++)
        for (size_t j = 0; j < lattice->knots[1].functions; j++)
            for (size_t i = 0; i < lattice->knots[0].functions; i++) {
                const size_t point =
                    lattice_index(lattice, i % lattice->size[0], j % lattice->size[1], k % lattice->size[2]);
                const long double h = lattice->rest_weights ? lattice->rest_weights[point] : 1;
                const long double term = h * value[0][i] * value[1][j] * value[2][k];
                for (int c = 0; c < 3; c++)
                    sum[c] += term * lattice->rest[3 * point + (size_t)c];
                sum[3] += term;
            }
}

static void check_against_sums(const ffd_lattice *lattice, const double uvw[3])
{
    double point[3], jacobian[9];
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, jacobian);
    long double homogeneous[4], slope[4];
    sum_all(lattice, uvw, 3, homogeneous);
    for (int a = 0; a < 3; a++) {
        sum_all(lattice, uvw, a, slope);
        const knot_vector *const knots = &lattice->knots[a];
        const int span = ffd_knots_span(knots, uvw[a]);
        /* N' is at most d over the width of the span, and so are C_u's terms up to the ratio of weights. */
        const double steepest = knots->degree / (knots->t[span + 1] - knots->t[span]);
        for (int c = 0; c < 3; c++) {
            const long double expected = homogeneous[c] / homogeneous[3];
            assert_true(fabsl(point[c] - expected) <= 256 * EPS);
            const long double expected_slope = (slope[c] - expected * slope[3]) / homogeneous[3];
            assert_true(fabsl(jacobian[3 * c + a] - expected_slope) <= 4096 * EPS * steepest);
        }
    }
}

static void volume_is_the_sum_over_control_points(void **state)
{
    (void)state;
    draw random = {seed + 1};
    for (rounds made = {0}; next_round(&made, 30, __func__);) {
        ffd_lattice *lattice = draw_lattice(&random);
        for (int n = 0; n < 4; n++) {
            double uvw[3];
            for (int a = 0; a < 3; a++)
                uvw[a] = ffd_knots_wrap(&lattice->knots[a], draw_parameter(&random, &lattice->knots[a]));
            check_against_sums(lattice, uvw);
        }
        ffd_lattice_destroy(&lattice);
    }
}

/* The same volume with every closed direction written out: an open list of its extended knots, and its first
   d layers of control points once more at the end. */
static ffd_lattice *unroll(const ffd_lattice *lattice)
{
    knot_vector knots[3];
    for (int a = 0; a < 3; a++) {
        const knot_vector *const k = &lattice->knots[a];
        const size_t count = k->functions + (size_t)k->degree + 1;
        ffd_error error;
        if (ffd_knots_make(KNOTS_LIST, k->degree, k->functions, k->t, count, "uvw"[a], &knots[a], &error))
            fail_msg("%s", error.message);
    }
    ffd_lattice *const open = lattice_of_knots(knots);
    if (lattice->rest_weights)
        lattice_add_weights(open);
    for (size_t k = 0, to = 0; k < open->size[2]; k++)
        for (size_t j = 0; j < open->size[1]; j++)
            for (size_t i = 0; i < open->size[0]; i++, to++) {
                const size_t from =
                    lattice_index(lattice, i % lattice->size[0], j % lattice->size[1], k % lattice->size[2]);
                memcpy(open->rest + 3 * to, lattice->rest + 3 * from, 3 * sizeof(double));
                if (lattice->rest_weights)
                    open->rest_weights[to] = lattice->rest_weights[from];
            }
    assert_int_equal(finish_by_hand(open, NULL), FFD_OK);
    return open;
}

static void closed_is_open_with_points_appended(void **state)
{
    (void)state;
    draw random = {seed + 2};
    for (rounds made = {0}; next_round(&made, 30, __func__);) {
        knot_vector knots[3];
        for (int a = 0; a < 3; a++)
            knots[a] = draw_knots(&random, draw_int(&random, 0, 1) ? KNOTS_CLOSED : KNOTS_CLOSED_LIST,
                                  draw_int(&random, 1, 5));
        ffd_lattice *closed = lattice_of_knots(knots);
        draw_points(&random, closed);
        ffd_lattice *open = unroll(closed);
        for (int n = 0; n < PARAMETERS; n++) {
            double uvw[3], point[3], jacobian[9], open_point[3], open_jacobian[9];
            bool at_end = false;
            for (int a = 0; a < 3; a++) {
                uvw[a] = draw_parameter(&random, &knots[a]);
                at_end |= uvw[a] == ffd_knots_last(&knots[a]);
            }
            ffd_lattice_evaluate(closed, FFD_VOLUME_REST, uvw, point, jacobian);
            ffd_lattice_evaluate(open, FFD_VOLUME_REST, uvw, open_point, open_jacobian);
            if (at_end) { /* the closed one has gone on to its start, where the volume joins */
                for (int c = 0; c < 3; c++)
                    assert_true(fabs(point[c] - open_point[c]) <= 1024 * EPS);
                continue;
            }
            assert_memory_equal(point, open_point, sizeof point);
            assert_memory_equal(jacobian, open_jacobian, sizeof jacobian);
        }
        ffd_lattice_destroy(&open);
        ffd_lattice_destroy(&closed);
    }
}

/* An affine map of all control points maps the volume. */
static void an_affine_map_of_points_maps_the_volume(void **state)
{
    (void)state;
    draw random = {seed + 3};
    for (rounds made = {0}; next_round(&made, 30, __func__);) {
        ffd_lattice *lattice = draw_lattice(&random);
        double m[9], offset[3];
        for (int i = 0; i < 9; i++)
            m[i] = draw_between(&random, -1, 1);
        for (int i = 0; i < 3; i++)
            offset[i] = draw_between(&random, -1, 1);
        for (size_t i = 0; i < lattice->count; i++) {
            const double *const p = lattice->rest + 3 * i;
            for (size_t r = 0; r < 3; r++)
                lattice->deformed[3 * i + r] =
                    m[3 * r] * p[0] + m[3 * r + 1] * p[1] + m[3 * r + 2] * p[2] + offset[r];
            if (lattice->rest_weights)
                lattice->deformed_weights[i] = lattice->rest_weights[i];
        }
        double uvw[3], p[3], q[3];
        for (int a = 0; a < 3; a++)
            uvw[a] = draw_parameter(&random, &lattice->knots[a]);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_DEFORMED, uvw, q, NULL);
        for (int r = 0; r < 3; r++) {
            const double expected = m[3 * r] * p[0] + m[3 * r + 1] * p[1] + m[3 * r + 2] * p[2] + offset[r];
            assert_true(fabs(q[r] - expected) <= 1024 * EPS);
        }
        ffd_lattice_destroy(&lattice);
    }
}

/* A control point outside the d + 1 functions of each direction changes no bit; one inside does (it is moved
   so far that no small value of its function hides it). */
static void a_control_point_acts_only_on_its_spans(void **state)
{
    (void)state;
    draw random = {seed + 4};
    int changed = 0, kept = 0;
    for (rounds made = {0}; next_round(&made, 200, __func__);) {
        ffd_lattice *lattice = draw_lattice(&random);
        double uvw[3], before[3], after[3];
        bool inside = true;
        size_t at[3];
        for (int a = 0; a < 3; a++) {
            const knot_vector *const knots = &lattice->knots[a];
            uvw[a] =
                ffd_knots_wrap(knots, draw_between(&random, ffd_knots_first(knots), ffd_knots_last(knots)));
            at[a] = (size_t)draw_int(&random, 0, (int)knots->points - 1);
            const int last = ffd_knots_span(knots, uvw[a]);
            bool found = false;
            for (int i = last - knots->degree; i <= last; i++)
                found |= (size_t)i % knots->points == at[a];
            inside &= found;
        }
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, before, NULL);
        lattice->rest[3 * lattice_index(lattice, at[0], at[1], at[2])] += 1e200;
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, after, NULL);
        assert_int_equal(memcmp(before, after, sizeof before) != 0, inside);
        changed += inside;
        kept += !inside;
        ffd_lattice_destroy(&lattice);
    }
    assert_true(changed > 0 && kept > 0);
}

int main(void)
{
    seed = draw_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(basis_values_sum_to_one),
        cmocka_unit_test(values_and_slopes_match_the_recursion),
        cmocka_unit_test(derivative_is_the_limit_of_differences),
        cmocka_unit_test(greville_points_reproduce_the_parameter),
        cmocka_unit_test(bezier_form_is_the_curve),
        cmocka_unit_test(wrap_brings_parameters_into_the_domain),
        cmocka_unit_test(volume_is_the_sum_over_control_points),
        cmocka_unit_test(closed_is_open_with_points_appended),
        cmocka_unit_test(an_affine_map_of_points_maps_the_volume),
        cmocka_unit_test(a_control_point_acts_only_on_its_spans),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
