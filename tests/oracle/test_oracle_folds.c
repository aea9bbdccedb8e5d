/* test_oracle_folds.c - verdicts on random deformed lattices against determinants that the oracle samples. */
#include "../support/lattice_by_hand.h"
#include "moves_sample.h"
#include "volume_sample.h"
#include <ffd/fold.h>

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A lattice under test and its volumes, seen from a control point. */
typedef struct subject {
    trial *t;
    sample *s;
    oracle_volume rest, deformed;
    double fineness; /* of u,v,w, whose own rounding shows in the determinant */
    int sign;
    long double mean; /* of det J_P, times sign */
} subject;

/* Totals over a test's lattices. */
typedef struct tally {
    long none, some, unknown;
    long bounds, near; /* lower bounds that were looked at, and those within 2 % of the least determinant */
} tally;

static oracle_volume shifted(const sample *s, const ffd_lattice *lattice, ffd_volume which)
{
    oracle_volume volume = sample_volume(s, lattice, which);
    const long double origin[3] = {volume.points[0], volume.points[1], volume.points[2]};
    for (size_t i = 0; i < oracle_count(&volume); i++)
        for (size_t r = 0; r < 3; r++)
            volume.points[3 * i + r] -= origin[r];
    return volume;
}

/* det J, and the greatest that it could be with other signs: what its rounding is relative to. */
static long double determinant_at(const oracle_volume *volume, const long double uvw[3], long double *size)
{
    long double point[3], jacobian[9];
    oracle_evaluate(volume, uvw, point, jacobian);
    const long double value = oracle_determinant(jacobian);
    if (size) {
        long double m[9];
        oracle_magnitude(volume, uvw, point, m);
        *size = 0;
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            *size += m[a] * (m[3 + b] * m[6 + c] + m[3 + c] * m[6 + b]);
        }
    }
    return value;
}

/* The span cells of the domain, by number. */
typedef struct cells {
    int count[3], span[3][ORACLE_MAX_KNOTS];
    size_t total;
} cells;

static cells find_cells(const oracle_volume *volume)
{
    cells c = {.total = 1};
    for (int a = 0; a < 3; a++) {
        const oracle_axis *axis = &volume->axis[a];
        for (int i = axis->degree; i < axis->n + (axis->closed ? axis->degree : 0); i++)
            if (oracle_knot(axis, i) < oracle_knot(axis, i + 1))
                c.span[a][c.count[a]++] = i;
        c.total *= (size_t)c.count[a];
    }
    return c;
}

static void cell_bounds(const oracle_volume *volume, const cells *c, size_t cell, long double lo[3],
                        long double hi[3])
{
    for (int a = 0; a < 3; a++) {
        const int span = c->span[a][cell % (size_t)c->count[a]];
        cell /= (size_t)c->count[a];
        lo[a] = oracle_knot(&volume->axis[a], span);
        hi[a] = oracle_knot(&volume->axis[a], span + 1);
    }
}

/* t in [0,1] of a cell, without leaving it at its end, where the next one's derivatives count. */
static void parameters(const oracle_volume *volume, const long double lo[3], const long double hi[3],
                       const long double t[3], long double uvw[3])
{
    for (int a = 0; a < 3; a++) {
        uvw[a] = lo[a] + t[a] * (hi[a] - lo[a]);
        if (uvw[a] >= hi[a])
            uvw[a] = nextafterl(hi[a], lo[a]);
        uvw[a] = oracle_wrap(&volume->axis[a], uvw[a]);
    }
}

/* Legendre's rules on [0,1], symmetric: the first half of their nodes and weights. */
typedef struct rule {
    int points;
    long double node[5], weight[5];
} rule;

static const rule rule_5 = {
    5,
    {0.0469100770306680036012L, 0.2307653449471584544819L, 0.5L},
    {0.1184634425280945437571L, 0.2393143352496832340206L, 0.2844444444444444444444L}};
static const rule rule_9 = {9,
                            {0.0159198802461869550822L, 0.0819844463366821028503L, 0.1933142836497048013456L,
                             0.3378732882980955354807L, 0.5L},
                            {0.0406371941807872059860L, 0.0903240803474287020292L, 0.1303053482014677311594L,
                             0.1561735385200014200343L, 0.1651196776006298815823L}};

