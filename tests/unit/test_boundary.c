/* test_boundary.c - the nearest point of the rest volume's border. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "../support/lattice_maps.h"
#include "../support/locations.h"
#include "../support/repetitions.h"
#include "base/vector/vec.h"
#include "embed/boundary/boundary.h"
#include <float.h>
#include <stdint.h>

/* Lattices */

static ffd_lattice *parsed(const char *text)
{
    ffd_lattice *lattice = NULL;
    ffd_error error;
    if (ffd_lattice_parse(text, strlen(text), "test", &lattice, &error))
        fail_msg("%s", error.message);
    return lattice;
}

static void finish(ffd_lattice *lattice)
{
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    if (lattice->rest_weights)
        memcpy(lattice->deformed_weights, lattice->rest_weights, lattice->count * sizeof(double));
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
}

/* Sets control points to the images of their Greville abscissae, perturbed by `shake`. */
static void set_points(ffd_lattice *lattice, point_map map, double shake, draw *d)
{
    lattice_map(lattice, map);
    for (size_t i = 0; i < 3 * lattice->count; i++)
        lattice->rest[i] += draw_between(d, -shake, shake);
}

static void add_random_weights(ffd_lattice *lattice, draw *d)
{
    lattice_add_weights(lattice);
    for (size_t i = 0; i < lattice->count; i++)
        lattice->rest_weights[i] = draw_between(d, 0.5, 2);
}

static void thin_map(const double g[3], double out[3])
{
    warped_map(g, out);
    out[2] = 0.3 * out[0] * out[0] + 1e-6 * out[2];
}

static void huge_map(const double g[3], double out[3])
{
    warped_map(g, out);
    for (int c = 0; c < 3; c++)
        out[c] *= 1e100;
}

static void tiny_map(const double g[3], double out[3])
{
    warped_map(g, out);
    for (int c = 0; c < 3; c++)
        out[c] *= 1e-100;
}

/* A tube round z, closed along v. */
static void tube_map(const double g[3], double out[3])
{
    const double angle = 6.283185307179586 * g[1], radius = 1 + g[0];
    out[0] = radius * cos(angle);
    out[1] = radius * sin(angle) * 0.8;
    out[2] = g[2] + 0.2 * out[0];
}

/* A tube whose ends meet: closed along v and w. */
static void torus_map(const double g[3], double out[3])
{
    const double a = 6.283185307179586 * g[1], b = 6.283185307179586 * g[2], radius = 0.3 + 0.7 * g[0];
    out[0] = (3 + radius * cos(a)) * cos(b);
    out[1] = (3 + radius * cos(a)) * sin(b);
    out[2] = radius * sin(a);
}

/* The face u = 0 collapses to a point. */
static void cone_map(const double g[3], double out[3])
{
    out[0] = g[0] * (g[1] - 0.3);
    out[1] = g[0] * (g[2] - 0.5 + 0.1 * g[1]);
    out[2] = g[0] * (1 + 0.2 * g[1] * g[1]);
}

/* The edges u = 0, w = 0 and u = 0, w = 1 collapse to points, so the face u = 0 has two poles. */
static void wedge_map(const double g[3], double out[3])
{
    out[0] = g[0] + 0.2 * g[1] * g[2];
    out[1] = (g[1] - 0.5) * (g[0] + g[2] * (1 - g[2]));
    out[2] = g[2];
}

/* Checks */

static void bounds_of(const ffd_lattice *lattice, double lo[3], double hi[3])
{
    for (int a = 0; a < 3; a++) {
        lo[a] = hi[a] = lattice->rest[a];
        for (size_t i = 1; i < lattice->count; i++) {
            lo[a] = fmin(lo[a], lattice->rest[3 * i + (size_t)a]);
            hi[a] = fmax(hi[a], lattice->rest[3 * i + (size_t)a]);
        }
    }
}

/* Draws a point in the lattice's bounds, grown by `factor` of the diagonal on every side. */
static void draw_point(draw *d, const ffd_lattice *lattice, double factor, double p[3])
{
    double lo[3], hi[3];
    bounds_of(lattice, lo, hi);
    for (int a = 0; a < 3; a++)
        p[a] = draw_between(d, lo[a] - factor * lattice->diagonal, hi[a] + factor * lattice->diagonal);
}

static double distance_at(const ffd_lattice *lattice, const double uvw[3], const double p[3])
{
    double c[3];
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, c, NULL);
    return hypot(hypot(c[0] - p[0], c[1] - p[1]), c[2] - p[2]);
}

/* Whether u,v,w are in the domain, and at least one is at its end. */
static bool is_on_border(const ffd_lattice *lattice, const double uvw[3])
{
    bool at_end = false;
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &lattice->knots[a];
        const double first = ffd_knots_first(knots), last = ffd_knots_last(knots);
        if (!(uvw[a] >= first && uvw[a] <= last) || (ffd_knots_closed(knots) && uvw[a] == last))
            return false;
        at_end = at_end || (!ffd_knots_closed(knots) && (uvw[a] == first || uvw[a] == last));
    }
    return at_end;
}

