/* The rigid motion, or the similarity, that takes points nearest to others. */
#include "base/vector/motion.h"
#include "base/vector/vec.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define POINTS 40

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

static rigid_motion find(const double *x, const double *y, size_t count, bool uniform)
{
    motion_sums sums = {0};
    rigid_motion motion;
    for (size_t i = 0; i < count; i++)
        ffd_motion_add(&sums, x + 3 * i, y + 3 * i);
    ffd_motion_middle(&sums);
    for (size_t i = 0; i < count; i++)
        ffd_motion_add_product(&sums, x + 3 * i, y + 3 * i);
    ffd_motion_find(&sums, uniform, &motion);
    return motion;
}

static void draw(uint64_t *seed, double size, double *points)
{
    for (size_t i = 0; i < (size_t)3 * POINTS; i++)
        points[i] = size * next_number(seed);
}

static double farthest(const rigid_motion *motion, const double *x, const double *y, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++) {
        double delta[3], off[3];
        ffd_motion_displace(motion, x + 3 * i, delta);
        for (size_t a = 0; a < 3; a++)
            off[a] = x[3 * i + a] + delta[a] - y[3 * i + a];
        most = larger_of(most, vec_length(off));
    }
    return most;
}

static double squares(const rigid_motion *motion, const double *x, const double *y, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        double delta[3];
        ffd_motion_displace(motion, x + 3 * i, delta);
        for (size_t a = 0; a < 3; a++)
            sum += (x[3 * i + a] + delta[a] - y[3 * i + a]) * (x[3 * i + a] + delta[a] - y[3 * i + a]);
    }
    return sum;
}

/* Whatever the size is, also where squares overflow or underflow, and however far off the points are. */
static void a_similarity_is_found_again(void **state)
{
    const double sizes[] = {1, 1e-200, 1e200, 1e-3};
    uint64_t seed = 7;
    (void)state;
    for (int round = 0; round < 200; round++) {
        const double size = sizes[round % 4], scale = 0.2 + fabs(next_number(&seed));
        const double far = round % 4 == 3 ? 1e3 : 0, angle = 3.1 * next_number(&seed);
        const double axis[3] = {next_number(&seed), next_number(&seed), next_number(&seed)};
        double x[3 * POINTS], y[3 * POINTS], turn[9];
        draw(&seed, size, x);
        turn_about(axis, angle, turn);
        for (size_t i = 0; i < POINTS; i++) {
            mat_apply(turn, x + 3 * i, y + 3 * i);
            for (size_t a = 0; a < 3; a++) {
                y[3 * i + a] = scale * y[3 * i + a] + 3 * size - far;
                x[3 * i + a] += far;
            }
        }
        const rigid_motion motion = find(x, y, POINTS, true);
        assert_true(fabs(motion.scale - scale) <= 1e-9);
        assert_true(fabs(ffd_motion_degrees(&motion) - fabs(angle) * 57.29577951308232) <= 1e-7);
        assert_true(farthest(&motion, x, y, POINTS) <= 1e-12 * size + 1e-12 * far);
        assert_true(fabs(mat_determinant(motion.rotation) - 1) <= 1e-14);
    }
}

/* A motion that differs a little, in any way, fits worse. */
static void the_motion_is_the_nearest(void **state)
{
    uint64_t seed = 99;
    (void)state;
    for (int round = 0; round < 100; round++) {
        double x[3 * POINTS], y[3 * POINTS];
        draw(&seed, 1, x);
        draw(&seed, 0.7, y);
        for (size_t i = 0; i < (size_t)3 * POINTS; i++)
            y[i] += i % 3 == 0 ? 2 * x[i] : x[i];
        const bool uniform = round % 2;
        const rigid_motion best = find(x, y, POINTS, uniform);
        for (int way = 0; way < 12; way++) {
            rigid_motion other = best;
            double turn[9], axis[3] = {0, 0, 0};
            const double by = way % 2 ? 1e-3 : -1e-3;
            if (way < 6) {
                axis[way / 2] = 1;
                turn_about(axis, by, turn);
                mat_multiply(turn, best.rotation, other.rotation);
            } else {
                other.by[(way - 6) / 2] += by;
            }
            other.scale += uniform ? by / 3 : 0;
            for (int i = 0; i < 9; i++)
                other.gradient[i] = other.scale * other.rotation[i] - (i % 4 == 0);
            assert_true(squares(&other, x, y, POINTS) > squares(&best, x, y, POINTS));
        }
    }
}

