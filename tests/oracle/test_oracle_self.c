/* test_oracle_self.c - the oracle itself, on identities and on values known in closed form. */
#include "sample.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static long double random_parameter(draw *random, const oracle_axis *axis)
{
    const long double first = oracle_first(axis), last = oracle_last(axis);
    if (random_chance(random, 0.1))
        return axis->closed || random_chance(random, 0.5) ? first : last;
    return first + (last - first) * (long double)draw_unit(random);
}

/* sum N = 1, N >= 0, sum N' = 0, and sum g N = u where the direction is not closed. */
static void partition_of_unity(void **state)
{
    (void)state;
    trial t = {.name = "partition_of_unity"};
    const sample_limits limits = {.max_degree = 9, .max_extra = 6, .closed = {true, true, true}};
    for (long k = 0; trial_next(&t, 300); k++, t.cases++) {
        sample s;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        sample_axes(&s, &random, &limits);
        for (int a = 0; a < 3; a++) {
            const oracle_axis *axis = &s.axis[a];
            const long double length = oracle_last(axis) - oracle_first(axis);
            const long double u = random_parameter(&random, axis);
            long double value[ORACLE_MAX_POINTS], derivative[ORACLE_MAX_POINTS];
            long double sum = 0, slope = 0, steepness = 0, greville_sum = 0, least = 0, size = 0;
            oracle_factors(axis, u, value, derivative);
            for (int i = 0; i < axis->n; i++) {
                sum += value[i];
                slope += derivative[i];
                steepness += fabsl(derivative[i]);
                least = fminl(least, value[i]);
                if (!axis->closed)
                    greville_sum += oracle_greville(axis, i) * value[i];
                size = fmaxl(size, fabsl(oracle_greville(axis, i)));
            }
            trial_check(&t, &s, fabsl(sum - 1) < 1e-17L && least >= 0, "%c: sum N = 1 + %Lg", "uvw"[a],
                        sum - 1);
            trial_check(&t, &s, steepness * length > 0.1L && fabsl(slope) <= 1e-17L * steepness,
                        "%c: sum N' = %Lg", "uvw"[a], slope);
            trial_check(&t, &s, axis->closed || fabsl(greville_sum - u) <= 1e-17L * size,
                        "%c: sum g N = u + %Lg", "uvw"[a], greville_sum - u);
        }
        sample_free(&s);
    }
    trial_end(&t);
}

static oracle_volume random_volume(sample *s, draw *random)
{
    oracle_volume volume = oracle_make(s->axis, random_chance(random, 0.5));
    for (size_t i = 0; i < oracle_count(&volume); i++) {
        for (size_t a = 0; a < 3; a++)
            volume.points[3 * i + a] = draw_between(random, -1, 1);
        if (volume.weights)
            volume.weights[i] = draw_between(random, 0.3, 3);
    }
    return volume;
}

/* J against central differences inside a span. */
static void jacobian_is_the_slope(void **state)
{
    (void)state;
    trial t = {.name = "jacobian_is_the_slope"};
    const sample_limits limits = {.max_degree = 5, .max_extra = 4, .closed = {true, true, true}};
    for (long k = 0; trial_next(&t, 60); k++, t.cases++) {
        sample s;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        sample_axes(&s, &random, &limits);
        oracle_volume volume = random_volume(&s, &random);
        long double uvw[3], point[3], jacobian[9], size[3], steepness[9];
        for (int a = 0; a < 3; a++)
            uvw[a] = random_parameter(&random, &s.axis[a]);
        for (int a = 0; a < 3; a++) {
            const long double length = oracle_last(&s.axis[a]) - oracle_first(&s.axis[a]);
            uvw[a] = oracle_first(&s.axis[a]) + length * (long double)draw_between(&random, 0.001, 0.999);
        }
        oracle_evaluate(&volume, uvw, point, jacobian);
        oracle_magnitude(&volume, uvw, size, steepness);
        for (int c = 0; c < 3; c++) {
            const long double h = 1e-6L * (oracle_last(&s.axis[c]) - oracle_first(&s.axis[c]));
            long double before[3], after[3], low[3], high[3];
            memcpy(before, uvw, sizeof uvw);
            memcpy(after, uvw, sizeof uvw);
            before[c] -= h;
            after[c] += h;
            oracle_evaluate(&volume, before, low, NULL);
            oracle_evaluate(&volume, after, high, NULL);
            for (int r = 0; r < 3; r++) {
                const long double slope = (high[r] - low[r]) / (2 * h);
                trial_check(&t, &s,
                            fabsl(slope - jacobian[3 * r + c]) <= 1e-7L * steepness[3 * r + c] + 1e-18L,
                            "J[%d][%d] = %Lg, difference quotient %Lg", r, c, jacobian[3 * r + c], slope);
            }
        }
        oracle_free(&volume);
        sample_free(&s);
    }
    trial_end(&t);
}

/* The uniform cubic at a knot is 1/6, 4/6, 1/6 with slopes -1/2, 0, 1/2 of the knot distance; the Bernstein
   polynomials; the closed quadratic at a breakpoint is 1/2, 1/2; a hat's slope at its top is the right-hand
   one. */