/* Descends from uvw along the two directions of a face, with decreasing steps. */
static double descend(const ffd_lattice *lattice, const double p[3], const int along[2],
                      const double start[2], double uvw[3])
{
    double least = distance_at(lattice, uvw, p), step[2] = {start[0], start[1]};
    for (int round = 0; round < 36; round++) {
        bool moved = true;
        for (int tries = 0; moved && tries < 100; tries++) {
            moved = false;
            for (int i = 0; i < 8; i++) {
                static const int way[8][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                              {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
                double to[3] = {uvw[0], uvw[1], uvw[2]};
                for (int f = 0; f < 2; f++)
                    to[along[f]] =
                        ffd_knots_wrap(&lattice->knots[along[f]], uvw[along[f]] + way[i][f] * step[f]);
                const double distance = distance_at(lattice, to, p);
                if (distance < least) {
                    least = distance;
                    memcpy(uvw, to, sizeof to);
                    moved = true;
                }
            }
        }
        step[0] *= 0.5;
        step[1] *= 0.5;
    }
    return least;
}

enum { GRID = 24, STARTS = 4 };

/* Approximates the distance to one face: a grid of samples, the best few refined. */
static double face_distance(const ffd_lattice *lattice, int direction, int end, const double p[3])
{
    const int along[2] = {direction == 0 ? 1 : 0, direction == 2 ? 1 : 2};
    double best[STARTS], place[STARTS][3], uvw[3], step[2], least = HUGE_VAL;
    for (int i = 0; i < STARTS; i++)
        best[i] = HUGE_VAL;
    uvw[direction] =
        end ? ffd_knots_last(&lattice->knots[direction]) : ffd_knots_first(&lattice->knots[direction]);
    for (int f = 0; f < 2; f++)
        step[f] =
            (ffd_knots_last(&lattice->knots[along[f]]) - ffd_knots_first(&lattice->knots[along[f]])) / GRID;
    for (int j = 0; j <= GRID; j++)
        for (int i = 0; i <= GRID; i++) {
            const int at[2] = {i, j};
            for (int f = 0; f < 2; f++)
                uvw[along[f]] = ffd_knots_wrap(&lattice->knots[along[f]],
                                               ffd_knots_first(&lattice->knots[along[f]]) + at[f] * step[f]);
            double distance = distance_at(lattice, uvw, p);
            for (int k = 0; k < STARTS; k++)
                if (distance < best[k]) {
                    memmove(best + k + 1, best + k, (size_t)(STARTS - 1 - k) * sizeof *best);
                    memmove(place + k + 1, place + k, (size_t)(STARTS - 1 - k) * sizeof *place);
                    best[k] = distance;
                    memcpy(place[k], uvw, sizeof uvw);
                    break;
                }
        }
    for (int k = 0; k < STARTS; k++)
        least = fmin(least, descend(lattice, p, along, step, place[k]));
    return least;
}

static double brute_distance(const ffd_lattice *lattice, const double p[3])
{
    double least = HUGE_VAL;
    for (int direction = 0; direction < 3; direction++)
        for (int end = 0; end < 2 && !ffd_knots_closed(&lattice->knots[direction]); end++)
            least = fmin(least, face_distance(lattice, direction, end, p));
    return least;
}

/* Checks what must hold for every answer. */
static void check_answer(const ffd_lattice *lattice, const double p[3], const boundary_point *nearest)
{
    const double offset = fabs(lattice->rest[0]) + fabs(lattice->rest[1]) + fabs(lattice->rest[2]) +
                          fabs(p[0]) + fabs(p[1]) + fabs(p[2]);
    double c[3], length = 0;
    assert_true(nearest->found);
    assert_true(is_on_border(lattice, nearest->uvw));
    const double attained = distance_at(lattice, nearest->uvw, p);
    if (!(fabs(attained - nearest->distance) <= 1e-13 * lattice->diagonal + 64 * DBL_EPSILON * offset))
        fail_msg("distance %.17g is said to be %.17g", attained, nearest->distance);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, nearest->uvw, c, NULL);
    for (int a = 0; a < 3; a++) {
        assert_true(fabs(c[a] + nearest->distance * nearest->direction[a] - p[a]) <=
                    1e-13 * lattice->diagonal + 64 * DBL_EPSILON * offset);
        length += nearest->direction[a] * nearest->direction[a];
    }
    assert_true(nearest->distance == 0 ? length == 0 : fabs(length - 1) < 1e-14);
    for (int i = 0; i < 9; i++)
        assert_true(isfinite(nearest->uvw_by_p[i]));
}

static void check_lattice(const char *name, const ffd_lattice *lattice, draw *d, int points, double factor)
{
    boundary *border;
    assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
    for (int i = 0; i < points; i++) {
        double p[3];
        boundary_point nearest;
        draw_point(d, lattice, i % 4 ? 0.3 * factor : 2 * factor, p);
        assert_int_equal(ffd_boundary_find(border, p, HUGE_VAL, &nearest, NULL), FFD_OK);
        check_answer(lattice, p, &nearest);
        if (is_memory_checked()) /* samples take long, and test only this test's own memory */
            continue;
        const double brute = brute_distance(lattice, p);
        if (!(nearest.distance <= brute + 1e-9 * lattice->diagonal))
            fail_msg("%s: %.17g %.17g %.17g is %.17g from the border, not %.17g", name, p[0], p[1], p[2],
                     brute, nearest.distance);
    }
    ffd_boundary_destroy(&border);
}

/* Tests */

typedef struct warped_case {
    const char *name;
    point_map map;
    double shake;
    bool rational;
    lattice_kinds shape;
} warped_case;

#define CLAMPED                                                                                              \
    {                                                                                                        \
        KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED                                                          \
    }

static const warped_case warped_cases[] = {
    {"cubic", warped_map, 0.02, false, {CLAMPED, {3, 3, 3}, {5, 6, 4}}},
    {"linear", warped_map, 0.05, false, {CLAMPED, {1, 1, 1}, {3, 4, 2}}},
    {"mixed degrees", warped_map, 0.03, false, {CLAMPED, {1, 2, 5}, {3, 5, 7}}},
    {"degree 9", warped_map, 0.1, false, {CLAMPED, {9, 9, 9}, {10, 10, 10}}},
    {"open", warped_map, 0.02, false, {{KNOTS_OPEN, KNOTS_UNIFORM, KNOTS_CLAMPED}, {3, 3, 2}, {6, 7, 5}}},
    {"rational", warped_map, 0.02, true, {CLAMPED, {3, 2, 3}, {5, 5, 4}}},
    {"rational of degree 5", warped_map, 0.02, true, {CLAMPED, {5, 5, 1}, {6, 7, 2}}},
    {"random", warped_map, 1, false, {CLAMPED, {3, 3, 3}, {5, 5, 5}}},
    {"bent", bent_map, 0, false, {CLAMPED, {2, 3, 1}, {3, 12, 2}}},
    {"tube", tube_map, 0.02, false, {{KNOTS_CLAMPED, KNOTS_CLOSED, KNOTS_CLAMPED}, {2, 3, 3}, {3, 9, 5}}},
    {"torus", torus_map, 0.02, false, {{KNOTS_CLAMPED, KNOTS_CLOSED, KNOTS_CLOSED}, {2, 3, 3}, {3, 7, 12}}},
    {"rational torus",
     torus_map,
     0,
     true,
     {{KNOTS_CLAMPED, KNOTS_CLOSED, KNOTS_CLOSED}, {1, 2, 2}, {2, 7, 9}}},
    {"cone", cone_map, 0, false, {CLAMPED, {3, 3, 3}, {4, 5, 5}}},
    {"wedge", wedge_map, 0, false, {CLAMPED, {2, 3, 2}, {4, 5, 3}}},
    {"thin", thin_map, 0, false, {CLAMPED, {3, 3, 3}, {6, 5, 4}}},
    {"far from the origin", far_map, 0.02, false, {CLAMPED, {3, 3, 3}, {5, 5, 5}}},
    {"huge", huge_map, 0, false, {CLAMPED, {3, 3, 3}, {5, 5, 5}}},
    {"tiny", tiny_map, 0, false, {CLAMPED, {3, 3, 3}, {5, 5, 5}}},
};
enum { WARPED_CASES = sizeof warped_cases / sizeof warped_cases[0], BENT_CASE = 8 };

static ffd_lattice *make_case(const warped_case *one, draw *d)
{
    ffd_lattice *lattice = lattice_of_kinds(&one->shape);
    set_points(lattice, one->map, one->shake, d);
    if (one->rational)
        add_random_weights(lattice, d);
    finish(lattice);
    return lattice;
}

static void the_foot_is_never_farther_than_samples(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int i = 0; i < WARPED_CASES; i++) {
        ffd_lattice *lattice = make_case(&warped_cases[i], &d);
        check_lattice(warped_cases[i].name, lattice, &d, repetitions(12), 1);
        ffd_lattice_destroy(&lattice);
    }
}

