/* Gaussian splats: exponentials and logarithms, the rotation in F, ellipsoids, spherical harmonics. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/repetitions.h"
#include "base/vector/exponential.h"
#include "base/vector/vec.h"
#include "splat/harmonics.h"
#include <float.h>
#include <math.h>
#include <string.h>

static const splat_form logarithms = {.is_logarithmic = true};

static void check_close(double found, double expected, double allowed)
{
    if (!(fabs(found - expected) <= allowed))
        fail_msg("found %.17g, expected %.17g", found, expected);
}

static void exponentials_and_logarithms(void **state)
{
    (void)state;
    for (double x = -150; x <= 30; x += 0.37) {
        const double value = exp(x);
        check_close(ffd_exp(x) / value, 1, 4e-16);
        check_close(ffd_log(value), x, 4e-16 * (1 + fabs(x)));
    }
    check_close(ffd_exp(0), 1, 0);
    check_close(ffd_log(1), 0, 0);
    check_close(ffd_log(1 + DBL_EPSILON), DBL_EPSILON, 1e-30);
}

/* Returns F - I. */
static void make_gradient(const double f[9], double gradient[9])
{
    for (int i = 0; i < 9; i++)
        gradient[i] = f[i] - (i % 4 == 0 ? 1 : 0);
}

static splat_turn turn_of(const double f[9])
{
    double gradient[9];
    splat_turn turn;
    make_gradient(f, gradient);
    ffd_splats_find_turns(FFD_ISA_SCALAR, gradient, 1, &turn);
    return turn;
}

static splat_outcome deform(const double f[9], const splat_form *form, splat_ellipsoid *splat)
{
    double gradient[9];
    const splat_turn turn = turn_of(f);
    make_gradient(f, gradient);
    uint8_t outcome;
    ffd_splats_deform(FFD_ISA_SCALAR, gradient, &turn, form, 1, splat, &outcome);
    return (splat_outcome)outcome;
}

/* The rotation of the polar decomposition is the one that was multiplied with a stretch, whatever the
   stretch. */
static void turns(void **state)
{
    (void)state;
    const double h = sqrt(0.5), angle = 0.3;
    const double rotation[9] = {cos(angle), -sin(angle), 0, sin(angle), cos(angle), 0, 0, 0, 1};
    for (int e = -12; e <= 8; e++) {
        const double big = pow(10, e), stretch[9] = {big, 0.2 * big, 0, 0.2 * big, 3, 0.1, 0, 0.1, 1};
        double f[9];
        mat_multiply(rotation, stretch, f);
        if (mat_determinant(stretch) <= 1e-10)
            continue;
        const splat_turn turn = turn_of(f);
        assert_true(turn.is_turn && !turn.is_mirrored);
        check_close(turn.quaternion[0], cos(angle / 2), 1e-11);
        check_close(turn.quaternion[3], sin(angle / 2), 1e-11);
    }
    const splat_turn mirror = turn_of((double[9]){0, -1, 0, -1, 0, 0, 0, 0, 1});
    assert_true(mirror.is_mirrored);
    check_close(fabs(mirror.quaternion[1]), h, 1e-15); /* a half turn about x = y */
    assert_false(turn_of((double[9]){2, 0, 0, 0, 3, 0, 0, 0, 0.1}).is_turn);
    assert_false(turn_of((double[9]){2, 1, 0, 4, 2, 0, 0, 0, 0}).is_turn); /* collapsed to a line */
    const splat_turn plane = turn_of((double[9]){0, -1, 0, 1, 0, 0, 0, 0, 0});
    check_close(plane.quaternion[3], h, 1e-15);
    assert_false(turn_of((double[9]){NAN, 0, 0, 0, 1, 0, 0, 0, 1}).is_turn);
}

