/* Sine, cosine and arc tangent: exact at multiples of 30 and 45 degrees, within an ulp elsewhere. */
#include "base/vector/trig.h"
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"

static void check(double degrees, double sine, double cosine)
{
    double s, c;
    ffd_sincos_degrees(degrees, &s, &c);
    if (s != sine || c != cosine || (s == 0 && signbit(s)) || (c == 0 && signbit(c)))
        fail_msg("%.17g degrees: sine %.17g cosine %.17g, expected %.17g %.17g", degrees, s, c, sine, cosine);
}

static void multiples_of_30_and_45_degrees_are_exact(void **state)
{
    (void)state;
    const double r = sqrt(0.5), h = sqrt(0.75);
    for (double turn = -3600; turn <= 3600; turn += 360) {
        check(turn, 0, 1);
        check(turn + 90, 1, 0);
        check(turn + 180, 0, -1);
        check(turn + 270, -1, 0);
        check(turn + 45, r, r);
        check(turn + 135, r, -r);
        check(turn + 225, -r, -r);
        check(turn + 315, -r, r);
        check(turn + 30, 0.5, h);
        check(turn + 60, h, 0.5);
        check(turn + 150, 0.5, -h);
        check(turn + 210, -0.5, -h);
        check(turn + 300, -h, 0.5);
    }
    /* 10^22 is exact in double, and is 280 modulo 360. */
    double sine, cosine;
    ffd_sincos_degrees(280, &sine, &cosine);
    check(1e22, sine, cosine);
}

static double ulps(double value, long double exact)
{
    const double nearest = fabs((double)exact);
    return (double)(fabsl((long double)value - exact) / (nextafter(nearest, 2) - nearest));
}

static void random_angles_are_within_one_ulp(void **state)
{
    (void)state;
    /* valgrind computes long double as double, which is too coarse as a reference. */
    const volatile long double small = LDBL_EPSILON;
    if (1 + small == 1)
        skip();
    const long double radian = acosl(-1.0L) / 180;
    draw d = {12345};
    for (int i = 0; i < 200000; i++) {
        static const double range[] = {45, 360, 1e6};
        const double degrees = (2 * draw_unit(&d) - 1) * range[i % 3];
        double s, c;
        ffd_sincos_degrees(degrees, &s, &c);
        /* Reduced exactly first: near a zero the long double product would be too coarse. */
        const long double turn = fmodl((long double)degrees, 360), quadrant = floorl(turn / 90 + 0.5L);
        const long double x = (turn - 90 * quadrant) * radian, sine = sinl(x), cosine = cosl(x);
        const int q = (int)quadrant & 3;
        const long double exact_sine = q == 0 ? sine : q == 1 ? cosine : q == 2 ? -sine : -cosine;
        const long double exact_cosine = q == 0 ? cosine : q == 1 ? -sine : q == 2 ? -cosine : sine;
        if (ulps(s, exact_sine) > 1 || ulps(c, exact_cosine) > 1)
            fail_msg("%.17g degrees: sine off by %g ulp, cosine by %g", degrees, ulps(s, exact_sine),
                     ulps(c, exact_cosine));
    }
}

static void sine_is_odd_and_cosine_is_even(void **state)
{
    (void)state;
    draw d = {99};
    for (int i = 0; i < 20000; i++) {
        const double degrees = draw_unit(&d) * 400;
        double s, c, s_back, c_back;
        ffd_sincos_degrees(degrees, &s, &c);
        ffd_sincos_degrees(-degrees, &s_back, &c_back);
        assert_true(s_back == -s);
        assert_true(c_back == c);
    }
}

/* Small angles keep their digits. */
static void small_angles_keep_their_digits(void **state)
{
    (void)state;
    for (double degrees = 40; degrees > 1e-290; degrees /= 7) {
        double s, c;
        ffd_sincos_degrees(degrees, &s, &c);
        const long double exact = sinl((long double)degrees * (acosl(-1.0L) / 180));
        assert_true(ulps(s, exact) <= 1);
        assert_true(c <= 1);
    }
}

static void the_arc_tangent_of_axes_and_diagonals_is_exact(void **state)
{
    (void)state;
    const double pi = acos(-1);
    static const double sizes[] = {1, 3, 1e-300, 1e300, 5e-324, DBL_MAX};
    assert_true(ffd_arc_tangent(0, 0) == 0 && ffd_arc_tangent(-0.0, -0.0) == 0);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const double s = sizes[i];
        assert_true(ffd_arc_tangent(0, s) == 0);
        assert_true(ffd_arc_tangent(0, -s) == pi);
        assert_true(ffd_arc_tangent(s, 0) == pi / 2);
        assert_true(ffd_arc_tangent(s, s) == pi / 4);
        assert_true(ffd_arc_tangent(s, -s) == pi - pi / 4);
    }
}

static void the_arc_tangent_matches_the_c_library(void **state)
{
    (void)state;
    draw d = {54321};
    double worst = 0;
    for (int i = 0; i < 300000; i++) {
        /* All directions, and ratios of all magnitudes. */
        const double angle = draw_unit(&d), size = ldexp(1, (int)(600 * draw_unit(&d)) - 300);
        const double ratio = i % 2 ? 1 : ldexp(1, (int)(100 * draw_unit(&d)) - 50);
        const double y = angle * size, x = (2 * draw_unit(&d) - 1) * size * ratio;
        const double exact = atan2(y, x);
        worst = fmax(worst, fabs(ffd_arc_tangent(y, x) - exact));
        /* Small angles are compared relatively. */
        if (exact > 0 && fabs(ffd_arc_tangent(y, x) - exact) > 4 * DBL_EPSILON * exact)
            fail_msg("atan2(%a, %a): %.17g, expected %.17g", y, x, ffd_arc_tangent(y, x), exact);
    }
    assert_true(worst < 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(multiples_of_30_and_45_degrees_are_exact),
        cmocka_unit_test(random_angles_are_within_one_ulp),
        cmocka_unit_test(sine_is_odd_and_cosine_is_even),
        cmocka_unit_test(small_angles_keep_their_digits),
        cmocka_unit_test(the_arc_tangent_of_axes_and_diagonals_is_exact),
        cmocka_unit_test(the_arc_tangent_matches_the_c_library),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
