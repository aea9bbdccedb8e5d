/* test_rounding.c - rounding cells of stored coordinates. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "mesh/rounding.h"
#include <float.h>
#include <math.h>
#include <string.h>

static const mesh_rounding floats = {.is_float = {true, true, true}};

static double half_of(const mesh_rounding *rounding, double x)
{
    const double position[3] = {x, x, x};
    double half[3];
    ffd_rounding_cell(rounding, position, half);
    assert_true(half[0] == half[1] && half[1] == half[2]);
    return half[0];
}

/* Compared with the next float of the C library. */
static void assert_half_float(float x)
{
    const double expected = ((double)nextafterf(fabsf(x), INFINITY) - (double)fabsf(x)) / 2;
    const double half = half_of(&floats, (double)x);
    if (half != expected)
        fail_msg("%a reaches %a, not %a", (double)x, half, expected);
}

static void a_float_reaches_half_way_to_the_next_one(void **state)
{
    (void)state;
    static const float special[] = {
        0, 1, 0.1f, 0.5f, 1.5f, 2, 16777216, FLT_MIN, FLT_MIN / 2, 0x1p-149f, 0x1.fffffep127f / 2, 1e8f};
    for (size_t i = 0; i < sizeof special / sizeof *special; i++) {
        assert_half_float(special[i]);
        assert_half_float(-special[i]);
    }
    draw d = {draw_seed()};
    for (int i = 0; i < 100000; i++) {
        const uint32_t bits = (uint32_t)draw_bits(&d);
        float x;
        memcpy(&x, &bits, sizeof x);
        if (isfinite(x) && fabsf(x) < FLT_MAX)
            assert_half_float(x);
    }
}

static void doubles_stand_for_themselves(void **state)
{
    (void)state;
    static const mesh_rounding exact = {{false, false, false}, {0, 0, 0}};
    assert_true(ffd_rounding_is_none(&exact));
    assert_false(ffd_rounding_is_none(&floats));
    for (double x = 1e-300; x < 1e300; x *= 1e10)
        assert_true(half_of(&exact, x) == 0);
}

static void of_steps_and_floats_the_more_counts(void **state)
{
    (void)state;
    mesh_rounding rounding = {{false, false, false}, {0.25, 0.25, 0.25}};
    assert_false(ffd_rounding_is_none(&rounding));
    assert_true(half_of(&rounding, 1) == 0.125 && half_of(&rounding, 1e9) == 0.125);
    memcpy(rounding.is_float, floats.is_float, sizeof rounding.is_float);
    assert_true(half_of(&rounding, 1) == 0.125 && half_of(&rounding, 1e9) == 32);
    rounding = (mesh_rounding){{true, false, false}, {0, 0, 0.5}};
    double half[3];
    ffd_rounding_cell(&rounding, (const double[3]){1, 1, 1}, half);
    assert_true(half[0] == 0x1p-24 && half[1] == 0 && half[2] == 0.25);
}

/* No corner of the transformed cell exceeds the bounds along any axis, and one reaches them. */
static void the_bounds_of_a_turned_cell(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int n = 0; n < 1000; n++) {
        double linear[9], own[3], half[3], most[3] = {0, 0, 0};
        for (int i = 0; i < 9; i++)
            linear[i] = (double)draw_bits(&d) / 0x1p63 - 1;
        for (int i = 0; i < 3; i++)
            half[i] = own[i] = (double)draw_bits(&d) / 0x1p64;
        for (int corner = 0; corner < 8; corner++)
            for (int r = 0; r < 3; r++) {
                const double x = corner & 1 ? own[0] : -own[0], y = corner & 2 ? own[1] : -own[1],
                             z = corner & 4 ? own[2] : -own[2];
                most[r] = fmax(most[r], linear[3 * r] * x + linear[3 * r + 1] * y + linear[3 * r + 2] * z);
            }
        ffd_rounding_transform(linear, half);
        for (int r = 0; r < 3; r++)
            assert_true(fabs(half[r] - most[r]) <= 1e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_float_reaches_half_way_to_the_next_one),
        cmocka_unit_test(doubles_stand_for_themselves),
        cmocka_unit_test(of_steps_and_floats_the_more_counts),
        cmocka_unit_test(the_bounds_of_a_turned_cell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