/* The mean of det J_P: without weights exact for degrees up to 6. */
static long double mean_determinant(const oracle_volume *volume)
{
    const cells c = find_cells(volume);
    const rule *rules[3];
    long double sum = 0, whole = 1;
    int points = 1;
    for (int a = 0; a < 3; a++) {
        whole *= oracle_last(&volume->axis[a]) - oracle_first(&volume->axis[a]);
        rules[a] = volume->axis[a].degree <= 3 && !volume->weights ? &rule_5 : &rule_9;
        points *= rules[a]->points;
    }
    for (size_t cell = 0; cell < c.total; cell++) {
        long double lo[3], hi[3];
        cell_bounds(volume, &c, cell, lo, hi);
        for (int step = 0; step < points; step++) {
            long double t[3], uvw[3], part = 1;
            for (int a = 0, rest = step; a < 3; rest /= rules[a]->points, a++) {
                const int last = rules[a]->points - 1, i = rest % (last + 1);
                const int half = i <= last / 2 ? i : last - i;
                t[a] = i == half ? rules[a]->node[half] : 1 - rules[a]->node[half];
                part *= rules[a]->weight[half] * (hi[a] - lo[a]);
            }
            parameters(volume, lo, hi, t, uvw);
            sum += part * determinant_at(volume, uvw, NULL);
        }
    }
    return sum / whole;
}

/* The least determinant, times sign. */
typedef struct least_place {
    long double value, size;
    long double lo[3], hi[3], t[3]; /* its cell, and its parameters there */
} least_place;

static void examine(const subject *x, least_place *least, const long double lo[3], const long double hi[3],
                    const long double t[3])
{
    long double uvw[3], size;
    parameters(&x->deformed, lo, hi, t, uvw);
    const long double value = x->sign * determinant_at(&x->deformed, uvw, &size);
    if (value >= least->value)
        return;
    *least = (least_place){.value = value, .size = size};
    for (int a = 0; a < 3; a++) {
        least->lo[a] = lo[a];
        least->hi[a] = hi[a];
        least->t[a] = t[a];
    }
}

enum { STEPS = 3 };

static least_place sample_least(const subject *x)
{
    const cells c = find_cells(&x->deformed);
    least_place least = {.value = LDBL_MAX};
    for (size_t cell = 0; cell < c.total; cell++) {
        long double lo[3], hi[3];
        cell_bounds(&x->deformed, &c, cell, lo, hi);
        for (int step = 0; step < (STEPS + 1) * (STEPS + 1) * (STEPS + 1); step++) {
            const long double t[3] = {(long double)(step % (STEPS + 1)) / STEPS,
                                      (long double)(step / (STEPS + 1) % (STEPS + 1)) / STEPS,
                                      (long double)(step / (STEPS + 1) / (STEPS + 1)) / STEPS};
            examine(x, &least, lo, hi, t);
        }
    }
    return least;
}

/* Goes down from the least point found, within its cell. */
static void descend(const subject *x, least_place *least)
{
    for (long double reach = 0.5L / STEPS; reach > 1e-7L;) {
        const least_place before = *least;
        for (int step = 0; step < 27; step++) {
            const int way[3] = {step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1};
            long double t[3];
            for (int a = 0; a < 3; a++)
                t[a] = fminl(fmaxl(before.t[a] + way[a] * reach, 0), 1);
            examine(x, least, before.lo, before.hi, t);
        }
        if (!(least->value < before.value))
            reach /= 2;
    }
}

static void check_witness(const subject *x, const ffd_folds *folds)
{
    long double uvw[3], size;
    for (int a = 0; a < 3; a++) {
        uvw[a] = folds->witness.uvw[a];
        trial_check(x->t, x->s,
                    uvw[a] >= oracle_first(&x->deformed.axis[a]) &&
                        uvw[a] <= oracle_last(&x->deformed.axis[a]),
                    "the witness' %c = %.17Lg is not in the domain", "uvw"[a], uvw[a]);
        uvw[a] = oracle_wrap(&x->deformed.axis[a], uvw[a]);
    }
    const long double value = x->sign * determinant_at(&x->deformed, uvw, &size);
    /* A witness of 0 means a cell that is flat to rounding. */
    const double error = folds->witness.det < 0 ? x->fineness : 1e-12;
    trial_check(x->t, x->s, value <= error * size,
                "a witness at %.17Lg, %.17Lg, %.17Lg, where the determinant is %.3Lg of %.3Lg", uvw[0],
                uvw[1], uvw[2], value, size);
    trial_check(x->t, x->s, folds->witness.det <= 0 && folds->min_det <= folds->witness.det,
                "determinant %g at the witness, least %g", folds->witness.det, folds->min_det);
}

