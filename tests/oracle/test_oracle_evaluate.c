/* test_oracle_evaluate.c - ffd_lattice_evaluate, points and Jacobian, against the oracle. */
#include "sample.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void random_points(sample *s, draw *random)
{
    static const double scales[] = {1, 1, 1e-6, 1e9};
    const double scale = scales[draw_int(random, 0, 3)];
    const double offset = random_chance(random, 0.2) ? 1e6 : 0;
    s->rest = SAMPLE_POINTS;
    s->points = sample_array(3 * sample_count(s));
    for (size_t i = 0; i < 3 * sample_count(s); i++)
        s->points[i] = scale * (draw_between(random, -1, 1) + offset);
}

static void random_deformed(sample *s, draw *random)
{
    if (random_chance(random, 0.5)) {
        s->deformed_points = sample_array(3 * sample_count(s));
        for (size_t i = 0; i < 3 * sample_count(s); i++)
            s->deformed_points[i] = draw_between(random, -2, 2);
    }
    if (s->weights && random_chance(random, 0.5)) {
        s->deformed_weights = sample_array(sample_count(s));
        for (size_t i = 0; i < sample_count(s); i++)
            s->deformed_weights[i] = draw_between(random, 0.2, 5);
    }
    if (random_chance(random, 0.3))
        text_add(&s->moves, "{\"at\":[0,\"all\",[0,-1]],\"by\":[0.25,-0.5,1.5]}");
}

/* Lattices of every kind of knots and rest. */
static void random_sample(sample *s, draw *random)
{
    const int kind = draw_int(random, 0, 9);
    sample_limits limits = {.max_degree = random_chance(random, 0.5) ? 9 : 4, .max_extra = 4};
    if (kind < 3) { /* box */
        sample_axes(s, random, &limits);
        sample_box(s, random, random_chance(random, 0.2) ? 1e-3 : 1, random_chance(random, 0.2) ? 1e4 : 0);
    } else if (kind == 3) { /* uniform spacing */
        limits.only_clamped = true;
        sample_axes(s, random, &limits);
        sample_box(s, random, 1, 0);
        s->uniform_spacing = true;
    } else if (kind < 6) { /* cylinder, a full turn or not */
        const bool full = kind == 4;
        limits.max_degree = 4;
        limits.always_closed[1] = full;
        sample_axes(s, random, &limits);
        sample_round_cylinder(s, random, full);
    } else {
        for (int a = 0; a < 3; a++)
            limits.closed[a] = true;
        sample_axes(s, random, &limits);
        random_points(s, random);
    }
    if (random_chance(random, 0.4))
        sample_weights(s, random, random_chance(random, 0.3) ? 50 : 3);
    random_deformed(s, random);
    sample_write(s);
}

/* Ends, knots and anything between; now and then outside, where the library must come back to the domain. */
static double random_parameter(draw *random, const oracle_axis *axis)
{
    const long double first = oracle_first(axis), last = oracle_last(axis);
    const int kind = draw_int(random, 0, 11);
    double u = (double)(first + (last - first) * (long double)draw_unit(random));
    if (kind == 0)
        u = (double)first;
    else if (kind == 1)
        u = (double)last;
    else if (kind == 2)
        u = (double)oracle_knot(axis, axis->degree +
                                          draw_int(random, 0, axis->n - (axis->closed ? 1 : axis->degree)));
    return u;
}

