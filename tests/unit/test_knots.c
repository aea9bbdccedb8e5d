/* Knot vectors: presets and lists, spans, Greville abscissae, refusals. */
#include "../support/repetitions.h"
#include "base/memory/memory.h"
#include "spline/knots.h"
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static void check_same(const double *t, const double *expected, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (t[i] != expected[i])
            fail_msg("knot %zu is %.17g, expected %.17g", i, t[i], expected[i]);
}

static knot_vector make(knot_kind kind, int degree, size_t points)
{
    knot_vector knots;
    assert_int_equal(ffd_knots_make(kind, degree, points, NULL, 0, 'u', &knots, NULL), FFD_OK);
    return knots;
}

static knot_vector make_list(knot_kind kind, int degree, size_t points, const double *list, size_t count)
{
    knot_vector knots;
    assert_int_equal(ffd_knots_make(kind, degree, points, list, count, 'u', &knots, NULL), FFD_OK);
    return knots;
}

static void clamped_knots_repeat_at_both_ends(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_CLAMPED, 3, 6);
    check_same(knots.t, (const double[]){0, 0, 0, 0, 1 / 3.0, 2 / 3.0, 1, 1, 1, 1}, 10);
    assert_int_equal(knots.functions, 6);
    assert_int_equal(knots.span_count, 3);
    assert_int_equal(knots.spans[0], 3);
    assert_int_equal(knots.spans[2], 5);
    ffd_knots_free(&knots);
    assert_null(knots.t);
    ffd_knots_free(&knots);
}

static void open_knots_run_on_evenly_beyond_the_domain(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_OPEN, 2, 5);
    check_same(knots.t, (const double[]){-2 / 3.0, -1 / 3.0, 0, 1 / 3.0, 2 / 3.0, 1, 4 / 3.0, 5 / 3.0}, 8);
    ffd_knots_free(&knots);
}

static void uniform_knots_divide_zero_to_one(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_UNIFORM, 3, 7);
    for (int i = 0; i <= 10; i++)
        assert_true(knots.t[i] == i / 10.0);
    assert_true(ffd_knots_first(&knots) == 0.3);
    assert_true(ffd_knots_last(&knots) == 0.7);
    ffd_knots_free(&knots);
}

static void closed_knots_reuse_the_first_control_points(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_CLOSED, 3, 4);
    check_same(knots.t, (const double[]){-.75, -.5, -.25, 0, .25, .5, .75, 1, 1.25, 1.5, 1.75}, 11);
    assert_int_equal(knots.functions, 7);
    assert_int_equal(knots.span_count, 4);
    const size_t points[] = {0, 1, 2, 3, 0, 1, 2};
    for (size_t i = 0; i < 7; i++)
        assert_int_equal(ffd_knots_point(&knots, i), points[i]);
    ffd_knots_free(&knots);
}

static void a_closed_list_repeats_its_period(void **state)
{
    (void)state;
    const double list[] = {10, 11, 11, 14, 18};
    knot_vector knots = make_list(KNOTS_CLOSED_LIST, 2, 4, list, COUNT(list));
    check_same(knots.t, (const double[]){3, 6, 10, 11, 11, 14, 18, 19, 19}, 9);
    assert_int_equal(knots.span_count, 3);
    assert_true(ffd_knots_first(&knots) == 10 && ffd_knots_last(&knots) == 18);
    ffd_knots_free(&knots);

    /* A preset equals the list of its knots. */
    const double fifths[] = {0, 1 / 5.0, 2 / 5.0, 3 / 5.0, 4 / 5.0, 1};
    knots = make_list(KNOTS_CLOSED_LIST, 4, 5, fifths, COUNT(fifths));
    knot_vector preset = make(KNOTS_CLOSED, 4, 5);
    check_same(preset.t, knots.t, 14);
    ffd_knots_free(&preset);
    ffd_knots_free(&knots);
}

static void presets_have_exact_domain_ends(void **state)
{
    (void)state;
    for (int degree = 1; degree <= MAX_DEGREE; degree++)
        for (size_t points = (size_t)degree + 1; points < 200; points += (size_t)stride(7)) {
            const knot_kind unit_kinds[] = {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_CLOSED};
            for (size_t k = 0; k < COUNT(unit_kinds); k++) {
                knot_vector knots = make(unit_kinds[k], degree, points);
                assert_true(ffd_knots_first(&knots) == 0);
                assert_true(ffd_knots_last(&knots) == 1);
                assert_int_equal(knots.span_count, k == 2 ? points : points - (size_t)degree);
                ffd_knots_free(&knots);
            }
            knot_vector knots = make(KNOTS_UNIFORM, degree, points);
            assert_true(ffd_knots_first(&knots) == degree / (double)(points + (size_t)degree));
            assert_true(ffd_knots_last(&knots) == points / (double)(points + (size_t)degree));
            assert_true(knots.t[0] == 0 && knots.t[points + (size_t)degree] == 1);
            ffd_knots_free(&knots);
        }
}