/* One affine map: det J is its determinant times that at rest, everywhere. */
static void check_affine(const subject *x, const ffd_folds *folds, tally *sum)
{
    const cells c = find_cells(&x->rest);
    trial_check(x->t, x->s, folds->verdict == FFD_FOLDS_NONE && folds->min_det > 0, "verdict %d, det %g",
                (int)folds->verdict, folds->min_det);
    for (size_t cell = 0; cell < c.total; cell++) {
        const long double t[3] = {0.3L, 0.45L, 0.6L};
        long double lo[3], hi[3], uvw[3], size;
        cell_bounds(&x->rest, &c, cell, lo, hi);
        parameters(&x->rest, lo, hi, t, uvw);
        const long double rest = determinant_at(&x->rest, uvw, NULL),
                          deformed = determinant_at(&x->deformed, uvw, &size);
        trial_check(x->t, x->s, fabsl(deformed - folds->min_det * rest) <= 1e-9L * size,
                    "det J is %.17Lg, at rest %.17Lg, but %.17g of it", deformed, rest, folds->min_det);
    }
    sum->none++;
}

static void check_verdict(const subject *x, const ffd_folds *folds, tally *sum)
{
    if (folds->relative_to == FFD_FOLDS_TO_PLACE) {
        check_affine(x, folds, sum);
        return;
    }
    least_place least = sample_least(x);
    descend(x, &least);
    const long double error = x->fineness * least.size;
    if (folds->verdict == FFD_FOLDS_NONE)
        trial_check(x->t, x->s, least.value >= -error, "no folds, but a determinant of %.3Lg of %.3Lg",
                    least.value, least.size);
    if (folds->verdict == FFD_FOLDS_SOME)
        check_witness(x, folds);
    trial_check(x->t, x->s, folds->verdict == FFD_FOLDS_SOME || least.value >= -1e-10L * least.size,
                "verdict %d, but a determinant of %.3Lg of %.3Lg", (int)folds->verdict, least.value,
                least.size);
    sum->none += folds->verdict == FFD_FOLDS_NONE;
    sum->some += folds->verdict == FFD_FOLDS_SOME;
    sum->unknown += folds->verdict == FFD_FOLDS_UNKNOWN;

    const long double relative = least.value / x->mean,
                      slack = 1e-9L + (error + 1e-11L * least.size) / x->mean;
    trial_check(x->t, x->s, folds->min_det <= relative + 1e-9L * fabsl(relative) + slack,
                "least determinant %.17g, but one of %.17Lg", folds->min_det, relative);
    sum->bounds++;
    sum->near += folds->min_det >= relative - 0.02L * fabsl(relative) - slack;
}

static void check_lattice(trial *t, sample *s, double fineness, tally *sum)
{
    ffd_lattice *lattice = trial_parse(t, s);
    if (!lattice)
        return;
    subject x = {.t = t,
                 .s = s,
                 .rest = shifted(s, lattice, FFD_VOLUME_REST),
                 .deformed = shifted(s, lattice, FFD_VOLUME_DEFORMED),
                 .fineness = fineness};
    x.mean = mean_determinant(&x.rest);
    x.sign = x.mean < 0 ? -1 : 1;
    x.mean = fabsl(x.mean);
    ffd_folds folds = {.struct_size = sizeof folds}, again = folds;
    ffd_error error;
    const bool found = ffd_folds_find(lattice, 1, &folds, &error) == FFD_OK &&
                       ffd_folds_find(lattice, 2, &again, &error) == FFD_OK;
    trial_check(t, s, found, "%s", error.message);
    if (found) {
        trial_check(t, s,
                    folds.verdict == again.verdict && folds.min_det == again.min_det &&
                        folds.folded_cells == again.folded_cells &&
                        folds.unknown_cells == again.unknown_cells &&
                        !memcmp(folds.witness.uvw, again.witness.uvw, sizeof folds.witness.uvw),
                    "two threads find other folds than one");
        check_verdict(&x, &folds, sum);
    }
    oracle_free(&x.rest);
    oracle_free(&x.deformed);
    ffd_lattice_destroy(&lattice);
}

