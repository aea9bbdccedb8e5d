/* Pulls, falloffs and mirrored moves of a lattice file, compared with values computed by hand. */
#include "lattice/lattice.h"
#include "lattice/mirror.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "../support/lattice_points.h"
#include "../support/lattice_text.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* 5 x 3 x 3 points of degree 1: x is -2, -1, 0, 1, 2; y and z are -1, 0, 1. */
static const char bar[] = "\"size\":[5,3,3],\"degree\":[1,1,1],\"rest\":{\"box\":{\"min\":[-2,-1,-1],\"max\":"
                          "[2,1,1]}}";

static void check_point(const ffd_lattice *l, size_t i, size_t j, size_t k, double x, double y, double z)
{
    check_within(l, (const size_t[]){i, j, k}, (const double[]){x, y, z}, 4e-15);
}

static void a_pull_takes_the_points_near_its_place(void **state)
{
    (void)state;
    /* Distances 0, 1, sqrt 2, sqrt 3 for the radius 2: weights 1, 9/16, 1/4, 1/16; at distance 2 nothing. */
    ffd_lattice *l = make(bar, "{\"pull\":{\"point\":[0,0,0],\"by\":[0,16,32],\"radius\":2}}");
    check_point(l, 2, 1, 1, 0, 16, 32);
    check_point(l, 3, 1, 1, 1, 9, 18);
    check_point(l, 2, 0, 1, 0, 8, 18);
    check_point(l, 1, 2, 1, -1, 5, 8);
    check_point(l, 3, 2, 2, 1, 2, 3);
    check_point(l, 0, 1, 1, -2, 0, 0);
    assert_int_equal(count_moved(l), 27);
    ffd_lattice_destroy(&l);
    /* Distances are of rest positions. Weight and selection work as for other moves. */
    l = make(bar, "{\"by\":[9,0,0]},{\"at\":[-3,-2,1],\"weight\":0.5,\"pull\":{\"point\":[0,0,0],\"by\":[0,0,"
                  "8],\"radius\":1}}");
    check_point(l, 2, 1, 1, 9, 0, 4);
    check_point(l, 3, 1, 1, 10, 0, 0);
    ffd_lattice_destroy(&l);
    /* In box units, with sides 4, 2, 2: a ball of radius 1/2 round the centre touches all sides. */
    l = make(bar, "");
    ffd_lattice_destroy(&l);
    l = make("\"units\":\"box\",\"size\":[5,3,3],\"degree\":[1,1,1],\"rest\":{\"box\":{\"min\":[-2,-1,-1],"
             "\"max\":[2,1,1]}}",
             "{\"pull\":{\"point\":[0.5,0.5,0.5],\"by\":[1,0,0],\"radius\":0.5}}");
    check_point(l, 2, 1, 1, 4, 0, 0);
    check_point(l, 3, 1, 1, 1 + 4 * 0.5625, 0, 0);
    assert_int_equal(count_moved(l), 3);
    ffd_lattice_destroy(&l);
    /* A pull that reaches no point moves nothing. */
    l = make(bar, "{\"pull\":{\"point\":[0.5,0,0],\"by\":[1,0,0],\"radius\":0.5}}");
    assert_int_equal(count_moved(l), 0);
    ffd_lattice_destroy(&l);
}

