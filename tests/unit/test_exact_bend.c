/* Exact bends: control points and weights computed by hand, the volume on its circles, refusals. */
#include "lattice/lattice.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "../support/lattice_text.h"
#include "../support/repetitions.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Two arcs along z, from 0 to 4; x and y from -1 to 1. */
#define REST "\"rest\":{\"box\":{\"min\":[-1,-1,0],\"max\":[1,1,4]}}"
#define TWO_ARCS                                                                                             \
    "\"size\":[2,2,5],\"degree\":[1,1,2],\"knots\":[\"clamped\",\"clamped\",[0,0,0,1,1,2,2,2]]," REST
#define ONE_ARC "\"size\":[3,2,3]," REST

#define THREE_ARCS(u, w, spacing)                                                                            \
    "\"size\":[4,4,7],\"degree\":[3,2,2],\"knots\":[" u ",\"clamped\"," w                                    \
    "],\"rest\":{\"box\":{\"min\":[-1,"                                                                      \
    "-1,0],\"max\":[1,1,4],\"spacing\":\"" spacing "\"}}"

static const double pi = 3.14159265358979323846;

static void check_point(const ffd_lattice *l, size_t i, size_t j, size_t k, const double expected[4])
{
    const size_t point = i + l->size[0] * (j + l->size[1] * k);
    const double *const p = l->deformed + 3 * point;
    for (int c = 0; c < 3; c++)
        if (!(fabs(p[c] - expected[c]) <= 4e-15 && fabs(l->deformed_weights[point] - expected[3]) <= 3e-16))
            fail_msg("point %zu,%zu,%zu: %.17g %.17g %.17g weight %.17g", i, j, k, p[0], p[1], p[2],
                     l->deformed_weights[point]);
}

/* 180 degrees over the length 4 toward x: R = 4/pi, in two arcs of 90 degrees, whose control points are
   corners of half a square. */
static void middle_layers_stand_where_the_tangents_cross(void **state)
{
    (void)state;
    ffd_lattice *l =
        make(TWO_ARCS, "{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":180,\"exact\":true}}");
    const double radius = 4 / pi;
    for (size_t i = 0; i < 2; i++)
        for (size_t j = 0; j < 2; j++) {
            const double x = i == 0 ? -1 : 1, y = j == 0 ? -1 : 1, r = radius - x;
            check_point(l, i, j, 0, (const double[]){x, y, 0, 1});
            check_point(l, i, j, 1, (const double[]){x, y, r, sqrt(0.5)});
            check_point(l, i, j, 2, (const double[]){radius, y, r, 1});
            check_point(l, i, j, 3, (const double[]){radius + r, y, r, sqrt(0.5)});
            check_point(l, i, j, 4, (const double[]){radius + r, y, 0, 1});
            assert_true(l->rest_weights[i] == 1);
        }
    ffd_lattice_destroy(&l);
}

static void check_circles(const ffd_lattice *l, double degrees, double length, const char *what)
{
    const double radius = length * 180 / (pi * degrees);
    double worst = 0;
    for (int n = 0; n < 3000; n++) {
        double lo[3], hi[3], uvw[3], rest[3], p[3];
        ffd_lattice_get_domain(l, lo, hi);
        for (int a = 0; a < 3; a++)
            uvw[a] = lo[a] + (hi[a] - lo[a]) * (n == 0 ? 0 : fmod(n * (a + 1) * 0.3819660112501051, 1));
        ffd_lattice_evaluate(l, FFD_VOLUME_REST, uvw, rest, NULL);
        ffd_lattice_evaluate(l, FFD_VOLUME_DEFORMED, uvw, p, NULL);
        const double away = hypot(p[0] - radius, p[2]), expected = fabs(radius - rest[0]);
        worst = fmax(worst, fabs(away - expected) / fabs(radius));
        assert_true(fabs(p[1] - rest[1]) <= 1e-14);
    }
    if (!(worst <= 1e-14))
        fail_msg("%s: off its circle by %g of the radius", what, worst);
}

