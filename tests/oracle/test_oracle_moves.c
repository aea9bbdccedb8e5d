/* test_oracle_moves.c - moved control points against another implementation of data/schema/lattice.md;
 * cylinders. */
#include "moves_sample.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void random_rest(sample *s, draw *random)
{
    const int kind = draw_int(random, 0, 3);
    const sample_limits limits = {
        .max_degree = 3, .max_extra = 2, .always_closed = {false, kind == 0, false}};
    sample_axes(s, random, &limits);
    if (kind == 0)
        sample_round_cylinder(s, random, true);
    else
        sample_box(s, random, kind == 1 ? 10 : 1, 0);
    s->box_units = kind > 1 && random_chance(random, 0.6);
    if (random_chance(random, 0.2)) {
        s->deformed_points = sample_array(3 * sample_count(s));
        for (size_t i = 0; i < 3 * sample_count(s); i++)
            s->deformed_points[i] = draw_between(random, -1, 1);
    }
}

/* The rest points that the moves start from come from the library (test_oracle_evaluate checks those). */
static void random_moves(void **state)
{
    (void)state;
    trial t = {.name = "random_moves"};
    for (long k = 0; trial_next(&t, 1000); k++, t.cases++) {
        sample s;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        random_rest(&s, &random);
        sample_write(&s);
        ffd_lattice *still = trial_parse(&t, &s);
        if (!still) {
            sample_free(&s);
            continue;
        }
        const double *rest = ffd_lattice_get_points(still, FFD_VOLUME_REST);
        moved_points m = moved_start(&s, rest, s.deformed_points ? s.deformed_points : rest);
        for (int count = draw_int(&random, 1, 3); count > 0; count--)
            moved_random(&m, &s, &random);
        sample_write(&s);
        ffd_lattice *lattice = trial_parse(&t, &s);
        for (size_t i = 0; lattice && i < 3 * m.count; i++) {
            const double found = ffd_lattice_get_points(lattice, FFD_VOLUME_DEFORMED)[i];
            trial_check(
                &t, &s, fabsl(found - m.points[i]) <= 1e-13L * m.size,
                "control point %zu, coordinate %zu is %.17g, expected %.20Lg, off by %.2Lg of the size",
                i / 3, i % 3, found, m.points[i], fabsl(found - m.points[i]) / m.size);
        }
        ffd_lattice_destroy(&lattice);
        moved_free(&m);
        ffd_lattice_destroy(&still);
        sample_free(&s);
    }
    trial_end(&t);
}

/* A cylinder's own directions: along the axis, towards angle 0, and across both. */
typedef struct cylinder {
    long double axis[3], zero[3], side[3];
} cylinder;

static cylinder frame_of(const sample *s)
{
    cylinder c;
    long double length = 0, along = 0;
    for (int a = 0; a < 3; a++)
        length += (long double)s->cylinder_axis[a] * s->cylinder_axis[a];
    int least = 0;
    for (int a = 0; a < 3; a++) {
        c.axis[a] = s->cylinder_axis[a] / sqrtl(length);
        if (fabs(s->cylinder_axis[a]) < fabs(s->cylinder_axis[least]))
            least = a;
    }
    for (int a = 0; a < 3; a++) {
        c.zero[a] = s->has_zero ? s->zero[a] : a == least;
        along += c.zero[a] * c.axis[a];
    }
    length = 0;
    for (int a = 0; a < 3; a++) {
        c.zero[a] -= along * c.axis[a];
        length += c.zero[a] * c.zero[a];
    }
    for (int a = 0; a < 3; a++)
        c.zero[a] /= sqrtl(length);
    for (int a = 0; a < 3; a++)
        c.side[a] = c.axis[(a + 1) % 3] * c.zero[(a + 2) % 3] - c.axis[(a + 2) % 3] * c.zero[(a + 1) % 3];
    return c;
}