static void a_falloff_scales_any_action_by_the_place_at_rest(void **state)
{
    (void)state;
    /* At quarters of the way: 1, 27/32, 1/2, 5/32, 0. */
    static const double left[] = {1, 0.84375, 0.5, 0.15625, 0};
    static const char *const falloffs[] = {
        "{\"axis\":\"x\",\"from\":-2,\"to\":2}",
        "{\"axis\":[-3,0,0],\"from\":2,\"to\":-2}",
    };
    for (size_t f = 0; f < COUNT(falloffs); f++) {
        char moves[512];
        snprintf(moves, sizeof moves,
                 "{\"by\":[0,0,8]},{\"falloff\":%s,\"weight\":0.5,\"by\":[0,32,0]},{\"at\":[\"all\",0,0],"
                 "\"falloff\":%s,\"to\":[0,0,0]}",
                 falloffs[f], falloffs[f]);
        ffd_lattice *l = make(bar, moves);
        for (size_t i = 0; i < 5; i++) {
            const double x = (double)i - 2, y = -1 + 16 * left[i], rest = 1 - left[i];
            check_point(l, i, 1, 1, x, 16 * left[i], 8);
            check_point(l, i, 0, 0, x * rest, y * rest, 7 * rest);
        }
        ffd_lattice_destroy(&l);
    }
    /* Decreasing along the axis, and beyond both ends: from x = 1 to x = 0. */
    ffd_lattice *l = make(bar, "{\"falloff\":{\"axis\":\"x\",\"from\":1,\"to\":-1},\"by\":[0,2,0]}");
    check_point(l, 4, 1, 1, 2, 2, 0);
    check_point(l, 3, 1, 1, 1, 2, 0);
    check_point(l, 2, 1, 1, 0, 1, 0);
    check_point(l, 1, 1, 1, -1, 0, 0);
    assert_int_equal(count_moved(l), 27);
    ffd_lattice_destroy(&l);
    /* Round a centre: distances 0 and 1 of 2. */
    l = make(bar,
             "{\"falloff\":{\"center\":[-2,0,0],\"radius\":2},\"scale\":{\"factor\":3,\"about\":[0,0,0]}}");
    check_point(l, 0, 1, 1, -6, 0, 0);
    check_point(l, 1, 1, 1, -2, 0, 0);
    check_point(l, 2, 1, 1, 0, 0, 0);
    check_point(l, 0, 2, 1, -4, 2, 0);
    ffd_lattice_destroy(&l);
}

/* The extent of a twist and the centroid are those of the selection, whatever the weights. */
static void a_falloff_changes_neither_extent_nor_centroid(void **state)
{
    (void)state;
    ffd_lattice *l = make(bar, "{\"falloff\":{\"axis\":\"x\",\"from\":-1,\"to\":0},\"twist\":{\"axis\":\"x\","
                               "\"degrees\":360}}");
    check_point(l, 1, 2, 1, -1, 0, 1);
    check_point(l, 2, 2, 1, 0, 1, 0);
    ffd_lattice_destroy(&l);
    l = make(bar, "{\"falloff\":{\"axis\":\"x\",\"from\":-1,\"to\":0},\"scale\":{\"factor\":2}}");
    check_point(l, 1, 2, 1, -2, 2, 0);
    ffd_lattice_destroy(&l);
}

static void a_falloff_in_box_units_runs_along_the_region(void **state)
{
    (void)state;
    /* A box turned by 90 degrees: its first side, of length 4, is along y. */
    ffd_lattice *l = make("\"units\":\"box\",\"size\":[5,3,3],\"degree\":[1,1,1],\"rest\":{\"box\":{\"min\":"
                          "[10,20,30],\"max\":[14,22,32],\"axes\":[[0,1,0],[-1,0,0],[0,0,1]]}}",
                          "{\"falloff\":{\"axis\":\"y\",\"from\":0,\"to\":1},\"by\":[0,0,1]}");
    check_point(l, 0, 0, 0, -20, 10, 32);
    check_point(l, 1, 1, 1, -21, 11, 31 + 2 * 0.84375);
    check_point(l, 4, 2, 2, -22, 14, 32);
    ffd_lattice_destroy(&l);
    l = make("\"units\":\"box\",\"size\":[5,3,3],\"degree\":[1,1,1],\"rest\":{\"box\":{\"min\":[0,0,0],"
             "\"max\":[4,2,2]}}",
             "{\"falloff\":{\"center\":[0,0,0],\"radius\":1},\"by\":[0,0,1]}");
    check_point(l, 1, 0, 0, 1, 0, 2 * 0.84375);
    check_point(l, 0, 1, 0, 0, 1, 1);
    check_point(l, 4, 0, 0, 4, 0, 0);
    ffd_lattice_destroy(&l);
}

