/* Control points of boxes and cylinders, and the extent of their volumes. */
#include "../support/message.h"
#include "../support/repetitions.h"
#include "lattice/border.h"
#include "lattice/spec.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static ffd_lattice *parse(const char *text)
{
    ffd_lattice *lattice;
    ffd_error error;
    if (ffd_lattice_parse(text, strlen(text), "t.json", &lattice, &error))
        fail_msg("%s\n%s", message_of(&error), text);
    return lattice;
}

/* Makes a lattice of JSON texts: size, degree, knots, rest. */
static ffd_lattice *make(const char *size, const char *degree, const char *knots, const char *rest)
{
    static char text[65536];
    snprintf(text, sizeof text,
             "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":%s,\"degree\":%s,\"knots\":%s,\"rest\":%s}",
             size, degree, knots, rest);
    return parse(text);
}

static void uvw_of(const ffd_lattice *lattice, double tu, double tv, double tw, double uvw[3])
{
    double lo[3], hi[3];
    const double t[3] = {tu, tv, tw};
    ffd_lattice_get_domain(lattice, lo, hi);
    for (int a = 0; a < 3; a++)
        uvw[a] = t[a] >= 1 ? hi[a] : lo[a] + t[a] * (hi[a] - lo[a]);
}

static const char *const knots_of_8[] = {
    "\"clamped\"",
    "\"open\"",
    "\"uniform\"",
    "[0,0,0,0,0.1,0.5,0.5,0.7,1,1,1,1]",
    "[-3,-1,0,1,2.5,3,4,6,8,8.5,9,11]",
    "[5,5,6,7,8,9,10,11,12,12,12,12]",
};

/* A box maps its domain affinely onto itself, whatever the knots. */
static void a_box_is_affine_whatever_its_knots(void **state)
{
    (void)state;
    double worst = 0;
    for (size_t kind = 0; kind < COUNT(knots_of_8); kind++) {
        char knots[512];
        snprintf(knots, sizeof knots, "[%s,%s,%s]", knots_of_8[kind],
                 knots_of_8[(kind + 1) % COUNT(knots_of_8)], knots_of_8[(kind + 3) % COUNT(knots_of_8)]);
        ffd_lattice *lattice =
            make("[8,8,8]", "[3,3,3]", knots, "{\"box\":{\"min\":[-1,2,-7],\"max\":[0.3,5,-6.5]}}");
        static const double min[3] = {-1, 2, -7}, max[3] = {0.3, 5, -6.5};
        assert_int_equal(lattice->form, REST_BOX_AFFINE);
        for (int sample = 0; sample < 11 * 11 * 11; sample++) {
            const double t[3] = {sample % 11 / 10.0, sample / 11 % 11 / 10.0, sample / 121 / 10.0};
            double uvw[3], lo[3], hi[3], point[3];
            uvw_of(lattice, t[0], t[1], t[2], uvw);
            ffd_lattice_get_domain(lattice, lo, hi);
            ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, NULL);
            for (int c = 0; c < 3; c++) {
                const double s = (uvw[c] - lo[c]) / (hi[c] - lo[c]);
                const double expected = min[c] + s * (max[c] - min[c]);
                const double size = fmax(fabs(min[c]), fabs(max[c]));
                worst = fmax(worst, fabs(point[c] - expected) / size);
                const double mapped = lattice->origin[c] + lattice->frame[3 * c + c] * s;
                assert_true(fabs(mapped - expected) <= 1e-15 * size);
            }
        }
        ffd_lattice_destroy(&lattice);
    }
    if (!(worst <= 1e-15))
        fail_msg("the box's map is off by %g of its size", worst);
}

