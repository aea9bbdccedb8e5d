/* Moves of a lattice file: control points compared with values computed by hand. */
#include "lattice/lattice.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "../support/lattice_points.h"
#include "../support/message.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static ffd_lattice *make(const char *size, const char *rest, const char *more)
{
    static char text[8192];
    ffd_lattice *lattice;
    ffd_error error;
    snprintf(text, sizeof text,
             "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":%s,\"degree\":[1,1,1],\"rest\":%s,%s}", size,
             rest, more);
    if (ffd_lattice_parse(text, strlen(text), "t.json", &lattice, &error))
        fail_msg("%s\n%s", message_of(&error), text);
    return lattice;
}

/* 3 x 3 x 5 points of degree 1: x and y are 0, 1, 2; z is 0, 1, 2, 3, 4. */
static const char tower[] = "{\"box\":{\"min\":[0,0,0],\"max\":[2,2,4]}}";

static ffd_lattice *move_tower(const char *moves)
{
    char more[2048];
    snprintf(more, sizeof more, "\"moves\":[%s]", moves);
    return make("[3,3,5]", tower, more);
}

/* Within a few rounding errors of coordinates around 10. */
static void check_near(const ffd_lattice *l, size_t i, size_t j, size_t k, double x, double y, double z)
{
    check_within(l, (const size_t[]){i, j, k}, (const double[]){x, y, z}, 5e-15);
}

static void check_exact(const ffd_lattice *l, size_t i, size_t j, size_t k, double x, double y, double z)
{
    check_within(l, (const size_t[]){i, j, k}, (const double[]){x, y, z}, 0);
}

static void at_and_within_select_the_right_points(void **state)
{
    (void)state;
    static const struct selection {
        const char *which;
        size_t count;
    } selections[] = {
        {"", 45},
        {"\"at\":[0,0,0],", 1},
        {"\"at\":[-1,-1,-1],", 1},
        {"\"at\":[-3,-3,-5],", 1},
        {"\"at\":[\"all\",\"all\",-1],", 9},
        {"\"at\":[[0,1],1,[1,3]],", 6},
        {"\"at\":[[-2,-1],[0,-1],[2,2]],", 6},
        {"\"at\":[\"all\",\"all\",\"all\"],", 45},
        {"\"within\":{\"min\":[0,0,4],\"max\":[2,2,4]},", 9},
        {"\"within\":{\"min\":[0.5,-9,0.5],\"max\":[9,9,2.5]},", 12},
        {"\"within\":{\"min\":[-1,-1,-1],\"max\":[9,9,9]},", 45},
    };
    for (size_t s = 0; s < COUNT(selections); s++) {
        char moves[256];
        snprintf(moves, sizeof moves, "{%s\"by\":[1,2,3]}", selections[s].which);
        ffd_lattice *l = move_tower(moves);
        if (count_moved(l) != selections[s].count)
            fail_msg("%s: %zu moved", selections[s].which, count_moved(l));
        ffd_lattice_destroy(&l);
    }
    ffd_lattice *l = move_tower("{\"at\":[-1,0,[3,-1]],\"by\":[1,2,3]}");
    check_exact(l, 2, 0, 3, 3, 2, 6);
    check_exact(l, 2, 0, 4, 3, 2, 7);
    check_exact(l, 2, 0, 2, 2, 0, 2);
    ffd_lattice_destroy(&l);
}

/* Points with their rest position on a face of `within` are inside, even if the coordinate is rounded:
   thirds, and a box with turned axes. */
static void points_on_a_face_of_within_are_selected(void **state)
{
    (void)state;
    ffd_lattice *l = make(
        "[4,4,4]", "{\"box\":{\"min\":[-0.1,0,0],\"max\":[0.2,1,1]}}",
        "\"moves\":[{\"within\":{\"min\":[0.1,0,0.6666666666666666],\"max\":[0.2,1,1]},\"by\":[1,0,0]}]");
    assert_int_equal(count_moved(l), 2 * 4 * 2);
    ffd_lattice_destroy(&l);
    l = make("[4,4,4]",
             "{\"box\":{\"min\":[0,0,0],\"max\":[3,1,1],\"axes\":[[0.6,0.8,0],[-0.8,0.6,0],[0,0,1]]}}",
             "\"units\":\"box\",\"moves\":[{\"within\":{\"min\":[0.3333333333333333,0,0],\"max\":[1,1,0."
             "6666666666666666]},"
             "\"by\":[0,0,1]}]");
    assert_int_equal(count_moved(l), 3 * 4 * 3);
    ffd_lattice_destroy(&l);
    l = move_tower("{\"by\":[100,0,0]},{\"within\":{\"min\":[0,0,0],\"max\":[0,0,0]},\"by\":[0,7,0]}");
    check_exact(l, 0, 0, 0, 100, 7, 0);
    check_exact(l, 1, 0, 0, 101, 0, 0);
    ffd_lattice_destroy(&l);
}