static void repeated_knots_bound_no_empty_span(void **state)
{
    (void)state;
    /* Multiplicity d+1 from index 1 on, d inside, d at the end. */
    const double list[] = {-1, 0, 0, 0, 0.5, 0.5, 2, 2, 3};
    knot_vector knots = make_list(KNOTS_LIST, 2, 6, list, COUNT(list));
    assert_int_equal(knots.span_count, 2);
    assert_int_equal(knots.spans[0], 3);
    assert_int_equal(knots.spans[1], 5);
    assert_int_equal(ffd_knots_span(&knots, 0), 3);
    assert_int_equal(ffd_knots_span(&knots, 0.49), 3);
    assert_int_equal(ffd_knots_span(&knots, 0.5), 5);
    assert_int_equal(ffd_knots_span(&knots, 2), 5);
    ffd_knots_free(&knots);
}

static void a_knot_belongs_to_the_span_it_begins(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_CLAMPED, 3, 7);
    assert_int_equal(ffd_knots_span(&knots, 0), 3);
    assert_int_equal(ffd_knots_span(&knots, nextafter(0.25, 0)), 3);
    assert_int_equal(ffd_knots_span(&knots, 0.25), 4);
    assert_int_equal(ffd_knots_span(&knots, 0.75), 6);
    assert_int_equal(ffd_knots_span(&knots, 1), 6);
    assert_int_equal(ffd_knots_span(&knots, -5), 3);
    assert_int_equal(ffd_knots_span(&knots, 5), 6);
    assert_in_range(ffd_knots_span(&knots, NAN), 3, 6);
    ffd_knots_free(&knots);
}

static void parameters_are_clamped_or_go_round(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_UNIFORM, 3, 7);
    assert_true(ffd_knots_wrap(&knots, 0.1) == 0.3);
    assert_true(ffd_knots_wrap(&knots, 0.9) == 0.7);
    assert_true(ffd_knots_wrap(&knots, INFINITY) == 0.7);
    assert_true(ffd_knots_wrap(&knots, -INFINITY) == 0.3);
    assert_true(ffd_knots_wrap(&knots, 0.7) == 0.7);
    assert_true(isnan(ffd_knots_wrap(&knots, NAN)));
    ffd_knots_free(&knots);

    knots = make(KNOTS_CLOSED, 3, 7);
    assert_true(ffd_knots_wrap(&knots, 1) == 0);
    assert_true(ffd_knots_wrap(&knots, 0) == 0);
    assert_true(ffd_knots_wrap(&knots, nextafter(1, 0)) == nextafter(1, 0));
    assert_true(ffd_knots_wrap(&knots, 1.25) == 0.25);
    assert_true(ffd_knots_wrap(&knots, -0.25) == 0.75);
    assert_true(ffd_knots_wrap(&knots, 1e6 + 0.5) == 0.5);
    assert_true(ffd_knots_wrap(&knots, -1e-30) ==
                0); /* 1 - 1e-30 rounds to the end, which is also the start */
    assert_true(isnan(ffd_knots_wrap(&knots, NAN)));
    ffd_knots_free(&knots);

    const double list[] = {10, 11, 12, 14};
    knots = make_list(KNOTS_CLOSED_LIST, 2, 3, list, COUNT(list));
    assert_true(ffd_knots_wrap(&knots, 14) == 10);
    assert_true(ffd_knots_wrap(&knots, 3) == 11);
    assert_true(ffd_knots_wrap(&knots, 19.5) == 11.5);
    ffd_knots_free(&knots);
}