/* Lattices */

/* The rest points, each moved at random by up to `strength` of the way to its next ones. */
static void shake(trial *t, sample *s, draw *random)
{
    static const double strengths[] = {0, 0.1, 0.3, 0.6, 1.5};
    const double strength = strengths[draw_int(random, 0, 4)];
    sample_write(s);
    ffd_lattice *still = trial_parse(t, s);
    if (!still)
        return;
    const double *rest = ffd_lattice_get_points(still, FFD_VOLUME_REST);
    const size_t count = sample_count(s),
                 stride[3] = {1, (size_t)s->axis[0].n, (size_t)s->axis[0].n * (size_t)s->axis[1].n};
    s->deformed_points = sample_array(3 * count);
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < 3; r++) {
            double way = 0;
            for (int a = 0; a < 3; a++) {
                const double there = rest[3 * ((i + stride[a]) % count) + r];
                way += draw_between(random, -1, 1) * strength / s->axis[a].degree * (there - rest[3 * i + r]);
            }
            s->deformed_points[3 * i + r] = rest[3 * i + r] + way;
        }
    ffd_lattice_destroy(&still);
}

static void move(trial *t, sample *s, draw *random)
{
    sample_write(s);
    ffd_lattice *still = trial_parse(t, s);
    if (!still)
        return;
    const double *rest = ffd_lattice_get_points(still, FFD_VOLUME_REST);
    moved_points m = moved_start(s, rest, rest);
    for (int count = draw_int(random, 1, 2); count > 0; count--)
        moved_random(&m, s, random);
    moved_free(&m);
    ffd_lattice_destroy(&still);
}

typedef double (*make_function)(trial *t, sample *s, draw *random); /* returns the fineness */

static void run(const char *name, make_function make, long cases, long least_none, long least_some,
                long most_unknown)
{
    trial t = {.name = name};
    tally sum = {0};
    for (; trial_next(&t, cases); t.cases++) {
        sample s;
        sample_init(&s, trial_seed() + (uint64_t)t.cases);
        draw random = {s.seed};
        const double fineness = make(&t, &s, &random);
        sample_write(&s);
        check_lattice(&t, &s, fineness, &sum);
        sample_free(&s);
    }
    printf("%s: none %ld, some %ld, unknown %ld; %ld of %ld lower bounds within 2 %%\n", name, sum.none,
           sum.some, sum.unknown, sum.near, sum.bounds);
    trial_end(&t);
    if (t.cases < TRIAL_LEAST) /* too few for shares */
        return;
    assert_true(sum.none * 100 >= least_none * t.cases);
    assert_true(sum.some * 100 >= least_some * t.cases);
    assert_true(sum.unknown * 100 <= most_unknown * t.cases);
    assert_true(sum.near * 100 >= 90 * sum.bounds);
}

static double make_box(trial *t, sample *s, draw *random)
{
    const sample_limits limits = {.max_degree = 4, .max_extra = 2};
    sample_axes(s, random, &limits);
    sample_box(s, random, random_chance(random, 0.2) ? 1e9 : 1, random_chance(random, 0.2) ? 1e6 : 0);
    if (random_chance(random, 0.5)) {
        move(t, s, random);
    } else {
        shake(t, s, random);
    }
    return 1e-15;
}

static double make_warped(trial *t, sample *s, draw *random)
{
    const sample_limits limits = {.max_degree = 3, .max_extra = 2};
    const volume_scale scale = (volume_scale)draw_int(random, 0, SCALE_COUNT - 1);
    sample_axes(s, random, &limits);
    if (random_chance(random, 0.3)) {
        sample_separable(s, random, scale);
    } else {
        sample_warped(s, random, scale, random_chance(random, 0.5), draw_between(random, 0, 0.9));
    }
    shake(t, s, random);
    return 1e-15;
}

