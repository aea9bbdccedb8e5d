/* test_oracle_embedding.c - ffd_locator_find against roots that the oracle knows. */
#include "embed/locator.h"
#include "volume_sample.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { POINTS = 40 };

/* A lattice under test, what it is measured with, and the points of one call. */
typedef struct subject {
    trial *t;
    sample *s;
    ffd_lattice *lattice;
    ffd_locator *locator;
    oracle_volume volume; /* seen from origin, so that long double holds thin and far lattices too */
    long double origin[3], lo[3], hi[3];
    double xyz[3 * POINTS];
    long double uvw[3 * POINTS];
    ffd_location found[POINTS];
    int count;
    bool far_knots; /* u,v,w are so large that their own rounding shows in the residual */
} subject;

/* Parses s->json and prepares the search. The volume is the file's own box where the way is the affine closed
   form (src/maths.md 5), else the spline of the library's control points. */
static bool open_subject(subject *x, trial *t, sample *s)
{
    ffd_error error = {.status = FFD_OK};
    *x = (subject){.t = t, .s = s};
    sample_write(s);
    x->lattice = trial_parse(t, s);
    if (!x->lattice)
        return false;
    const ffd_status status = ffd_locator_create(x->lattice, &x->locator, &error);
    trial_check(t, s, status == FFD_OK, "locator: %s %s", error.pointer, error.message);
    if (status != FFD_OK) {
        ffd_lattice_destroy(&x->lattice);
        return false;
    }
    const bool affine = strcmp(ffd_locator_get_method(x->locator), "affine") == 0;
    if (s->rest == SAMPLE_BOX && affine) {
        x->volume = sample_box_volume(s, x->origin);
    } else {
        x->volume = sample_volume(s, x->lattice, FFD_VOLUME_REST);
        for (size_t a = 0; a < 3; a++)
            x->origin[a] = x->volume.points[a];
        for (size_t i = 0; i < 3 * sample_count(s); i++)
            x->volume.points[i] -= x->origin[i % 3];
    }
    oracle_bounds(&x->volume, x->lo, x->hi);
    return true;
}

static void close_subject(subject *x)
{
    oracle_free(&x->volume);
    ffd_locator_destroy(&x->locator);
    ffd_lattice_destroy(&x->lattice);
}

static void seen_from_origin(const subject *x, int i, long double p[3])
{
    for (int a = 0; a < 3; a++)
        p[a] = x->xyz[3 * i + a] - x->origin[a];
}

/* src/maths.md 6.6, whatever the weights are: the largest is that of sizes as in the file; sizes from the
   middle of the control points give the least, at which a root is surely met. */
static void tolerances(const subject *x, const long double p[3], long double least[3], long double largest[3])
{
    for (int a = 0; a < 3; a++) {
        const long double extent = x->hi[a] - x->lo[a], middle = (x->lo[a] + x->hi[a]) / 2;
        const long double most = fmaxl(fabsl(x->origin[a] + x->lo[a]), fabsl(x->origin[a] + x->hi[a]));
        least[a] = 16 * DBL_EPSILON * (extent / 2 + fabsl(p[a] - middle));
        largest[a] = 16 * DBL_EPSILON * (most + fabsl(p[a] + x->origin[a]));
    }
}

static const char *status_name(int status)
{
    static const char *const names[] = {"inside", "outside", "multiple", "singular", "invalid"};
    return status >= 0 && status < FFD_VERTEX_STATUS_COUNT ? names[status] : "?";
}

/* A found u,v,w: in the domain, the residual within the tolerance and as reported, and near the known root.
 */
