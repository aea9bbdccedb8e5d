/* test_wide.c - numbers of 256 bits: sums and products are exact as far as they fit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "fold/wide.h"
#include <math.h>

static wide product(double a, double b)
{
    const wide x = ffd_wide_of(a), y = ffd_wide_of(b);
    return ffd_wide_multiply(&x, &y);
}

static wide sum(double a, double b)
{
    const wide x = ffd_wide_of(a), y = ffd_wide_of(b);
    return ffd_wide_add(&x, &y);
}

static void assert_zero(const wide *a)
{
    assert_int_equal(a->sign, 0);
    for (int i = 0; i < WIDE_LIMBS; i++)
        assert_int_equal(a->limb[i], 0);
}

static void assert_value(const wide *a, double value)
{
    const wide expected = ffd_wide_of(value), off = wide_subtract(a, &expected);
    const scaled size = ffd_wide_scaled(&expected);
    assert_zero(&off);
    assert_int_equal(a->sign, value < 0 ? -1 : value > 0);
    assert_true(value == 0 || ldexp(size.mantissa, size.exponent) == fabs(value));
}

static double random_number(draw *d, int reach)
{
    return ldexp(draw_between(d, -1, 1), draw_int(d, -reach, reach));
}

static void doubles_are_held_exactly(void **state)
{
    static const double values[] = {0,       -0.0,      1,       -1,      0.1,     5e-324, -5e-324, 2.3e-308,
                                    1.7e308, -1.79e308, 0x1p-31, 0x1p-32, 0x1p-33, 0x1p31, 0x1p32,  0x1p33};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        const wide a = ffd_wide_of(values[i]);
        assert_value(&a, values[i]);
    }
    draw d = {1};
    for (int i = 0; i < 2000; i++) {
        const double value = random_number(&d, 1000);
        const wide a = ffd_wide_of(value);
        assert_value(&a, value);
    }
    (void)state;
}

/* (a + b)(a - b) + b b - a a = 0: no digit is lost where numbers differ by less than 2^60. */
static void sums_and_products_are_exact(void **state)
{
    draw d = {2};
    for (int i = 0; i < 2000; i++) {
        const double a = random_number(&d, 30), b = random_number(&d, 30);
        const wide plus = sum(a, b), minus = sum(a, -b), both = ffd_wide_multiply(&plus, &minus);
        const wide squares[2] = {product(b, b), product(a, -a)};
        wide left = ffd_wide_add(&both, &squares[0]);
        left = ffd_wide_add(&left, &squares[1]);
        assert_zero(&left);
    }
    (void)state;
}

/* What is lost is less than 2^-223 of the larger number. */
static void small_terms_are_lost_only_beyond_the_last_limb(void **state)
{
    for (int exponent = 1; exponent < 400; exponent++) {
        const wide one = ffd_wide_of(1);
        wide small = ffd_wide_of(ldexp(-1, -exponent)), rest = ffd_wide_add(&one, &small);
        small.sign = 1;
        rest = ffd_wide_add(&rest, &small);
        rest = wide_subtract(&rest, &one);
        if (exponent <= 223)
            assert_zero(&rest);
        else if (rest.sign)
            assert_true(ffd_wide_scaled(&rest).exponent <= -222);
    }
    (void)state;
}

/* Exponents beyond those of doubles. */
static void products_do_not_overflow(void **state)
{
    wide huge = ffd_wide_of(1e300), tiny = ffd_wide_of(1e-300);
    for (int i = 0; i < 20; i++) {
        const wide factors[2] = {ffd_wide_of(0x1p900), ffd_wide_of(0x1p-900)};
        huge = ffd_wide_multiply(&huge, &factors[0]);
        tiny = ffd_wide_multiply(&tiny, &factors[1]);
    }
    assert_int_equal(ffd_wide_scaled(&huge).exponent, 18000 + 997);
    assert_int_equal(ffd_wide_scaled(&tiny).exponent, -18000 - 996);
    const wide one = ffd_wide_multiply(&huge, &tiny), plain = product(1e300, 1e-300),
               off = wide_subtract(&one, &plain);
    assert_zero(&off);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(doubles_are_held_exactly),
        cmocka_unit_test(sums_and_products_are_exact),
        cmocka_unit_test(small_terms_are_lost_only_beyond_the_last_limb),
        cmocka_unit_test(products_do_not_overflow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