/* Radius, angle in degrees, and height over the middle, of a point. */
static void polar(const sample *s, const cylinder *c, const long double point[3], long double out[3])
{
    long double x = 0, y = 0, z = 0;
    for (int a = 0; a < 3; a++) {
        x += (point[a] - s->center[a]) * c->zero[a];
        y += (point[a] - s->center[a]) * c->side[a];
        z += (point[a] - s->center[a]) * c->axis[a];
    }
    out[0] = sqrtl(x * x + y * y);
    out[1] = atan2l(y, x) * 180 / acosl(-1);
    out[2] = z;
}

static void point_of(const sample *s, const cylinder *c, const long double rah[3], long double out[3])
{
    const long double angle = rah[1] * acosl(-1) / 180;
    for (int a = 0; a < 3; a++)
        out[a] = s->center[a] + rah[0] * (cosl(angle) * c->zero[a] + sinl(angle) * c->side[a]) +
                 rah[2] * c->axis[a];
}

static long double at_fraction(const oracle_axis *axis, long double f)
{
    return oracle_wrap(axis, oracle_first(axis) + f * (oracle_last(axis) - oracle_first(axis)));
}

/* The outer face is nowhere nearer to the axis than r1, the inner one nowhere farther than r0, and the ends
   lie at the ends of the height. */
static void check_faces(trial *t, const sample *s, const cylinder *c, const oracle_volume *volume)
{
    const long double tiny = 1e-12L * (s->radius[1] + s->height + 5);
    for (int k = 0; k <= 96; k++) {
        const long double v = at_fraction(&s->axis[1], k / 96.0L),
                          w = at_fraction(&s->axis[2], (k % 8) / 7.0L);
        const long double inner[3] = {oracle_first(&s->axis[0]), v, w},
                          outer[3] = {oracle_last(&s->axis[0]), v, w};
        const long double low[3] = {at_fraction(&s->axis[0], 0.5L), v, oracle_first(&s->axis[2])};
        const long double high[3] = {low[0], v, oracle_last(&s->axis[2])};
        long double point[3], rah[3];
        oracle_evaluate(volume, inner, point, NULL);
        polar(s, c, point, rah);
        trial_check(t, s, rah[0] <= s->radius[0] + tiny, "v %.17Lg: the inner face is at %.17Lg, r0 is %.17g",
                    v, rah[0], s->radius[0]);
        oracle_evaluate(volume, outer, point, NULL);
        polar(s, c, point, rah);
        trial_check(t, s, rah[0] >= s->radius[1] - tiny, "v %.17Lg: the outer face is at %.17Lg, r1 is %.17g",
                    v, rah[0], s->radius[1]);
        oracle_evaluate(volume, low, point, NULL);
        polar(s, c, point, rah);
        trial_check(t, s, fabsl(rah[2] + s->height / 2) <= tiny, "the low end is at %.17Lg, height %.17g",
                    rah[2], s->height);
        oracle_evaluate(volume, high, point, NULL);
        polar(s, c, point, rah);
        trial_check(t, s, fabsl(rah[2] - s->height / 2) <= tiny, "the high end is at %.17Lg, height %.17g",
                    rah[2], s->height);
    }
}

/* v's ends: a0 and, unless it is a full turn, a1. */
static void check_angles(trial *t, const sample *s, const cylinder *c, const oracle_volume *volume, bool full)
{
    for (int end = 0; end < (full ? 1 : 2); end++) {
        const long double v = end == 0 ? oracle_first(&s->axis[1]) : oracle_last(&s->axis[1]);
        const long double uvw[3] = {oracle_last(&s->axis[0]), v, at_fraction(&s->axis[2], 0.5L)};
        long double point[3], rah[3];
        oracle_evaluate(volume, uvw, point, NULL);
        polar(s, c, point, rah);
        const long double off = remainderl(rah[1] - s->angle[end], 360);
        /* A part of a turn must reach the end at least; a full one starts at a0. */
        trial_check(t, s,
                    full       ? fabsl(off) <= 1e-10L
                    : end == 0 ? off <= 1e-10L
                               : off >= -1e-10L,
                    "v = %.17Lg is at the angle %.17Lg, expected %.17g", v, rah[1], s->angle[end]);
    }
}