static void check_root(const subject *x, int i, const long double root[3])
{
    const ffd_location *found = &x->found[i];
    const double *p = x->xyz + 3 * i;
    long double uvw[3], q[3], point[3], jacobian[9], inverse[9], least[3], tol[3], length2 = 0, tol2 = 0;
    seen_from_origin(x, i, q);
    for (int a = 0; a < 3; a++) {
        uvw[a] = found->uvw[a];
        trial_check(
            x->t, x->s,
            uvw[a] >= (double)oracle_first(&x->s->axis[a]) && uvw[a] <= (double)oracle_last(&x->s->axis[a]),
            "point %.17g %.17g %.17g: %c = %.17Lg is not in the domain", p[0], p[1], p[2], "uvw"[a], uvw[a]);
        uvw[a] = oracle_wrap(&x->s->axis[a], uvw[a]);
    }
    tolerances(x, q, least, tol);
    oracle_evaluate(&x->volume, uvw, point, jacobian);
    for (int a = 0; a < 3; a++) {
        const long double residual = fabsl(point[a] - q[a]);
        for (int b = 0; b < 3; b++) /* what u is rounded by, from the start of its cell and in the file */
            tol[a] += fabsl(jacobian[3 * a + b]) * DBL_EPSILON *
                      (oracle_last(&x->s->axis[b]) - oracle_first(&x->s->axis[b]) + fabsl(uvw[b]) / 2);
        length2 += residual * residual;
        tol2 += tol[a] * tol[a];
        trial_check(x->t, x->s, residual <= tol[a],
                    "point %.17g %.17g %.17g (root %.17Lg %.17Lg %.17Lg): found %.17g %.17g %.17g, "
                    "residual[%d] %.3Lg "
                    "> tol %.3Lg",
                    p[0], p[1], p[2], root[0], root[1], root[2], found->uvw[0], found->uvw[1], found->uvw[2],
                    a, residual, tol[a]);
    }
    trial_check(x->t, x->s, fabsl(found->residual - sqrtl(length2)) <= sqrtl(tol2),
                "reported residual %.3g, oracle %.3Lg", found->residual, sqrtl(length2));
    if (!oracle_invert(jacobian, inverse))
        return;
    for (int a = 0; a < 3; a++) {
        const oracle_axis *axis = &x->s->axis[a];
        long double reach = 0;
        for (int b = 0; b < 3; b++)
            reach += fabsl(inverse[3 * a + b]) * tol[b];
        const long double allowed = fmaxl(1e-12L * (oracle_last(axis) - oracle_first(axis)), 4 * reach);
        trial_check(x->t, x->s, oracle_distance(axis, uvw[a], root[a]) <= allowed,
                    "point %.17g %.17g %.17g: %c = %.17Lg, expected %.20Lg, allowed %.3Lg", p[0], p[1], p[2],
                    "uvw"[a], uvw[a], root[a], allowed);
    }
}

static void check_nothing_found(const subject *x, int i, int status)
{
    const ffd_location *found = &x->found[i];
    const double *p = x->xyz + 3 * i;
    trial_check(x->t, x->s, found->status == status, "point %.17g %.17g %.17g is %s, expected %s", p[0], p[1],
                p[2], status_name(found->status), status_name(status));
    if (found->status == status)
        trial_check(x->t, x->s,
                    isnan(found->uvw[0]) && isnan(found->uvw[1]) && isnan(found->uvw[2]) &&
                        found->residual == 0,
                    "%s with u,v,w %g %g %g, residual %g", status_name(status), found->uvw[0], found->uvw[1],
                    found->uvw[2], found->residual);
}

/* The point has the one root next to uvw, but may have left the domain when it was rounded to double: then it
   is inside where the nearest point of the domain is within the least tolerance. Where it is not the point
   may be outside, or inside with a root that meets the largest tolerance. */