static void by_and_to_move_points_and_identities_do_not(void **state)
{
    (void)state;
    ffd_lattice *l =
        move_tower("{\"at\":[0,0,0],\"to\":[9,8,7]},{\"at\":[0,0,0],\"by\":[-1,0.5,0],\"weight\":0.5}");
    check_exact(l, 0, 0, 0, 8.5, 8.25, 7);
    check_exact(l, 1, 0, 0, 1, 0, 0);
    assert_int_equal(count_moved(l), 1);
    assert_true(l->difference[0] == 8.5 && l->difference[3] == 0);
    ffd_lattice_destroy(&l);
    l = move_tower(
        "{\"by\":[0,0,0]},{\"weight\":0,\"to\":[1,1,1]},{\"scale\":{\"factor\":1}},{\"rotate\":{\"axis\":"
        "\"x\","
        "\"degrees\":720}},{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},{\"twist\":{\"axis\":[1,2,3],"
        "\"degrees\":0}},{\"taper\":{\"axis\":\"z\",\"factor\":1}},{\"bend\":{\"axis\":\"z\",\"toward\":"
        "\"x\","
        "\"degrees\":0}}");
    assert_int_equal(count_moved(l), 0);
    ffd_lattice_destroy(&l);
}

static void scale_is_about_the_centroid_or_a_given_point(void **state)
{
    (void)state;
    /* About the centroid, (1,1,2). */
    ffd_lattice *l = move_tower("{\"scale\":{\"factor\":3}}");
    check_exact(l, 0, 0, 0, -2, -2, -4);
    check_exact(l, 1, 1, 2, 1, 1, 2);
    check_exact(l, 2, 0, 4, 4, -2, 8);
    ffd_lattice_destroy(&l);
    /* The centroid of the selected points: the face z = 4. */
    l = move_tower("{\"at\":[\"all\",\"all\",-1],\"scale\":{\"factor\":[0.5,1,-2]}}");
    check_exact(l, 0, 2, 4, 0.5, 2, 4);
    check_exact(l, 2, 0, 4, 1.5, 0, 4);
    ffd_lattice_destroy(&l);
    /* About a point; after an earlier move; with a weight: p + 1/4 (2p - p - about). */
    l = move_tower("{\"by\":[1,0,0]},{\"scale\":{\"factor\":2,\"about\":[3,0,0]},\"weight\":0.25}");
    check_exact(l, 0, 0, 4, 0.5, 0, 5);
    ffd_lattice_destroy(&l);
}

static void rotate_is_right_handed_about_its_axis(void **state)
{
    (void)state;
    ffd_lattice *l = move_tower("{\"rotate\":{\"axis\":\"z\",\"degrees\":90,\"about\":[0,0,0]}}");
    check_exact(l, 2, 1, 3, -1, 2, 3);
    check_exact(l, 0, 0, 4, 0, 0, 4);
    ffd_lattice_destroy(&l);
    l = move_tower("{\"rotate\":{\"axis\":[0,0,-7],\"degrees\":90}}");
    check_exact(l, 2, 1, 3, 1, 0, 3);
    ffd_lattice_destroy(&l);
    /* A turn by 120 degrees about (1,1,1) permutes x, y, z. */
    l = move_tower("{\"rotate\":{\"axis\":[1,1,1],\"degrees\":120,\"about\":[0,0,0]}}");
    check_near(l, 2, 1, 3, 3, 2, 1);
    ffd_lattice_destroy(&l);
    l = move_tower("{\"rotate\":{\"axis\":\"y\",\"degrees\":30,\"about\":[1,5,2]}}");
    /* d = (1, ., 2): x' = 1 + d_x cos + d_z sin, z' = 2 - d_x sin + d_z cos. */
    check_near(l, 2, 1, 4, 1 + sqrt(0.75) + 1, 1, 2 - 0.5 + 2 * sqrt(0.75));
    ffd_lattice_destroy(&l);
}