/* Each action on the face x = 2 with its mirror image on x = -2: the result is exactly symmetric. */
static void a_mirrored_move_does_the_same_on_the_other_side(void **state)
{
    (void)state;
    static const char *const actions[] = {
        "\"by\":[1,2,3]",
        "\"to\":[3,1,2]",
        "\"scale\":{\"factor\":[2,3,4]}",
        "\"scale\":{\"factor\":0.3,\"about\":[0.7,0.1,-0.2]}",
        "\"rotate\":{\"axis\":[1,2,3],\"degrees\":33}",
        "\"matrix\":[1,2,0.5,0.1,0,1,0.3,0.2,0.7,0,1,0.3,0,0,0,1]",
        "\"twist\":{\"axis\":[1,2,3],\"degrees\":33}",
        "\"taper\":{\"axis\":[1,2,3],\"factor\":0.3}",
        "\"bend\":{\"axis\":[1,2,3],\"toward\":\"x\",\"degrees\":33}",
    };
    static const char *const planes[] = {"\"x\"", "{\"axis\":\"x\",\"at\":0}", "{\"axis\":[-3,0,0],\"at\":0}",
                                         "{\"point\":[0,7,8],\"normal\":[2,0,0]}"};
    for (size_t a = 0; a < COUNT(actions); a++) {
        char plain[512], mirrored[512];
        snprintf(plain, sizeof plain, "{\"at\":[[-2,-1],\"all\",\"all\"],%s}", actions[a]);
        snprintf(mirrored, sizeof mirrored, "{\"at\":[[-2,-1],\"all\",\"all\"],\"mirror\":%s,%s}",
                 planes[a % COUNT(planes)], actions[a]);
        ffd_lattice *one = make(bar, plain), *both = make(bar, mirrored);
        assert_true(count_moved(one) > 0);
        for (size_t i = 0; i < 5; i++)
            for (size_t j = 0; j < 3; j++)
                for (size_t k = 0; k < 3; k++) {
                    const double *const right = point_of(one, i < 2 ? 4 - i : i, j, k);
                    const double *const p = point_of(both, i, j, k);
                    if (p[0] != (i < 2 ? -right[0] : right[0]) || p[1] != right[1] || p[2] != right[2])
                        fail_msg("%s: point %zu,%zu,%zu: %.17g %.17g %.17g, image %.17g %.17g %.17g",
                                 mirrored, i, j, k, p[0], p[1], p[2], right[0], right[1], right[2]);
                }
        ffd_lattice_destroy(&one);
        ffd_lattice_destroy(&both);
    }
}

/* Fails unless two moves give the same points within rounding. */
static void check_same(const char *rest, const char *move, const char *others)
{
    ffd_lattice *one = make(rest, move), *two = make(rest, others);
    size_t size[3];
    ffd_lattice_get_size(one, size);
    assert_true(count_moved(one) > 0);
    for (size_t i = 0; i < 3 * size[0] * size[1] * size[2]; i++)
        if (!(fabs(one->deformed[i] - two->deformed[i]) < 1e-14))
            fail_msg("%s: number %zu: %.17g, by %s %.17g", move, i, one->deformed[i], others,
                     two->deformed[i]);
    ffd_lattice_destroy(&one);
    ffd_lattice_destroy(&two);
}

/* 5 x 3 x 3 points that are no mirror images of each other in the planes below. */
static const char skew[] =
    "\"size\":[5,3,3],\"degree\":[1,1,1],\"knots\":[[0,0,1,2,5,6,6],\"clamped\",\"clamped\"],"
    "\"rest\":{\"box\":{\"min\":[-2,-1,-1],\"max\":[3,1,1]}}";