static void check_known(const subject *x, int i)
{
    const double *p = x->xyz + 3 * i;
    long double root[3], q[3], point[3], least[3], tol[3];
    bool surely_inside = true;
    memcpy(root, x->uvw + 3 * i, sizeof root);
    seen_from_origin(x, i, q);
    oracle_descend(&x->volume, q, root);
    oracle_evaluate(&x->volume, root, point, NULL);
    tolerances(x, q, least, tol);
    for (int a = 0; a < 3; a++) {
        const long double residual = fabsl(point[a] - q[a]);
        surely_inside = surely_inside && residual <= 0.75L * least[a]; /* 4 of 16 eps: C's own rounding */
    }
    if (x->found[i].status == FFD_VERTEX_OUTSIDE && !surely_inside) {
        check_nothing_found(x, i, FFD_VERTEX_OUTSIDE);
        return;
    }
    trial_check(
        x->t, x->s, x->found[i].status == FFD_VERTEX_INSIDE,
        "point %.17g %.17g %.17g (root %.17Lg %.17Lg %.17Lg, residual there %.3Lg %.3Lg %.3Lg, tolerance at "
        "least %.3Lg %.3Lg %.3Lg) is %s",
        p[0], p[1], p[2], root[0], root[1], root[2], point[0] - q[0], point[1] - q[1], point[2] - q[2],
        least[0], least[1], least[2], status_name(x->found[i].status));
    if (x->found[i].status == FFD_VERTEX_INSIDE || x->found[i].status == FFD_VERTEX_MULTIPLE ||
        x->found[i].status == FFD_VERTEX_SINGULAR)
        check_root(x, i, root);
}

static bool find(subject *x)
{
    ffd_error error = {.status = FFD_OK};
    const ffd_status status = ffd_locator_find(x->locator, x->xyz, (size_t)x->count, x->found, &error);
    trial_check(x->t, x->s, status == FFD_OK, "find: %s", error.message);
    return status == FFD_OK;
}

static bool same_location(const ffd_location *a, const ffd_location *b)
{
    return memcmp(a->uvw, b->uvw, sizeof a->uvw) == 0 &&
           memcmp(&a->residual, &b->residual, sizeof a->residual) == 0 && a->status == b->status &&
           a->evaluations == b->evaluations && a->leaves == b->leaves;
}

/* Order and company of the points do not matter: reversed, one by one, and in unequal parts. */
static void check_order(const subject *x, draw *random)
{
    double xyz[3 * POINTS];
    int order[POINTS];
    ffd_location found[POINTS];
    for (int i = 0; i < x->count; i++)
        order[i] = i;
    for (int i = x->count - 1; i > 0; i--) {
        const int k = draw_int(random, 0, i), swap = order[i];
        order[i] = order[k];
        order[k] = swap;
    }
    for (int i = 0; i < x->count; i++)
        memcpy(xyz + 3 * i, x->xyz + 3 * order[i], 3 * sizeof xyz[0]);
    for (int begin = 0, size; begin < x->count; begin += size) {
        size = draw_int(random, 1, 7);
        size = size < x->count - begin ? size : x->count - begin;
        const ffd_status status =
            ffd_locator_find(x->locator, xyz + 3 * begin, (size_t)size, found + begin, NULL);
        trial_check(x->t, x->s, status == FFD_OK, "find of a part: status %d", (int)status);
        if (status != FFD_OK)
            return;
    }
    for (int i = 0; i < x->count; i++)
        trial_check(x->t, x->s, same_location(&found[i], &x->found[order[i]]),
                    "point %d is found otherwise in another order: %.17g %.17g %.17g, %.17g %.17g %.17g",
                    order[i], found[i].uvw[0], found[i].uvw[1], found[i].uvw[2], x->found[order[i]].uvw[0],
                    x->found[order[i]].uvw[1], x->found[order[i]].uvw[2]);
}

static void add_known(subject *x, draw *random)
{
    long double point[3];
    long double *uvw = x->uvw + 3 * x->count;
    sample_parameters(x->s, random, uvw);
    oracle_evaluate(&x->volume, uvw, point, NULL);
    for (int a = 0; a < 3; a++)
        x->xyz[3 * x->count + a] = (double)(x->origin[a] + point[a]);
    x->count++;
}

/* Outside the bounds of the control points: by an extent of one coordinate, by a small part of it, or far
 * away. */
static void add_outside(subject *x, draw *random)
{
    static const long double distances[] = {1e-6L, 1e-3L, 1, 1e12L};
    const int beyond = draw_int(random, 0, 2);
    for (int a = 0; a < 3; a++) {
        const long double extent = x->hi[a] - x->lo[a];
        long double value = x->lo[a] + extent * (long double)draw_unit(random);
        if (a == beyond) {
            const long double distance =
                extent * distances[draw_int(random, 0, 3)] + 1e-9L * fabsl(x->origin[a]);
            value = random_chance(random, 0.5) ? x->lo[a] - distance : x->hi[a] + distance;
        }
        x->xyz[3 * x->count + a] = (double)(x->origin[a] + value);
    }
    x->count++;
}