/* All degrees, with the presets. */
static void a_box_is_affine_at_every_degree(void **state)
{
    (void)state;
    static const char *const kinds[] = {"clamped", "open", "uniform"};
    for (int degree = 1; degree <= 9; degree++)
        for (int n = degree + 1; n <= degree + 12; n += 4)
            for (size_t kind = 0; kind < COUNT(kinds); kind++) {
                char size[32], degrees[32], knots[64];
                snprintf(size, sizeof size, "[%d,2,2]", n);
                snprintf(degrees, sizeof degrees, "[%d,1,1]", degree);
                snprintf(knots, sizeof knots, "[\"%s\",\"clamped\",\"clamped\"]", kinds[kind]);
                ffd_lattice *lattice =
                    make(size, degrees, knots, "{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1]}}");
                for (int i = 0; i <= 20; i++) {
                    double uvw[3], lo[3], hi[3], point[3];
                    uvw_of(lattice, i / 20.0, 0.5, 0.5, uvw);
                    ffd_lattice_get_domain(lattice, lo, hi);
                    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, NULL);
                    /* The domain of "uniform" has the length (n-d)/(n+d), so rounding of its parameters
                       counts that much more. */
                    const double tolerance =
                        1e-15 * (1 + degree) * (kind == 2 ? (n + degree) / (n - degree) : 1);
                    if (!(fabs(point[0] - (uvw[0] - lo[0]) / (hi[0] - lo[0])) <= tolerance))
                        fail_msg("%s degree %d points %d at %g: off by %g", kinds[kind], degree, n, i / 20.0,
                                 point[0] - (uvw[0] - lo[0]) / (hi[0] - lo[0]));
                }
                ffd_lattice_destroy(&lattice);
            }
}

static void check_points(const ffd_lattice *lattice, size_t step, int c, const double *expected, size_t count)
{
    const double *const p = ffd_lattice_get_points(lattice, FFD_VOLUME_REST);
    for (size_t i = 0; i < count; i++)
        if (!(fabs(p[3 * i * step + (size_t)c] - expected[i]) <= 4e-16))
            fail_msg("point %zu: %.17g, expected %.17g", i, p[3 * i * step + (size_t)c], expected[i]);
}

static void box_points_stand_where_spacing_and_axes_say(void **state)
{
    (void)state;
    ffd_lattice *l = make("[5,5,5]", "[3,3,3]", "[\"clamped\",\"open\",\"uniform\"]",
                          "{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1]}}");
    /* Clamped: knots 0 0 0 0 1/2 1 1 1 1. Open: spacing 1/(n-d), starting (d-1)/2 spacings before the box. */
    check_points(l, 1, 0, (const double[]){0, 1 / 6.0, 0.5, 5 / 6.0, 1}, 5);
    check_points(l, 5, 1, (const double[]){-0.5, 0, 0.5, 1, 1.5}, 5);
    check_points(l, 25, 2, (const double[]){-0.5, 0, 0.5, 1, 1.5}, 5);
    ffd_lattice_destroy(&l);

    l = make("[5,5,5]", "[3,3,3]", "[\"clamped\",\"clamped\",\"clamped\"]",
             "{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1],\"spacing\":\"uniform\"}}");
    assert_int_equal(l->form, REST_POINTS);
    check_points(l, 1, 0, (const double[]){0, 0.25, 0.5, 0.75, 1}, 5);
    ffd_lattice_destroy(&l);

    /* The ends are exactly the numbers of the file: 0.2 - -0.1 + -0.1 is not 0.2. */
    l = make("[4,4,4]", "[3,3,3]", "[\"clamped\",\"clamped\",\"clamped\"]",
             "{\"box\":{\"min\":[-0.1,0,0],\"max\":[0.2,1,1]}}");
    assert_true(l->rest[0] == -0.1);
    assert_true(l->rest[9] == 0.2);
    ffd_lattice_destroy(&l);

    /* min and max are measured along the axes. */
    l = make("[2,2,2]", "[1,1,1]", "[\"clamped\",\"clamped\",\"clamped\"]",
             "{\"box\":{\"min\":[1,2,3],\"max\":[4,5,6],\"axes\":[[0,1,0],[-1,0,0],[0,0,1]]}}");
    check_points(l, 1, 1, (const double[]){1, 4}, 2);
    check_points(l, 2, 0, (const double[]){-2, -5}, 2);
    check_points(l, 4, 2, (const double[]){3, 6}, 2);
    ffd_lattice_destroy(&l);
}