static void check_values(trial *t, const sample *s, const ffd_lattice *lattice, ffd_volume which,
                         const oracle_volume *volume, const double uvw[3])
{
    long double at[3], point[3], jacobian[9], size[3], steepness[9], largest = 0;
    double found[3], slopes[9], alone[3];
    for (int a = 0; a < 3; a++)
        at[a] = oracle_wrap(&s->axis[a], uvw[a]);
    oracle_evaluate(volume, at, point, jacobian);
    oracle_magnitude(volume, at, size, steepness);
    ffd_lattice_evaluate(lattice, which, uvw, found, slopes);
    ffd_lattice_evaluate(lattice, which, uvw, alone, NULL);
    for (int a = 0; a < 3; a++)
        largest = fmaxl(largest, size[a]);
    for (int r = 0; r < 3; r++) {
        trial_check(t, s, fabsl(found[r] - point[r]) <= 1e-13L * largest,
                    "%s at %.17g %.17g %.17g: C[%d] = %.17g, expected %.20Lg, off by %.2Lg of the size",
                    which == FFD_VOLUME_REST ? "rest" : "deformed", uvw[0], uvw[1], uvw[2], r, found[r],
                    point[r], fabsl(found[r] - point[r]) / largest);
        trial_check(t, s, memcmp(&found[r], &alone[r], sizeof found[r]) == 0,
                    "C[%d] differs with and without the Jacobian: %.17g %.17g", r, found[r], alone[r]);
        for (int c = 0; c < 3; c++)
            trial_check(
                t, s, fabsl(slopes[3 * r + c] - jacobian[3 * r + c]) <= 1e-13L * steepness[3 * r + c],
                "%s at %.17g %.17g %.17g: J[%d][%d] = %.17g, expected %.20Lg, off by %.2Lg of the scale",
                which == FFD_VOLUME_REST ? "rest" : "deformed", uvw[0], uvw[1], uvw[2], r, c,
                slopes[3 * r + c], jacobian[3 * r + c],
                fabsl(slopes[3 * r + c] - jacobian[3 * r + c]) / steepness[3 * r + c]);
    }
}

static void check_shape(trial *t, const sample *s, const ffd_lattice *lattice)
{
    size_t size[3];
    int degree[3];
    double lo[3], hi[3];
    ffd_lattice_get_size(lattice, size);
    ffd_lattice_get_degree(lattice, degree);
    ffd_lattice_get_domain(lattice, lo, hi);
    for (int a = 0; a < 3; a++) {
        const oracle_axis *axis = &s->axis[a];
        trial_check(t, s, size[a] == (size_t)axis->n && degree[a] == axis->degree, "%c: size %zu, degree %d",
                    "uvw"[a], size[a], degree[a]);
        trial_check(t, s, lo[a] == (double)oracle_first(axis) && hi[a] == (double)oracle_last(axis),
                    "%c: domain %.17g %.17g, expected %.17Lg %.17Lg", "uvw"[a], lo[a], hi[a],
                    oracle_first(axis), oracle_last(axis));
    }
}

/* The control points of a box are where data/schema/lattice.md 5.1 says. */
static void check_box_points(trial *t, const sample *s, const ffd_lattice *lattice)
{
    long double corner[3];
    oracle_volume volume = sample_box_volume(s, corner);
    const double *points = ffd_lattice_get_points(lattice, FFD_VOLUME_REST);
    long double largest = 0;
    for (size_t i = 0; i < 3 * sample_count(s); i++)
        largest = fmaxl(largest, fabsl(volume.points[i] + corner[i % 3]));
    for (size_t i = 0; i < 3 * sample_count(s); i++)
        trial_check(t, s, fabsl(points[i] - corner[i % 3] - volume.points[i]) <= 1e-14L * largest,
                    "box: control point %zu, coordinate %zu is %.17g, expected %.20Lg", i / 3, i % 3,
                    points[i], volume.points[i]);
    oracle_free(&volume);
}