static void add_invalid(subject *x, draw *random)
{
    const double wrong[] = {NAN, INFINITY, -INFINITY};
    for (int a = 0; a < 3; a++)
        x->xyz[3 * x->count + a] = (double)x->origin[a];
    x->xyz[3 * x->count + draw_int(random, 0, 2)] = wrong[draw_int(random, 0, 2)];
    x->count++;
}

/* The usual round: known points, points outside, points that are none. */
static void round_trip(subject *x, draw *random)
{
    const int known = POINTS - 8;
    while (x->count < known)
        add_known(x, random);
    for (int i = 0; i < 6; i++)
        add_outside(x, random);
    for (int i = 0; i < 2; i++)
        add_invalid(x, random);
    if (!find(x))
        return;
    for (int i = 0; i < known; i++)
        check_known(x, i);
    for (int i = known; i < known + 6; i++)
        check_nothing_found(x, i, FFD_VERTEX_OUTSIDE);
    for (int i = known + 6; i < POINTS; i++)
        check_nothing_found(x, i, FFD_VERTEX_INVALID);
    check_order(x, random);
}

/* Makes the case's lattice; false skips it. method is the way it must take, NULL where it is open. */
typedef bool (*make_function)(sample *s, draw *random, const char **method);

static bool make_far_knots(sample *s, draw *random, const char **method);

static void run(const char *name, make_function make, long cases)
{
    trial t = {.name = name};
    for (uint64_t seed = trial_seed(); trial_next(&t, cases); seed++) {
        sample s;
        const char *method = NULL;
        sample_init(&s, seed);
        draw random = {seed};
        if (!make(&s, &random, &method)) {
            sample_free(&s);
            continue;
        }
        subject x;
        t.cases++;
        if (open_subject(&x, &t, &s)) {
            const char *way = ffd_locator_get_method(x.locator);
            trial_check(&t, &s, !method || strcmp(way, method) == 0, "the way is %s, expected %s", way,
                        method);
            x.far_knots = make == make_far_knots;
            round_trip(&x, &random);
            close_subject(&x);
        }
        sample_free(&s);
    }
    trial_end(&t);
}

static const sample_limits no_closed = {.max_degree = 5, .max_extra = 4};

static bool make_box(sample *s, draw *random, const char **method)
{
    static const double scales[] = {1, 1e-6, 1e9};
    sample_axes(s, random, &no_closed);
    sample_box(s, random, scales[draw_int(random, 0, 2)], 0);
    /* Thin, or far from the origin: without axes, whose products would round. */
    if (random_chance(random, 0.25)) {
        s->has_axes = false;
        const bool thin = random_chance(random, 0.5);
        const int a = draw_int(random, 0, 2);
        const double side = s->box_max[a] - s->box_min[a];
        if (!thin)
            s->box_min[a] += 1e6 * side;
        s->box_max[a] = s->box_min[a] + (thin ? 1e-6 : 1) * side;
    }
    *method = "affine";
    return true;
}

static bool make_affine_points(sample *s, draw *random, const char **method)
{
    sample_axes(s, random, &no_closed);
    sample_warped(s, random, (volume_scale)draw_int(random, 0, SCALE_COUNT - 1), random_chance(random, 0.5),
                  0);
    (void)method; /* rounded points are affine to a few eps only; the way is the library's choice */
    return true;
}

static bool make_uniform_box(sample *s, draw *random, const char **method)
{
    sample_limits limits = no_closed;
    limits.only_clamped = true;
    sample_axes(s, random, &limits);
    sample_box(s, random, 1, 0);
    s->has_axes = s->has_axes && random_chance(random, 0.5);
    s->uniform_spacing = true;
    (void)method;
    return true;
}