/* Equal weights keep the map affine, others do not. */
static void only_equal_weights_keep_a_box_affine(void **state)
{
    (void)state;
    static const char text[] =
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,2,2],\"rest\":{\"box\":{\"min\":"
        "[0,0,0],\"max\":[1,1,1]}},\"weights\":[%s]%s}";
    char buffer[512];
    snprintf(buffer, sizeof buffer, text, "2,2,2,2,2,2,2,2", "");
    ffd_lattice *l = parse(buffer);
    assert_int_equal(l->form, REST_BOX_AFFINE);
    ffd_lattice_destroy(&l);
    snprintf(buffer, sizeof buffer, text, "2,2,2,2,2,2,2,3", "");
    l = parse(buffer);
    assert_int_equal(l->form, REST_POINTS);
    assert_false(l->weights_moved);
    ffd_lattice_destroy(&l);
    snprintf(buffer, sizeof buffer, text, "1,1,1,1,1,1,1,1", "");
    l = parse(buffer);
    assert_null(ffd_lattice_get_weights(l, FFD_VOLUME_REST));
    ffd_lattice_destroy(&l);
    snprintf(buffer, sizeof buffer, text, "1,1,1,1,1,1,1,1", ",\"deformed\":{\"weights\":[1,1,1,1,1,1,1,5]}");
    l = parse(buffer);
    assert_int_equal(l->form, REST_BOX_AFFINE);
    assert_true(l->weights_moved);
    assert_true(l->deformed_weights[7] == 5 && l->rest_weights[7] == 1);
    ffd_lattice_destroy(&l);
}

typedef struct turn {
    double first, last;
} turn;

/* The volume covers the radii r0 to r1 at every v, starts and ends at the right angles, and has the right
   height. */
static void check_cylinder(const ffd_lattice *lattice, double r0, double r1, double height, turn range,
                           const char *what)
{
    static const double radian = 3.14159265358979323846 / 180;
    const double tiny = 1e-13 * r1;
    for (int i = 0; i <= 997; i++) {
        double uvw[3], inner[3], outer[3];
        const double v = i / 997.0, w = i % 7 / 6.0;
        uvw_of(lattice, 0, v, w, uvw);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, inner, NULL);
        uvw_of(lattice, 1, v, w, uvw);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, outer, NULL);
        const double r_in = hypot(inner[0], inner[1]), r_out = hypot(outer[0], outer[1]);
        if (!(r_in <= r0 + tiny) || !(r_out >= r1 - tiny))
            fail_msg("%s: radii %.17g to %.17g at v = %g", what, r_in, r_out, v);
        if (!(fabs(outer[2] - (w - 0.5) * height) <= 1e-13 * height))
            fail_msg("%s: height %.17g at w = %g", what, outer[2], w);
        if (i != 0 && i != 997)
            continue;
        const double angle = (i == 0 ? range.first : range.last) * radian;
        const double across = (cos(angle) * outer[1] - sin(angle) * outer[0]) / r_out;
        const double along = (cos(angle) * outer[0] + sin(angle) * outer[1]) / r_out;
        if (!(fabs(across) <= 1e-12) || along < 0)
            fail_msg("%s: v = %g is %g radians off the angle %g", what, v, across, angle / radian);
    }
}

/* It is tight: the outer radius is r1 somewhere, and so is the inner radius r0. */
static void check_tight(const ffd_lattice *lattice, double r0, double r1, const char *what)
{
    double least = INFINITY, greatest = 0;
    for (int i = 0; i <= 4000; i++) {
        double uvw[3], point[3];
        uvw_of(lattice, 1, i / 4000.0, 0.5, uvw);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, NULL);
        least = fmin(least, hypot(point[0], point[1]));
        uvw_of(lattice, 0, i / 4000.0, 0.5, uvw);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, NULL);
        greatest = fmax(greatest, hypot(point[0], point[1]));
    }
    if (!(least <= r1 * (1 + 1e-3)) || !(greatest >= r0 * (1 - 1e-3)))
        fail_msg("%s: least outer radius %g, greatest inner %g", what, least, greatest);
}

/* Whether both end faces coincide up to rounding, though they have different control points. */
static void check_seam(const ffd_lattice *lattice, const char *knots, turn range, const char *what)
{
    const bool meets = range.last - range.first == 360 && strcmp(knots, "\"closed\"") != 0;
    if (knots[0] == '"' && ffd_lattice_is_seam(lattice, 1) != meets)
        fail_msg("%s: %s", what, meets ? "the ends do not meet" : "the ends meet");
}