static void the_volume_lies_on_its_circles(void **state)
{
    (void)state;
    static const double angles[] = {180, -180, 90, 359, 30, -1, 1e-3};
    static const char *const rests[] = {
        TWO_ARCS,
        THREE_ARCS("\"open\"", "[0,0,0,1,1,1.5,1.5,3,3,3]", "greville"),
        THREE_ARCS("\"clamped\"", "[0,0,0,1,1,2,2,3,3,3]", "uniform"),
    };
    for (size_t r = 0; r < COUNT(rests); r++)
        for (size_t a = 0; a < COUNT(angles); a += (size_t)stride(4)) {
            char moves[256];
            snprintf(moves, sizeof moves,
                     "{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":%g,\"about\":[0,0,0],\"exact\":"
                     "true}}",
                     angles[a]);
            ffd_lattice *l = make(rests[r], moves);
            check_circles(l, angles[a], 4, moves);
            ffd_lattice_destroy(&l);
        }
}

/* The upper half to one side, the lower half mirrored: the layer between them stays. */
static void whole_arcs_may_be_bent_alone_and_mirrored(void **state)
{
    (void)state;
    ffd_lattice *l =
        make(TWO_ARCS, "{\"at\":[\"all\",\"all\",[2,-1]],\"mirror\":\"z\",\"bend\":{\"axis\":\"z\","
                       "\"toward\":\"x\",\"degrees\":90,\"about\":[0,0,2],\"exact\":true}}");
    const double radius = 4 / pi;
    for (size_t i = 0; i < 2; i++) {
        const double x = i == 0 ? -1 : 1, r = radius - x;
        check_point(l, i, 1, 2, (const double[]){x, 1, 2, 1});
        check_point(l, i, 1, 3, (const double[]){x, 1, 2 + r, sqrt(0.5)});
        check_point(l, i, 1, 4, (const double[]){radius, 1, 2 + r, 1});
        check_point(l, i, 1, 1, (const double[]){x, 1, 2 - r, sqrt(0.5)});
        check_point(l, i, 1, 0, (const double[]){radius, 1, 2 - r, 1});
    }
    ffd_lattice_destroy(&l);
}

static void no_angle_changes_nothing(void **state)
{
    (void)state;
    ffd_lattice *l =
        make(TWO_ARCS, "{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":0,\"exact\":true}}");
    assert_null(l->deformed_weights);
    assert_memory_equal(l->rest, l->deformed, 3 * l->count * sizeof(double));
    ffd_lattice_destroy(&l);
    /* "exact": false is the same as no "exact". */
    l = make(TWO_ARCS, "{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":90,\"exact\":false}}");
    assert_null(l->deformed_weights);
    ffd_lattice_destroy(&l);
}

/* Existing weights are multiplied. */
static void weights_across_the_axis_are_kept(void **state)
{
    (void)state;
    ffd_lattice *l = make(ONE_ARC ",\"weights\":[1,2,3,4,5,6,1,2,3,4,5,6,1,2,3,4,5,6]",
                          "{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":120,\"exact\":true}}");
    for (size_t i = 0; i < 18; i++) {
        const double weight = (double)(i % 6 + 1);
        assert_true(l->rest_weights[i] == weight);
        assert_true(fabs(l->deformed_weights[i] - weight * (i / 6 == 1 ? 0.5 : 1)) <= 1e-15);
    }
    check_circles(l, 120, 4, "weights");
    ffd_lattice_destroy(&l);
}

#define EXACT(degrees) "\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":" degrees ",\"exact\":true}"