static void weights_by_position_are_mirrored(void **state)
{
    (void)state;
    check_same(skew,
               "{\"mirror\":{\"axis\":\"x\",\"at\":0.1},\"pull\":{\"point\":[1,0.1,0.3],\"by\":[1,2,3],"
               "\"radius\":2.5}}",
               "{\"pull\":{\"point\":[1,0.1,0.3],\"by\":[1,2,3],\"radius\":2.5}},"
               "{\"pull\":{\"point\":[-0.8,0.1,0.3],\"by\":[-1,2,3],\"radius\":2.5}}");
    /* Only on what the move selects. */
    check_same(skew,
               "{\"at\":[[2,4],\"all\",\"all\"],\"weight\":0.5,\"mirror\":{\"axis\":\"x\",\"at\":0.1},"
               "\"falloff\":{\"center\":[1,0.1,0.3],\"radius\":3},\"by\":[1,2,3]}",
               "{\"at\":[[2,4],\"all\",\"all\"],\"weight\":0.5,\"falloff\":{\"center\":[1,0.1,0.3],"
               "\"radius\":3},\"by\":[1,2,3]},"
               "{\"at\":[[2,4],\"all\",\"all\"],\"weight\":0.5,\"falloff\":{\"center\":[-0.8,0.1,0.3],"
               "\"radius\":3},\"by\":[-1,2,3]}");
    /* Any plane: normal (3, 4, 0)/5 through (0, 0.5, 0). The image of (1, 0, 0) is (0.76, -0.32, 0), and that
       of (1, 0.1, 0.3) is (0.808, -0.156 ..): n.p = 0.68, offset 0.4, so 0.56 n is taken off. */
    check_same(skew,
               "{\"mirror\":{\"point\":[0,0.5,0],\"normal\":[3,4,0]},\"pull\":{\"point\":[1,0.1,0.3],\"by\":["
               "1,0,3],\"radius\":2.5}}",
               "{\"pull\":{\"point\":[1,0.1,0.3],\"by\":[1,0,3],\"radius\":2.5}},"
               "{\"pull\":{\"point\":[0.664,-0.348,0.3],\"by\":[0.28,-0.96,3],\"radius\":2.5}}");
    /* A falloff along an axis; a turn goes the other way. */
    check_same(skew,
               "{\"mirror\":{\"axis\":\"x\",\"at\":0.1},\"falloff\":{\"axis\":\"x\",\"from\":3,\"to\":0},"
               "\"rotate\":{\"axis\":\"z\",\"degrees\":70,\"about\":[1,0,0]}}",
               "{\"falloff\":{\"axis\":\"x\",\"from\":3,\"to\":0},\"rotate\":{\"axis\":\"z\",\"degrees\":70,"
               "\"about\":[1,0,0]}},"
               "{\"falloff\":{\"axis\":\"x\",\"from\":-2.8,\"to\":0.2},\"rotate\":{\"axis\":\"z\","
               "\"degrees\":-70,\"about\":[-0.8,0,0]}}");
    /* Fractions: `at` counts along the axis from the region's lower corner. x = -2 + 5/2. */
    check_same("\"units\":\"box\",\"size\":[5,3,3],\"rest\":{\"box\":{\"min\":[-2,-1,-1],\"max\":[3,1,1]}}",
               "{\"mirror\":{\"axis\":\"x\",\"at\":0.5},\"pull\":{\"point\":[0.8,0.5,0.5],\"by\":[0.1,0.2,0],"
               "\"radius\":0.4}}",
               "{\"pull\":{\"point\":[0.8,0.5,0.5],\"by\":[0.1,0.2,0],\"radius\":0.4}},"
               "{\"pull\":{\"point\":[0.2,0.5,0.5],\"by\":[-0.1,0.2,0],\"radius\":0.4}}");
    check_same("\"units\":\"box\",\"size\":[5,3,3],\"rest\":{\"box\":{\"min\":[-2,-1,-1],\"max\":[3,1,1]}}",
               "{\"mirror\":{\"point\":[0.5,0.1,0.2],\"normal\":\"x\"},\"pull\":{\"point\":[0.8,0.5,0.5],"
               "\"by\":[0.1,0.2,0],\"radius\":0.4}}",
               "{\"mirror\":{\"axis\":\"x\",\"at\":0.5},\"pull\":{\"point\":[0.8,0.5,0.5],\"by\":[0.1,0.2,0],"
               "\"radius\":0.4}}");
}

/* Images in an oblique plane: the points of a cube, of which the plane swaps x and y. */
static void any_plane_has_images(void **state)
{
    (void)state;
    static const char cube[] =
        "\"size\":[3,3,3],\"degree\":[1,1,1],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}";
    check_same(cube,
               "{\"at\":[2,0,\"all\"],\"mirror\":{\"point\":[0.5,0.5,0],\"normal\":[1,-1,0]},\"by\":[1,0,2]}",
               "{\"at\":[2,0,\"all\"],\"by\":[1,0,2]},{\"at\":[0,2,\"all\"],\"by\":[0,1,2]}");
    check_same(cube,
               "{\"at\":[2,0,\"all\"],\"mirror\":{\"axis\":[1,-1,0],\"at\":0},\"twist\":{\"axis\":\"z\","
               "\"degrees\":90,\"about\":[1,-1,0]}}",
               "{\"at\":[2,0,\"all\"],\"twist\":{\"axis\":\"z\",\"degrees\":90,\"about\":[1,-1,0]}},"
               "{\"at\":[0,2,\"all\"],\"twist\":{\"axis\":\"z\",\"degrees\":-90,\"about\":[-1,1,0]}}");
    check_same(cube, "{\"at\":[2,0,\"all\"],\"mirror\":{\"axis\":[1,-1,0],\"at\":0},\"to\":[3,4,5]}",
               "{\"at\":[2,0,\"all\"],\"to\":[3,4,5]},{\"at\":[0,2,\"all\"],\"to\":[4,3,5]}");
    ffd_lattice *l;
    ffd_error error;
    assert_int_equal(parse(cube,
                           "{\"at\":[2,1,1],\"mirror\":{\"axis\":[0.6,0,-0.8],\"at\":1},\"by\":[1,0,0]}", &l,
                           &error),
                     FFD_E_INVALID);
    assert_string_equal(message_of(&error),
                        "t.json:1: /moves/0: control point 2,1,1 has no mirror image: no other rests "
                        "across the plane 0.6 x - 0.8 z = 1");
}