static void check_one_cylinder(int n, int degree, const char *knots, turn range, double r0)
{
    char size[32], degrees[32], kinds[8192], rest[256];
    snprintf(size, sizeof size, "[3,%d,3]", n);
    snprintf(degrees, sizeof degrees, "[2,%d,2]", degree);
    snprintf(kinds, sizeof kinds, "[\"clamped\",%s,\"open\"]", knots);
    snprintf(
        rest, sizeof rest,
        "{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[%g,2],\"height\":5,\"angle\":[%g,%g]}}",
        r0, range.first, range.last);
    ffd_lattice *lattice = make(size, degrees, kinds, rest);
    char what[256];
    snprintf(what, sizeof what, "%d points, degree %d, %.60s, %g to %g", n, degree, knots, range.first,
             range.last);
    check_cylinder(lattice, r0, 2, 5, range, what);
    check_seam(lattice, knots, range, what);
    if (n < 12)
        check_tight(lattice, r0, 2, what);
    ffd_lattice_destroy(&lattice);
}

static void a_full_turn_covers_its_cylinder(void **state)
{
    (void)state;
    static const turn turns[] = {{0, 360}, {-37.5, 322.5}, {90, 450}};
    for (int degree = 1; degree <= 9; degree += stride(4))
        for (int n = degree < 3 ? 3 : degree + 1; n <= 40; n += n < 12 ? stride(5) : 9 * stride(2))
            check_one_cylinder(n, degree, "\"closed\"", turns[(n + degree) % 3], n % 2 ? 0 : 0.75);
    /* A full turn that is not closed has a seam, if there are enough points. */
    for (int degree = 1; degree <= 5; degree += stride(2))
        for (int n = degree + 4; n <= 20; n += 3 * stride(3)) {
            check_one_cylinder(n, degree, "\"clamped\"", turns[n % 3], 0.5);
            check_one_cylinder(n, degree, "\"open\"", turns[n % 3], 0.5);
            check_one_cylinder(n, degree, "\"uniform\"", turns[n % 3], 0.5);
        }
}

static void a_partial_turn_covers_its_sector(void **state)
{
    (void)state;
    static const turn turns[] = {{0, 90}, {-20, 33}, {10, 280}, {45, 45.5}, {100, 290}};
    static const char *const kinds[] = {"\"clamped\"", "\"open\"", "\"uniform\""};
    for (size_t t = 0; t < COUNT(turns); t++)
        for (size_t k = 0; k < COUNT(kinds); k++) {
            if (is_memory_checked() && (t + k) % (size_t)stride(5))
                continue;
            for (int degree = 1; degree <= 9; degree += 2 * stride(2))
                for (int n = degree + 4; n <= 30; n += 7 * stride(2))
                    check_one_cylinder(n, degree, kinds[k], turns[t], 1.5);
        }
}

static void knot_lists_cover_their_cylinder(void **state)
{
    (void)state;
    static const turn turns[] = {{0, 90}, {10, 280}, {0, 360}};
    for (size_t t = 0; t < COUNT(turns); t++)
        for (size_t k = 3; k < COUNT(knots_of_8); k++)
            check_one_cylinder(8, 3, knots_of_8[k], turns[t], 0.5);
    check_one_cylinder(8, 3, "{\"closed\":[0,1,2,3.5,4,5,7,8,9]}", (turn){30, 390}, 0.5);
    check_one_cylinder(8, 2, "{\"closed\":[0,1,1,3,4,5,6.5,8,9]}", (turn){30, 390}, 0.5);
    check_one_cylinder(7, 4, "{\"closed\":[-1,-0.5,0,0.25,0.5,0.75,1,1.5]}", (turn){-90, 270}, 0);
}

/* By hand: closed quadratic splines are nearest to the axis at the knots, by the factor cos(pi/n). So the
   outer control points are at r1 / cos(pi/n), and v = 0 is at angle a0, half a step after the first of
   them. */