static const char *const cylinders[] = {
    "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,8,4],\"rest\":{\"cylinder\":{\"center\":[1,2,3],"
    "\"axis\":[1,1,2],\"radius\":[0,1],\"height\":3,\"angle\":[0,360]}}}",
    "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[3,9,4],\"rest\":{\"cylinder\":{\"center\":[0,0,0],"
    "\"axis\":[0,0,1],\"radius\":[0.5,1],\"height\":1,\"angle\":[0,360]}}}",
    "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[3,5,4],\"rest\":{\"cylinder\":{\"center\":[0,0,0],"
    "\"axis\":[0,1,1],\"radius\":[0,2],\"height\":1,\"angle\":[20,200]}}}",
};

static void feet_on_cylinders_are_as_near_as_samples(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (size_t i = 0; i < sizeof cylinders / sizeof cylinders[0]; i++) {
        ffd_lattice *lattice = parsed(cylinders[i]);
        check_lattice("cylinder", lattice, &d, repetitions(30), 1);
        ffd_lattice_destroy(&lattice);
    }
}

/* Above the end of a collapsed axis every v is equally near; the least one counts. On the axis of a tube a
   circle, or several places, are equally near. */
static void the_least_of_equally_near_feet_is_taken(void **state)
{
    (void)state;
    boundary *border;
    boundary_point nearest;
    ffd_lattice *lattice = parsed(
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,8,4],\"rest\":{\"cylinder\":{\"center\":"
        "[0,0,0],\"axis\":[0,0,1],\"radius\":[0,1],\"height\":2,\"angle\":[0,360]}}}");
    assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
    const double above[3] = {0, 0, 1.5};
    assert_int_equal(ffd_boundary_find(border, above, HUGE_VAL, &nearest, NULL), FFD_OK);
    assert_true(nearest.found);
    assert_true(nearest.uvw[0] == 0 && nearest.uvw[1] == 0 && nearest.uvw[2] == 1);
    assert_true(fabs(nearest.distance - 0.5) < 1e-15);
    ffd_boundary_destroy(&border);
    ffd_lattice_destroy(&lattice);

    lattice =
        parsed("{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,9,2],\"degree\":[1,2,1],\"knots\":"
               "[\"clamped\",[0,0,0,1,1,2,2,3,3,4,4,4],\"clamped\"],\"weights\":["
               "1,1,0.70710678118654757,0.70710678118654757,1,1,0.70710678118654757,0.70710678118654757,"
               "1,1,0.70710678118654757,0.70710678118654757,1,1,0.70710678118654757,0.70710678118654757,"
               "1,1,"
               "1,1,0.70710678118654757,0.70710678118654757,1,1,0.70710678118654757,0.70710678118654757,"
               "1,1,0.70710678118654757,0.70710678118654757,1,1,0.70710678118654757,0.70710678118654757,"
               "1,1],\"rest\":{\"points\":["
               "[1,0,0],[2,0,0],[1,1,0],[2,2,0],[0,1,0],[0,2,0],[-1,1,0],[-2,2,0],[-1,0,0],[-2,0,0],"
               "[-1,-1,0],[-2,-2,0],[0,-1,0],[0,-2,0],[1,-1,0],[2,-2,0],[1,0,0],[2,0,0],"
               "[1,0,2],[2,0,2],[1,1,2],[2,2,2],[0,1,2],[0,2,2],[-1,1,2],[-2,2,2],[-1,0,2],[-2,0,2],"
               "[-1,-1,2],[-2,-2,2],[0,-1,2],[0,-2,2],[1,-1,2],[2,-2,2],[1,0,2],[2,0,2]]}}");
    assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
    const double axis[3] = {0, 0, 0.75};
    assert_int_equal(ffd_boundary_find(border, axis, HUGE_VAL, &nearest, NULL), FFD_OK);
    assert_true(nearest.found);
    assert_true(fabs(nearest.distance - 1) < 1e-14);
    assert_true(nearest.uvw[0] == 0 && nearest.uvw[1] < 1e-9);
    assert_true(fabs(nearest.uvw[2] - 0.375) < 1e-9);
    for (int i = 0; i < 9; i++) /* v rests on its end, like u */
        assert_true(fabs(nearest.uvw_by_p[i] - (i == 8 ? 0.5 : 0)) < 1e-12);
    ffd_boundary_destroy(&border);
    ffd_lattice_destroy(&lattice);
}