static void greville_abscissae_of_equal_knots_are_exact(void **state)
{
    (void)state;
    knot_vector knots = make(KNOTS_CLAMPED, 3, 5);
    const double expected[] = {0, 1 / 6.0, 0.5, 5 / 6.0, 1};
    for (size_t i = 0; i < 5; i++)
        assert_true(fabs(ffd_knots_greville(&knots, i) - expected[i]) <= DBL_EPSILON / 2);
    assert_true(ffd_knots_greville(&knots, 0) == 0 && ffd_knots_greville(&knots, 4) == 1);
    ffd_knots_free(&knots);

    /* (0.1 + 0.1 + 0.1)/3 is not 0.1 in double: equal knots must still give exactly themselves. */
    const double list[] = {0.1, 0.1, 0.1, 0.1, 0.7, 0.7, 0.7, 0.7};
    knots = make_list(KNOTS_LIST, 3, 4, list, COUNT(list));
    assert_true(ffd_knots_greville(&knots, 0) == 0.1);
    assert_true(ffd_knots_greville(&knots, 3) == 0.7);
    ffd_knots_free(&knots);
}

typedef struct refusal {
    knot_kind kind;
    int degree;
    size_t points;
    size_t count;
    double list[12];
    ffd_status status;
    const char *message;
} refusal;

static const refusal refusals[] = {
    {KNOTS_CLAMPED,
     0,
     4,
     0,
     {0},
     FFD_E_INVALID,
     "direction v: degree 0 is not between 1 and 14: degree 1 between two layers that move alike does the "
     "same"},
    {KNOTS_CLAMPED, -3, 4, 0, {0}, FFD_E_INVALID, "direction v: degree -3 is not between 1 and 14"},
    {KNOTS_OPEN,
     15,
     40,
     0,
     {0},
     FFD_E_INVALID,
     "direction v: degree 15 is not between 1 and 14: as many control points of a lower degree each move a "
     "smaller part"},
    {KNOTS_CLAMPED,
     3,
     3,
     0,
     {0},
     FFD_E_INVALID,
     "direction v: 3 control points, but degree 3 needs at least 4"},
    {KNOTS_UNIFORM,
     1,
     0,
     0,
     {0},
     FFD_E_INVALID,
     "direction v: 0 control points, but degree 1 needs at least 2"},
    {KNOTS_CLOSED,
     3,
     3,
     0,
     {0},
     FFD_E_INVALID,
     "direction v: 3 control points, but degree 3 needs at least 4"},
    {KNOTS_OPEN,
     3,
     SIZE_MAX,
     0,
     {0},
     FFD_E_LIMIT,
     SIZE_MAX > UINT32_MAX ? "direction v: 18446744073709551615 control points are too many"
                           : "direction v: 4294967295 control points are too many"},
    {KNOTS_LIST,
     2,
     3,
     5,
     {0, 0, 0, 1, 1},
     FFD_E_INVALID,
     "direction v: 5 knots, but 3 control points of degree 2 need 6"},
    {KNOTS_CLOSED_LIST,
     2,
     3,
     5,
     {0, 1, 2, 3, 4},
     FFD_E_INVALID,
     "direction v: 5 breakpoints, but 3 control points need 4 in one period"},
    {KNOTS_LIST,
     2,
     4,
     7,
     {0, 0, 0, 0.1, 0.25, 0.2, 1},
     FFD_E_INVALID,
     "direction v: knot 5 is 0.2, less than knot 4, 0.25"},
    {KNOTS_CLOSED_LIST,
     2,
     3,
     4,
     {0, 2, 1, 3},
     FFD_E_INVALID,
     "direction v: breakpoint 2 is 1, less than breakpoint 1, 2"},
    {KNOTS_LIST,
     1,
     2,
     4,
     {0, 0, 1, INFINITY},
     FFD_E_INVALID,
     "direction v: knot 3 is inf, not a finite number"},
    {KNOTS_LIST,
     1,
     2,
     4,
     {-INFINITY, 0, 1, 2},
     FFD_E_INVALID,
     "direction v: knot 0 is -inf, not a finite number"},
    {KNOTS_LIST, 1, 2, 4, {0, NAN, 1, 2}, FFD_E_INVALID, "direction v: knot 1 is nan, not a finite number"},
    {KNOTS_CLOSED_LIST,
     1,
     2,
     3,
     {0, NAN, 1},
     FFD_E_INVALID,
     "direction v: breakpoint 1 is nan, not a finite number"},
    {KNOTS_LIST,
     2,
     4,
     7,
     {-1, -0.5, 0.5, 0.5, 0.5, 2, 3},
     FFD_E_INVALID,
     "direction v: the domain is empty, knot 2 and knot 4 are both 0.5"},
    {KNOTS_CLOSED_LIST,
     2,
     3,
     4,
     {7, 7, 7, 7},
     FFD_E_INVALID,
     "direction v: the domain is empty, breakpoint 0 and breakpoint 3 are both 7"},
    {KNOTS_LIST,
     2,
     6,
     9,
     {0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1},
     FFD_E_INVALID,
     "direction v: knots 3 to 5 are all 0.5, 3 times, but degree 2 allows 2 inside the domain"},
    {KNOTS_LIST,
     2,
     5,
     8,
     {0, 0, 0, 0, 0.5, 1, 1, 1},
     FFD_E_INVALID,
     "direction v: knots 0 to 3 are all 0, 4 times, but degree 2 allows 3 at an end of the domain"},
    {KNOTS_LIST,
     2,
     5,
     8,
     {0, 0, 0, 0.5, 1, 1, 1, 1},
     FFD_E_INVALID,
     "direction v: knots 4 to 7 are all 1, 4 times, but degree 2 allows 3 at an end of the domain"},
    {KNOTS_CLOSED_LIST,
     2,
     6,
     7,
     {0, 1, 2, 2, 2, 3, 4},
     FFD_E_INVALID,
     "direction v: breakpoints 2 to 4 are all 2, 3 times, but degree 2 allows 2 inside the domain"},
    {KNOTS_CLOSED_LIST,
     2,
     4,
     5,
     {0, 0, 1, 4, 4},
     FFD_E_INVALID,
     "direction v: the breakpoints at the seam, 0 and 4, meet there 3 times, but degree 2 allows 2"},
    {KNOTS_LIST,
     1,
     3,
     5,
     {-1.5e308, 0, 1, 2, 1.5e308},
     FFD_E_INVALID,
     "direction v: the knots reach from -1.5e+308 to 1.5e+308, too far to compute with"},
    {KNOTS_CLOSED_LIST,
     1,
     2,
     3,
     {-1.5e308, 0, 1.5e308},
     FFD_E_INVALID,
     "direction v: the breakpoints reach from -1.5e+308 to 1.5e+308, too far to compute with"},
    {KNOTS_LIST,
     1,
     3,
     5,
     {0, 0, 1e-310, 1, 1},
     FFD_E_INVALID,
     "direction v: knots 1 and 2, 0 and 1e-310, are too close"},
    {KNOTS_CLOSED_LIST,
     2,
     3,
     4,
     {0, 1e-310, 1, 2},
     FFD_E_INVALID,
     "direction v: breakpoints 0 and 1, 0 and 1e-310, are too close"},
};