static void cylinder_points_match_those_worked_out_by_hand(void **state)
{
    (void)state;
    ffd_lattice *l =
        make("[2,4,2]", "[1,2,1]", "[\"clamped\",\"closed\",\"clamped\"]",
             "{\"cylinder\":{\"center\":[10,20,30],\"axis\":[0,0,2],\"radius\":[0,1],\"height\":4}}");
    const double *const p = ffd_lattice_get_points(l, FFD_VOLUME_REST);
    /* r1/cos 45 at -45, 45, 135, 225 degrees: the corners of a square with side 2. */
    static const double corner[4][2] = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    for (size_t j = 0; j < 4; j++) {
        assert_true(p[3 * (2 * j)] == 10 && p[3 * (2 * j) + 1] == 20 && p[3 * (2 * j) + 2] == 28);
        assert_true(fabs(p[3 * (2 * j + 1)] - (10 + corner[j][0])) <= 4e-15);
        assert_true(fabs(p[3 * (2 * j + 1) + 1] - (20 + corner[j][1])) <= 4e-15);
    }
    assert_true(ffd_knots_closed(&l->knots[1]));
    ffd_lattice_destroy(&l);

    /* Right-handed about the axis, starting at zero: about x, from y towards z. */
    l = make(
        "[2,5,2]", "[1,1,1]", "[\"clamped\",\"clamped\",\"clamped\"]",
        "{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"x\",\"radius\":[1,2],\"height\":2,\"angle\":[0,90]}}");
    assert_true(fabs(l->rest[1] - 1) <= 1e-15 && fabs(l->rest[2]) <= 1e-15 && l->rest[0] == -1);
    const double *const last = l->rest + 3 * 8;
    assert_true(fabs(last[1]) <= 1e-15 && fabs(last[2] - 1) <= 1e-15);
    ffd_lattice_destroy(&l);
}

/* A rational full circle: nine points of degree 2 with double knots and weights 1, cos 45. The ring is exact,
   so the control points on it have the radius r1 itself. */
static void a_rational_circle_has_the_given_radius(void **state)
{
    (void)state;
    static const char text[] =
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,9,2],\"degree\":[1,2,1],\"knots\":["
        "\"clamped\","
        "[0,0,0,1,1,2,2,3,3,4,4,4],\"clamped\"],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\","
        "\"radius\":[1,2],\"height\":1}},\"weights\":[%s]}";
    char weights[1024] = "", buffer[2048];
    for (int i = 0; i < 36; i++)
        snprintf(weights + strlen(weights), sizeof weights - strlen(weights), "%s%s", i ? "," : "",
                 i / 2 % 9 % 2 ? "0.7071067811865476" : "1");
    snprintf(buffer, sizeof buffer, text, weights);
    ffd_lattice *l = parse(buffer);
    check_cylinder(l, 1, 2, 1, (turn){0, 360}, "exact circle");
    ffd_lattice_destroy(&l);
}

static void check_refused(const char *size, const char *degree, const char *knots, const char *rest,
                          const char *words)
{
    char text[2048];
    ffd_lattice *lattice;
    ffd_error error;
    snprintf(text, sizeof text,
             "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":%s,\"degree\":%s,\"knots\":%s,\"rest\":%s}",
             size, degree, knots, rest);
    assert_int_equal(ffd_lattice_parse(text, strlen(text), "t.json", &lattice, &error), FFD_E_INVALID);
    assert_null(lattice);
    assert_string_equal(message_of(&error), words);
}

/* Too few points round the axis are refused, not placed at infinity. */
static void too_few_points_round_a_cylinder_are_refused(void **state)
{
    (void)state;
    static const char rest[] =
        "{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[0,1],\"height\":1}}";
    check_refused(
        "[2,2,2]", "[1,1,1]", "[\"clamped\",\"closed\",\"clamped\"]", rest,
        "t.json:1: /rest/cylinder: 2 control points of degree 1 along v are too few for this angle of the "
        "cylinder");
    check_refused(
        "[2,3,2]", "[1,2,1]", "[\"clamped\",\"clamped\",\"clamped\"]", rest,
        "t.json:1: /rest/cylinder: 3 control points of degree 2 along v are too few for this angle of the "
        "cylinder");
}

