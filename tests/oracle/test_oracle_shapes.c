/* test_oracle_shapes.c - u,v,w in bent, rolled up, closed, collapsed and folded lattices, against all roots
 * that the oracle finds. */
#include "shape_judge.h"
#include "shape_sample.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Every setting in turn; the first two seeds are the plain ones. */
static shape_setting setting_of(uint64_t seed)
{
    static const volume_scale scales[] = {SCALE_PLAIN, SCALE_PLAIN, SCALE_THIN, SCALE_HUGE,
                                          SCALE_FAR,   SCALE_TINY,  SCALE_THIN};
    return (shape_setting){.scale = scales[seed % 7], .rotated = seed % 2 == 1};
}

static void add_totals(judge *totals, const judge *j)
{
    for (int status = 0; status < FFD_VERTEX_STATUS_COUNT; status++)
        totals->seen[status] += j->seen[status];
    totals->judged += j->judged;
    totals->left_out += j->left_out;
}

static void print_totals(const char *name, const judge *totals)
{
    printf("%s: %ld inside, %ld outside, %ld multiple, %ld singular; %ld of %ld left out\n", name,
           totals->seen[FFD_VERTEX_INSIDE], totals->seen[FFD_VERTEX_OUTSIDE],
           totals->seen[FFD_VERTEX_MULTIPLE], totals->seen[FFD_VERTEX_SINGULAR], totals->left_out,
           totals->judged);
}

static void put_on_face(const sample *s, draw *random, long double uvw[3])
{
    const int a = draw_int(random, 0, 2);
    const oracle_axis *axis = &s->axis[a];
    uvw[a] = random_chance(random, 0.5) || axis->closed ? oracle_first(axis) : oracle_last(axis);
}

static void somewhere(const sample *s, draw *random, long double uvw[3])
{
    for (int a = 0; a < 3; a++)
        uvw[a] = oracle_first(&s->axis[a]) + (oracle_last(&s->axis[a]) - oracle_first(&s->axis[a])) *
                                                 (long double)draw_between(random, 0.05, 0.95);
}

/* Points of the volume (also on knots, faces, edges, corners), around it, and on both sides of its faces. */
static void judge_shape(judge *j, draw *random)
{
    enum { KNOWN = 12, WITHIN = 9, NEAR = 9 };
    long double uvw[KNOWN][3], face[3];
    for (int i = 0; i < KNOWN; i++) {
        sample_parameters(j->s, random, uvw[i]);
        judge_add_known(j, uvw[i]);
    }
    for (int i = 0; i < WITHIN; i++)
        judge_add_within(j, random);
    for (int i = 0; i < NEAR; i++) {
        sample_parameters(j->s, random, face);
        put_on_face(j->s, random, face);
        judge_add_near(j, random, face, 1e-3);
    }
    if (!judge_find(j))
        return;
    for (int i = 0; i < j->count; i++)
        judge_counted(j, i, i < KNOWN ? uvw[i] : NULL);
    judge_order(j, random);
}

/* A lattice of a known shape, and what is judged in it. */
typedef struct shape_case {
    long number; /* from 0 in its trial */
    draw random;
    sample s;
    shape x;
    judge j;
} shape_case;

/* Makes the lattice of a case, then judges points in it. */
typedef struct case_steps {
    void (*make)(shape_case *c, shape_kind kind);
    void (*judge)(shape_case *c);
} case_steps;

static void run_case(trial *t, const case_steps *steps, shape_kind kind, long number, judge *totals)
{
    shape_case c = {.number = number};
    sample_init(&c.s, trial_seed() + (uint64_t)number);
    c.random = (draw){c.s.seed};
    steps->make(&c, kind);
    if (judge_open(&c.j, t, &c.s)) {
        steps->judge(&c);
        add_totals(totals, &c.j);
        judge_close(&c.j);
    }
    sample_free(&c.s);
    t->cases++;
}

static void end_cases(const trial *t, const judge *totals)
{
    print_totals(t->name, totals);
    trial_end(t);
}

/* Runs so many cases of one kind of shape at the most, and returns what was counted. */
static judge run_cases(const char *name, const case_steps *steps, shape_kind kind, long cases)
{
    trial t = {.name = name};
    judge totals = {.count = 0};
    for (long k = 0; trial_next(&t, cases); k++)
        run_case(&t, steps, kind, k, &totals);
    end_cases(&t, &totals);
    return totals;
}