static void a_point_selected_by_both_gets_both_in_order(void **state)
{
    (void)state;
    ffd_lattice *l = make(bar, "{\"at\":[[2,4],\"all\",\"all\"],\"mirror\":\"x\",\"by\":[1,2,0]}");
    check_point(l, 2, 1, 1, 0, 4, 0);
    check_point(l, 0, 1, 1, -3, 2, 0);
    check_point(l, 4, 1, 1, 3, 2, 0);
    ffd_lattice_destroy(&l);
    /* First moved to x = 3, then scaled by 2 about the mirror image of x = 1: -1 + 2 (3 + 1) = 7. */
    l = make(bar, "{\"at\":[2,1,1],\"by\":[3,0,0]},{\"at\":[2,1,1],\"mirror\":\"x\",\"scale\":{\"factor\":2,"
                  "\"about\":[1,0,0]}}");
    check_point(l, 2, 1, 1, -1 + 2 * (5 + 1), 0, 0);
    ffd_lattice_destroy(&l);
}

static void the_plane_goes_through_the_middle_of_the_rest(void **state)
{
    (void)state;
    /* A box from 1 to 4 along y: the mirror plane is y = 5/2. */
    ffd_lattice *l = make("\"size\":[2,3,2],\"degree\":[1,1,1],\"rest\":{\"box\":{\"min\":[0,1,0],\"max\":[1,"
                          "4,1]}}",
                          "{\"at\":[0,0,0],\"mirror\":\"y\",\"to\":[9,0,7]}");
    check_point(l, 0, 0, 0, 9, 0, 7);
    check_point(l, 0, 2, 0, 9, 5, 7);
    ffd_lattice_destroy(&l);
    /* Points not ordered along the indices: the mirror image is found by position. */
    l = make("\"size\":[2,2,2],\"rest\":{\"points\":[[0,0,0],[4,0,0],[1,2,0],[3,2,0],[0,0,4],[4,0,4],[1,2,4],"
             "[3,2,4]]}",
             "{\"at\":[0,1,0],\"mirror\":\"x\",\"by\":[0.5,1,0]}");
    check_point(l, 0, 1, 0, 1.5, 3, 0);
    check_point(l, 1, 1, 0, 2.5, 3, 0);
    assert_int_equal(count_moved(l), 2);
    ffd_lattice_destroy(&l);
    /* A full cylinder with a collapsed axis: all points on the axis are mirror images of each other. */
    l = make("\"size\":[2,8,2],\"rest\":{\"cylinder\":{\"center\":[3,0,0],\"axis\":\"z\",\"radius\":[0,1],"
             "\"height\":2}}",
             "{\"at\":[0,2,0],\"mirror\":\"z\",\"by\":[0,0,1]}");
    assert_int_equal(count_moved(l), 9);
    ffd_lattice_destroy(&l);
}

#define FAR_ROW(yz)                                                                                          \
    "[1000000000000," yz "],[1000000000000.3334," yz "],[1000000000000.6667," yz "],[1000000000001," yz "]"