static void a_mesh_box_fits_the_mesh_with_its_margin(void **state)
{
    (void)state;
    ffd_lattice *l = make("[3,3,3]", "[2,2,2]", "[\"clamped\",\"clamped\",\"clamped\"]",
                          "{\"box\":\"mesh\",\"margin\":0.25}");
    ffd_error error;
    assert_true(ffd_lattice_needs_bounds(l));
    assert_null(ffd_lattice_get_points(l, FFD_VOLUME_REST));
    assert_int_equal(ffd_lattice_fit(l, (const double[]){0, 0, 0}, (const double[]){4, 8, 2}, &error),
                     FFD_OK);
    check_points(l, 1, 0, (const double[]){-1, 2, 5}, 3);
    check_points(l, 3, 1, (const double[]){-2, 4, 10}, 3);
    check_points(l, 9, 2, (const double[]){-0.5, 1, 2.5}, 3);
    /* Other bounds. A failure leaves the lattice unchanged. */
    assert_int_equal(ffd_lattice_fit(l, (const double[]){0, 0, 0}, (const double[]){NAN, 8, 2}, &error),
                     FFD_E_INVALID);
    assert_int_equal(ffd_lattice_fit(l, (const double[]){1, 0, 0}, (const double[]){0, 8, 2}, NULL),
                     FFD_E_INVALID);
    assert_int_equal(ffd_lattice_fit(l, (const double[]){-1e308, 0, 0}, (const double[]){1e308, 8, 2}, NULL),
                     FFD_E_INVALID);
    check_points(l, 1, 0, (const double[]){-1, 2, 5}, 3);
    /* A flat mesh gets a box that has volume. */
    assert_int_equal(ffd_lattice_fit(l, (const double[]){0, 5, 0}, (const double[]){3, 5, 4}, &error),
                     FFD_OK);
    const double low = l->rest[1], high = l->rest[3 * 6 + 1];
    assert_true(low < 5 && high > 5 && high - low > 0.01 && high - low < 0.5);
    /* A single point. */
    assert_int_equal(ffd_lattice_fit(l, (const double[]){7, 5, 1}, (const double[]){7, 5, 1}, &error),
                     FFD_OK);
    assert_true(l->rest[0] < 7 && l->rest[6] > 7 && l->rest[6] < 8);
    ffd_lattice_destroy(&l);
    l = make("[2,2,2]", "[1,1,1]", "[\"clamped\",\"clamped\",\"clamped\"]",
             "{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1]}}");
    assert_false(ffd_lattice_needs_bounds(l));
    assert_int_equal(ffd_lattice_fit(l, (const double[]){5, 5, 5}, (const double[]){6, 6, 6}, &error),
                     FFD_OK);
    assert_true(l->rest[0] == 0);
    ffd_lattice_destroy(&l);
}

/* A slanted bar: 4 by 2 by 1 along known directions, centred at (5,6,7). */
static void fill_bar(double points[24], double rows[9])
{
    static const double length[3] = {4, 2, 1};
    const double axes[9] = {2 / 3.0, 2 / 3.0, 1 / 3.0,  -2 / 3.0, 1 / 3.0,
                            2 / 3.0, 1 / 3.0, -2 / 3.0, 2 / 3.0};
    memcpy(rows, axes, sizeof axes);
    for (int i = 0; i < 8; i++)
        for (int c = 0; c < 3; c++) {
            points[3 * i + c] = 5 + c;
            for (int a = 0; a < 3; a++)
                points[3 * i + c] += (i >> a & 1 ? 0.5 : -0.5) * length[a] * axes[3 * a + c];
        }
}