static double make_rational(trial *t, sample *s, draw *random)
{
    const sample_limits limits = {.max_degree = 3, .max_extra = 1};
    sample_axes(s, random, &limits);
    sample_warped(s, random, SCALE_PLAIN, true, draw_between(random, 0, 0.6));
    shake(t, s, random);
    sample_weights(s, random, random_chance(random, 0.5) ? 1.1 : 2);
    if (random_chance(random, 0.6)) {
        s->deformed_weights = sample_array(sample_count(s));
        for (size_t i = 0; i < sample_count(s); i++)
            s->deformed_weights[i] = s->weights[i] * draw_between(random, 0.8, 1.25);
    }
    return 1e-14;
}

static double make_high_degree(trial *t, sample *s, draw *random)
{
    static const int degree[][3] = {{5, 1, 2}, {2, 6, 1}, {1, 2, 7}, {8, 1, 1}, {1, 9, 2}, {5, 5, 2}};
    const int *d = degree[draw_int(random, 0, 5)];
    for (int a = 0; a < 3; a++)
        sample_named_axis(s, a, random_chance(random, 0.5) ? "clamped" : "open",
                          d[a] + 1 + draw_int(random, 0, 1), d[a]);
    sample_warped(s, random, SCALE_PLAIN, true, draw_between(random, 0, 0.5));
    shake(t, s, random);
    return 1e-13;
}

static double make_closed(trial *t, sample *s, draw *random)
{
    const sample_limits limits = {.max_degree = 3, .max_extra = 2};
    sample_axes(s, random, &limits);
    sample_named_axis(s, 1, "closed", draw_int(random, 8, 12), draw_int(random, 2, 3));
    sample_ring(s, random);
    if (random_chance(random, 0.5))
        shake(t, s, random);
    return 1e-15;
}

/* From the axis, which stays a line or is moved at random. */
static double make_collapsed(trial *t, sample *s, draw *random)
{
    const sample_limits limits = {.max_degree = 3, .max_extra = 2, .always_closed = {false, true, false}};
    sample_axes(s, random, &limits);
    sample_named_axis(s, 0, "clamped", draw_int(random, 4, 5), draw_int(random, 1, 3));
    sample_round_cylinder(s, random, true);
    s->radius[0] = 0;
    if (random_chance(random, 0.6)) {
        static const char *const moves[] = {
            "{\"twist\":{\"axis\":\"z\",\"degrees\":30}}",
            "{\"bend\":{\"axis\":\"x\",\"toward\":[0,1,0],\"degrees\":40}}",
            "{\"at\":[\"all\",\"all\",1],\"by\":[0.1,0.1,0.1]}",
            "{\"at\":[0,\"all\",\"all\"],\"by\":[0.05,-0.05,0.02]}",
            "{\"at\":[0,1,\"all\"],\"by\":[0.05,-0.05,0.02]}",
            "{\"at\":[1,\"all\",\"all\"],\"scale\":{\"factor\":-0.2}}",
        };
        text_add(&s->moves, "%s", moves[draw_int(random, 0, 5)]);
    } else if (random_chance(random, 0.5)) {
        shake(t, s, random);
    }
    return 1e-14;
}

/* The edge of folding */

/* rest + amount * way */
static ffd_folds verdict_at(ffd_lattice *lattice, const double *way, double amount)
{
    ffd_folds folds = {.struct_size = sizeof folds};
    for (size_t i = 0; i < 3 * lattice->count; i++)
        lattice->deformed[i] = lattice->rest[i] + amount * way[i];
    if (finish_by_hand(lattice, NULL) || ffd_folds_find(lattice, 1, &folds, NULL))
        abort();
    return folds;
}

/* Between an amount whose verdict is `low` and one whose verdict is not: the last of the one, or the first of
   the other kind. */
static double find_edge(ffd_lattice *lattice, const double *way, bool (*is_low)(ffd_fold_verdict), bool last,
                        double most)
{
    double low = 0, high = most;
    for (;;) {
        const double middle = 0.5 * (low + high);
        if (!(low < middle && middle < high))
            return last ? low : high;
        if (is_low(verdict_at(lattice, way, middle).verdict))
            low = middle;
        else
            high = middle;
    }
}