/* What is mirrored is not turned inside out. */
static void a_mirror_image_is_met_by_a_rotation(void **state)
{
    uint64_t seed = 5;
    double x[3 * POINTS], y[3 * POINTS];
    (void)state;
    draw(&seed, 1, x);
    for (size_t i = 0; i < (size_t)3 * POINTS; i++)
        y[i] = i % 3 == 2 ? -x[i] : x[i] * (double)(4 - i % 3);
    const rigid_motion motion = find(x, y, POINTS, false);
    assert_true(fabs(mat_determinant(motion.rotation) - 1) <= 1e-14);
}

static void points_on_a_line_turn_by_the_least_rotation(void **state)
{
    const double x[] = {0, 0, 0, 1, 0, 0, 3, 0, 0};
    const double y[] = {0, 0, 0, 0, 2, 0, 0, 6, 0}, opposite[] = {3, 0, 0, 2, 0, 0, 0, 0, 0};
    const double turn[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
    (void)state;
    const rigid_motion quarter = find(x, y, 3, true);
    for (int i = 0; i < 9; i++)
        assert_true(fabs(quarter.rotation[i] - turn[i]) <= 1e-15);
    assert_true(fabs(quarter.scale - 2) <= 1e-15);
    const rigid_motion half = find(x, opposite, 3, false);
    assert_true(fabs(ffd_motion_degrees(&half) - 180) <= 1e-12);
    assert_true(farthest(&half, x, opposite, 3) <= 1e-15);
    /* Points that are on a line but for the rounding of floats are, too. */
    const double rough[] = {0, 0, 0, 1, 1e-8, 0, 3, 0, 1e-8};
    const rigid_motion alike = find(rough, y, 3, false);
    for (int i = 0; i < 9; i++)
        assert_true(fabs(alike.rotation[i] - turn[i]) <= 1e-7);
}

static void a_point_is_moved_and_not_turned(void **state)
{
    const double x[] = {1, 2, 3, 1, 2, 3}, y[] = {4, 2, 3, 4, 2, 3}, others[] = {1, 2, 3, 4, 5, 6};
    (void)state;
    for (int uniform = 0; uniform < 2; uniform++) {
        const rigid_motion motion = find(x, y, 2, uniform);
        assert_true(mat_largest_entry(motion.gradient) == 0);
        assert_true(motion.by[0] == 3 && motion.by[1] == 0 && motion.by[2] == 0);
    }
    /* Points that the deformation joins do not turn either. */
    const rigid_motion joined = find(others, x, 2, false);
    assert_true(mat_largest_entry(joined.gradient) == 0);
}

/* To the bit: what stays keeps its bytes. */
static void what_does_not_move_stays(void **state)
{
    uint64_t seed = 3;
    double x[3 * POINTS], delta[3];
    (void)state;
    draw(&seed, 1, x);
    const rigid_motion motion = find(x, x, POINTS, true);
    for (size_t i = 0; i < POINTS; i++) {
        ffd_motion_displace(&motion, x + 3 * i, delta);
        assert_true(delta[0] == 0 && delta[1] == 0 && delta[2] == 0);
    }
    assert_true(ffd_motion_degrees(&motion) == 0);
    /* Next to a line the turn about it is hardly told. */
    for (size_t i = 0; i < POINTS; i++) {
        x[3 * i + 1] = 5e-3 * x[3 * i] * x[3 * i];
        x[3 * i + 2] = 5e-3 * x[3 * i + 2];
    }
    const rigid_motion still = find(x, x, POINTS, true);
    assert_true(mat_largest_entry(still.gradient) == 0);
}

static void singular_values_are_those_of_a_stretch_between_turns(void **state)
{
    uint64_t seed = 11;
    (void)state;
    for (int round = 0; round < 200; round++) {
        const double axes[2][3] = {{next_number(&seed), next_number(&seed), next_number(&seed)},
                                   {next_number(&seed), next_number(&seed), next_number(&seed)}};
        const double wanted[3] = {3, round % 3 == 0 ? 3 : 1.5, round % 2 ? 0 : 1e-3};
        double u[9], v[9], first[9], m[9], found[3];
        turn_about(axes[0], 2 * next_number(&seed), u);
        turn_about(axes[1], 2 * next_number(&seed), v);
        for (int i = 0; i < 9; i++)
            first[i] = u[i] * wanted[i % 3];
        mat_multiply(first, v, m);
        ffd_singular_values(m, found);
        for (int i = 0; i < 3; i++)
            assert_true(fabs(found[i] - wanted[i]) <= 4e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_similarity_is_found_again),
        cmocka_unit_test(the_motion_is_the_nearest),
        cmocka_unit_test(a_mirror_image_is_met_by_a_rotation),
        cmocka_unit_test(points_on_a_line_turn_by_the_least_rotation),
        cmocka_unit_test(a_point_is_moved_and_not_turned),
        cmocka_unit_test(what_does_not_move_stays),
        cmocka_unit_test(singular_values_are_those_of_a_stretch_between_turns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