static void a_principal_box_lies_along_its_points(void **state)
{
    (void)state;
    double points[24], rows[9];
    fill_bar(points, rows);
    ffd_lattice_desc desc;
    ffd_lattice_desc_init(&desc, sizeof desc);
    desc.principal = true;
    desc.margin[0] = desc.margin[1] = desc.margin[2] = 0;
    ffd_lattice *l;
    ffd_error error;
    assert_int_equal(ffd_lattice_create(&desc, points, 8, &l, &error), FFD_OK);
    /* The sign of the second axis makes its largest component positive, either -2/3 of x or 2/3 of z: both
       may flip, and the third axis follows. */
    for (int a = 0; a < 3; a++) {
        const double *const axis = l->spec->box_axes + 3 * a, *const row = rows + 3 * a;
        assert_true(fabs(fabs(axis[0] * row[0] + axis[1] * row[1] + axis[2] * row[2]) - 1) <= 1e-14);
        const double side = l->spec->box_max[a] - l->spec->box_min[a];
        assert_true(fabs(side - (4 >> a)) <= 1e-12); /* widened by the rounding of the axes */
    }
    const double *const x = l->spec->box_axes;
    const double determinant = x[0] * (x[4] * x[8] - x[5] * x[7]) - x[1] * (x[3] * x[8] - x[5] * x[6]) +
                               x[2] * (x[3] * x[7] - x[4] * x[6]);
    assert_true(fabs(determinant - 1) <= 1e-14);
    /* All points are inside. */
    double middle[3];
    ffd_lattice_evaluate(l, FFD_VOLUME_REST, (const double[]){0.5, 0.5, 0.5}, middle, NULL);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(middle[c] - (5 + c)) <= 1e-14);
    ffd_lattice_destroy(&l);
}

static void a_created_box_encloses_the_finite_points(void **state)
{
    (void)state;
    static const double points[] = {0, 0, 0, 10, 20, 0, NAN, 1, 1, 5, 5, 40, INFINITY, 0, 0};
    ffd_lattice_desc desc;
    ffd_error error;
    ffd_lattice *l;
    ffd_lattice_desc_init(&desc, sizeof desc);
    assert_int_equal(ffd_lattice_create(&desc, points, 5, &l, &error), FFD_OK);
    size_t size[3];
    int degree[3];
    ffd_lattice_get_size(l, size);
    ffd_lattice_get_degree(l, degree);
    assert_true(size[0] == 4 && size[1] == 4 && size[2] == 4);
    assert_true(degree[0] == 3 && degree[1] == 3 && degree[2] == 3);
    assert_true(l->spec->box_min[0] == -0.5 && l->spec->box_max[0] == 10.5);
    assert_true(l->spec->box_min[1] == -1 && l->spec->box_max[1] == 21);
    assert_true(l->spec->box_min[2] == -2 && l->spec->box_max[2] == 42);
    ffd_lattice_destroy(&l);
    assert_int_equal(ffd_lattice_create(&desc, points + 6, 1, &l, &error), FFD_E_INVALID);
    assert_null(l);
    assert_int_equal(ffd_lattice_create(&desc, points, 0, &l, &error), FFD_E_INVALID);
    desc.size[2] = 1;
    assert_int_equal(ffd_lattice_create(&desc, points, 5, &l, &error), FFD_E_ARGUMENT);
    assert_string_equal(
        error.message, "size 1 along w is less than 2: a plane needs two layers that move alike: size 5,5,2, "
                       "degree 3,3,1, and \"at\": [i, j, \"all\"]");
    desc.size[2] = 4;
    desc.spacing = FFD_SPACING_UNIFORM;
    desc.size[1] = 2;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_OK);
    ffd_lattice_get_degree(l, degree);
    assert_int_equal(degree[1], 1);
    assert_int_equal(l->form, REST_POINTS);
    ffd_lattice_destroy(&l);
}