/* Far from the origin, rounding of coordinates exceeds 1e-9 of a small lattice. */
static void images_are_found_within_1e_9_and_rounding(void **state)
{
    (void)state;
    static const char *const format =
        "\"size\":[2,2,2],\"rest\":{\"points\":[[0,0,0],[1,%s,0],[0,1,0],[1,1,0],"
        "[0,0,1],[1,0,1],[0,1,1],[1,1,1]]}";
    char rest[512];
    ffd_lattice *l;
    ffd_error error;
    snprintf(rest, sizeof rest, format, "1.7e-9");
    l = make(rest, "{\"at\":[0,0,0],\"mirror\":\"x\",\"by\":[0,1,0]}");
    assert_int_equal(count_moved(l), 2);
    ffd_lattice_destroy(&l);
    snprintf(rest, sizeof rest, format, "1.8e-9");
    assert_int_equal(parse(rest, "{\"at\":[0,0,0],\"mirror\":\"x\",\"by\":[0,1,0]}", &l, &error),
                     FFD_E_INVALID);
    assert_string_equal(message_of(&error), "t.json:1: /moves/0: control point 0,0,0 has no mirror image: no "
                                            "other rests across the plane x = 0.5");
    /* Doubles are 1/8192 apart there. Of the two points in the middle, neither is exactly the other's mirror
       image. */
    l = make(
        "\"size\":[4,2,2],\"degree\":[1,1,1],\"rest\":{\"points\":[" FAR_ROW("0,0") "," FAR_ROW(
            "1,0") "," FAR_ROW("0,1") "," FAR_ROW("1,1") "]}",
        "{\"at\":[0,0,0],\"mirror\":\"x\",\"by\":[0,1,0]},{\"at\":[2,0,0],\"mirror\":\"x\",\"by\":[0,1,0]}");
    assert_int_equal(count_moved(l), 4);
    ffd_lattice_destroy(&l);
}

/* The tree finds the same as comparing all pairs, even with many points at one place. */
static void selections_are_as_all_pairs_say(void **state)
{
    (void)state;
    enum { N = 600 };
    static double rest[3 * N];
    static unsigned char selected[N], expected[N];
    uint32_t draw = 7;
    for (int round = 0; round < 40; round++) {
        const uint32_t places = round % 4 == 0 ? 2 : 3 + (uint32_t)round;
        for (size_t c = 0; c < 3 * N; c++) {
            draw = draw * 1664525u + 1013904223u;
            rest[c] = (double)((draw >> 8) % places) - (round % 3 == 0 ? 0.5 * (double)(places - 1) : 0);
        }
        for (size_t c = 0; c < 3; c++) { /* the bounds of all points */
            rest[c] = round % 3 == 0 ? -0.5 * (double)(places - 1) : 0;
            rest[3 + c] = rest[c] + (double)(places - 1);
        }
        const ffd_lattice lattice = {.rest = rest, .count = N};
        const int axis = round % 3;
        const mirror_plane plane = ffd_mirror_middle(&lattice, axis);
        mirror_tree all = {0};
        for (size_t i = 0; i < N; i++) {
            draw = draw * 1664525u + 1013904223u;
            selected[i] = (draw >> 20) % 5 == 0;
        }
        size_t without = N, missing;
        memset(expected, 0, sizeof expected);
        for (size_t i = N; i-- > 0;) {
            bool any = false;
            for (size_t j = 0; j < N && selected[i]; j++) {
                bool same = true;
                for (int c = 0; c < 3; c++)
                    same = same &&
                           rest[3 * j + (size_t)c] ==
                               (c == axis ? plane.twice - rest[3 * i + (size_t)c] : rest[3 * i + (size_t)c]);
                any = any || same;
                expected[j] |= same;
            }
            without = selected[i] && !any ? i : without;
        }
        assert_int_equal(ffd_mirror_select(&lattice, &plane, &all, selected, &missing, NULL), FFD_OK);
        assert_int_equal(missing, without);
        if (missing == N)
            assert_memory_equal(selected, expected, N);
        ffd_mirror_tree_free(&all);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pull_takes_the_points_near_its_place),
        cmocka_unit_test(a_falloff_scales_any_action_by_the_place_at_rest),
        cmocka_unit_test(a_falloff_changes_neither_extent_nor_centroid),
        cmocka_unit_test(a_falloff_in_box_units_runs_along_the_region),
        cmocka_unit_test(a_mirrored_move_does_the_same_on_the_other_side),
        cmocka_unit_test(weights_by_position_are_mirrored),
        cmocka_unit_test(any_plane_has_images),
        cmocka_unit_test(a_point_selected_by_both_gets_both_in_order),
        cmocka_unit_test(the_plane_goes_through_the_middle_of_the_rest),
        cmocka_unit_test(images_are_found_within_1e_9_and_rounding),
        cmocka_unit_test(selections_are_as_all_pairs_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