static void make_shape(shape_case *c, shape_kind kind)
{
    const shape_setting setting = setting_of(c->s.seed);
    shape_make(&c->x, &c->s, &c->random, kind, &setting);
}

static void make_weighted_shape(shape_case *c, shape_kind kind)
{
    make_shape(c, kind);
    if (random_chance(&c->random, 0.2))
        sample_weights(&c->s, &c->random, 1.1);
}

static void judge_case(shape_case *c)
{
    judge_shape(&c->j, &c->random);
}

/* share: the largest part of the points that may be left out. */
static void run(const char *name, shape_kind kind, long cases, double share)
{
    const judge totals = run_cases(name, &(case_steps){make_weighted_shape, judge_case}, kind, cases);
    assert_true((double)totals.left_out <= share * (double)totals.judged);
    assert_true((kind != SHAPE_OVERLAP && kind != SHAPE_FOLD) || totals.seen[FFD_VERTEX_MULTIPLE] > 0);
}

static void c_shapes(void **state)
{
    (void)state;
    run("c_shapes", SHAPE_C, 7, 0.3);
}

static void spirals(void **state)
{
    (void)state;
    run("spirals", SHAPE_SPIRAL, 5, 0.3);
}

static void twisted_boxes(void **state)
{
    (void)state;
    run("twisted_boxes", SHAPE_TWIST, 7, 0.3);
}

static void half_tori(void **state)
{
    (void)state;
    run("half_tori", SHAPE_HALF_TORUS, 7, 0.3);
}

static void tori(void **state)
{
    (void)state;
    run("tori", SHAPE_TORUS, 4, 0.3);
}

static void kinks(void **state)
{
    (void)state;
    run("kinks", SHAPE_KINKED, 7, 0.3);
}

static void overlaps(void **state)
{
    (void)state;
    run("overlaps", SHAPE_OVERLAP, 7, 0.3);
}

static void folds(void **state)
{
    (void)state;
    run("folds", SHAPE_FOLD, 7, 0.4);
}

/* Known points only where the oracle's recursion would take minutes to look for all. */
static void judge_known(judge *j, draw *random)
{
    enum { KNOWN = 24 };
    long double uvw[KNOWN][3];
    for (int i = 0; i < KNOWN; i++) {
        sample_parameters(j->s, random, uvw[i]);
        judge_add_known(j, uvw[i]);
    }
    if (!judge_find(j))
        return;
    for (int i = 0; i < KNOWN; i++)
        judge_expect(j, i, FFD_VERTEX_INSIDE, uvw[i], NULL);
    judge_order(j, random);
}

/* The case's number is the degree. */
static void make_degree(shape_case *c, shape_kind kind)
{
    (void)kind;
    const shape_setting setting = setting_of(c->s.seed);
    shape_make_degree(&c->x, &c->s, &c->random, (int)c->number, &setting);
}

static void judge_degree(shape_case *c)
{
    enum { MOST_COUNTED = 5 };
    if (c->number <= MOST_COUNTED)
        judge_shape(&c->j, &c->random);
    else
        judge_known(&c->j, &c->random);
}

static void degrees(void **state)
{
    (void)state;
    trial t = {.name = "degrees"};
    judge totals = {.count = 0};
    for (int degree = 1; degree <= FFD_MAX_DEGREE; degree++)
        run_case(&t, &(case_steps){make_degree, judge_degree}, SHAPE_C, degree, &totals);
    end_cases(&t, &totals);
    assert_true(totals.left_out <= totals.judged / 3);
}

/* Points a few tolerances out of a face, and a few inside of it; points that no box holds. */
static void judge_faces(judge *j, draw *random)
{
    static const double steps[] = {2, 4, 50, 1e4, 0.1, 0, -1, -50};
    enum { STEPS = sizeof steps / sizeof steps[0], BESIDE = 5 * STEPS, FAR = 8 };
    long double face[BESIDE][3];
    int direction[BESIDE];
    for (int i = 0; i < BESIDE; i++) {
        const oracle_axis *axis;
        somewhere(j->s, random, face[i]);
        do
            axis = &j->s->axis[direction[i] = draw_int(random, 0, 2)];
        while (axis->closed);
        face[i][direction[i]] = random_chance(random, 0.5) ? oracle_first(axis) : oracle_last(axis);
        judge_add_beside(j, face[i], direction[i], steps[i % STEPS]);
    }
    for (int i = 0; i < FAR; i++)
        judge_add_far(j, random);
    if (!judge_find(j))
        return;
    for (int i = 0; i < BESIDE; i++)
        judge_beside(j, i, face[i], direction[i]);
    for (int i = BESIDE; i < j->count; i++)
        judge_far(j, i);
}