static void a_created_cylinder_encloses_its_points(void **state)
{
    (void)state;
    /* Points at radius 3 round the line through (1,2) along z; z from 0 to 8. */
    double points[3 * 65];
    for (size_t i = 0; i < 65; i++) {
        points[3 * i] = 1 + 3 * cos((double)i * 0.1);
        points[3 * i + 1] = 2 + 3 * sin((double)i * 0.1);
        points[3 * i + 2] = (double)i / 8;
    }
    ffd_lattice_desc desc;
    ffd_error error;
    ffd_lattice *l;
    ffd_lattice_desc_init(&desc, sizeof desc);
    desc.shape = FFD_SHAPE_CYLINDER;
    desc.axis[2] = -4;
    desc.margin[0] = desc.margin[1] = desc.margin[2] = 0.1;
    assert_int_equal(ffd_lattice_create(&desc, points, 65, &l, &error), FFD_OK);
    assert_true(ffd_knots_closed(&l->knots[1]));
    assert_true(l->spec->axis[2] == -1);
    assert_true(fabs(l->spec->center[0] - 1) < 0.02 && fabs(l->spec->center[1] - 2) < 0.02);
    assert_true(fabs(l->spec->center[2] - 4) < 1e-14);
    assert_true(fabs(l->spec->height - 9.6) < 1e-14);
    for (size_t i = 0; i < 65; i++)
        assert_true(hypot(points[3 * i] - l->spec->center[0], points[3 * i + 1] - l->spec->center[1]) * 1.2 <=
                    l->spec->radius[1] * (1 + 1e-15));
    ffd_lattice_destroy(&l);
    desc.knots[1] = FFD_KNOTS_OPEN;
    desc.size[1] = 9;
    assert_int_equal(ffd_lattice_create(&desc, points, 65, &l, &error), FFD_OK);
    assert_false(ffd_knots_closed(&l->knots[1]));
    ffd_lattice_destroy(&l);
    desc.knots[1] = FFD_KNOTS_CLAMPED;
    assert_int_equal(ffd_lattice_create(&desc, points, 65, &l, &error), FFD_OK);
    assert_false(ffd_knots_closed(&l->knots[1]));
    ffd_lattice_destroy(&l);
    /* All points on the axis, or in a plane across it: the lattice still has volume. */
    desc.knots[1] = FFD_KNOTS_DEFAULT;
    assert_int_equal(ffd_lattice_create(&desc, points, 1, &l, &error), FFD_OK);
    assert_true(l->spec->radius[1] > 0 && l->spec->height > 0);
    ffd_lattice_destroy(&l);
}

static void bad_lattice_descriptions_are_refused(void **state)
{
    (void)state;
    static const double points[] = {0, 0, 0, 1, 1, 1};
    ffd_lattice_desc good, desc;
    ffd_lattice *l;
    ffd_error error;
    ffd_lattice_desc_init(&good, sizeof good);
    desc = good;
    desc.struct_size += 8;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.size[1] = 1;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.degree[2] = 4;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.degree[2] = 10;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.size[0] = SIZE_MAX / 2;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_LIMIT);
    desc = good;
    desc.margin[1] = -0.5;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.margin[2] = NAN;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.knots[1] = FFD_KNOTS_CLOSED;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.spacing = FFD_SPACING_UNIFORM;
    desc.knots[0] = FFD_KNOTS_OPEN;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.message,
                        "spacing = uniform needs knots = clamped, which direction u does not have");
    desc = good;
    desc.shape = FFD_SHAPE_CYLINDER;
    desc.axis[2] = 0;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.shape = FFD_SHAPE_CYLINDER;
    desc.margin[2] = 0.5;
    assert_int_equal(ffd_lattice_create(&desc, points, 2, &l, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.margin[0] = 1e308;
    static const double large[] = {-1e308, 0, 0, 1e308, 1, 1};
    assert_int_equal(ffd_lattice_create(&desc, large, 2, &l, &error), FFD_E_INVALID);
    assert_null(l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_is_affine_whatever_its_knots),
        cmocka_unit_test(a_box_is_affine_at_every_degree),
        cmocka_unit_test(box_points_stand_where_spacing_and_axes_say),
        cmocka_unit_test(only_equal_weights_keep_a_box_affine),
        cmocka_unit_test(a_full_turn_covers_its_cylinder),
        cmocka_unit_test(a_partial_turn_covers_its_sector),
        cmocka_unit_test(knot_lists_cover_their_cylinder),
        cmocka_unit_test(cylinder_points_match_those_worked_out_by_hand),
        cmocka_unit_test(a_rational_circle_has_the_given_radius),
        cmocka_unit_test(too_few_points_round_a_cylinder_are_refused),
        cmocka_unit_test(a_mesh_box_fits_the_mesh_with_its_margin),
        cmocka_unit_test(a_created_box_encloses_the_finite_points),
        cmocka_unit_test(a_principal_box_lies_along_its_points),
        cmocka_unit_test(a_created_cylinder_encloses_its_points),
        cmocka_unit_test(bad_lattice_descriptions_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
