/* Basis functions: known values and slopes, exact ends, the recursion, extraction of the Bezier form. */
#include "../support/bspline_reference.h"
#include "spline/basis.h"
#include "spline/bezier.h"
#include "spline/knots.h"
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static knot_vector make_list(int degree, size_t points, const double *list)
{
    knot_vector knots;
    assert_int_equal(
        ffd_knots_make(KNOTS_LIST, degree, points, list, points + (size_t)degree + 1, 'u', &knots, NULL),
        FFD_OK);
    return knots;
}

static knot_vector make(knot_kind kind, int degree, size_t points)
{
    knot_vector knots;
    assert_int_equal(ffd_knots_make(kind, degree, points, NULL, 0, 'u', &knots, NULL), FFD_OK);
    return knots;
}

static void check_values(const double *values, const double *expected, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs(values[i] - expected[i]) <= 4 * DBL_EPSILON))
            fail_msg("entry %zu is %.17g, expected %.17g", i, values[i], expected[i]);
}

/* With a single clamped span the functions are Bernstein polynomials: binomial(9, i) / 2^9 in the middle. */
static void one_clamped_span_is_bernstein(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_CLAMPED, 9, 10);
    double value[MAX_ORDER], derivative[MAX_ORDER];
    ffd_basis_derivatives(&knots, 9, 0.5, value, derivative);
    const double binomials[] = {1, 9, 36, 84, 126, 126, 84, 36, 9, 1};
    const double slopes[] = {-9,  -63, -180, -252, -126,
                             126, 252, 180,  63,   9}; /* 9 (B_{i-1,8} - B_{i,8}), times 256 */
    for (int i = 0; i < 10; i++) {
        assert_true(value[i] == binomials[i] / 512);
        assert_true(derivative[i] == slopes[i] / 256);
    }
    ffd_knots_free(&knots);
}

/* Values of the uniform cubic: (1, 4, 1, 0)/6 at a knot, (1, 23, 23, 1)/48 midway between two. */
static void the_uniform_cubic_has_its_known_values(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_OPEN, 3, 8);
    double value[MAX_ORDER], derivative[MAX_ORDER];
    ffd_basis_derivatives(&knots, ffd_knots_span(&knots, 0.4), 0.4, value, derivative);
    check_values(value, (const double[]){1 / 6.0, 4 / 6.0, 1 / 6.0, 0}, 4);
    for (int i = 0; i < 4; i++)
        assert_true(fabs(derivative[i] - (const double[]){-2.5, 0, 2.5, 0}[i]) < 1e-14);
    ffd_basis_values(&knots, ffd_knots_span(&knots, 0.5), 0.5, value);
    check_values(value, (const double[]){1 / 48.0, 23 / 48.0, 23 / 48.0, 1 / 48.0}, 4);
    ffd_knots_free(&knots);
}

/* Degree 1 is not a special case: the slopes are +1/width and -1/width, right-hand ones at an inner knot,
   left-hand ones at the end of the domain. */
static void slopes_at_degree_one_are_one_sided_at_knots(void **state)
{
    (void)state;
    const double list[] = {0, 0, 0.5, 2, 2};
    knot_vector knots = make_list(1, 3, list);
    double value[MAX_ORDER], derivative[MAX_ORDER];
    ffd_basis_derivatives(&knots, ffd_knots_span(&knots, 0.25), 0.25, value, derivative);
    check_values(value, (const double[]){0.5, 0.5}, 2);
    check_values(derivative, (const double[]){-2, 2}, 2);
    assert_int_equal(ffd_knots_span(&knots, 0.5), 2);
    ffd_basis_derivatives(&knots, 2, 0.5, value, derivative);
    check_values(value, (const double[]){1, 0}, 2);
    check_values(derivative, (const double[]){-1 / 1.5, 1 / 1.5}, 2);
    ffd_basis_derivatives(&knots, ffd_knots_span(&knots, 2), 2, value, derivative);
    check_values(value, (const double[]){0, 1}, 2);
    check_values(derivative, (const double[]){-1 / 1.5, 1 / 1.5}, 2);
    ffd_knots_free(&knots);
}