static void matrix_maps_points_and_weight_blends(void **state)
{
    (void)state;
    ffd_lattice *l = move_tower("{\"matrix\":[1,2,0,10, 0,1,0,20, 0,0,3,30, 0,0,0,1]}");
    check_exact(l, 2, 1, 4, 2 + 2 + 10, 1 + 20, 12 + 30);
    ffd_lattice_destroy(&l);
    l = move_tower("{\"matrix\":[1,2,0,10, 0,1,0,20, 0,0,3,30, 0,0,0,1],\"weight\":0.5}");
    check_exact(l, 2, 1, 4, 8, 11, 23);
    ffd_lattice_destroy(&l);
}

static void twist_grows_along_the_selected_extent(void **state)
{
    (void)state;
    /* z from 0 to 4 about the middle line x = y = 1: 0, 90, 180, 270, 360 degrees. */
    ffd_lattice *l = move_tower("{\"twist\":{\"axis\":\"z\",\"degrees\":360}}");
    check_exact(l, 2, 1, 0, 2, 1, 0);
    check_near(l, 2, 1, 1, 1, 2, 1);
    check_near(l, 2, 1, 2, 0, 1, 2);
    check_near(l, 2, 1, 3, 1, 0, 3);
    check_near(l, 2, 1, 4, 2, 1, 4);
    check_exact(l, 1, 1, 3, 1, 1, 3);
    ffd_lattice_destroy(&l);
    /* The extent is that of the selected points, z from 2 to 4. The axis points down, so s and f grow
       downwards. */
    l = move_tower(
        "{\"at\":[\"all\",\"all\",[2,4]],\"twist\":{\"axis\":[0,0,-1],\"degrees\":-90,\"about\":[0,0,0]}}");
    check_exact(l, 2, 1, 4, 2, 1, 4);
    check_near(l, 2, 0, 2, 0, 2, 2);
    check_near(l, 2, 0, 3, sqrt(2), sqrt(2), 3);
    ffd_lattice_destroy(&l);
    /* Without extent nothing turns. */
    l = move_tower("{\"at\":[\"all\",\"all\",2],\"twist\":{\"axis\":\"z\",\"degrees\":90}}");
    assert_int_equal(count_moved(l), 0);
    ffd_lattice_destroy(&l);
}

static void taper_scales_across_its_axis_from_the_low_end(void **state)
{
    (void)state;
    ffd_lattice *l = move_tower("{\"taper\":{\"axis\":\"z\",\"factor\":0}}");
    /* 1 + (0-1) f across, about x = y = 1. */
    check_exact(l, 0, 0, 0, 0, 0, 0);
    check_exact(l, 0, 2, 1, 0.25, 1.75, 1);
    check_exact(l, 0, 2, 2, 0.5, 1.5, 2);
    check_exact(l, 0, 2, 4, 1, 1, 4);
    ffd_lattice_destroy(&l);
    l = move_tower("{\"taper\":{\"axis\":\"x\",\"factor\":3,\"about\":[0,0,0]}}");
    check_exact(l, 1, 1, 2, 1, 2, 4);
    check_exact(l, 2, 1, 2, 2, 3, 6);
    ffd_lattice_destroy(&l);
}

/* The formula of data/schema/lattice.md 8.3, with the C library's functions. */
static void check_bend(const ffd_lattice *l, double degrees, double about_x)
{
    const double pi = 3.14159265358979323846, radius = 4 / (degrees * pi / 180);
    for (size_t k = 0; k < 5; k++)
        for (size_t i = 0; i < 3; i++) {
            const double s = (double)k, t = (double)i - about_x;
            const double s_bent = (radius - t) * sin(s / radius),
                         t_bent = radius - (radius - t) * cos(s / radius);
            const double *const p = point_of(l, i, 2, k);
            const double tolerance = 4e-16 * fabs(radius) + 5e-15;
            if (!(fabs(p[0] - (about_x + t_bent)) <= tolerance) || p[1] != 2 ||
                !(fabs(p[2] - s_bent) <= tolerance))
                fail_msg("%g degrees, point %zu,2,%zu: %.17g %.17g %.17g, expected %.17g 2 %.17g", degrees, i,
                         k, p[0], p[1], p[2], about_x + t_bent, s_bent);
        }
}

