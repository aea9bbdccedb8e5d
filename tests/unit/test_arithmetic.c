/* The functions of base/arithmetic.h and root.h, against those of C's library. */
#include "base/arithmetic.h"
#include "base/vector/root.h"
#include "base/vector/trig.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"

#define DRAWS 50000

/* A number of any magnitude that is finite. */
static double any(draw *d)
{
    for (;;) {
        const uint64_t bits = draw_bits(d);
        double x;
        memcpy(&x, &bits, sizeof x);
        if (isfinite(x))
            return x;
    }
}

static void assert_same(const char *what, double a, double b, double found, double expected)
{
    if (!(found == expected || (isnan(found) && isnan(expected))))
        fail_msg("%s of %a and %a: %a, expected %a", what, a, b, found, expected);
}

static void the_number_of_a_number_and_nan_is_the_number(void **state)
{
    (void)state;
    assert_true(maximum_number(NAN, 1) == 1 && maximum_number(1, NAN) == 1);
    assert_true(minimum_number(NAN, 1) == 1 && minimum_number(1, NAN) == 1);
    assert_true(isnan(maximum_number(NAN, NAN)) && isnan(minimum_number(NAN, NAN)));
    draw d = {1};
    for (int i = 0; i < DRAWS; i++) {
        const double a = any(&d), b = any(&d);
        assert_same("maximum", a, b, maximum_number(a, b), fmax(a, b));
        assert_same("minimum", a, b, minimum_number(a, b), fmin(a, b));
    }
}

static void neighbours_are_those_of_nextafter(void **state)
{
    (void)state;
    static const double edges[] = {0, DBL_MIN, DBL_MAX, 1, 0x1p-1074, -0x1p-1074, -0.0, -1};
    for (size_t i = 0; i < sizeof edges / sizeof *edges; i++)
        assert_same("below", edges[i], 0, next_below(edges[i]), nextafter(edges[i], -HUGE_VAL));
    draw d = {2};
    for (int i = 0; i < DRAWS; i++) {
        const double x = any(&d), size = fabs(x);
        assert_same("below", x, 0, next_below(x), nextafter(x, -HUGE_VAL));
        assert_same("above", size, 0, next_above(size), nextafter(size, HUGE_VAL));
        const float single = (float)ldexp(draw_unit(&d), (int)(draw_bits(&d) % 260) - 140);
        assert_same("float above", single, 0, next_float_above(single), nextafterf(single, HUGE_VALF));
    }
}

static void integers_are_the_nearest_and_the_one_below(void **state)
{
    (void)state;
    static const double halves[] = {
        0.5, 1.5, 2.5, -0.5, -1.5, 0.49999999999999994, -3, 0, 4503599627370495.5 / 4};
    for (size_t i = 0; i < sizeof halves / sizeof *halves; i++) {
        assert_same("nearest", halves[i], 0, nearest_integer(halves[i]), nearbyint(halves[i]));
        assert_same("below", halves[i], 0, (double)integer_below(halves[i]), floor(halves[i]));
        assert_same("floor", halves[i], 0, floor_of(halves[i]), floor(halves[i]));
        assert_same("ceil", halves[i], 0, ceil_of(halves[i]), ceil(halves[i]));
    }
    draw d = {3};
    assert_true(signbit(floor_of(-0.0)) && isnan(floor_of(NAN)) && floor_of(-HUGE_VAL) == -HUGE_VAL);
    for (int i = 0; i < DRAWS; i++) {
        const double far = any(&d);
        assert_same("nearest", far, 0, nearest_integer(far), rint(far));
        assert_same("floor", far, 0, floor_of(far), floor(far));
        assert_same("ceil", far, 0, ceil_of(far), ceil(far));
        const double x = (2 * draw_unit(&d) - 1) * ldexp(1, (int)(draw_bits(&d) % 60) - 10);
        assert_same("nearest", x, 0, nearest_integer(x), nearbyint(x));
        assert_same("below", x, 0, (double)integer_below(x), floor(x));
    }
}

static void remainders_are_exact(void **state)
{
    (void)state;
    assert_same("remainder", HUGE_VAL, 1, remainder_of(HUGE_VAL, 1), NAN);
    assert_same("remainder", DBL_MAX, 0x1p-1074, remainder_of(DBL_MAX, 0x1p-1074), 0);
    assert_same("remainder", -7, 7, remainder_of(-7, 7), 0);
    draw d = {4};
    for (int i = 0; i < DRAWS; i++) {
        const double m = fabs(any(&d)), x = i % 2 ? any(&d) : m * (2000 * draw_unit(&d) - 1000);
        if (m > 0 && isfinite(x))
            assert_same("remainder", x, m, remainder_of(x, m), fmod(x, m));
    }
}

static void roots_and_angles_are_within_an_ulp(void **state)
{
    (void)state;
    draw d = {5};
    for (int i = 0; i < DRAWS; i++) {
        const double x = fabs(any(&d)) + 0x1p-1060, root = ffd_root(x, 3), exact = cbrt(x);
        if (!(fabs(root - exact) <= 4 * (next_above(exact) - exact)))
            fail_msg("cube root of %a: %a, expected %a", x, root, exact);
        const double a = 2 * draw_unit(&d) - 1, b = 2 * draw_unit(&d) - 1;
        if (!(fabs(ffd_angle_degrees(a, b) - atan2(a, b) * (180 / 3.14159265358979323846)) <= 1e-13))
            fail_msg("angle of (%a, %a): %a", b, a, ffd_angle_degrees(a, b));
    }
    assert_true(ffd_angle_degrees(-1, 0) == -90 && ffd_angle_degrees(0, -1) == 180);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_number_of_a_number_and_nan_is_the_number),
        cmocka_unit_test(neighbours_are_those_of_nextafter),
        cmocka_unit_test(integers_are_the_nearest_and_the_one_below),
        cmocka_unit_test(remainders_are_exact),
        cmocka_unit_test(roots_and_angles_are_within_an_ulp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
