/* Polar decomposition, cube roots and quaternions. */
#include "base/vector/polar.h"
#include "base/vector/vec.h"
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static double next_number(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 4503599627370496.0 - 1;
}

/* A rotation by Rodrigues' formula, unlike the code under test. */
static void turn_about(const double axis[3], double angle, double m[9])
{
    const double c = cos(angle), s = sin(angle), length = vec_length(axis);
    const double x = axis[0] / length, y = axis[1] / length, z = axis[2] / length;
    const double made[9] = {c + x * x * (1 - c),     x * y * (1 - c) - z * s, x * z * (1 - c) + y * s,
                            y * x * (1 - c) + z * s, c + y * y * (1 - c),     y * z * (1 - c) - x * s,
                            z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)};
    memcpy(m, made, sizeof made);
}

static void assert_near(const double *found, const double *expected, size_t count, double most)
{
    for (size_t i = 0; i < count; i++)
        assert_true(fabs(found[i] - expected[i]) <= most);
}

/* m = R H with H symmetric and positive definite: the factor is R, whatever H is. */
static void the_rotation_of_a_turn_after_a_stretch(void **state)
{
    uint64_t seed = 7;
    (void)state;
    for (int k = 0; k < 2000; k++) {
        const double axis[3] = {next_number(&seed), next_number(&seed), next_number(&seed)};
        const double other[3] = {next_number(&seed), next_number(&seed), next_number(&seed)};
        const double stretch = pow(10, 3 * next_number(&seed)), size = pow(10, 20 * next_number(&seed));
        double turn[9], own[9], half[9], h[9], transposed[9], m[9], found[9];
        if (vec_length(axis) < 0.1 || vec_length(other) < 0.1)
            continue;
        turn_about(axis, 3.1 * next_number(&seed), turn);
        turn_about(other, 3 * next_number(&seed), own);
        const double diagonal[9] = {stretch, 0, 0, 0, 1, 0, 0, 0, 1 / stretch};
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                transposed[3 * r + c] = own[3 * c + r];
        mat_multiply(own, diagonal, half);
        mat_multiply(half, transposed, h);
        mat_multiply(turn, h, m);
        for (int i = 0; i < 9; i++)
            m[i] *= size;
        assert_true(ffd_mat_rotation(m, found));
        assert_near(found, turn, 9, 1e-9);
    }
}

static void what_does_not_turn_gives_the_identity_to_the_bit(void **state)
{
    const double matrices[][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1},
                                  {2, 0, 0, 0, 2, 0, 0, 0, 2},
                                  {1, 1e-15, 0, -1e-15, 1, 0, 0, 0, 1},
                                  {3, 0, 0, 0, 0.1, 0, 0, 0, 1e9},
                                  {2, 1, 0, 1, 2, 0, 0, 0, 1}};
    (void)state;
    for (size_t i = 0; i < sizeof matrices / sizeof *matrices; i++) {
        double found[9];
        assert_true(ffd_mat_rotation(matrices[i], found));
        assert_memory_equal(found, identity, sizeof found);
    }
}

static void no_rotation_where_there_is_no_inverse_or_a_mirror(void **state)
{
    const double matrices[][9] = {{0, 0, 0, 0, 0, 0, 0, 0, 0},       {1, 0, 0, 0, 1, 0, 0, 0, 0},
                                  {1, 2, 3, 2, 4, 6, 0, 0, 1},       {-1, 0, 0, 0, 1, 0, 0, 0, 1},
                                  {-2, 0, 0, 0, -2, 0, 0, 0, -2},    {NAN, 0, 0, 0, 1, 0, 0, 0, 1},
                                  {INFINITY, 0, 0, 0, 1, 0, 0, 0, 1}};
    (void)state;
    for (size_t i = 0; i < sizeof matrices / sizeof *matrices; i++) {
        double found[9];
        assert_false(ffd_mat_rotation(matrices[i], found));
        assert_memory_equal(found, identity, sizeof found);
    }
}

static void cube_roots_are_those_of_the_library(void **state)
{
    uint64_t seed = 3;
    (void)state;
    assert_true(ffd_cube_root(0) == 0);
    assert_true(ffd_cube_root(8) == 2 && ffd_cube_root(-27) == -3 && ffd_cube_root(1) == 1);
    for (int k = 0; k < 2000; k++) {
        const double value = ldexp(next_number(&seed), (int)(300 * next_number(&seed)));
        assert_true(fabs(ffd_cube_root(value) - cbrt(value)) <= 4 * DBL_EPSILON * fabs(cbrt(value)));
    }
}

/* Turns about all axes, including half turns, where w is 0. */
static void quaternions_turn_as_their_matrices_do(void **state)
{
    uint64_t seed = 5;
    (void)state;
    for (int k = 0; k < 2000; k++) {
        const double axis[3] = {next_number(&seed), next_number(&seed), next_number(&seed)};
        const double angle = k % 4 ? 3.14159 * next_number(&seed) : 3.141592653589793;
        double m[9], q[4], back[9];
        if (vec_length(axis) < 0.1)
            continue;
        turn_about(axis, angle, m);
        ffd_mat_quaternion(m, q);
        assert_true(q[3] >= 0);
        const double x = q[0], y = q[1], z = q[2], w = q[3];
        const double made[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                                2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                                2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
        memcpy(back, made, sizeof back);
        assert_near(back, m, 9, 1e-12);
    }
}

/* i j = k, and a product corresponds to that of the matrices. */
static void quaternions_are_multiplied_as_hamilton_says(void **state)
{
    const double i[4] = {1, 0, 0, 0}, j[4] = {0, 1, 0, 0}, k[4] = {0, 0, 1, 0}, less[4] = {0, 0, -1, 0};
    double product[4];
    (void)state;
    ffd_quaternion_multiply(i, j, product);
    assert_memory_equal(product, k, sizeof k);
    ffd_quaternion_multiply(j, i, product);
    assert_near(product, less, 4, 0);
    memcpy(product, i, sizeof product);
    ffd_quaternion_multiply(product, product, product);
    const double minus_one[4] = {0, 0, 0, -1};
    assert_near(product, minus_one, 4, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rotation_of_a_turn_after_a_stretch),
        cmocka_unit_test(what_does_not_turn_gives_the_identity_to_the_bit),
        cmocka_unit_test(no_rotation_where_there_is_no_inverse_or_a_mirror),
        cmocka_unit_test(cube_roots_are_those_of_the_library),
        cmocka_unit_test(quaternions_turn_as_their_matrices_do),
        cmocka_unit_test(quaternions_are_multiplied_as_hamilton_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