/* A valley z = x^2 seen from its centre of curvature: the second derivative of the distance is 0, so the
   motion of the point is undefined. */
static void the_derivative_at_a_centre_of_curvature_is_zero(void **state)
{
    (void)state;
    boundary *border;
    boundary_point nearest;
    ffd_lattice *lattice = parsed(
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[3,2,2],\"degree\":[2,1,1],\"rest\":{\"points\":["
        "[-0.25,0,-3],[0,0,-3],[0.25,0,-3],[-0.25,1,-3],[0,1,-3],[0.25,1,-3],"
        "[-0.25,0,0.0625],[0,0,-0.0625],[0.25,0,0.0625],[-0.25,1,0.0625],[0,1,-0.0625],[0.25,1,0.0625]]}}");
    assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
    const double centre[3] = {0, 0.25, 0.5}, below[3] = {0, 0.25, 0.25};
    assert_int_equal(ffd_boundary_find(border, centre, HUGE_VAL, &nearest, NULL), FFD_OK);
    check_answer(lattice, centre, &nearest);
    assert_true(nearest.uvw[2] == 1 && fabs(nearest.uvw[0] - 0.5) < 1e-3);
    for (int i = 0; i < 9; i++)
        assert_true(nearest.uvw_by_p[i] == 0);
    assert_int_equal(ffd_boundary_find(border, below, HUGE_VAL, &nearest, NULL), FFD_OK);
    check_answer(lattice, below, &nearest);
    assert_true(nearest.uvw[2] == 1 && fabs(nearest.uvw[0] - 0.5) < 1e-12);
    /* dx/dp is 1 / (1 - 0.25 / 0.5) = 2, and x = (u - 1/2) / 2. */
    assert_true(fabs(nearest.uvw_by_p[0] - 4) < 1e-9 && fabs(nearest.uvw_by_p[4] - 1) < 1e-9);
    ffd_boundary_destroy(&border);
    ffd_lattice_destroy(&lattice);
}

