/* sRGB and linear colours: compared with long double, at known values, and round trips. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "mesh/srgb.h"
#include <float.h>
#include <math.h>
#include <stdbool.h>

/* Relative. If long double is only double, as under valgrind, the expected value has an error of an ulp of
   the exponent 1 / 2.4, times the logarithm. */
static long double tolerance(void)
{
    const volatile long double one = 1, little = 0x1p-60L;
    return one + little > one ? 0x1p-49L : 0x1p-43L;
}

static long double exact_linear(double srgb)
{
    return srgb <= 0.04045 ? srgb / 12.92L : powl((srgb + 0.055L) / 1.055L, 2.4L);
}

static long double exact_srgb(double linear)
{
    return linear <= 0.0031308 ? 12.92L * linear : 1.055L * powl(linear, 1 / 2.4L) - 0.055L;
}

static void assert_near(double found, long double expected, double at)
{
    const long double off = fabsl(found - expected) / fabsl(expected);
    if (expected < 0 || expected > 0 ? !(off <= tolerance()) : found < 0 || found > 0)
        fail_msg("at %.17g: %.17g, which is %Lg off", at, found, off);
}

static void curves_are_those_of_the_standard(void **state)
{
    (void)state;
    for (int i = 0; i <= 20000; i++) {
        const double at = i / 20011.0; /* not the value of a byte, except at the ends */
        assert_near(ffd_srgb_to_linear(at), exact_linear(at), at);
        assert_near(ffd_srgb_from_linear(at), exact_srgb(at), at);
    }
    static const double others[] = {-0.5,         1e-300, 0.04045, 0.0404500001, 0.0031308,
                                    0.0031308001, 1.5,    300,     1e30,         DBL_MAX};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        assert_near(ffd_srgb_from_linear(others[i]), exact_srgb(others[i]), others[i]);
        if (others[i] < 1e30)
            assert_near(ffd_srgb_to_linear(others[i]), exact_linear(others[i]), others[i]);
    }
}

/* Known bits, to detect a processor or compiler that gives others. */
static void bits_are_known(void **state)
{
    (void)state;
    static const struct {
        double srgb, linear;
    } known[] = {{0, 0},
                 {0.25, 0x1.a0c6e3db0c475p-5},
                 {0.5, 0x1.b65b3392f5354p-3},
                 {0.75, 0x1.0b87f1f37fa9dp-1},
                 {1, 1}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        assert_memory_equal(&(double){ffd_srgb_to_linear(known[i].srgb)}, &known[i].linear, sizeof(double));
    assert_memory_equal(&(double){ffd_srgb_from_linear(0.5)}, &(double){0x1.7880b5e230e4fp-1},
                        sizeof(double));
    assert_memory_equal(&(double){ffd_srgb_from_linear(1)}, &(double){1}, sizeof(double));
}

static void bytes_come_back(void **state)
{
    (void)state;
    int before = -1;
    for (unsigned byte = 0; byte < 256; byte++) {
        const uint16_t linear = ffd_srgb_byte_to_linear(byte);
        assert_int_equal(linear, (int)(65535 * exact_linear(byte / 255.0) + 0.5L));
        assert_true(linear > before);
        before = linear;
        const double there[] = {linear / 65535.0, (double)(float)ffd_srgb_to_linear(byte / 255.0)};
        for (int i = 0; i < 2; i++)
            assert_memory_equal(&(double){ffd_srgb_from_linear(there[i])}, &(double){byte / 255.0},
                                sizeof(double));
    }
}

static void what_is_not_finite_stays(void **state)
{
    (void)state;
    assert_true(isinf(ffd_srgb_to_linear(INFINITY)) && isinf(ffd_srgb_from_linear(INFINITY)));
    assert_true(isinf(ffd_srgb_to_linear(-INFINITY)) && isinf(ffd_srgb_from_linear(-INFINITY)));
    assert_true(isnan(ffd_srgb_to_linear(NAN)) && isnan(ffd_srgb_from_linear(NAN)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curves_are_those_of_the_standard),
        cmocka_unit_test(bits_are_known),
        cmocka_unit_test(bytes_come_back),
        cmocka_unit_test(what_is_not_finite_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