static bool is_none(ffd_fold_verdict verdict)
{
    return verdict == FFD_FOLDS_NONE;
}

static bool is_not_some(ffd_fold_verdict verdict)
{
    return verdict != FFD_FOLDS_SOME;
}

/* The last deformation that is proven, and the first that is refuted: the oracle must agree to its last
   digits, and little may lie between. */
static void check_edge(trial *t, sample *s, ffd_lattice *lattice, const double *way)
{
    double most = 0.01;
    while (most < 1e6 && verdict_at(lattice, way, most).verdict != FFD_FOLDS_SOME)
        most *= 2;
    const double proven = find_edge(lattice, way, is_none, true, most),
                 refuted = find_edge(lattice, way, is_not_some, false, most);
    trial_check(t, s, refuted - proven < 1e-8 * refuted, "proven up to %.17g, refuted from %.17g", proven,
                refuted);
    for (int end = 0; end < 2; end++) {
        const ffd_folds folds = verdict_at(lattice, way, end ? refuted : proven);
        subject x = {.t = t,
                     .s = s,
                     .rest = shifted(s, lattice, FFD_VOLUME_REST),
                     .deformed = shifted(s, lattice, FFD_VOLUME_DEFORMED),
                     .fineness = 1e-16};
        x.sign = mean_determinant(&x.rest) < 0 ? -1 : 1;
        least_place least = sample_least(&x);
        descend(&x, &least);
        if (end == 0)
            trial_check(t, s, folds.verdict == FFD_FOLDS_NONE && least.value > 0 && folds.min_det > 0,
                        "at %.17g verdict %d, least %.3Lg of %.3Lg", proven, (int)folds.verdict, least.value,
                        least.size);
        else
            check_witness(&x, &folds);
        oracle_free(&x.rest);
        oracle_free(&x.deformed);
    }
}

static void edge(void **state)
{
    (void)state;
    trial t = {.name = "edge"};
    for (; trial_next(&t, 12); t.cases++) {
        sample s;
        sample_init(&s, trial_seed() + (uint64_t)t.cases);
        draw random = {s.seed};
        const sample_limits limits = {.max_degree = 3, .max_extra = 1};
        sample_axes(&s, &random, &limits);
        sample_warped(&s, &random, t.cases % 3 ? SCALE_PLAIN : SCALE_THIN, false, 0.3);
        if (random_chance(&random, 0.3))
            sample_weights(&s, &random, 1.2);
        sample_write(&s);
        ffd_lattice *lattice = trial_parse(&t, &s);
        double *way = sample_array(3 * sample_count(&s));
        for (size_t i = 0; i < 3 * sample_count(&s); i++)
            way[i] =
                draw_between(&random, -1, 1) * (s.points[3 * sample_count(&s) - 3 + i % 3] - s.points[i % 3]);
        if (lattice && verdict_at(lattice, way, 0).verdict == FFD_FOLDS_NONE)
            check_edge(&t, &s, lattice, way);
        free(way);
        ffd_lattice_destroy(&lattice);
        sample_free(&s);
    }
    trial_end(&t);
    assert_true(t.checks >= 2 * t.cases);
}

static void boxes(void **state)
{
    (void)state;
    run("boxes", make_box, 60, 20, 20, 5);
}

static void warped(void **state)
{
    (void)state;
    run("warped", make_warped, 60, 20, 20, 5);
}

static void rational(void **state)
{
    (void)state;
    run("rational", make_rational, 40, 20, 20, 5);
}

static void high_degrees(void **state)
{
    (void)state;
    run("high degrees", make_high_degree, 24, 20, 10, 5);
}

static void closed(void **state)
{
    (void)state;
    run("closed", make_closed, 40, 20, 10, 5);
}

static void collapsed(void **state)
{
    (void)state;
    run("collapsed", make_collapsed, 40, 20, 10, 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes),        cmocka_unit_test(warped), cmocka_unit_test(rational),
        cmocka_unit_test(high_degrees), cmocka_unit_test(closed), cmocka_unit_test(collapsed),
        cmocka_unit_test(edge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