/* Clamped ends are interpolated exactly, whatever the inner knots. */
static void clamped_ends_are_exact(void **state)
{
    (void)state;
    for (int degree = 1; degree <= MAX_DEGREE; degree++)
        for (size_t points = (size_t)degree + 1; points < 60; points++) {
            knot_vector knots = make(KNOTS_CLAMPED, degree, points);
            double value[MAX_ORDER];
            ffd_basis_values(&knots, ffd_knots_span(&knots, 0), 0, value);
            for (int i = 0; i <= degree; i++)
                assert_true(value[i] == (i == 0));
            ffd_basis_values(&knots, ffd_knots_span(&knots, 1), 1, value);
            for (int i = 0; i <= degree; i++)
                assert_true(value[i] == (i == degree));
            ffd_knots_free(&knots);
        }
}

/* Multiplicity d+1 at the start, d inside, d+1 at the end, uneven: the control point at the inner knot is
   interpolated. */
static void a_knot_repeated_d_times_meets_its_control_point(void **state)
{
    (void)state;
    const double list[] = {-3, -3, -3, -3, 0.1, 0.1, 0.1, 7, 7, 7, 7};
    knot_vector knots = make_list(3, 7, list);
    double value[MAX_ORDER], derivative[MAX_ORDER];
    assert_int_equal(ffd_knots_span(&knots, nextafter(0.1, -1)), 3);
    assert_int_equal(ffd_knots_span(&knots, 0.1), 6);
    ffd_basis_derivatives(&knots, 6, 0.1, value, derivative);
    for (int i = 0; i < 4; i++)
        assert_true(value[i] == (i == 0));
    check_values(derivative, (const double[]){-3 / 6.9, 3 / 6.9, 0, 0}, 4);
    ffd_basis_derivatives(&knots, 3, 0.1, value, derivative); /* the limit from the left */
    for (int i = 0; i < 4; i++)
        assert_true(value[i] == (i == 3));
    check_values(derivative, (const double[]){0, 0, -3 / 3.1, 3 / 3.1}, 4);
    ffd_basis_derivatives(&knots, 6, 7, value, derivative);
    for (int i = 0; i < 4; i++)
        assert_true(value[i] == (i == 3));
    ffd_knots_free(&knots);
}

/* An end knot of multiplicity d+1, but one place too far inside: the first control point has no effect, the
   second one is interpolated. */
static void a_shifted_clamp_meets_the_second_control_point(void **state)
{
    (void)state;
    const double list[] = {-1, 0, 0, 0, 1, 2, 3};
    knot_vector knots = make_list(2, 4, list);
    const int span = ffd_knots_span(&knots, 0);
    assert_int_equal(span, 3);
    double value[MAX_ORDER];
    ffd_basis_values(&knots, span, 0, value);
    check_values(value, (const double[]){1, 0, 0}, 3);
    ffd_knots_free(&knots);
}

static void values_alone_are_the_same_bits(void **state)
{
    (void)state;
    for (int degree = 1; degree <= MAX_DEGREE; degree++) {
        knot_vector knots = make(KNOTS_UNIFORM, degree, 17);
        const double first = ffd_knots_first(&knots), last = ffd_knots_last(&knots);
        for (int i = 0; i <= 50; i++) {
            const double u = ffd_knots_wrap(&knots, first + (last - first) * (i / 50.0));
            const int span = ffd_knots_span(&knots, u);
            double value[MAX_ORDER], again[MAX_ORDER], derivative[MAX_ORDER];
            ffd_basis_values(&knots, span, u, value);
            ffd_basis_derivatives(&knots, span, u, again, derivative);
            for (int j = 0; j <= degree; j++)
                assert_true(value[j] == again[j]);
        }
        ffd_knots_free(&knots);
    }
}