static void what_would_be_no_circle_is_refused(void **state)
{
    (void)state;
    static const struct refusal {
        const char *rest, *moves, *words;
    } refusals[] = {
        {"\"size\":[2,2,5]," REST, "{" EXACT("90") "}",
         "/moves/0: the bend cannot be exact: along the axis, w, it needs degree 2, not 3"},
        {"\"size\":[2,2,5],\"degree\":[1,1,2]," REST, "{" EXACT("90") "}",
         "/moves/0: the bend cannot be exact: along the axis, w, it needs clamped knots with each inner one "
         "twice, as 0 0 0 1 1 2 2 2"},
        {"\"size\":[2,2,3],\"knots\":[\"open\",\"open\",\"open\"]," REST, "{" EXACT("90") "}",
         "/moves/0: the bend cannot be exact: along the axis, w, it needs clamped knots with each inner one "
         "twice, as 0 0 0 1 1 2 2 2"},
        {TWO_ARCS, "{" EXACT("360") "}",
         "/moves/0: the bend cannot be exact: an arc has less than 180 degrees, not 180; it needs more "
         "knots"},
        {ONE_ARC, "{" EXACT("-200") "}",
         "/moves/0: the bend cannot be exact: an arc has less than 180 degrees, not 200; it needs more "
         "knots"},
        {TWO_ARCS, "{\"at\":[0,\"all\",\"all\"]," EXACT("90") "}",
         "/moves/0: the bend cannot be exact: it needs all points of a layer, not a part of them"},
        {TWO_ARCS, "{\"at\":[\"all\",\"all\",[1,3]]," EXACT("90") "}",
         "/moves/0: the bend cannot be exact: its layers begin and end at even indices, where its arcs meet"},
        {TWO_ARCS, "{\"taper\":{\"axis\":\"z\",\"factor\":0.999999}},{" EXACT("90") "}",
         "/moves/1: the bend cannot be exact: the rows of its points do not run along the axis"},
        {TWO_ARCS, "{\"at\":[1,\"all\",\"all\"],\"by\":[0,0,1e-6]},{" EXACT("90") "}",
         "/moves/1: the bend cannot be exact: the layers of its points do not stand across the axis"},
        {TWO_ARCS ",\"weights\":[1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,2]", "{" EXACT("90") "}",
         "/moves/0: the bend cannot be exact: the weights of its points differ along the axis"},
        {TWO_ARCS, "{" EXACT("90") "},{" EXACT("90") "}",
         "/moves/1: the bend cannot be exact: the weights of its points differ along the axis"},
        {TWO_ARCS, "{\"weight\":0.5," EXACT("90") "}",
         "/moves/0/bend/exact: a bend with a weight other than 1 is not exact: what it leaves is no circle"},
        {TWO_ARCS, "{\"falloff\":{\"axis\":\"z\",\"from\":0,\"to\":1}," EXACT("90") "}",
         "/moves/0/bend/exact: a bend with a falloff is not exact: what it leaves is no circle"},
        {TWO_ARCS, "{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":9,\"exact\":1}}",
         "/moves/0/bend/exact: must be true or false, not the number 1"},
        {TWO_ARCS, "{\"exact\":true,\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":9}}",
         "/moves/0/exact: unknown key \"exact\" of a move; it is one of \"bend\""},
        {TWO_ARCS, "{\"twist\":{\"axis\":\"z\",\"degrees\":9,\"exact\":true}}",
         "/moves/0/twist/exact: unknown key \"exact\"; known ones are \"axis\", \"degrees\", \"about\", "
         "\"comment\", \"name\""},
    };
    for (size_t i = 0; i < COUNT(refusals); i++) {
        ffd_lattice *l;
        ffd_error error;
        const ffd_status status = parse(refusals[i].rest, refusals[i].moves, &l, &error);
        if (status != FFD_E_INVALID ||
            strcmp(message_of(&error) + strlen("t.json:1: "), refusals[i].words) != 0)
            fail_msg("%s: %d, %s\nexpected %s", refusals[i].moves, (int)status, message_of(&error),
                     refusals[i].words);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(middle_layers_stand_where_the_tangents_cross),
        cmocka_unit_test(the_volume_lies_on_its_circles),
        cmocka_unit_test(whole_arcs_may_be_bent_alone_and_mirrored),
        cmocka_unit_test(no_angle_changes_nothing),
        cmocka_unit_test(weights_across_the_axis_are_kept),
        cmocka_unit_test(what_would_be_no_circle_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