/* Boxes: compared with a clip in long double. */
static void check_box(const char *text, const double origin[3], const double side[3], const double axes[9],
                      draw *d)
{
    ffd_lattice *lattice = parsed(text);
    boundary *border;
    assert_int_equal(lattice->form, REST_BOX_AFFINE);
    assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
    const double size = side[0] + side[1] + side[2];
    for (int i = 0; i < 2000; i++) {
        double p[3], lo[3], hi[3];
        boundary_point nearest;
        ffd_lattice_get_domain(lattice, lo, hi);
        for (int a = 0; a < 3; a++)
            p[a] = origin[a] + draw_between(d, -2, 2) * size;
        assert_int_equal(ffd_boundary_find(border, p, HUGE_VAL, &nearest, NULL), FFD_OK);
        long double t[3], to[3], off = 0, nearest_face = HUGE_VALL;
        int face = 0, end = 0;
        bool inside = true;
        for (int a = 0; a < 3; a++) {
            t[a] = 0;
            for (int r = 0; r < 3; r++)
                t[a] += ((long double)p[r] - origin[r]) * axes[3 * a + r];
            to[a] = t[a] < 0 ? 0 : t[a] > side[a] ? side[a] : t[a];
            inside = inside && to[a] == t[a];
            for (int e = 0; e < 2; e++)
                if ((e ? side[a] - t[a] : t[a]) < nearest_face) {
                    nearest_face = e ? side[a] - t[a] : t[a];
                    face = a;
                    end = e;
                }
        }
        if (inside)
            to[face] = end ? side[face] : 0;
        for (int a = 0; a < 3; a++) {
            off += (t[a] - to[a]) * (t[a] - to[a]);
            const double expected = lo[a] + (hi[a] - lo[a]) * (double)(to[a] / side[a]);
            assert_true(fabs(nearest.uvw[a] - expected) <= 1e-15 * size / side[a] * (hi[a] - lo[a]) * 8);
            if (to[a] == 0 || to[a] == side[a]) {
                assert_true(nearest.uvw[a] == (to[a] == 0 ? lo[a] : hi[a]));
                for (int c = 0; c < 3; c++)
                    assert_true(nearest.uvw_by_p[3 * a + c] == 0);
            } else {
                for (int c = 0; c < 3; c++)
                    assert_true(fabs(nearest.uvw_by_p[3 * a + c] * side[a] / (hi[a] - lo[a]) -
                                     axes[3 * a + c]) < 1e-14);
            }
        }
        assert_true(fabsl(nearest.distance - sqrtl(off)) <= 1e-14 * size);
        check_answer(lattice, p, &nearest);
    }
    ffd_boundary_destroy(&border);
    ffd_lattice_destroy(&lattice);
}

static void feet_of_a_box_are_those_of_the_clip(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double origin[3] = {-1, 2, 0}, side[3] = {3, 0.5, 8};
    check_box(
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,4,4],\"rest\":{\"box\":{\"min\":[-1,2,0],"
        "\"max\":[2,2.5,8]}}}",
        origin, side, identity, &d);
    check_box("{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,5,6],\"knots\":[\"uniform\",\"open\","
              "\"clamped\"],\"rest\":{\"box\":{\"min\":[-1,2,0],\"max\":[2,2.5,8]}}}",
              origin, side, identity, &d);
    const double turned[9] = {0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, 1};
    const double corner[3] = {0.6 * -1 - 0.8 * 2, 0.8 * -1 + 0.6 * 2, 0};
    check_box(
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,4,4],\"rest\":{\"box\":{\"min\":[-1,2,0],"
        "\"max\":[2,2.5,8],\"axes\":[[0.6,0.8,0],[-0.8,0.6,0],[0,0,1]]}}}",
        corner, side, turned, &d);
}

/* The corner of a box of places that is nearest to a turned box is in front of a face or not. */
static void a_box_of_places_meets_a_turned_box_or_not(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    const double normal[3] = {0.6, 0.8, 0}, side[3] = {-0.8, 0.6, 0};
    ffd_lattice *lattice = parsed(
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,4,4],\"rest\":{\"box\":{\"min\":[-1,2,0],"
        "\"max\":[2,2.5,8],\"axes\":[[0.6,0.8,0],[-0.8,0.6,0],[0,0,1]]}}}");
    boundary *border;
    assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
    for (int i = 0; i < 500; i++) {
        const double across = draw_between(&d, 2, 2.5), up = draw_between(&d, 0, 8);
        for (int beyond = 0; beyond < 2; beyond++) {
            double p[3], each[3];
            boundary_verdict verdict;
            for (int a = 0; a < 3; a++) {
                each[a] = pow(10, draw_between(&d, -6, -2));
                p[a] = 2 * normal[a] + across * side[a] + (a == 2 ? up : 0) +
                       (beyond ? 1.0001 : 0.9999) * each[a] * (normal[a] > 0 ? 1 : 0);
            }
            assert_int_equal(ffd_boundary_meets(border, p, each, &verdict, NULL), FFD_OK);
            assert_int_equal(verdict, beyond ? BOUNDARY_MISSES : BOUNDARY_MEETS);
        }
    }
    ffd_boundary_destroy(&border);
    ffd_lattice_destroy(&lattice);
}

/* The search agrees with the clip if the box is given by its points. */
static void the_search_agrees_with_the_clip(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    ffd_lattice *box =
        parsed("{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[5,4,6],\"rest\":{\"box\":{"
               "\"min\":[-1,2,0],\"max\":[2,2.5,8],\"axes\":[[0.6,0.8,0],[-0.8,0.6,0],[0,0,1]]}}}");
    boundary *clip, *search;
    assert_int_equal(ffd_boundary_create(box, &clip, NULL), FFD_OK);
    for (int i = 0; i < 500; i++) {
        double p[3];
        boundary_point a, b;
        draw_point(&d, box, 0.5, p);
        assert_int_equal(ffd_boundary_find(clip, p, HUGE_VAL, &a, NULL), FFD_OK);
        box->form = REST_POINTS;
        assert_int_equal(ffd_boundary_create(box, &search, NULL), FFD_OK);
        assert_int_equal(ffd_boundary_find(search, p, HUGE_VAL, &b, NULL), FFD_OK);
        ffd_boundary_destroy(&search);
        box->form = REST_BOX_AFFINE;
        assert_true(fabs(a.distance - b.distance) < 1e-13);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(a.uvw[c] - b.uvw[c]) < 1e-12);
        for (int c = 0; c < 9; c++)
            assert_true(fabs(a.uvw_by_p[c] - b.uvw_by_p[c]) < 1e-9);
    }
    ffd_boundary_destroy(&clip);
    ffd_lattice_destroy(&box);
}