static void broken_knots_are_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(refusals); i++) {
        const refusal *const r = &refusals[i];
        knot_vector knots;
        ffd_error error = {0};
        const double *const list = r->count ? r->list : NULL;
        const ffd_status status =
            ffd_knots_make(r->kind, r->degree, r->points, list, r->count, 'v', &knots, &error);
        if (status != r->status || strcmp(error.message, r->message))
            fail_msg("case %zu: status %d, message \"%s\", expected \"%s\"", i, status, error.message,
                     r->message);
        assert_int_equal(error.status, r->status);
        assert_null(knots.t);
        assert_null(knots.spans);
        /* Refused without an error record too. */
        assert_int_equal(ffd_knots_make(r->kind, r->degree, r->points, list, r->count, 'v', &knots, NULL),
                         r->status);
    }
}

static void each_failed_allocation_is_reported(void **state)
{
    (void)state;
    for (long successes = 0; successes < 2; successes++) {
        knot_vector knots;
        ffd_error error;
        ffd_alloc_fail_after(successes);
        const ffd_status status = ffd_knots_make(KNOTS_CLOSED, 3, 8, NULL, 0, 'w', &knots, &error);
        ffd_alloc_fail_after(-1);
        assert_int_equal(status, FFD_E_MEMORY);
        assert_null(knots.t);
        assert_null(knots.spans);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clamped_knots_repeat_at_both_ends),
        cmocka_unit_test(open_knots_run_on_evenly_beyond_the_domain),
        cmocka_unit_test(uniform_knots_divide_zero_to_one),
        cmocka_unit_test(closed_knots_reuse_the_first_control_points),
        cmocka_unit_test(a_closed_list_repeats_its_period),
        cmocka_unit_test(presets_have_exact_domain_ends),
        cmocka_unit_test(repeated_knots_bound_no_empty_span),
        cmocka_unit_test(a_knot_belongs_to_the_span_it_begins),
        cmocka_unit_test(parameters_are_clamped_or_go_round),
        cmocka_unit_test(greville_abscissae_of_equal_knots_are_exact),
        cmocka_unit_test(broken_knots_are_refused),
        cmocka_unit_test(each_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