static void make_one_of_all(shape_case *c, shape_kind kind)
{
    static const shape_kind kinds[] = {SHAPE_C,          SHAPE_SPIRAL, SHAPE_TWIST,
                                       SHAPE_HALF_TORUS, SHAPE_TORUS,  SHAPE_KINKED};
    (void)kind;
    make_weighted_shape(c, kinds[c->number % 6]);
}

static void judge_case_faces(shape_case *c)
{
    judge_faces(&c->j, &c->random);
}

static void faces(void **state)
{
    (void)state;
    const judge totals = run_cases("faces", &(case_steps){make_one_of_all, judge_case_faces}, SHAPE_C, 42);
    assert_true(totals.left_out <= totals.judged / 3);
    assert_true(totals.seen[FFD_VERTEX_INSIDE] > 0 && totals.seen[FFD_VERTEX_OUTSIDE] > 0);
}

/* The angle of a quarter circle's rational quadratic at t in [0,1]. */
static long double quarter_angle(long double t)
{
    const long double corner = 2 * t * (1 - t) * sqrtl(0.5L);
    return atan2l(t * t + corner, (1 - t) * (1 - t) + corner);
}

/* The torus in closed form: radius of the tube, angle of the tube, angle of the ring. */
static void torus_coordinates(const long double p[3], long double torus[3])
{
    const long double far = sqrtl(p[0] * p[0] + p[1] * p[1]) - SHAPE_TORUS_RADIUS;
    torus[0] = sqrtl(far * far + p[2] * p[2]);
    torus[1] = atan2l(p[2], far);
    torus[2] = atan2l(p[1], p[0]);
    if (torus[1] < 0)
        torus[1] += 2 * acosl(-1);
}

/* How far a point is inside (> 0) the torus' piece: the least of its distances from the faces. */
static long double depth_in_torus(const shape *x, const long double torus[3], bool whole_tube)
{
    const long double pi = acosl(-1);
    long double depth = fminl(torus[0] - x->radius, x->radius + x->across - torus[0]);
    depth = fminl(depth, fminl(torus[2], pi / 2 - torus[2]));
    return whole_tube ? depth : fminl(depth, fminl(torus[1], pi / 2 - torus[1]));
}

static void judge_torus_point(judge *j, const shape *x, int i)
{
    const long double p[3] = {j->xyz[3 * i], j->xyz[3 * i + 1], j->xyz[3 * i + 2]}, pi = acosl(-1);
    const ffd_location *found = &j->found[i];
    const bool whole = j->volume.axis[x->role[1]].n > 3;
    long double torus[3];
    torus_coordinates(p, torus);
    const long double depth = depth_in_torus(x, torus, whole);
    if (fabsl(depth) < 1e-12L)
        return;
    trial_check(j->t, j->s, found->status == (depth > 0 ? FFD_VERTEX_INSIDE : FFD_VERTEX_OUTSIDE),
                "tube radius %.17Lg, angle %.17Lg, ring angle %.17Lg: status %d", torus[0], torus[1],
                torus[2], found->status);
    if (found->status != FFD_VERTEX_INSIDE)
        return;
    const long double v = found->uvw[x->role[1]], quarter = fminl(floorl(v), whole ? 3 : 0);
    const long double tube = quarter * pi / 2 + quarter_angle(v - quarter);
    const long double ring = quarter_angle(found->uvw[x->role[2]]);
    const long double radius = x->radius + x->across * found->uvw[x->role[0]];
    trial_check(j->t, j->s,
                fabsl(radius - torus[0]) < 1e-13L && fabsl(tube - torus[1]) < 1e-13L &&
                    fabsl(ring - torus[2]) < 1e-13L,
                "tube radius %.17Lg, angle %.17Lg, ring angle %.17Lg: found %.17Lg %.17Lg %.17Lg", torus[0],
                torus[1], torus[2], radius, tube, ring);
}