static void bend_makes_a_circular_arc_from_the_low_end(void **state)
{
    (void)state;
    static const double angles[] = {90, -90, 180, 30, 1, 1e-3, -250, 700};
    for (size_t i = 0; i < COUNT(angles); i++) {
        char moves[256];
        snprintf(moves, sizeof moves,
                 "{\"bend\":{\"axis\":\"z\",\"toward\":[3,0,5],\"degrees\":%g,\"about\":[1,1,77]}}",
                 angles[i]);
        ffd_lattice *l = move_tower(moves);
        check_bend(l, angles[i], 1);
        /* The low end is exactly fixed. */
        check_exact(l, 2, 0, 0, 2, 0, 0);
        ffd_lattice_destroy(&l);
    }
    /* 90 degrees over the length 4: R = 8/pi. The end of the axis moves to (R, R) and points along x. */
    ffd_lattice *l = move_tower("{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":90}}");
    const double radius = 8 / 3.14159265358979323846;
    check_near(l, 1, 1, 4, 1 + radius, 1, radius);
    check_near(l, 2, 1, 4, 1 + radius, 1, radius - 1);
    ffd_lattice_destroy(&l);
    /* Tiny angles move by about s^2/2R: no cancellation with the long radius. */
    l = move_tower("{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":1e-9}}");
    const double *const p = point_of(l, 1, 1, 4);
    const double expected = 4 * (1e-9 * 3.14159265358979323846 / 180) / 2;
    assert_true(fabs(p[0] - 1 - expected) <= 3e-16 && fabs(p[2] - 4) <= 2e-15);
    ffd_lattice_destroy(&l);
}

static void box_units_are_fractions_of_the_box(void **state)
{
    (void)state;
    /* Sides 2, 2, 4 from (0,0,0): fractions of these. */
    ffd_lattice *l =
        make("[3,3,5]", tower,
             "\"units\":\"box\",\"moves\":[{\"at\":[0,0,0],\"by\":[0.5,1,0.25]},{\"at\":[1,0,0],\"to\":"
             "[0.5,0.25,1]},{\"at\":[2,0,0],\"scale\":{\"factor\":2,\"about\":[0,0,0.5]}},{\"at\":[0,1,0],"
             "\"rotate\":{\"axis\":\"z\",\"degrees\":90,\"about\":[0.5,0.5,0]}},{\"at\":[2,2,4],\"matrix\":"
             "[1,0,0,0.5,0,1,0,0,0,0,0.5,0,0,0,0,1]},{\"within\":{\"min\":[0.5,1,0.5],\"max\":[0.5,1,0.5]},"
             "\"by\":[0,0,1]}]");
    check_exact(l, 0, 0, 0, 1, 2, 1);
    check_exact(l, 1, 0, 0, 1, 0.5, 4);
    check_exact(l, 2, 0, 0, 4, 0, -2);
    check_near(l, 0, 1, 0, 1, 0, 0);
    check_exact(l, 2, 2, 4, 3, 2, 2);
    check_exact(l, 1, 2, 2, 1, 2, 6);
    ffd_lattice_destroy(&l);
    /* Along the box's own axes, from its lower corner. */
    l = make(
        "[2,2,2]", "{\"box\":{\"min\":[1,2,3],\"max\":[4,5,7],\"axes\":[[0,1,0],[-1,0,0],[0,0,1]]}}",
        "\"units\":\"box\",\"moves\":[{\"at\":[0,0,0],\"by\":[1,0,0.5]},{\"at\":[1,1,1],\"to\":[0.5,0,0]}]");
    check_exact(l, 0, 0, 0, -2, 4, 5);
    check_exact(l, 1, 1, 1, -2, 2.5, 3);
    ffd_lattice_destroy(&l);
    /* For a cylinder the bounds of the solid cylinder, [-2,2] x [-2,2] x [-5,5]; for points their bounds. */
    l = make(
        "[2,8,2]",
        "{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[1,2],\"height\":10,\"angle\":[0,90]}}",
        "\"units\":\"box\",\"moves\":[{\"at\":[0,0,0],\"to\":[0.25,0.5,1]}]");
    check_near(l, 0, 0, 0, -1, 0, 5);
    ffd_lattice_destroy(&l);
    l = make("[2,2,2]", "{\"points\":[[0,0,0],[1,0,0],[0,2,0],[1,2,0],[0,0,4],[1,0,4],[0,2,4],[5,2,4]]}",
             "\"units\":\"box\",\"moves\":[{\"at\":[0,0,0],\"by\":[1,0.5,0.25]}]");
    check_exact(l, 0, 0, 0, 5, 1, 1);
    ffd_lattice_destroy(&l);
    /* For the box of a mesh, including its margin: sides 4, 4, 4. */
    l = make("[2,2,2]", "{\"box\":\"mesh\",\"margin\":0.5}",
             "\"units\":\"box\",\"moves\":[{\"at\":[0,0,0],\"by\":[0.5,0,0]}]");
    assert_int_equal(ffd_lattice_fit(l, (const double[]){0, 0, 0}, (const double[]){2, 2, 2}, NULL), FFD_OK);
    check_exact(l, 0, 0, 0, 1, -1, -1);
    assert_int_equal(ffd_lattice_fit(l, (const double[]){0, 0, 0}, (const double[]){4, 2, 2}, NULL), FFD_OK);
    check_exact(l, 0, 0, 0, 2, -1, -1);
    ffd_lattice_destroy(&l);
}