/* Compares the first derivative with differences where the nearest point moves smoothly: both one-sided
   differences agree, and the same coordinates are fixed. */
static void compare_derivative(const ffd_lattice *lattice, const boundary *border, const double p[3],
                               const boundary_point *nearest, int *compared)
{
    const double h = 1e-5 * lattice->diagonal;
    for (int c = 0; c < 3; c++) {
        double to[3] = {p[0], p[1], p[2]};
        boundary_point ahead, behind;
        bool smooth = true;
        to[c] = p[c] + h;
        assert_int_equal(ffd_boundary_find(border, to, HUGE_VAL, &ahead, NULL), FFD_OK);
        to[c] = p[c] - h;
        assert_int_equal(ffd_boundary_find(border, to, HUGE_VAL, &behind, NULL), FFD_OK);
        for (int a = 0; a < 3; a++) {
            const double forth = ahead.uvw[a] - nearest->uvw[a], back = nearest->uvw[a] - behind.uvw[a];
            const double change = fmax(fabs(forth), fabs(back));
            smooth = smooth && fabs(forth - back) <= 0.001 * change && change < 0.01;
            for (int i = 0; i < 3; i++)
                smooth = smooth && fabs(ahead.uvw_by_p[3 * a + i] - behind.uvw_by_p[3 * a + i]) <=
                                       0.02 * fabs(nearest->uvw_by_p[3 * a + i]) + 0.001 / lattice->diagonal;
        }
        if (!smooth)
            continue;
        ++*compared;
        for (int a = 0; a < 3; a++) {
            const double difference = (ahead.uvw[a] - behind.uvw[a]) / (2 * h);
            const double found = nearest->uvw_by_p[3 * a + c];
            if (!(fabs(found - difference) <= 0.001 * fabs(difference) + 0.0001 / lattice->diagonal))
                fail_msg("d(uvw[%d])/dp[%d] is %.9g, not %.9g", a, c, difference, found);
        }
    }
}

static void the_derivative_agrees_with_differences(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    static const int cases[] = {0, 2, 3, 4, 5, 6, 9, 10, 11};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ffd_lattice *lattice = make_case(&warped_cases[cases[i]], &d);
        boundary *border;
        int compared = 0;
        assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
        for (int k = 0; k < 100; k += stride(12)) {
            double p[3];
            boundary_point nearest;
            draw_point(&d, lattice, 0.2, p);
            assert_int_equal(ffd_boundary_find(border, p, HUGE_VAL, &nearest, NULL), FFD_OK);
            compare_derivative(lattice, border, p, &nearest, &compared);
        }
        if (compared < (is_memory_checked() ? 1 : 60))
            fail_msg("%s: only %d of 300 derivatives are smooth", warped_cases[cases[i]].name, compared);
        ffd_boundary_destroy(&border);
        ffd_lattice_destroy(&lattice);
    }
}

/* No step from the answer along its face gets nearer, up to rounding. */
static void no_step_along_a_face_goes_nearer(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int i = 0; i < WARPED_CASES; i++) {
        ffd_lattice *lattice = make_case(&warped_cases[i], &d);
        boundary *border;
        assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
        for (int k = 0; k < 100; k += stride(20)) {
            double p[3], c[3], jacobian[9];
            boundary_point nearest;
            draw_point(&d, lattice, 0.3, p);
            assert_int_equal(ffd_boundary_find(border, p, HUGE_VAL, &nearest, NULL), FFD_OK);
            ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, nearest.uvw, c, jacobian);
            for (int a = 0; a < 3; a++) {
                /* Coordinates that are free have rows that are not 0. */
                const double *row = nearest.uvw_by_p + 3 * a;
                if (row[0] == 0 && row[1] == 0 && row[2] == 0)
                    continue;
                double slope = 0, length = 0;
                for (int r = 0; r < 3; r++) {
                    slope += nearest.direction[r] * (jacobian[3 * r + a] / lattice->diagonal);
                    length += fabs(jacobian[3 * r + a] / lattice->diagonal);
                }
                const double offset = (fabs(lattice->rest[0]) + fabs(lattice->rest[1])) / lattice->diagonal;
                const double noise =
                    (1e-13 + 64 * DBL_EPSILON * offset) * (1 + lattice->diagonal / nearest.distance);
                if (!(fabs(slope) <= noise * fmax(length, 1)))
                    fail_msg("%s: the slope along %c is %g of %g", warped_cases[i].name, "uvw"[a], slope,
                             length);
            }
        }
        ffd_boundary_destroy(&border);
        ffd_lattice_destroy(&lattice);
    }
}

static void feet_are_the_same_bits_in_any_order(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    enum { POINTS = 200 };
    const int count = repetitions(POINTS);
    static double p[POINTS][3];
    static boundary_point first[POINTS], again;
    for (int i = 0; i < WARPED_CASES; i += 3) {
        ffd_lattice *lattice = make_case(&warped_cases[i], &d);
        boundary *border;
        assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
        for (int k = 0; k < count; k++) {
            draw_point(&d, lattice, 0.5, p[k]);
            assert_int_equal(ffd_boundary_find(border, p[k], HUGE_VAL, &first[k], NULL), FFD_OK);
        }
        ffd_boundary_destroy(&border);
        assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
        for (int k = count - 1; k >= 0; k--) {
            assert_int_equal(ffd_boundary_find(border, p[k], HUGE_VAL, &again, NULL), FFD_OK);
            assert_true(same_border_points(&again, &first[k]));
        }
        ffd_boundary_destroy(&border);
        ffd_lattice_destroy(&lattice);
    }
}