static void make_bare_shape(shape_case *c, shape_kind kind)
{
    const shape_setting setting = {.bare = true};
    shape_make(&c->x, &c->s, &c->random, kind, &setting);
}

static void judge_torus(shape_case *c)
{
    judge *j = &c->j;
    while (j->count < JUDGE_POINTS / 2)
        judge_add_within(j, &c->random);
    while (j->count < JUDGE_POINTS) {
        long double uvw[3];
        sample_parameters(&c->s, &c->random, uvw);
        judge_add_near(j, &c->random, uvw, 1e-2);
    }
    if (!judge_find(j))
        return;
    for (int i = 0; i < j->count; i++)
        judge_torus_point(j, &c->x, i);
    judge_order(j, &c->random);
}

/* Rational lattices whose inverse is known: u,v,w of any point in closed form. */
static void quarter_tori(void **state)
{
    (void)state;
    const judge totals =
        run_cases("quarter_tori", &(case_steps){make_bare_shape, judge_torus}, SHAPE_QUARTER_TORUS, 20);
    assert_true(totals.seen[FFD_VERTEX_INSIDE] > 0 && totals.seen[FFD_VERTEX_OUTSIDE] > 0);
}

/* Points of collapsed faces have a set of roots, the least of which is the answer; points next to them have
   one. Steps from the face are 1e-3, 1e-4, ... of the domain; below 2^-24 a point may be called singular
   (src/maths.md 6.5). */
static void judge_collapsed(judge *j, const shape *x, draw *random)
{
    enum { ON = 12, STEPS = 8, CLEAR_STEPS = 5, NEXT = 2 * STEPS, KNOWN = 10, WITHIN = 6 };
    long double uvw[ON + NEXT + KNOWN][3], before[3];
    bool exact[ON][3];
    for (int i = 0; i < ON + NEXT; i++) {
        if (i < ON)
            sample_parameters(j->s, random, uvw[i]);
        else
            somewhere(j->s, random, uvw[i]);
        memcpy(before, uvw[i], sizeof before);
        shape_to_collapsed(x, j->s, random, uvw[i]);
        for (int a = 0; i >= ON && a < 3; a++) { /* a step from the face */
            const oracle_axis *axis = &j->s->axis[a];
            const long double step =
                powl(10, -3 - (i - ON) % STEPS) * (oracle_last(axis) - oracle_first(axis));
            if (uvw[i][a] != before[a])
                uvw[i][a] += uvw[i][a] == oracle_first(axis) ? step : -step;
        }
        if (i < ON) {
            memcpy(before, uvw[i], sizeof before);
            assert_true(shape_collapse(x, j->s, uvw[i]));
            for (int a = 0; a < 3; a++)
                exact[i][a] = uvw[i][a] != before[a];
        }
        judge_add_known(j, uvw[i]);
    }
    for (int i = ON + NEXT; i < ON + NEXT + KNOWN; i++) {
        do
            sample_parameters(j->s, random, uvw[i]);
        while (shape_collapse(x, j->s, uvw[i]));
        judge_add_known(j, uvw[i]);
    }
    for (int i = 0; i < WITHIN; i++)
        judge_add_within(j, random);
    if (!judge_find(j))
        return;
    for (int i = 0; i < ON + NEXT + KNOWN; i++)
        if (i >= ON && i < ON + NEXT && (i - ON) % STEPS >= CLEAR_STEPS)
            judge_next_to_singular(j, i, uvw[i]);
        else
            judge_expect(j, i, i < ON ? FFD_VERTEX_SINGULAR : FFD_VERTEX_INSIDE, uvw[i],
                         i < ON ? exact[i] : NULL);
    for (int i = ON + NEXT + KNOWN; i < j->count; i++)
        judge_counted(j, i, NULL);
    judge_order(j, random);
}

static void judge_collapsed_case(shape_case *c)
{
    judge_collapsed(&c->j, &c->x, &c->random);
}

static void run_collapsed(const char *name, shape_kind kind, long cases)
{
    const judge totals = run_cases(name, &(case_steps){make_shape, judge_collapsed_case}, kind, cases);
    assert_true(totals.seen[FFD_VERTEX_SINGULAR] > 0 && totals.left_out <= totals.judged / 2);
}

static void cylinders(void **state)
{
    (void)state;
    run_collapsed("cylinders", SHAPE_CYLINDER, 7);
}