static void known_values(void **state)
{
    (void)state;
    sample s;
    long double value[ORACLE_MAX_POINTS], slope[ORACLE_MAX_POINTS];
    sample_init(&s, 0);
    sample_named_axis(&s, 0, "open", 7, 3); /* knots every 1/4 */
    oracle_factors(&s.axis[0], 0.5L, value, slope);
    const long double cubic[7] = {0, 0, 1 / 6.0L, 4 / 6.0L, 1 / 6.0L, 0, 0}, rise[7] = {0, 0, -2, 0, 2, 0, 0};
    for (int i = 0; i < 7; i++) {
        assert_true(fabsl(value[i] - cubic[i]) < 1e-18L);
        assert_true(fabsl(slope[i] - rise[i]) < 1e-17L);
    }
    sample_named_axis(&s, 0, "clamped", 6, 5);
    oracle_factors(&s.axis[0], 0.3L, value, slope);
    const long double binomial[6] = {1, 5, 10, 10, 5, 1};
    for (int i = 0; i < 6; i++)
        assert_true(fabsl(value[i] - binomial[i] * powl(0.3L, i) * powl(0.7L, 5 - i)) < 1e-18L);
    oracle_factors(&s.axis[0], 1, value, slope);
    assert_true(value[5] == 1 && value[0] == 0 && slope[5] == 5 && slope[4] == -5);
    sample_named_axis(&s, 0, "closed", 4, 2);
    oracle_factors(&s.axis[0], 0, value, slope);
    assert_true(value[0] == 0.5L && value[1] == 0.5L && value[2] == 0 && value[3] == 0);
    oracle_factors(&s.axis[0], 0.75L, value, slope);
    assert_true(value[3] == 0.5L && value[0] == 0.5L && value[1] == 0 && value[2] == 0);
    sample_named_axis(&s, 0, "clamped", 3, 1); /* knots 0 0 1/2 1 1 */
    oracle_factors(&s.axis[0], 0.5L, value, slope);
    assert_true(value[1] == 1 && slope[1] == -2 && slope[2] == 2 && slope[0] == 0);
    sample_free(&s);
}

/* Rest points of a bar that runs along an arc of the given angle about z, from radius 1 to 2, height 1. */
static oracle_volume arc(const oracle_axis axis[3], long double angle)
{
    oracle_volume volume = oracle_make(axis, false);
    size_t at = 0;
    int i[3];
    for (i[2] = 0; i[2] < axis[2].n; i[2]++)
        for (i[1] = 0; i[1] < axis[1].n; i[1]++)
            for (i[0] = 0; i[0] < axis[0].n; i[0]++, at++) {
                const long double turn = angle * oracle_greville(&axis[1], i[1]);
                const long double radius = 1 + oracle_greville(&axis[0], i[0]);
                volume.points[3 * at] = radius * cosl(turn);
                volume.points[3 * at + 1] = radius * sinl(turn);
                volume.points[3 * at + 2] = oracle_greville(&axis[2], i[2]);
            }
    return volume;
}

/* A bar bent to less than a full turn holds a point once, past it twice in the overlap, and none at the
 * centre. */
static void counts_preimages(void **state)
{
    (void)state;
    sample s;
    long double roots[ORACLE_MAX_ROOTS][3];
    sample_init(&s, 0);
    sample_named_axis(&s, 0, "clamped", 3, 2);
    sample_named_axis(&s, 1, "clamped", 16, 3);
    sample_named_axis(&s, 2, "clamped", 2, 1);
    oracle_volume volume = arc(s.axis, 440 * acosl(-1) / 180);
    const long double twice[3] = {1.4L * cosl(0.5L), 1.4L * sinl(0.5L), 0.3L};
    const long double once[3] = {1.4L * cosl(2.5L), 1.4L * sinl(2.5L), 0.3L}, centre[3] = {0, 0, 0.3L};
    assert_int_equal(oracle_find_all(&volume, twice, 1e-15L, roots), 2);
    assert_true(roots[0][1] != roots[1][1]);
    for (int k = 0; k < 2; k++) {
        long double point[3];
        oracle_evaluate(&volume, roots[k], point, NULL);
        for (int a = 0; a < 3; a++)
            assert_true(fabsl(point[a] - twice[a]) < 1e-14L);
    }
    assert_int_equal(oracle_find_all(&volume, once, 1e-15L, roots), 1);
    assert_int_equal(oracle_find_all(&volume, centre, 1e-15L, roots), 0);
    oracle_free(&volume);
    sample_free(&s);
}

/* An injective map by contraction (a small displacement of the identity): the root found is the one put in.
 */
static void finds_what_was_put_in(void **state)
{
    (void)state;
    trial t = {.name = "finds_what_was_put_in"};
    const sample_limits limits = {.max_degree = 4, .max_extra = 3};
    for (long k = 0; trial_next(&t, 20); k++, t.cases++) {
        sample s;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        sample_axes(&s, &random, &limits);
        sample_box(&s, &random, 1, 0);
        s.has_axes = false;
        long double corner[3];
        oracle_volume volume = sample_box_volume(&s, corner);
        for (size_t i = 0; i < 3 * oracle_count(&volume); i++)
            volume.points[i] += draw_between(&random, -0.002, 0.002);
        long double uvw[3], point[3], roots[ORACLE_MAX_ROOTS][3] = {{0}};
        for (int a = 0; a < 3; a++)
            uvw[a] = random_parameter(&random, &s.axis[a]);
        oracle_evaluate(&volume, uvw, point, NULL);
        const int count = oracle_find_all(&volume, point, 1e-16L, roots);
        trial_check(&t, &s, count == 1, "%d roots", count);
        for (int a = 0; a < 3 && count > 0; a++) {
            const long double length = oracle_last(&s.axis[a]) - oracle_first(&s.axis[a]);
            trial_check(&t, &s, oracle_distance(&s.axis[a], roots[0][a], uvw[a]) <= 1e-14L * length,
                        "%c = %.18Lg, found %.18Lg", "uvw"[a], uvw[a], roots[0][a]);
        }
        oracle_free(&volume);
        sample_free(&s);
    }
    trial_end(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(partition_of_unity),    cmocka_unit_test(jacobian_is_the_slope),
        cmocka_unit_test(known_values),          cmocka_unit_test(counts_preimages),
        cmocka_unit_test(finds_what_was_put_in),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