static bool make_separable(sample *s, draw *random, const char **method)
{
    sample_axes(s, random, &no_closed);
    sample_separable(s, random, (volume_scale)draw_int(random, 0, SCALE_COUNT - 1));
    bool bent = false; /* two points a side of degree 1 are affine */
    for (int a = 0; a < 3; a++)
        bent = bent || s->axis[a].n > 2;
    *method = bent ? "separable" : NULL;
    return true;
}

static bool make_warped(sample *s, draw *random, const char **method)
{
    sample_axes(s, random, &no_closed);
    sample_warped(s, random, (volume_scale)draw_int(random, 0, SCALE_COUNT - 1), random_chance(random, 0.5),
                  draw_between(random, 0.2, 0.95));
    *method = "general";
    return true;
}

static bool make_high_degree(sample *s, draw *random, const char **method)
{
    const sample_limits limits = {.max_degree = 9, .max_extra = 1};
    sample_axes(s, random, &limits);
    sample_warped(s, random, SCALE_PLAIN, true, draw_between(random, 0.2, 0.9));
    *method = "general";
    return true;
}

static bool make_rational(sample *s, draw *random, const char **method)
{
    sample_axes(s, random, &no_closed);
    sample_warped(s, random, (volume_scale)draw_int(random, 0, SCALE_COUNT - 1), random_chance(random, 0.5),
                  draw_between(random, 0.1, 0.5));
    sample_weights(s, random, draw_between(random, 1.01, 1.3));
    oracle_volume volume = oracle_with_points(s->axis, s->points, s->weights);
    const bool valid = volume_has_one_sign(&volume);
    oracle_free(&volume);
    *method = "general";
    return valid;
}

static bool make_rational_box(sample *s, draw *random, const char **method)
{
    sample_limits limits = no_closed;
    limits.only_clamped = true;
    sample_axes(s, random, &limits);
    sample_box(s, random, 1, 0);
    sample_weights(s, random, draw_between(random, 1.01, 1.3));
    long double corner[3];
    oracle_volume volume = sample_box_volume(s, corner);
    const bool valid = volume_has_one_sign(&volume);
    oracle_free(&volume);
    *method = "general";
    return valid;
}

static bool make_ring(sample *s, draw *random, const char **method)
{
    const sample_limits limits = {.max_degree = 3, .max_extra = 5, .always_closed = {false, true, false}};
    sample_axes(s, random, &limits);
    if (s->axis[1].n < 4)
        return false;
    sample_ring(s, random);
    oracle_volume volume = oracle_with_points(s->axis, s->points, NULL);
    const bool valid = volume_has_one_sign(&volume);
    oracle_free(&volume);
    *method = "general";
    return valid;
}

static bool make_cylinder(sample *s, draw *random, const char **method, bool full)
{
    sample_limits limits = {.max_degree = 3, .max_extra = 4, .always_closed = {false, full, false}};
    sample_axes(s, random, &limits);
    sample_round_cylinder(s, random, full);
    *method = "general";
    return true;
}

static bool make_full_cylinder(sample *s, draw *random, const char **method)
{
    return make_cylinder(s, random, method, true);
}

static bool make_part_cylinder(sample *s, draw *random, const char **method)
{
    return make_cylinder(s, random, method, false);
}

static void box_lattices(void **state)
{
    (void)state;
    run("box_lattices", make_box, 150);
}

static void affine_points(void **state)
{
    (void)state;
    run("affine_points", make_affine_points, 60);
}

static void uniform_boxes(void **state)
{
    (void)state;
    run("uniform_boxes", make_uniform_box, 60);
}

static void separable_points(void **state)
{
    (void)state;
    run("separable_points", make_separable, 100);
}

static void warped_points(void **state)
{
    (void)state;
    run("warped_points", make_warped, 100);
}

static void high_degrees(void **state)
{
    (void)state;
    run("high_degrees", make_high_degree, 8);
}

static void rational_points(void **state)
{
    (void)state;
    run("rational_points", make_rational, 40);
}

static void rational_boxes(void **state)
{
    (void)state;
    run("rational_boxes", make_rational_box, 20);
}