static void sectors(void **state)
{
    (void)state;
    run_collapsed("sectors", SHAPE_SECTOR, 7);
}

static void balls(void **state)
{
    (void)state;
    run_collapsed("balls", SHAPE_BALL, 3);
}

static void shells(void **state)
{
    (void)state;
    run_collapsed("shells", SHAPE_SHELL, 3);
}

static void pyramids(void **state)
{
    (void)state;
    run_collapsed("pyramids", SHAPE_PYRAMID, 7);
}

static void prisms(void **state)
{
    (void)state;
    run_collapsed("prisms", SHAPE_PRISM, 7);
}

typedef enum ends_kind { ENDS_AT_REST, ENDS_ALIKE, ENDS_APART } ends_kind;

/* Moves every control point by its own vector, or by one that control points of one position share. */
static void deform(sample *s, draw *random, ends_kind kind, double size)
{
    const size_t count = sample_count(s);
    if (kind == ENDS_AT_REST)
        return;
    s->deformed_points = sample_array(3 * count);
    for (size_t i = 0; i < 3 * count; i++)
        s->deformed_points[i] = s->points[i] + size * draw_between(random, 0.1, 0.2);
    if (kind == ENDS_APART)
        return;
    const double shift[3] = {size, -size / 2, size / 4};
    for (size_t i = 0; i < 3 * count; i++)
        s->deformed_points[i] = s->points[i] + shift[i % 3];
}

static ends_kind ends_of(const shape_case *c)
{
    return (ends_kind)(c->number % 3);
}

static void make_seam(shape_case *c, shape_kind kind)
{
    static const volume_scale scales[] = {SCALE_PLAIN, SCALE_HUGE, SCALE_PLAIN, SCALE_TINY};
    const shape_setting setting = {.scale = scales[c->number % 4], .rotated = c->number % 2 == 1};
    shape_make_seam(&c->x, &c->s, &c->random, kind, &setting, random_chance(&c->random, 0.7));
    deform(&c->s, &c->random, ends_of(c),
           setting.scale == SCALE_HUGE   ? 1e9
           : setting.scale == SCALE_TINY ? 1e-6
                                         : 1);
}

/* End faces that meet at rest: a point there has one u,v,w, the least, whatever the moves do to the ends. */
static void judge_seam(shape_case *c)
{
    enum { ON = 16, OFF = 8 };
    judge *j = &c->j;
    long double uvw[ON + OFF][3];
    for (int i = 0; i < ON + OFF; i++) {
        somewhere(&c->s, &c->random, uvw[i]);
        for (int part = 1; i < ON && part <= (c->x.kind == SHAPE_TORUS && i % 2 ? 2 : 1); part++)
            uvw[i][c->x.role[part]] = oracle_first(&c->s.axis[c->x.role[part]]);
        judge_add_known(j, uvw[i]);
    }
    if (!judge_find(j))
        return;
    for (int i = 0; i < ON + OFF; i++)
        judge_expect(j, i, FFD_VERTEX_INSIDE, uvw[i], NULL);
    judge_order(j, &c->random);
}

static void run_seams(const char *name, shape_kind kind, long cases)
{
    const judge totals = run_cases(name, &(case_steps){make_seam, judge_seam}, kind, cases);
    assert_int_equal(totals.left_out, 0);
}

static void full_turns(void **state)
{
    (void)state;
    run_seams("full_turns", SHAPE_OVERLAP, 24);
}

static void clamped_tori(void **state)
{
    (void)state;
    run_seams("clamped_tori", SHAPE_TORUS, 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(c_shapes),     cmocka_unit_test(spirals),      cmocka_unit_test(twisted_boxes),
        cmocka_unit_test(half_tori),    cmocka_unit_test(tori),         cmocka_unit_test(kinks),
        cmocka_unit_test(overlaps),     cmocka_unit_test(folds),        cmocka_unit_test(degrees),
        cmocka_unit_test(faces),        cmocka_unit_test(quarter_tori), cmocka_unit_test(cylinders),
        cmocka_unit_test(sectors),      cmocka_unit_test(balls),        cmocka_unit_test(shells),
        cmocka_unit_test(pyramids),     cmocka_unit_test(prisms),       cmocka_unit_test(full_turns),
        cmocka_unit_test(clamped_tori),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