/* The reach only decides whether the point is found. */
static void a_reach_decides_only_whether_a_foot_is_found(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int i = 0; i < WARPED_CASES + 1; i++) {
        ffd_lattice *lattice =
            i < WARPED_CASES ? make_case(&warped_cases[i], &d)
                             : parsed("{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,4,4],\"rest\":{"
                                      "\"box\":{\"min\":[0,0,0],\"max\":[1,2,3]}}}");
        boundary *border;
        assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
        for (int k = 0; k < 50; k += stride(10)) {
            double p[3];
            boundary_point any, within;
            draw_point(&d, lattice, 0.5, p);
            assert_int_equal(ffd_boundary_find(border, p, HUGE_VAL, &any, NULL), FFD_OK);
            assert_true(any.found);
            const double reach[] = {any.distance,       nextafter(any.distance, HUGE_VAL),
                                    1.5 * any.distance, nextafter(any.distance, 0),
                                    0.5 * any.distance, 0};
            for (int r = 0; r < 6; r++) {
                assert_int_equal(ffd_boundary_find(border, p, reach[r], &within, NULL), FFD_OK);
                assert_int_equal(within.found, r < 3);
                if (within.found)
                    assert_true(same_border_points(&within, &any));
            }
        }
        ffd_boundary_destroy(&border);
        ffd_lattice_destroy(&lattice);
    }
}

/* For far points the answer is the extreme point in their direction, and nothing overflows. */
static void far_points_find_their_foot_without_overflow(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int i = 0; i < WARPED_CASES; i++) {
        ffd_lattice *lattice = make_case(&warped_cases[i], &d);
        boundary *border;
        assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
        check_lattice(warped_cases[i].name, lattice, &d, 1, 100);
        for (int power = 3; power <= 300; power += (power < 30 ? 3 : 30) * stride(9))
            for (int k = 0; k < 5; k += stride(5)) {
                double p[3];
                boundary_point nearest;
                for (int c = 0; c < 3; c++)
                    p[c] = draw_between(&d, -1, 1) * pow(10, power);
                assert_int_equal(ffd_boundary_find(border, p, HUGE_VAL, &nearest, NULL), FFD_OK);
                check_answer(lattice, p, &nearest);
            }
        const double most[3] = {DBL_MAX, -DBL_MAX, DBL_MAX};
        boundary_point nearest;
        assert_int_equal(ffd_boundary_find(border, most, HUGE_VAL, &nearest, NULL), FFD_OK);
        assert_true(nearest.found && nearest.distance == HUGE_VAL);
        assert_int_equal(ffd_boundary_find(border, most, 1, &nearest, NULL), FFD_OK);
        assert_false(nearest.found);
        const double none[3] = {0, NAN, 0};
        assert_int_equal(ffd_boundary_find(border, none, HUGE_VAL, &nearest, NULL), FFD_OK);
        assert_false(nearest.found);
        ffd_boundary_destroy(&border);
        ffd_lattice_destroy(&lattice);
    }
}

/* Points on the border itself. */
static void points_on_the_border_are_their_own_feet(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int i = 0; i < WARPED_CASES; i++) {
        ffd_lattice *lattice = make_case(&warped_cases[i], &d);
        const double offset = fabs(lattice->rest[0]) + fabs(lattice->rest[1]);
        boundary *border;
        assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
        for (int k = 0; k < 100; k += stride(20)) {
            double uvw[3], p[3], lo[3], hi[3];
            boundary_point nearest;
            ffd_lattice_get_domain(lattice, lo, hi);
            for (int a = 0; a < 3; a++) {
                const int where = draw_int(&d, 0, 5);
                uvw[a] = a == 0 || where == 0 ? (where < 3 ? lo[a] : hi[a]) : draw_between(&d, lo[a], hi[a]);
            }
            ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
            assert_int_equal(ffd_boundary_find(border, p, HUGE_VAL, &nearest, NULL), FFD_OK);
            check_answer(lattice, p, &nearest);
            assert_true(nearest.distance <= 1e-13 * lattice->diagonal + 16 * DBL_EPSILON * offset);
        }
        ffd_boundary_destroy(&border);
        ffd_lattice_destroy(&lattice);
    }
}

/* All directions closed: no border. */
static void an_all_closed_lattice_has_no_border(void **state)
{
    (void)state;
    const lattice_kinds shape = {{KNOTS_CLOSED, KNOTS_CLOSED, KNOTS_CLOSED}, {2, 2, 2}, {4, 4, 4}};
    draw d = {draw_seed()};
    ffd_lattice *lattice = lattice_of_kinds(&shape);
    set_points(lattice, warped_map, 0, &d);
    finish(lattice);
    boundary *border;
    boundary_point nearest;
    const double p[3] = {2, 2, 2};
    assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
    assert_int_equal(ffd_boundary_find(border, p, HUGE_VAL, &nearest, NULL), FFD_OK);
    assert_false(nearest.found);
    ffd_boundary_destroy(&border);
    ffd_boundary_destroy(&border);
    ffd_boundary_destroy(NULL);
    ffd_lattice_destroy(&lattice);
}