/* Compared with the recursion, for every preset and degree, at knots and between them. */
static void values_and_slopes_are_those_of_the_recursion(void **state)
{
    (void)state;
    const knot_kind kinds[] = {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_UNIFORM, KNOTS_CLOSED};
    for (size_t k = 0; k < COUNT(kinds); k++)
        for (int degree = 1; degree <= MAX_DEGREE; degree++) {
            knot_vector knots = make(kinds[k], degree, (size_t)degree + 3);
            for (size_t s = (size_t)degree; s <= 4 * knots.functions; s++) {
                const double u = s <= knots.functions
                                     ? knots.t[s]
                                     : ffd_knots_wrap(&knots, (double)s / (4 * (double)knots.functions));
                const int span = ffd_knots_span(&knots, u);
                assert_int_equal(span, reference_span(knots.t, knots.functions, degree, u));
                double value[MAX_ORDER], derivative[MAX_ORDER];
                ffd_basis_derivatives(&knots, span, u, value, derivative);
                for (int j = 0; j <= degree; j++) {
                    const size_t i = (size_t)(span - degree + j);
                    const long double expected = reference_value(knots.t, (size_t)span, i, degree, u);
                    assert_true(fabsl(value[j] - expected) <= 8 * (degree + 1) * DBL_EPSILON * expected);
                    long double rising, falling;
                    reference_slopes(knots.t, (size_t)span, i, degree, u, &rising, &falling);
                    assert_true(fabsl(derivative[j] - (rising - falling)) <=
                                8 * (degree + 1) * DBL_EPSILON * (rising + falling));
                }
            }
            ffd_knots_free(&knots);
        }
}

/* The clamped cubic, first of two spans: knot insertion by hand (Boehm). */
static void extraction_of_two_spans_is_knot_insertion(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_CLAMPED, 3, 5);
    double matrix[MAX_ORDER * MAX_ORDER];
    ffd_bezier_extraction(&knots, 3, matrix);
    check_values(matrix, (const double[]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0, 0.25, 0.5, 0.25}, 16);
    ffd_bezier_extraction(&knots, 4, matrix);
    check_values(matrix, (const double[]){0.25, 0.5, 0.25, 0, 0, 0.5, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 16);
    ffd_knots_free(&knots);
}

static void extraction_of_the_uniform_cubic_is_the_known_one(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_UNIFORM, 3, 9);
    double matrix[MAX_ORDER * MAX_ORDER];
    ffd_bezier_extraction(&knots, 5, matrix);
    check_values(matrix,
                 (const double[]){1 / 6.0, 4 / 6.0, 1 / 6.0, 0, 0, 4 / 6.0, 2 / 6.0, 0, 0, 2 / 6.0, 4 / 6.0,
                                  0, 0, 1 / 6.0, 4 / 6.0, 1 / 6.0},
                 16);
    ffd_knots_free(&knots);
}

static void extraction_of_one_span_is_the_identity(void **state)
{
    (void)state;
    for (int degree = 1; degree <= MAX_DEGREE; degree++) {
        knot_vector knots = make(KNOTS_CLAMPED, degree, (size_t)degree + 1);
        double matrix[MAX_ORDER * MAX_ORDER];
        ffd_bezier_extraction(&knots, degree, matrix);
        for (int r = 0; r <= degree; r++)
            for (int c = 0; c <= degree; c++)
                assert_true(matrix[r * (degree + 1) + c] == (r == c));
        ffd_knots_free(&knots);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_clamped_span_is_bernstein),
        cmocka_unit_test(the_uniform_cubic_has_its_known_values),
        cmocka_unit_test(slopes_at_degree_one_are_one_sided_at_knots),
        cmocka_unit_test(clamped_ends_are_exact),
        cmocka_unit_test(a_knot_repeated_d_times_meets_its_control_point),
        cmocka_unit_test(a_shifted_clamp_meets_the_second_control_point),
        cmocka_unit_test(values_alone_are_the_same_bits),
        cmocka_unit_test(values_and_slopes_are_those_of_the_recursion),
        cmocka_unit_test(extraction_of_two_spans_is_knot_insertion),
        cmocka_unit_test(extraction_of_the_uniform_cubic_is_the_known_one),
        cmocka_unit_test(extraction_of_one_span_is_the_identity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