/* Moves act on the deformed points; `within` selects by rest position. */
static void moves_act_on_deformed_points_and_within_on_rest(void **state)
{
    (void)state;
    ffd_lattice *l =
        make("[2,2,2]", "{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1]}}",
             "\"deformed\":{\"points\":[[5,5,5],[1,0,0],[0,1,0],[1,1,0],[0,0,1],[1,0,1],[0,1,1],[1,1,1]]},"
             "\"moves\":[{\"within\":{\"min\":[0,0,0],\"max\":[0,0,0]},\"by\":[1,1,1]}]");
    check_exact(l, 0, 0, 0, 6, 6, 6);
    assert_true(l->rest[0] == 0);
    assert_int_equal(count_moved(l), 1);
    ffd_lattice_destroy(&l);
}

static void moves_that_select_nothing_or_overflow_fail(void **state)
{
    (void)state;
    static const struct failure {
        const char *more, *words;
    } failures[] = {
        {"\"moves\":[{\"by\":[1,0,0]},{\"within\":{\"min\":[9,9,9],\"max\":[10,10,10]},\"by\":[1,0,0]}]",
         "t.json:1: /moves/1: selects no control point: none is within these bounds at rest"},
        {"\"moves\":[{\"by\":[1e308,0,0]},{\"at\":[1,0,0],\"scale\":{\"factor\":10,\"about\":[0,0,0]}}]",
         "t.json:1: /moves/1: moves control point 1,0,0 to a position that is not finite"},
    };
    for (size_t i = 0; i < COUNT(failures); i++) {
        char text[1024];
        ffd_lattice *l;
        ffd_error error;
        snprintf(text, sizeof text,
                 "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[3,3,5],\"rest\":%s,%s}", tower,
                 failures[i].more);
        assert_int_equal(ffd_lattice_parse(text, strlen(text), "t.json", &l, &error), FFD_E_INVALID);
        assert_string_equal(message_of(&error), failures[i].words);
        assert_int_equal(ffd_lattice_parse(text, strlen(text), "t.json", &l, NULL), FFD_E_INVALID);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_and_within_select_the_right_points),
        cmocka_unit_test(points_on_a_face_of_within_are_selected),
        cmocka_unit_test(by_and_to_move_points_and_identities_do_not),
        cmocka_unit_test(scale_is_about_the_centroid_or_a_given_point),
        cmocka_unit_test(rotate_is_right_handed_about_its_axis),
        cmocka_unit_test(matrix_maps_points_and_weight_blends),
        cmocka_unit_test(twist_grows_along_the_selected_extent),
        cmocka_unit_test(taper_scales_across_its_axis_from_the_low_end),
        cmocka_unit_test(bend_makes_a_circular_arc_from_the_low_end),
        cmocka_unit_test(box_units_are_fractions_of_the_box),
        cmocka_unit_test(moves_act_on_deformed_points_and_within_on_rest),
        cmocka_unit_test(moves_that_select_nothing_or_overflow_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