/* Inner knots where the faces have ridges: a whole range of points has its nearest point on a ridge. */
static void a_foot_rests_on_a_ridge(void **state)
{
    (void)state;
    static const double list[] = {5, 5, 5, 6, 6, 8, 8, 8}, linear[] = {0, 0, 1, 2, 2};
    draw d = {draw_seed()};
    knot_vector knots[3];
    assert_int_equal(ffd_knots_make(KNOTS_LIST, 2, 5, list, 8, 'u', &knots[0], NULL), FFD_OK);
    assert_int_equal(ffd_knots_make(KNOTS_LIST, 2, 5, list, 8, 'v', &knots[1], NULL), FFD_OK);
    assert_int_equal(ffd_knots_make(KNOTS_LIST, 1, 3, linear, 5, 'w', &knots[2], NULL), FFD_OK);
    ffd_lattice *lattice = lattice_of_knots(knots);
    set_points(lattice, warped_map, 0.05, &d);
    for (size_t i = 0; i < lattice->count; i++) /* folded outwards along u = 6 */
        lattice->rest[3 * i + 2] -= i % 5 == 2 ? 0 : 0.3;
    finish(lattice);
    check_lattice("ridges", lattice, &d, 12, 1);
    boundary *border;
    int resting = 0;
    assert_int_equal(ffd_boundary_create(lattice, &border, NULL), FFD_OK);
    for (int i = 0; i < 200; i++) {
        boundary_point nearest;
        const double p[3] = {draw_between(&d, 0.3, 0.7), draw_between(&d, 0.3, 0.7),
                             draw_between(&d, 1.5, 3)};
        assert_int_equal(ffd_boundary_find(border, p, HUGE_VAL, &nearest, NULL), FFD_OK);
        check_answer(lattice, p, &nearest);
        if (nearest.uvw[0] != 6)
            continue;
        resting++;
        for (int c = 0; c < 3; c++)
            assert_true(nearest.uvw_by_p[c] == 0);
    }
    assert_true(resting > 20);
    ffd_boundary_destroy(&border);
    ffd_lattice_destroy(&lattice);
}

/* More patches than are cached, so each search makes its own; and leaves with several cells. */
static void lattices_of_many_cells_are_searched_right(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    const lattice_kinds shapes[] = {{CLAMPED, {2, 2, 2}, {250, 250, 3}}, {CLAMPED, {1, 2, 1}, {540, 540, 2}}};
    for (int i = 0; i < 2; i += stride(2)) {
        ffd_lattice *lattice = lattice_of_kinds(&shapes[i]);
        set_points(lattice, warped_map, 1e-4, &d);
        finish(lattice);
        check_lattice("many cells", lattice, &d, 5, 1);
        ffd_lattice_destroy(&lattice);
    }
}

/* Any allocation may fail. */
static void each_failed_allocation_is_reported(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    ffd_lattice *lattice = make_case(&warped_cases[BENT_CASE], &d);
    boundary *border = NULL;
    boundary_point nearest;
    ffd_status status = FFD_E_MEMORY;
    long failing = 0;
    for (; status; failing += stride(31)) {
        assert_true(failing < 100000);
        ffd_alloc_fail_after(failing);
        status = ffd_boundary_create(lattice, &border, NULL);
        ffd_alloc_fail_after(-1);
        assert_int_equal(border != NULL, status == FFD_OK);
        if (status)
            assert_int_equal(status, FFD_E_MEMORY);
    }
    assert_true(failing > 3);
    /* The centre of the bar, where nearly equal distances cause subdivision. */
    const double p[3] = {0, 0, 0.5};
    status = FFD_E_MEMORY;
    for (failing = 0; status; failing += stride(31)) {
        assert_true(failing < 100000);
        ffd_alloc_fail_after(failing);
        status = ffd_boundary_find(border, p, HUGE_VAL, &nearest, NULL);
        ffd_alloc_fail_after(-1);
        if (status)
            assert_int_equal(status, FFD_E_MEMORY);
    }
    assert_true(failing > 10);
    check_answer(lattice, p, &nearest);
    ffd_boundary_destroy(&border);
    ffd_lattice_destroy(&lattice);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feet_of_a_box_are_those_of_the_clip),
        cmocka_unit_test(a_box_of_places_meets_a_turned_box_or_not),
        cmocka_unit_test(the_search_agrees_with_the_clip),
        cmocka_unit_test(the_foot_is_never_farther_than_samples),
        cmocka_unit_test(feet_on_cylinders_are_as_near_as_samples),
        cmocka_unit_test(the_least_of_equally_near_feet_is_taken),
        cmocka_unit_test(the_derivative_at_a_centre_of_curvature_is_zero),
        cmocka_unit_test(the_derivative_agrees_with_differences),
        cmocka_unit_test(no_step_along_a_face_goes_nearer),
        cmocka_unit_test(feet_are_the_same_bits_in_any_order),
        cmocka_unit_test(a_reach_decides_only_whether_a_foot_is_found),
        cmocka_unit_test(far_points_find_their_foot_without_overflow),
        cmocka_unit_test(points_on_the_border_are_their_own_feet),
        cmocka_unit_test(an_all_closed_lattice_has_no_border),
        cmocka_unit_test(a_foot_rests_on_a_ridge),
        cmocka_unit_test(lattices_of_many_cells_are_searched_right),
        cmocka_unit_test(each_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