static void every_kind_of_lattice(void **state)
{
    (void)state;
    trial t = {.name = "every_kind_of_lattice"};
    for (long k = 0; trial_next(&t, 400); k++, t.cases++) {
        sample s;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        random_sample(&s, &random);
        ffd_lattice *lattice = trial_parse(&t, &s);
        if (lattice) {
            check_shape(&t, &s, lattice);
            if (s.rest == SAMPLE_BOX)
                check_box_points(&t, &s, lattice);
            for (int which = 0; which < 2; which++) {
                oracle_volume volume = sample_volume(&s, lattice, (ffd_volume)which);
                for (int i = 0; i < 8; i++) {
                    double uvw[3];
                    for (int a = 0; a < 3; a++)
                        uvw[a] = random_parameter(&random, &s.axis[a]);
                    check_values(&t, &s, lattice, (ffd_volume)which, &volume, uvw);
                }
                oracle_free(&volume);
            }
            ffd_lattice_destroy(&lattice);
        }
        sample_free(&s);
    }
    trial_end(&t);
}

/* What the file gives is what the lattice has, to the bit. */
static void given_numbers_are_kept(void **state)
{
    (void)state;
    trial t = {.name = "given_numbers_are_kept"};
    const sample_limits limits = {.max_degree = 3, .max_extra = 2, .closed = {true, true, true}};
    for (long k = 0; trial_next(&t, 50); k++, t.cases++) {
        sample s;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        sample_axes(&s, &random, &limits);
        random_points(&s, &random);
        sample_weights(&s, &random, 4);
        random_deformed(&s, &random);
        text_free(&s.moves);
        sample_write(&s);
        ffd_lattice *lattice = trial_parse(&t, &s);
        if (lattice) {
            const size_t count = sample_count(&s);
            const double *rest = ffd_lattice_get_points(lattice, FFD_VOLUME_REST);
            const double *deformed = ffd_lattice_get_points(lattice, FFD_VOLUME_DEFORMED);
            const double *weights = ffd_lattice_get_weights(lattice, FFD_VOLUME_REST);
            const double *moved = ffd_lattice_get_weights(lattice, FFD_VOLUME_DEFORMED);
            trial_check(&t, &s, memcmp(rest, s.points, 3 * count * sizeof *rest) == 0, "rest points differ");
            trial_check(&t, &s,
                        memcmp(deformed, s.deformed_points ? s.deformed_points : s.points,
                               3 * count * sizeof *rest) == 0,
                        "deformed points differ");
            trial_check(&t, &s, weights && memcmp(weights, s.weights, count * sizeof *rest) == 0,
                        "weights differ");
            trial_check(&t, &s,
                        moved && memcmp(moved, s.deformed_weights ? s.deformed_weights : s.weights,
                                        count * sizeof *rest) == 0,
                        "deformed weights differ");
            ffd_lattice_destroy(&lattice);
        }
        sample_free(&s);
    }
    trial_end(&t);
}

/* Outside the domain: its nearest point; closed directions modulo their period (whole ones, so that both
 * agree). */
static void outside_comes_back(void **state)
{
    (void)state;
    trial t = {.name = "outside_comes_back"};
    for (long k = 0; trial_next(&t, 50); k++, t.cases++) {
        sample s;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        sample_named_axis(&s, 0, "open", 6, draw_int(&random, 1, 5));
        sample_named_axis(&s, 1, "closed", 5, draw_int(&random, 1, 4));
        sample_named_axis(&s, 2, "clamped", 5, draw_int(&random, 1, 4));
        random_points(&s, &random);
        sample_write(&s);
        ffd_lattice *lattice = trial_parse(&t, &s);
        if (lattice) {
            oracle_volume volume = sample_volume(&s, lattice, FFD_VOLUME_REST);
            const double fraction = draw_int(&random, 1, 1023) / 1024.0;
            const double uvw[3] = {random_chance(&random, 0.5) ? -0.25 : 1.5,
                                   draw_int(&random, -3, 3) + fraction,
                                   random_chance(&random, 0.5) ? -1e300 : 1e300};
            check_values(&t, &s, lattice, FFD_VOLUME_REST, &volume, uvw);
            oracle_free(&volume);
            ffd_lattice_destroy(&lattice);
        }
        sample_free(&s);
    }
    trial_end(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_lattice),
        cmocka_unit_test(given_numbers_are_kept),
        cmocka_unit_test(outside_comes_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