/* Knots far from 0: the distance of two doubles there moves C by more than the tolerance, but a point does
   not lie outside for it. */
static bool make_far_knots(sample *s, draw *random, const char **method)
{
    static const make_function makes[] = {make_box, make_separable, make_warped, make_rational};
    if (!makes[draw_int(random, 0, 3)](s, random, method))
        return false;
    for (int a = 0; a < 3; a++)
        sample_shift_knots(s, a,
                           (double)(oracle_last(&s->axis[a]) - oracle_first(&s->axis[a])) *
                               draw_int(random, -1000, 1000));
    return true;
}

static void far_knots(void **state)
{
    (void)state;
    run("far_knots", make_far_knots, 40);
}

static void closed_rings(void **state)
{
    (void)state;
    run("closed_rings", make_ring, 40);
}

static void full_cylinders(void **state)
{
    (void)state;
    run("full_cylinders", make_full_cylinder, 30);
}

static void part_cylinders(void **state)
{
    (void)state;
    run("part_cylinders", make_part_cylinder, 30);
}

/* Judges a point by all its roots. Where there are several, det J > 0 in all of them, so the least is
 * expected. */
static void check_counted(subject *x, int i)
{
    const double *p = x->xyz + 3 * i;
    long double roots[ORACLE_MAX_ROOTS][3], q[3];
    seen_from_origin(x, i, q);
    const int count = oracle_find_all(&x->volume, q, 1e-15L, roots);
    if (count == 0) {
        check_nothing_found(x, i, FFD_VERTEX_OUTSIDE);
        return;
    }
    const int status = count == 1 ? FFD_VERTEX_INSIDE : FFD_VERTEX_MULTIPLE;
    trial_check(x->t, x->s, x->found[i].status == status, "point %.17g %.17g %.17g with %d roots is %s", p[0],
                p[1], p[2], count, status_name(x->found[i].status));
    if (x->found[i].status == FFD_VERTEX_INSIDE || x->found[i].status == FFD_VERTEX_MULTIPLE)
        check_root(x, i, roots[0]);
}

static void add_within_bounds(subject *x, draw *random)
{
    for (int a = 0; a < 3; a++)
        x->xyz[3 * x->count + a] =
            (double)(x->origin[a] + x->lo[a] + (x->hi[a] - x->lo[a]) * (long double)draw_unit(random));
    x->count++;
}

/* Bars bent to less and more than a full turn: every count of roots from 0 to 2. */
static void bent_bars(void **state)
{
    (void)state;
    trial t = {.name = "bent_bars"};
    int seen[5] = {0};
    for (long k = 0; trial_next(&t, 20); k++, t.cases++) {
        sample s;
        subject x;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        sample_arc(&s, &random, draw_between(&random, 90, 560));
        if (open_subject(&x, &t, &s)) {
            trial_check(&t, &s, volume_has_one_sign(&x.volume), "the arc is not regular");
            while (x.count < POINTS)
                add_within_bounds(&x, &random);
            if (find(&x)) {
                for (int i = 0; i < x.count; i++) {
                    check_counted(&x, i);
                    seen[x.found[i].status]++;
                }
                check_order(&x, &random);
            }
            close_subject(&x);
        }
        sample_free(&s);
    }
    printf("bent_bars: %d inside, %d outside, %d multiple\n", seen[0], seen[1], seen[2]);
    trial_end(&t);
    assert_true(seen[FFD_VERTEX_INSIDE] > 0 && seen[FFD_VERTEX_OUTSIDE] > 0 && seen[FFD_VERTEX_MULTIPLE] > 0);
}