/* A turn seen from a turned, stretched or mirrored frame. */
static void turns_in_another_space(void **state)
{
    (void)state;
    const double quarter[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1}; /* about z */
    const double frames[3][9] = {
        {0, 0, 5, 7, 0, 0, 0, 2, 0}, {0, 0, -5, 7, 0, 0, 0, 2, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    for (int i = 0; i < 3; i++) {
        splat_turn turn = turn_of(quarter);
        double matrix[9], seen[9], back[9], product[9], axes[9];
        ffd_splat_turn_to_file(frames[i], &turn);
        ffd_splat_matrix(turn.quaternion, matrix);
        for (int k = 0; k < 9; k++)
            axes[k] = (frames[i][k] > 0) - (frames[i][k] < 0); /* its orthogonal factor */
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                back[3 * r + c] = axes[3 * c + r];
        mat_multiply(quarter, axes, product);
        mat_multiply(back, product, seen);
        for (int k = 0; k < 9; k++)
            check_close(matrix[k], seen[k], 1e-15);
    }
}

static void sizes_of_a_stretched_splat(void **state)
{
    (void)state;
    const double f[9] = {2, 0, 0, 0, 3, 0, 0, 0, 0.5};
    splat_ellipsoid splat = {{3, 0, 0, 0}, {1, 0, 4}};
    assert_int_equal(deform(f, &(splat_form){0}, &splat), SPLAT_CARRIED);
    check_close(splat.scale[0], 2, 1e-15);
    check_close(splat.scale[1], 0, 0);
    check_close(splat.scale[2], 2, 1e-15);
    check_close(splat.rotation[0], 3, 1e-15); /* keeps its length */
    splat = (splat_ellipsoid){{1, 0, 0, 0}, {-INFINITY, 5, 1}};
    assert_int_equal(deform(f, &logarithms, &splat), SPLAT_CARRIED);
    assert_true(splat.scale[0] < -DBL_MAX);
    check_close(splat.scale[1], 5 + log(3), 1e-15);
    check_close(splat.scale[2], 1 - log(2), 1e-15);
}

/* The longest axis of a sheared ball is the first principal axis; a needle follows its direction. */
static void a_sheared_splat(void **state)
{
    (void)state;
    const double k = 0.5, f[9] = {1, k, 0, 0, 1, 0, 0, 0, 1}, large = 0.5 * (k + sqrt(k * k + 4));
    splat_ellipsoid ball = {{1, 0, 0, 0}, {0, 0, 0}};
    double matrix[9];
    assert_int_equal(deform(f, &logarithms, &ball), SPLAT_CARRIED);
    check_close(fabs(ball.scale[0]), log(large), 1e-15);
    check_close(ball.scale[0] + ball.scale[1], 0, 1e-15);
    splat_ellipsoid needle = {{1, 0, 0, 0}, {-40, 0, -40}};
    assert_int_equal(deform(f, &logarithms, &needle), SPLAT_CARRIED);
    ffd_splat_matrix(needle.rotation, matrix);
    check_close(matrix[1] / matrix[4], k, 1e-15);
    check_close(needle.scale[0], -40 - 0.5 * log(1 + k * k), 2e-14);
    check_close(needle.scale[1], 0.5 * log(1 + k * k), 1e-15);
}

static void outcomes(void **state)
{
    (void)state;
    const double same[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, plane[9] = {1, 0, 0, 0, 1, 0, 0, 0, 0},
                 wild[9] = {NAN, 0, 0, 0, 1, 0, 0, 0, 1};
    const splat_form linear = {0};
    const splat_ellipsoid good = {{1, 2, 3, 4}, {1, 2, 3}};
    splat_ellipsoid splat = good;
    assert_int_equal(deform(same, &linear, &splat), SPLAT_KEPT);
    assert_int_equal(deform(wild, &linear, &splat), SPLAT_BROKEN);
    assert_memory_equal(&splat, &good, sizeof good);
    assert_int_equal(deform(plane, &linear, &splat), SPLAT_FLATTENED);
    assert_true(splat.scale[0] > 0 && splat.scale[1] > 0 && splat.scale[2] > 0);
    const splat_ellipsoid bad[] = {{{0, 0, 0, 0}, {1, 2, 3}},
                                   {{1, NAN, 3, 4}, {1, 2, 3}},
                                   {{1, 2, 3, 4}, {1, NAN, 3}},
                                   {{1, 2, 3, 4}, {1, 2, INFINITY}},
                                   {{1, 2, INFINITY, 4}, {1, 2, 3}}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        splat = bad[i];
        assert_int_equal(deform(plane, &logarithms, &splat), SPLAT_BROKEN);
        assert_memory_equal(&splat, &bad[i], sizeof splat);
    }
    splat = (splat_ellipsoid){{1, 2, 3, 4}, {1, -2, 3}};
    assert_int_equal(deform(plane, &linear, &splat), SPLAT_BROKEN);
}

/* Returns a pseudorandom number from -1 to 1; the sequence is fixed. */
static double draw(uint32_t *state)
{
    *state = *state * 1664525 + 1013904223;
    return *state / 2147483648.0 - 1;
}

/* Returns how well a frame fits another: the sum of the cosines between axes, permuted and signed. */
static double fit(const double axes[9], const double frame[9], const int order[3], const double signs[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            sum += axes[3 * k + i] * signs[i] * frame[3 * k + order[i]];
    return sum;
}

/* Of the 24 right-handed frames along an ellipsoid's axes, none is nearer to the turned old frame. */
static void the_nearest_axes(void **state)
{
    (void)state;
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
    uint32_t seed = 1;
    for (int n = 0; n < 2000; n++) {
        double f[9], old[9], turning[9], axes[9], frame[9];
        splat_ellipsoid splat;
        for (int i = 0; i < 9; i++)
            f[i] = draw(&seed);
        for (int i = 0; i < 4; i++)
            splat.rotation[i] = draw(&seed);
        for (int i = 0; i < 3; i++)
            splat.scale[i] = n % 2 ? 0 : draw(&seed);
        const splat_turn turn = turn_of(f);
        double length = 0, unit[4];
        for (int i = 0; i < 4; i++)
            length += splat.rotation[i] * splat.rotation[i];
        for (int i = 0; i < 4; i++)
            unit[i] = splat.rotation[i] / sqrt(length);
        ffd_splat_matrix(unit, old);
        ffd_splat_matrix(turn.quaternion, turning);
        mat_multiply(turning, old, axes);
        assert_int_equal(deform(f, &logarithms, &splat), SPLAT_CARRIED);
        for (int i = 0; i < 4; i++)
            unit[i] = splat.rotation[i] / sqrt(length);
        ffd_splat_matrix(unit, frame);
        const double found = fit(axes, frame, orders[0], (double[3]){1, 1, 1});
        for (int o = 0; o < 6; o++)
            for (int s = 0; s < 8; s++) {
                const double signs[3] = {s & 1 ? -1 : 1, s & 2 ? -1 : 1, s & 4 ? -1 : 1};
                if ((signs[0] * signs[1] * signs[2] > 0) == (o < 3))
                    assert_true(fit(axes, frame, orders[o], signs) <= found + 1e-9);
            }
    }
}

enum { MOST = 133 };

/* Draws gradients: zeros, NaN, small turns, mirrors, flattening, collapse, and ordinary ones. */
static void draw_gradients(uint32_t *seed, double gradients[9 * MOST])
{
    for (int i = 0; i < 9 * MOST; i++) {
        const int splat = i / 9, entry = i % 9;
        const double identity = entry % 4 == 0, value = draw(seed);
        gradients[i] = splat % 11 == 3                 ? 0
                       : splat % 13 == 5               ? NAN
                       : splat % 19 == 8 && entry >= 3 ? value * (entry >= 6) - (entry == 4)
                       : splat % 23 == 4               ? -identity
                       : splat % 29 == 9               ? 1e-33 * value - identity
                       : splat % 31 == 7               ? 1e31 * value
                       : splat % 37 == 2               ? 1e-15 * value
                       : splat % 7                     ? value
                                                       : 1e-3 * value;
    }
}

/* Draws splats, some without rotation, or with sizes that are equal, 0 or NaN. */
static void draw_splats(uint32_t *seed, bool is_logarithmic, splat_ellipsoid splats[MOST])
{
    for (int i = 0; i < MOST; i++)
        for (int k = 0; k < 4; k++) {
            splats[i].rotation[k] = i % 17 == 6 ? 0 : draw(seed);
            if (k == 3)
                continue;
            const double size = draw(seed), none = is_logarithmic ? -INFINITY : 0;
            splats[i].scale[k] = i % 41 == 3 || (i % 43 == 5 && k == 1) ? none
                                 : i % 47 == 8                          ? INFINITY
                                 : i % 5 == 0                           ? 1
                                 : is_logarithmic                       ? 20 * size
                                                                        : fabs(size);
        }
}

/* Checks that an instruction set gives the same bits as scalar code. */
static void check_isa(ffd_isa isa, const splat_form *form, const double *gradients,
                      const splat_ellipsoid *splats, size_t count)
{
    splat_turn turns[2][MOST];
    splat_ellipsoid made[2][MOST];
    uint8_t outcomes[2][MOST];
    harmonics_block c[2][MOST];
    for (int k = 0; k < 2; k++) {
        const ffd_isa own = k ? isa : FFD_ISA_SCALAR;
        memcpy(made[k], splats, count * sizeof *splats);
        ffd_splats_find_turns(own, gradients, count, turns[k]);
        ffd_splats_deform(own, gradients, turns[k], form, count, made[k], outcomes[k]);
        for (size_t i = 0; i < count * HARMONICS_MOST * HARMONICS_CHANNELS; i++)
            ((double *)c[k])[i] = sin((double)i);
        ffd_harmonics_turn(own, turns[k], 1 + (int)count % 3, count, c[k]);
    }
    for (size_t i = 0; i < count; i++) {
        assert_memory_equal(turns[0][i].quaternion, turns[1][i].quaternion, sizeof turns[0][i].quaternion);
        assert_int_equal(turns[0][i].is_turn, turns[1][i].is_turn);
        assert_int_equal(turns[0][i].is_mirrored, turns[1][i].is_mirrored);
    }
    assert_memory_equal(made[0], made[1], count * sizeof **made);
    assert_memory_equal(outcomes[0], outcomes[1], count);
    assert_memory_equal(c[0], c[1], count * sizeof **c);
}

/* Any number of splats, some of them degenerate, with any instruction set. */
static void all_instruction_sets_give_the_same_bits(void **state)
{
    (void)state;
    static const ffd_isa sets[] = {FFD_ISA_SSE2, FFD_ISA_AVX2, FFD_ISA_AVX512, FFD_ISA_NEON};
    uint32_t seed = 7;
    const int rounds = is_memory_checked() ? 4 : 40; /* each form at least once */
    for (int round = 0; round < rounds; round++) {
        const splat_form form = {.is_logarithmic = round % 2, .is_flat = round % 4 > 1};
        double gradients[9 * MOST];
        splat_ellipsoid splats[MOST];
        draw_gradients(&seed, gradients);
        draw_splats(&seed, form.is_logarithmic, splats);
        for (size_t count = 1; count <= MOST; count += count < 20 ? 1 : 56)
            for (size_t s = 0; s < sizeof sets / sizeof *sets; s++)
                if (ffd_isa_available(sets[s]))
                    check_isa(sets[s], &form, gradients, splats, count);
    }
}

/* The turned function has the same values as the original in the directions turned back. */
static void harmonics(void **state)
{
    (void)state;
    const double directions[][3] = {{1, 0, 0}, {0, 0.6, 0.8}, {-0.48, 0.6, 0.64}, {0, 0, -1}};
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        const splat_turn turn = {{0.5, -0.1, 0.7, 0.5}, true, mirrored}; /* of length 1 */
        harmonics_block before, after;
        double m[9];
        for (int i = 0; i < HARMONICS_MOST; i++)
            for (int k = 0; k < HARMONICS_CHANNELS; k++)
                before[k][i] = after[k][i] = sin(1 + i + 20 * k);
        ffd_harmonics_turn(FFD_ISA_SCALAR, &turn, 3, 1, &after);
        ffd_splat_matrix(turn.quaternion, m);
        for (size_t d = 0; d < sizeof directions / sizeof *directions; d++)
            for (int degree = 1, at = 0; degree <= 3; at += 2 * degree++ + 1) {
                const double *const v = directions[d], sign = mirrored ? -1 : 1;
                double back[3], old[7], turned[7];
                for (int c = 0; c < 3; c++)
                    back[c] = sign * (m[c] * v[0] + m[3 + c] * v[1] + m[6 + c] * v[2]);
                ffd_harmonics_values(degree, back, old);
                ffd_harmonics_values(degree, v, turned);
                for (int k = 0; k < HARMONICS_CHANNELS; k++) {
                    double expected = 0, found = 0;
                    for (int i = 0; i <= 2 * degree; i++) {
                        expected += before[k][at + i] * old[i];
                        found += after[k][at + i] * turned[i];
                    }
                    check_close(found, expected, 2e-15);
                }
            }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exponentials_and_logarithms),
        cmocka_unit_test(turns),
        cmocka_unit_test(turns_in_another_space),
        cmocka_unit_test(sizes_of_a_stretched_splat),
        cmocka_unit_test(a_sheared_splat),
        cmocka_unit_test(the_nearest_axes),
        cmocka_unit_test(outcomes),
        cmocka_unit_test(all_instruction_sets_give_the_same_bits),
        cmocka_unit_test(harmonics),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