static void check_coverage(trial *t, const sample *s, const cylinder *c, const oracle_volume *volume,
                           draw *random)
{
    for (int k = 0; k < 4; k++) {
        const long double rah[3] = {
            s->radius[0] + (s->radius[1] - s->radius[0]) * (long double)draw_between(random, 1e-9, 1 - 1e-9),
            s->angle[0] + (s->angle[1] - s->angle[0]) * (long double)draw_between(random, 1e-9, 1 - 1e-9),
            s->height * (long double)draw_between(random, -0.5 + 1e-9, 0.5 - 1e-9)};
        long double point[3], roots[ORACLE_MAX_ROOTS][3];
        point_of(s, c, rah, point);
        const int count = oracle_find_all(volume, point, 1e-15L, roots);
        trial_check(t, s, count == 1,
                    "radius %.17Lg, angle %.17Lg, height %.17Lg is held %d times (widest angle %g)", rah[0],
                    rah[1], rah[2], count, sample_widest_angle(s));
    }
}

/* wide: only those whose control points lie half a turn apart or more somewhere. Such a ring goes round
   nothing, so that the file must be refused unless the volume covers the radii all the same. */
static void cylinders(bool full, bool wide, const char *name)
{
    trial t = {.name = name};
    int refused = 0;
    const sample_limits limits = {.max_degree = 4, .max_extra = 6, .always_closed = {false, full, false}};
    for (uint64_t seed = trial_seed(); trial_next(&t, 150); seed++) {
        sample s;
        sample_init(&s, seed);
        draw random = {seed};
        sample_axes(&s, &random, &limits);
        sample_cylinder(&s, &random, full);
        if ((sample_widest_angle(&s) >= 180) != wide) {
            sample_free(&s);
            continue;
        }
        t.cases++;
        if (random_chance(&random, 0.2))
            s.radius[0] = 0;
        sample_write(&s);
        ffd_lattice *lattice = NULL;
        if (s.knots[1].data[0] == '"' && sample_widest_angle(&s) < 150) {
            lattice = trial_parse(&t, &s);
        } else { /* near half a turn, and where listed knots leave the ends: refused in words, and seldom */
            const ffd_status status = ffd_lattice_parse(s.json.data, s.json.length, "listed", &lattice, NULL);
            trial_check(&t, &s, status == FFD_OK || status == FFD_E_INVALID, "parse: status %d", (int)status);
            refused += status == FFD_E_INVALID;
        }
        if (lattice) {
            oracle_volume volume = sample_volume(&s, lattice, FFD_VOLUME_REST);
            const cylinder c = frame_of(&s);
            check_faces(&t, &s, &c, &volume);
            check_angles(&t, &s, &c, &volume, full);
            check_coverage(&t, &s, &c, &volume, &random);
            oracle_free(&volume);
            ffd_lattice_destroy(&lattice);
        }
        sample_free(&s);
    }
    printf("%s: %d refused\n", name, refused);
    trial_end(&t);
    assert_true(wide || 20 * refused <= t.cases);
}

static void full_cylinders(void **state)
{
    (void)state;
    cylinders(true, false, "full_cylinders");
}

static void part_cylinders(void **state)
{
    (void)state;
    cylinders(false, false, "part_cylinders");
}

static void wide_full_cylinders(void **state)
{
    (void)state;
    cylinders(true, true, "wide_full_cylinders");
}

static void wide_part_cylinders(void **state)
{
    (void)state;
    cylinders(false, true, "wide_part_cylinders");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_moves),        cmocka_unit_test(full_cylinders),
        cmocka_unit_test(part_cylinders),      cmocka_unit_test(wide_full_cylinders),
        cmocka_unit_test(wide_part_cylinders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