/* Next to the faces of a warped volume, on both sides of them, and in closed rings: judged by all roots. */
static void near_faces(void **state)
{
    (void)state;
    trial t = {.name = "near_faces"};
    for (uint64_t seed = trial_seed(); trial_next(&t, 30); seed++) {
        static const make_function makes[] = {make_full_cylinder, make_warped, make_rational, make_ring};
        sample s;
        subject x;
        const char *method;
        sample_init(&s, seed);
        draw random = {seed};
        if (!makes[seed % 4](&s, &random, &method)) {
            sample_free(&s);
            continue;
        }
        t.cases++;
        if (open_subject(&x, &t, &s)) {
            while (x.count < POINTS / 2) {
                long double uvw[3], point[3];
                const int a = draw_int(&random, 0, 2);
                for (int c = 0; c < 3; c++)
                    uvw[c] = oracle_first(&s.axis[c]) + (oracle_last(&s.axis[c]) - oracle_first(&s.axis[c])) *
                                                            (long double)draw_unit(&random);
                uvw[a] = random_chance(&random, 0.5) ? oracle_first(&s.axis[a]) : oracle_last(&s.axis[a]);
                oracle_evaluate(&x.volume, uvw, point, NULL);
                for (int c = 0; c < 3; c++) {
                    const long double way = (x.hi[c] - x.lo[c]) * draw_between(&random, -1e-3, 1e-3);
                    x.xyz[3 * x.count + c] = (double)(x.origin[c] + point[c] + way);
                }
                x.count++;
            }
            if (find(&x))
                for (int i = 0; i < x.count; i++)
                    check_counted(&x, i);
            close_subject(&x);
        }
        sample_free(&s);
    }
    trial_end(&t);
}

/* A cylinder from radius 0: points of the axis have a line of roots, and the least u,v,w of it is the answer
 * for them. */
static void collapsed_axes(void **state)
{
    (void)state;
    trial t = {.name = "collapsed_axes"};
    for (uint64_t seed = trial_seed(); trial_next(&t, 15); seed++) {
        sample s;
        subject x;
        const char *method;
        sample_init(&s, seed);
        draw random = {s.seed};
        if (!make_cylinder(&s, &random, &method, true)) {
            sample_free(&s);
            continue;
        }
        t.cases++;
        s.radius[0] = 0;
        for (int a = 0; a < 3; a++) { /* on a coordinate axis, so that the points of the axis are exact */
            s.cylinder_axis[a] = a == 2;
            s.center[a] = 0;
        }
        s.has_zero = false;
        s.axis[0] = (oracle_axis){.n = 0};
        sample_named_axis(&s, 0, "clamped", 4, draw_int(&random, 1, 3));
        if (open_subject(&x, &t, &s)) {
            const int known = POINTS / 2;
            while (x.count < known) {
                add_known(&x, &random);
                if (x.uvw[3 * x.count - 3] == 0)
                    x.count--;
            }
            for (int i = 0; i < 6; i++, x.count++) {
                double *p = x.xyz + 3 * x.count;
                p[0] = p[1] = 0;
                p[2] = s.height * draw_between(&random, -0.49, 0.49);
            }
            if (find(&x)) {
                for (int i = 0; i < known; i++)
                    check_known(&x, i);
                for (int i = known; i < x.count; i++) {
                    const ffd_location *found = &x.found[i];
                    trial_check(&t, &s, found->status == FFD_VERTEX_SINGULAR, "a point of the axis is %s",
                                status_name(found->status));
                    trial_check(&t, &s,
                                found->status == FFD_VERTEX_OUTSIDE ||
                                    (found->uvw[0] == 0 && found->uvw[1] == (double)oracle_first(&s.axis[1])),
                                "a point of the axis has u,v,w %.17g %.17g %.17g", found->uvw[0],
                                found->uvw[1], found->uvw[2]);
                }
                check_order(&x, &random);
            }
            close_subject(&x);
        }
        sample_free(&s);
    }
    trial_end(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(box_lattices),   cmocka_unit_test(affine_points),
        cmocka_unit_test(uniform_boxes),  cmocka_unit_test(separable_points),
        cmocka_unit_test(warped_points),  cmocka_unit_test(high_degrees),
        cmocka_unit_test(closed_rings),   cmocka_unit_test(full_cylinders),
        cmocka_unit_test(part_cylinders), cmocka_unit_test(bent_bars),
        cmocka_unit_test(near_faces),     cmocka_unit_test(rational_points),
        cmocka_unit_test(rational_boxes), cmocka_unit_test(far_knots),
        cmocka_unit_test(collapsed_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
