/* test_locator.c - u,v,w of points: all three methods, statuses, tolerance, independence of other points. */
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
#include "embed/cells/cells.h"
#include "embed/locator.h"
#include <ffd/embedding.h>
#include <float.h>

static ffd_lattice *clamped(int degree, size_t size)
{
    const lattice_kinds shape = {
        {KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {degree, degree, degree}, {size, size, size}};
    return lattice_of_kinds(&shape);
}

static void set_points(ffd_lattice *lattice, point_map map)
{
    lattice_map(lattice, map);
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
}

static void box_map(const double g[3], double out[3])
{
    out[0] = -1 + 3 * g[0];
    out[1] = -0.25 + 0.5 * g[1];
    out[2] = 10 * g[2];
}

/* Residuals whose squares underflow. */
static void tiny_map(const double g[3], double out[3])
{
    box_map(g, out);
    for (int a = 0; a < 3; a++)
        out[a] *= 1e-150;
}

static void sheared_map(const double g[3], double out[3])
{
    out[0] = -0.75 + g[0] + 0.5 * g[1];
    out[1] = g[1] - 0.25 * g[2];
    out[2] = g[2] + 0.125 * g[0];
}

static void mirrored_map(const double g[3], double out[3])
{
    box_map(g, out);
    out[0] = -out[0];
}

static void separable_map(const double g[3], double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = g[a] * g[a] + (a + 1) * g[a];
}

static void thin_map(const double g[3], double out[3])
{
    warped_map(g, out);
    out[2] *= 1e-6;
}

static void huge_map(const double g[3], double out[3])
{
    warped_map(g, out);
    for (int a = 0; a < 3; a++)
        out[a] *= 1e9;
}

typedef struct locator_case {
    const char *name;
    point_map map;
    const char *method;
} locator_case;

/* Round trip: random u,v,w, their point, and back. */
static void check_round_trip(const ffd_lattice *lattice, const char *method, draw *d, int points)
{
    /* Far from the origin the rounding of a point on a face may exceed the tolerance, which depends on the
       lattice's size: it may really be outside. */
    const bool far = fabs(lattice->rest[0]) > 1e5 * lattice->diagonal;
    ffd_locator *locator;
    ffd_error error;
    assert_int_equal(ffd_locator_create(lattice, &locator, &error), FFD_OK);
    assert_string_equal(ffd_locator_get_method(locator), method);
    for (int i = 0; i < repetitions(points); i++) {
        double uvw[3], p[3], jacobian[9], inverse[9], back[3];
        ffd_location location;
        for (int a = 0; a < 3; a++) {
            const knot_vector *knots = &lattice->knots[a];
            const double lo = ffd_knots_first(knots), hi = ffd_knots_last(knots);
            const int where = far ? 2 : draw_int(d, 0, 9);
            uvw[a] = where == 0 ? lo : where == 1 ? hi : draw_between(d, lo, hi);
        }
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, jacobian);
        assert_true(mat_invert(jacobian, inverse));
        assert_int_equal(ffd_locator_find(locator, p, 1, &location, &error), FFD_OK);
        if (location.status != FFD_VERTEX_INSIDE)
            fail_msg("u,v,w %.17g %.17g %.17g: status %d", uvw[0], uvw[1], uvw[2], location.status);
        for (int a = 0; a < 3; a++) {
            double allowed = 0;
            for (int r = 0; r < 3; r++) {
                double size = fabs(p[r]);
                for (size_t n = 0; n < lattice->count; n++)
                    size = fmax(size, fabs(p[r]) + fabs(lattice->rest[3 * n + (size_t)r]));
                allowed += fabs(inverse[3 * a + r]) * 16 * DBL_EPSILON * size;
            }
            allowed = fmax(1e-12, 4 * allowed);
            if (!(fabs(location.uvw[a] - uvw[a]) <= allowed))
                fail_msg("direction %d: %.17g is not %.17g (within %g)", a, location.uvw[a], uvw[a], allowed);
        }
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, location.uvw, back, NULL);
        for (int r = 0; r < 3; r++)
            assert_true(fabs(back[r] - p[r]) <= 64 * DBL_EPSILON * (fabs(p[r]) + lattice->diagonal));
    }
    ffd_locator_destroy(&locator);
    assert_null(locator);
}

static void u_v_w_come_back_by_each_method(void **state)
{
    static const locator_case cases[] = {
        {"box", box_map, "affine"},           {"sheared", sheared_map, "affine"},
        {"mirrored", mirrored_map, "affine"}, {"separable", separable_map, "separable"},
        {"warped", warped_map, "general"},    {"thin", thin_map, "general"},
        {"far", far_map, "general"},          {"huge", huge_map, "general"},
    };
    draw d = {draw_seed()};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        for (int degree = 1; degree <= 9; degree += degree < 3 ? 1 : is_memory_checked() ? 6 : 3) {
            if (is_memory_checked() && degree > 3 &&
                c % 4) /* the highest degree for one method after the other */
                continue;
            ffd_lattice *lattice = clamped(degree, (size_t)degree + 4);
            set_points(lattice, cases[c].map);
            print_message("%s, degree %d\n", cases[c].name, degree);
            check_round_trip(lattice, cases[c].method, &d, 60);
            ffd_lattice_destroy(&lattice);
        }
    (void)state;
}

static void u_v_w_come_back_with_mixed_knots(void **state)
{
    draw d = {draw_seed()};
    const lattice_kinds shape = {{KNOTS_OPEN, KNOTS_UNIFORM, KNOTS_CLAMPED}, {2, 3, 4}, {6, 7, 8}};
    ffd_lattice *lattice = lattice_of_kinds(&shape);
    set_points(lattice, box_map);
    check_round_trip(lattice, "affine", &d, 100);
    set_points(lattice, separable_map);
    check_round_trip(lattice, "separable", &d, 100);
    set_points(lattice, warped_map);
    check_round_trip(lattice, "general", &d, 100);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void u_v_w_come_back_in_a_bent_bar(void **state)
{
    draw d = {draw_seed()};
    ffd_lattice *lattice = clamped(3, 10);
    set_points(lattice, bent_map);
    check_round_trip(lattice, "general", &d, 300);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void u_v_w_come_back_with_weights(void **state)
{
    draw d = {draw_seed()};
    ffd_lattice *lattice = clamped(3, 6);
    lattice_add_weights(lattice);
    for (size_t i = 0; i < lattice->count; i++)
        lattice->rest_weights[i] = lattice->deformed_weights[i] = draw_between(&d, 0.8, 1.25);
    set_points(lattice, warped_map);
    check_round_trip(lattice, "general", &d, 300);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static ffd_location find_one(const ffd_locator *locator, double x, double y, double z)
{
    const double p[3] = {x, y, z};
    ffd_location location;
    assert_int_equal(ffd_locator_find(locator, p, 1, &location, NULL), FFD_OK);
    return location;
}

static void far_points_are_outside_and_nan_is_invalid(void **state)
{
    static const point_map maps[] = {box_map, separable_map, warped_map};
    for (size_t m = 0; m < 3; m++) {
        ffd_lattice *lattice = clamped(3, 6);
        ffd_locator *locator;
        set_points(lattice, maps[m]);
        assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
        const ffd_location far = find_one(locator, 1e5, 0, 0), huge = find_one(locator, 0, -1e308, 1e308);
        const ffd_location nan = find_one(locator, 0, NAN, 0), inf = find_one(locator, INFINITY, 0, 0);
        assert_int_equal(far.status, FFD_VERTEX_OUTSIDE);
        assert_int_equal(far.evaluations, 0);
        assert_true(isnan(far.uvw[0]) && isnan(far.uvw[1]) && isnan(far.uvw[2]));
        assert_int_equal(huge.status, FFD_VERTEX_OUTSIDE);
        assert_int_equal(nan.status, FFD_VERTEX_INVALID);
        assert_int_equal(inf.status, FFD_VERTEX_INVALID);
        /* 1e-9 beyond the faces of a box is outside: that is far more than the tolerance. */
        if (maps[m] == box_map) {
            assert_int_equal(find_one(locator, -1 - 1e-9, 0.1, 5).status, FFD_VERTEX_OUTSIDE);
            assert_int_equal(find_one(locator, -1, 0.1, 5).status, FFD_VERTEX_INSIDE);
            assert_int_equal(find_one(locator, 2, 0.25, 10).status, FFD_VERTEX_INSIDE);
            assert_int_equal(find_one(locator, 2, 0.25, 10 + 1e-9).status, FFD_VERTEX_OUTSIDE);
        }
        ffd_locator_destroy(&locator);
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

/* Shuffled, in pieces, and one at a time: the same bits. */
static void a_point_has_the_same_bits_alone_and_in_company(void **state)
{
    enum { COUNT = 500 };
    static double points[3 * COUNT];
    static ffd_location together[COUNT];
    draw d = {draw_seed()};
    ffd_lattice *lattice = clamped(3, 8);
    ffd_locator *locator, *other;
    set_points(lattice, warped_map);
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    assert_int_equal(ffd_locator_create(lattice, &other, NULL), FFD_OK);
    for (int i = 0; i < 3 * COUNT; i++)
        points[i] = draw_between(&d, -0.1, 1.3);
    assert_int_equal(ffd_locator_find(locator, points, COUNT, together, NULL), FFD_OK);
    for (int i = COUNT - 1; i >= 0; i--) {
        ffd_location alone;
        assert_int_equal(ffd_locator_find(other, points + 3 * i, 1, &alone, NULL), FFD_OK);
        assert_memory_equal(alone.uvw, together[i].uvw, sizeof alone.uvw);
        assert_int_equal(alone.status, together[i].status);
        assert_int_equal(alone.evaluations, together[i].evaluations);
    }
    ffd_locator_destroy(&other);
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

/* The map overlaps itself along u: x goes back and forth. */
static void folded_map(const double g[3], double out[3])
{
    out[0] = 4 * g[0] * (1 - g[0]) + 0.01 * g[1];
    out[1] = g[1];
    out[2] = g[2];
}

static void a_point_in_a_fold_is_multiple(void **state)
{
    ffd_lattice *lattice = clamped(2, 6);
    ffd_locator *locator;
    set_points(lattice, folded_map);
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    const ffd_location location = find_one(locator, 0.5, 0.5, 0.5);
    assert_int_equal(location.status, FFD_VERTEX_MULTIPLE);
    double back[3];
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, location.uvw, back, NULL);
    assert_true(fabs(back[0] - 0.5) < 1e-13);
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void flat_map(const double g[3], double out[3])
{
    out[0] = g[0];
    out[1] = g[1];
    out[2] = 0.25 * g[0] - g[1];
}

static void a_flat_lattice_is_refused(void **state)
{
    ffd_lattice *lattice = clamped(3, 5);
    ffd_locator *locator;
    ffd_error error;
    set_points(lattice, flat_map);
    assert_int_equal(ffd_locator_create(lattice, &locator, &error), FFD_E_INVALID);
    assert_null(locator);
    assert_non_null(strstr(error.message, "no volume"));
    ffd_lattice_destroy(&lattice);
    (void)state;
}

/* Draws three orthogonal unit vectors. */
static void draw_axes(draw *d, double axis[3][3])
{
    for (int a = 0; a < 2; a++)
        for (int r = 0; r < 3; r++)
            axis[a][r] = draw_between(d, -1, 1) + (a == r);
    vec_cross(axis[0], axis[1], axis[2]);
    vec_cross(axis[2], axis[0], axis[1]);
    for (int a = 0; a < 3; a++) {
        const double length = vec_length(axis[a]);
        for (int r = 0; r < 3; r++)
            axis[a][r] /= length;
    }
}

typedef enum sheet_shape { EVEN_SHEET, UNEVEN_SHEET, SKEW_SHEET, CURVED_SHEET, SHEET_SHAPES } sheet_shape;

/* Makes a sheet of this thickness, turned and far from the origin. */
static void make_sheet(draw *d, sheet_shape shape, double thickness, double far, ffd_lattice *lattice)
{
    double axis[3][3], origin[3], *p = lattice->rest;
    draw_axes(d, axis);
    for (int r = 0; r < 3; r++)
        origin[r] = draw_between(d, -far, far);
    for (size_t k = 0; k < lattice->size[2]; k++)
        for (size_t j = 0; j < lattice->size[1]; j++)
            for (size_t i = 0; i < lattice->size[0]; i++, p += 3) {
                double g[3] = {ffd_knots_greville(&lattice->knots[0], i),
                               ffd_knots_greville(&lattice->knots[1], j),
                               ffd_knots_greville(&lattice->knots[2], k)};
                if (shape == SKEW_SHEET)
                    g[0] += g[2];
                for (int a = 0; a < 3 && shape == UNEVEN_SHEET; a++)
                    g[a] += draw_between(d, -0.02, 0.02);
                const double up = thickness * g[2] + (shape == CURVED_SHEET ? 0.3 * g[0] * g[1] : 0);
                for (int r = 0; r < 3; r++)
                    p[r] = origin[r] + g[0] * axis[0][r] + g[1] * axis[1][r] + up * axis[2][r];
            }
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
}

/* A sheet whose thickness is only rounding of control points has no volume; a somewhat thicker one has,
   whatever the weights. A curved sheet without thickness may get a volume from its weights. */
static void a_sheet_is_refused_only_where_its_thickness_is_rounding(void **state)
{
    draw d = {draw_seed()};
    for (int n = 0; n < 400; n += stride(16)) {
        const sheet_shape shape = (sheet_shape)(n / 4 % SHEET_SHAPES);
        const double far = n % 3 ? 0 : pow(10, draw_between(&d, 0, 8));
        const int degree = 1 + n % 4;
        for (int thin = 0; thin < 2; thin++) {
            ffd_lattice *lattice = clamped(degree, (size_t)degree + 2);
            ffd_locator *locator;
            ffd_error error;
            make_sheet(&d, shape, thin ? 2e-14 * (1 + far) : 0, far, lattice);
            if (n % 5 > 2 && (thin || shape != CURVED_SHEET)) {
                lattice_add_weights(lattice);
                for (size_t i = 0; i < lattice->count; i++)
                    lattice->rest_weights[i] = lattice->deformed_weights[i] = pow(10, draw_between(&d, 0, 6));
            }
            const ffd_status status = ffd_locator_create(lattice, &locator, &error);
            assert_int_equal(status, thin ? FFD_OK : FFD_E_INVALID);
            if (!thin)
                assert_non_null(strstr(error.message, "no volume"));
            ffd_locator_destroy(&locator);
            ffd_lattice_destroy(&lattice);
        }
    }
    (void)state;
}

/* A wedge: the face u = 0 collapses to its axis, where J is singular. */
static void wedge_map(const double g[3], double out[3])
{
    const double angle = 1.2 * g[1];
    out[0] = g[0] * cos(angle);
    out[1] = g[0] * sin(angle);
    out[2] = g[2];
}

static void a_point_on_a_collapsed_face_is_singular(void **state)
{
    draw d = {draw_seed()};
    ffd_lattice *lattice = clamped(2, 5);
    ffd_locator *locator;
    set_points(lattice, wedge_map);
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    for (int i = 0; i < 100; i++) {
        const double uvw[3] = {pow(10, draw_between(&d, -7, 0)), draw_unit(&d), draw_unit(&d)};
        double p[3], back[3];
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
        const ffd_location location = find_one(locator, p[0], p[1], p[2]);
        assert_true(location.status == FFD_VERTEX_INSIDE || location.status == FFD_VERTEX_SINGULAR);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, location.uvw, back, NULL);
        for (int a = 0; a < 3; a++)
            assert_true(fabs(back[a] - p[a]) < 1e-13);
    }
    const ffd_location axis = find_one(locator, 0, 0, 0.5);
    assert_int_equal(axis.status, FFD_VERTEX_SINGULAR);
    assert_true(fabs(axis.uvw[0]) < 1e-12);
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

/* Bounds the cost of a point by counters, not by time. */
static void a_point_takes_few_evaluations_and_leaves(void **state)
{
    enum { POINTS = 4000 };
    ffd_lattice *lattice = clamped(3, 8);
    ffd_locator *locator;
    draw d = {draw_seed()};
    double *xyz = malloc(POINTS * 3 * sizeof *xyz), evaluations = 0, leaves = 0;
    ffd_location *found = malloc(POINTS * sizeof *found);
    assert_true(xyz && found);
    set_points(lattice, warped_map);
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    for (int i = 0; i < POINTS; i++) {
        const double uvw[3] = {draw_unit(&d), draw_unit(&d), draw_unit(&d)};
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, xyz + 3 * i, NULL);
    }
    assert_int_equal(ffd_locator_find(locator, xyz, POINTS, found, NULL), FFD_OK);
    for (int i = 0; i < POINTS; i++) {
        evaluations += found[i].evaluations;
        leaves += found[i].leaves;
    }
    print_message("%.3f evaluations and %.3f leaves a point\n", evaluations / POINTS, leaves / POINTS);
    assert_true(evaluations <= 5.0 * POINTS);
    assert_true(leaves <= 2.0 * POINTS);
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    free(xyz);
    free(found);
    (void)state;
}

/* A bar bent to a ring, whose end faces meet. */
static void whole_turn_map(const double g[3], double out[3])
{
    const double radius = 2 + g[0], turn = 6.283185307179586;
    const bool ends = g[1] == 0 || g[1] == 1;
    out[0] = ends ? radius : radius * cos(turn * g[1]);
    out[1] = ends ? 0 : radius * sin(turn * g[1]);
    out[2] = g[2];
}

static void a_seam_point_is_one_root_whatever_the_moves(void **state)
{
    ffd_lattice *lattice = clamped(3, 10);
    ffd_locator *locator;
    set_points(lattice, whole_turn_map);
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    ffd_location found = find_one(locator, 2.5, 0, 0.3);
    assert_int_equal(found.status, FFD_VERTEX_INSIDE);
    assert_true(found.uvw[1] == 0);
    ffd_locator_destroy(&locator);

    /* The moves separate the ends, but the rest lattice is the same. */
    const size_t size[3] = {10, 10, 10};
    for (size_t k = 0; k < size[2]; k++)
        for (size_t i = 0; i < size[0]; i++)
            lattice->deformed[3 * (i + size[0] * (0 + size[1] * k)) + 1] += 0.25;
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    found = find_one(locator, 2.5, 0, 0.3);
    assert_int_equal(found.status, FFD_VERTEX_INSIDE);
    assert_true(found.uvw[1] == 0);
    assert_true(ffd_locator_has_seam(locator, 1));
    assert_false(ffd_locator_has_seam(locator, 0));
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

/* Bricks that are remade again and again, because of the memory limit, give the same results as cached
   ones. */
static void bricks_without_room_give_the_same_results(void **state)
{
    enum { POINTS = 500 };
    const size_t count = is_memory_checked() ? 20 : POINTS;
    ffd_lattice *lattice = clamped(2, 20);
    ffd_locator *kept, *full;
    draw d = {draw_seed()};
    double xyz[3 * POINTS];
    ffd_location found[POINTS], again[POINTS];
    set_points(lattice, warped_map);
    assert_int_equal(ffd_locator_create(lattice, &kept, NULL), FFD_OK);
    assert_int_equal(ffd_locator_create(lattice, &full, NULL), FFD_OK);
    atomic_store(&full->cells->light_leaves, MOST_LIGHT_LEAVES);
    for (size_t i = 0; i < count; i++) {
        const double uvw[3] = {draw_unit(&d), draw_unit(&d), draw_unit(&d)};
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, xyz + 3 * i, NULL);
    }
    assert_int_equal(ffd_locator_find(kept, xyz, count, found, NULL), FFD_OK);
    assert_int_equal(ffd_locator_find(full, xyz, count, again, NULL), FFD_OK);
    for (size_t i = 0; i < count; i++) {
        assert_memory_equal(found[i].uvw, again[i].uvw, sizeof found[i].uvw);
        assert_int_equal(found[i].status, again[i].status);
        assert_int_equal(found[i].evaluations, again[i].evaluations);
    }
    for (size_t b = 0; b < full->cells->bricks[0] * full->cells->bricks[1] * full->cells->bricks[2]; b++)
        assert_null(atomic_load(&full->cells->made[b]));
    ffd_locator_destroy(&kept);
    ffd_locator_destroy(&full);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

/* A lattice that overlaps itself in every cell is refused only when it exceeds the memory limit. */
static void folds_are_refused_only_beyond_the_limit(void **state)
{
    ffd_lattice *lattice = clamped(3, is_memory_checked() ? 5 : 8);
    ffd_locator *locator;
    ffd_location found;
    ffd_error error;
    draw d = {draw_seed()};
    for (size_t i = 0; i < 3 * lattice->count; i++)
        lattice->rest[i] = lattice->deformed[i] = draw_unit(&d);
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    const double middle[3] = {0.5, 0.5, 0.5};
    assert_int_equal(ffd_locator_find(locator, middle, 1, &found, NULL), FFD_OK);
    assert_true(found.status != FFD_VERTEX_OUTSIDE);
    ffd_locator_destroy(&locator);

    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    atomic_store(&locator->cells->heavy_leaves, MOST_HEAVY_LEAVES);
    assert_int_equal(ffd_locator_find(locator, middle, 1, &found, &error), FFD_E_LIMIT);
    assert_non_null(strstr(error.message, "folds in too many of its cells"));
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

/* The unit of the lattice does not change u,v,w: exactly not if it is a power of two. */
static void u_v_w_do_not_depend_on_the_unit(void **state)
{
    static const int exponents[] = {-900, -500, -100, 60, 330, 900};
    enum { POINTS = 60 };
    draw d = {draw_seed()};
    ffd_lattice *unit = clamped(3, 6);
    ffd_locator *locator;
    double xyz[3 * POINTS];
    ffd_location expected[POINTS];
    set_points(unit, warped_map);
    for (int i = 0; i < POINTS; i++) {
        const double uvw[3] = {draw_unit(&d), draw_unit(&d), draw_unit(&d)};
        ffd_lattice_evaluate(unit, FFD_VOLUME_REST, uvw, xyz + 3 * i, NULL);
    }
    assert_int_equal(ffd_locator_create(unit, &locator, NULL), FFD_OK);
    assert_int_equal(ffd_locator_find(locator, xyz, POINTS, expected, NULL), FFD_OK);
    ffd_locator_destroy(&locator);
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
        ffd_lattice *scaled = clamped(3, 6);
        double scaled_xyz[3 * POINTS];
        ffd_location found[POINTS];
        for (size_t i = 0; i < 3 * scaled->count; i++)
            scaled->rest[i] = scaled->deformed[i] = ldexp(unit->rest[i], exponents[e]);
        for (int i = 0; i < 3 * POINTS; i++)
            scaled_xyz[i] = ldexp(xyz[i], exponents[e]);
        assert_int_equal(finish_by_hand(scaled, NULL), FFD_OK);
        assert_int_equal(ffd_locator_create(scaled, &locator, NULL), FFD_OK);
        assert_int_equal(ffd_locator_find(locator, scaled_xyz, POINTS, found, NULL), FFD_OK);
        for (int i = 0; i < POINTS; i++) {
            assert_int_equal(found[i].status, expected[i].status);
            assert_memory_equal(found[i].uvw, expected[i].uvw, sizeof found[i].uvw);
            assert_true(found[i].residual == ldexp(expected[i].residual, exponents[e]));
        }
        ffd_locator_destroy(&locator);
        ffd_lattice_destroy(&scaled);
    }
    ffd_lattice_destroy(&unit);
    (void)state;
}

static void check_all_inside(ffd_lattice *lattice, draw *d)
{
    enum { POINTS = 300 };
    double xyz[3 * POINTS], lo[3], hi[3];
    ffd_location found[POINTS];
    ffd_locator *locator;
    const int count = repetitions(POINTS);
    ffd_lattice_get_domain(lattice, lo, hi);
    for (int i = 0; i < count; i++) {
        double uvw[3];
        for (int a = 0; a < 3; a++)
            uvw[a] = draw_between(d, lo[a], hi[a]);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, xyz + 3 * i, NULL);
    }
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    assert_int_equal(ffd_locator_find(locator, xyz, (size_t)count, found, NULL), FFD_OK);
    for (int i = 0; i < count; i++)
        assert_int_equal(found[i].status, FFD_VERTEX_INSIDE);
    ffd_locator_destroy(&locator);
}

/* In a narrow span at the far end of the domain, neighbouring doubles u are farther apart in space than the
   tolerance. */
static void points_in_narrow_spans_are_inside(void **state)
{
    static const double widths[] = {0.1, 0.003, 0.0001};
    draw d = {draw_seed()};
    for (int bent = 0; bent < 2; bent++)
        for (size_t w = 0; w < 3; w += is_memory_checked() ? 2 : 1) {
            const double list[] = {0, 0, 0, 0, 0.3, 0.6, 1 - widths[w], 1, 1, 1, 1};
            knot_vector knots[3];
            for (int a = 0; a < 3; a++)
                assert_int_equal(ffd_knots_make(KNOTS_LIST, 3, 7, list, 11, "uvw"[a], &knots[a], NULL),
                                 FFD_OK);
            ffd_lattice *lattice = lattice_of_knots(knots);
            for (size_t n = 0; n < lattice->count; n++) {
                const double x = (double)(n % 7), y = (double)(n / 7 % 7), z = (double)(n / 49);
                double *p = lattice->rest + 3 * n;
                p[0] = x + (bent ? 0.1 * sin(y) : 0);
                p[1] = y + (bent ? 0.1 * sin(z) : 0);
                p[2] = z + (bent ? 0.1 * sin(x) : 0);
            }
            memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
            assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
            check_all_inside(lattice, &d);
            ffd_lattice_destroy(&lattice);
        }
    (void)state;
}

/* Columns (1,1) and (1+e,1-e): the inverse has few correct digits. */
static void steep_map(const double g[3], double out[3])
{
    const double e = 1e-10;
    out[0] = g[0] + (1 + e) * g[1];
    out[1] = g[0] + (1 - e) * g[1];
    out[2] = g[2];
}

static void points_in_a_steep_shear_are_inside(void **state)
{
    draw d = {draw_seed()};
    ffd_lattice *lattice = clamped(3, 5);
    set_points(lattice, steep_map);
    check_all_inside(lattice, &d);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

/* (uv, u+v, w + u/5): folded along u = v, where the determinant at the centre of many boxes is 0. A point has
   two solutions u,v if (u+v)^2/4 > uv and both are in the domain, none if it is less. */
static void product_map(const double g[3], double out[3])
{
    out[0] = g[0] * g[1];
    out[1] = g[0] + g[1];
    out[2] = g[2] + 0.2 * g[0];
}

static void points_of_a_symmetric_fold_are_multiple(void **state)
{
    draw d = {draw_seed()};
    ffd_lattice *lattice = clamped(2, 3);
    ffd_locator *locator;
    set_points(lattice, product_map);
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    for (int i = 0; i < 400; i++) {
        const double u = draw_between(&d, 0.05, 0.95), v = draw_between(&d, 0.05, 0.95);
        if (fabs(u - v) < 1e-3)
            continue;
        const ffd_location two = find_one(locator, u * v, u + v, 0.5);
        assert_int_equal(two.status, FFD_VERTEX_MULTIPLE);
        assert_false(two.unresolved);
        const double middle = 0.5 * (u + v);
        assert_int_equal(find_one(locator, middle * middle + 1e-6 + 0.1 * draw_unit(&d), u + v, 0.5).status,
                         FFD_VERTEX_OUTSIDE);
    }
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

/* A trilinear cell whose determinant is negative in the middle and whose volume is positive: the solution
   with a positive determinant is taken. */
static void the_root_with_the_sign_of_the_volume_is_taken(void **state)
{
    static const double points[] = {0.14,   0.498, 0.569, 0.347, 0.284, -0.553, -0.134, 0.834,
                                    -0.343, 0.317, 0.541, 0.31,  0.686, 0.614,  0.284,  1.104,
                                    -0.464, 1.031, 0.05,  0.494, 0.382, 0.971,  0.329,  1.512};
    ffd_lattice *lattice = clamped(1, 2);
    ffd_locator *locator;
    memcpy(lattice->rest, points, sizeof points);
    memcpy(lattice->deformed, points, sizeof points);
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    const ffd_location found = find_one(locator, 0.7323, -0.0194, 0.4003);
    assert_int_equal(found.status, FFD_VERTEX_MULTIPLE);
    assert_true(fabs(found.uvw[0] - 0.98034) < 1e-5 && fabs(found.uvw[1] - 0.15813) < 1e-5);
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

/* x goes to 1 and back to 0.1, so the volume is 0.1 whatever the weights, and the way there has its sign. A
   weight of 100 is too steep for a rule with few nodes in each cell. */
static void steep_weights_do_not_turn_the_volume_round(void **state)
{
    static const double x[3] = {0, 1, 0.1};
    static const size_t heavy[] = {3, 6, 0, 9};
    for (size_t i = 0; i < sizeof heavy / sizeof *heavy; i++) {
        const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {1, 1, 1}, {3, 2, 2}};
        ffd_lattice *lattice = lattice_of_kinds(&shape);
        ffd_locator *locator;
        set_points(lattice, box_map);
        for (size_t p = 0; p < lattice->count; p++)
            lattice->rest[3 * p] = lattice->deformed[3 * p] = x[p % 3];
        lattice_add_weights(lattice);
        lattice->rest_weights[heavy[i]] = lattice->deformed_weights[heavy[i]] = i < 2 ? 100 : 1e4;
        assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
        assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
        const ffd_location found = find_one(locator, 0.5, 0, 5);
        assert_int_equal(found.status, FFD_VERTEX_MULTIPLE);
        assert_true(found.uvw[0] < 0.5);
        ffd_locator_destroy(&locator);
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

static void every_failed_allocation_is_reported(void **state)
{
    ffd_lattice *lattice = clamped(3, 6);
    set_points(lattice, bent_map);
    int failures = 0;
    for (long n = 0;; n++) {
        ffd_locator *locator = NULL;
        ffd_location location;
        const double p[3] = {1.5, 0.1, 0.5};
        ffd_alloc_fail_after(n);
        ffd_status status = ffd_locator_create(lattice, &locator, NULL);
        if (!status)
            status = ffd_locator_find(locator, p, 1, &location, NULL);
        ffd_alloc_fail_after(-1);
        ffd_locator_destroy(&locator);
        if (!status)
            break;
        assert_int_equal(status, FFD_E_MEMORY);
        failures++;
    }
    assert_true(failures > 5);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

/* Draws images of u,v,w inside, on cell borders and on the border of the volume, some slightly moved, and
   points around it; some occur twice. */
static void draw_points(draw *d, const ffd_lattice *lattice, size_t count, double *points)
{
    for (size_t i = 0; i < count; i++) {
        double uvw[3], *const p = points + 3 * i;
        for (int a = 0; a < 3; a++) {
            const knot_vector *const knots = &lattice->knots[a];
            const int span = knots->spans[draw_int(d, 0, (int)knots->span_count - 1)],
                      choice = draw_int(d, 0, 7);
            uvw[a] = choice == 0   ? knots->t[span]
                     : choice == 1 ? knots->t[span + 1]
                                   : draw_between(d, ffd_knots_first(knots), ffd_knots_last(knots));
        }
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
        const double away = i % 5 == 0 ? 0.3 : i % 5 == 1 ? 1e-13 : 0;
        for (int a = 0; a < 3; a++)
            p[a] += draw_between(d, -away, away);
        if (i % 11 == 10)
            memcpy(p, p - 3, 3 * sizeof *p);
        if (i % 97 == 96)
            p[1] = i % 2 ? NAN : 1e300;
    }
}

static void check_same(const ffd_location *a, const ffd_location *b, ffd_isa isa, const double p[3])
{
    if (!same_locations(a, b))
        fail_msg("instruction set %d: %.17g %.17g %.17g has status %d, u %.17g after %u evaluations, not %d, "
                 "%.17g, %u",
                 (int)isa, p[0], p[1], p[2], a->status, a->uvw[0], a->evaluations, b->status, b->uvw[0],
                 b->evaluations);
}

static void every_instruction_set_gives_the_same_bits(void **state)
{
    enum { COUNT = 2311 };
    static const struct {
        point_map map;
        int degree;
        size_t size;
    } kinds[] = {{warped_map, 3, 8},   {warped_map, 3, 4}, {bent_map, 3, 6},   {folded_map, 2, 6},
                 {steep_map, 3, 5},    {warped_map, 1, 6}, {warped_map, 5, 8}, {product_map, 2, 4},
                 {far_map, 3, 5},      {thin_map, 3, 6},   {box_map, 3, 5},    {sheared_map, 2, 4},
                 {mirrored_map, 4, 7}, {tiny_map, 3, 4}};
    /* More than the lanes of any instruction set, with a remainder. */
    const size_t count = is_memory_checked() ? 19 : COUNT;
    static double points[3 * COUNT];
    static ffd_location one_by_one[COUNT], several[COUNT];
    draw d = {draw_seed()};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i += (size_t)stride(3)) {
        ffd_lattice *lattice = clamped(kinds[i].degree, kinds[i].size);
        ffd_locator *locator;
        set_points(lattice, kinds[i].map);
        draw_points(&d, lattice, count, points);
        assert_int_equal(ffd_locator_create_for(lattice, FFD_ISA_SCALAR, &locator, NULL), FFD_OK);
        assert_int_equal(ffd_locator_find(locator, points, count, one_by_one, NULL), FFD_OK);
        ffd_locator_destroy(&locator);
        for (ffd_isa isa = FFD_ISA_AUTO; isa <= FFD_ISA_NEON; isa++) {
            if (!ffd_isa_available(isa))
                continue;
            assert_int_equal(ffd_locator_create_for(lattice, isa, &locator, NULL), FFD_OK);
            /* The first time, bricks are made. The second time, other points share the lanes. */
            for (size_t round = 0; round < 2; round++) {
                assert_int_equal(
                    ffd_locator_find(locator, points + 3 * round, count - round, several + round, NULL),
                    FFD_OK);
                for (size_t k = round; k < count; k++)
                    check_same(&several[k], &one_by_one[k], isa, points + 3 * k);
            }
            ffd_locator_destroy(&locator);
        }
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(u_v_w_come_back_by_each_method),
        cmocka_unit_test(u_v_w_come_back_with_mixed_knots),
        cmocka_unit_test(u_v_w_come_back_in_a_bent_bar),
        cmocka_unit_test(u_v_w_come_back_with_weights),
        cmocka_unit_test(far_points_are_outside_and_nan_is_invalid),
        cmocka_unit_test(a_point_has_the_same_bits_alone_and_in_company),
        cmocka_unit_test(a_point_in_a_fold_is_multiple),
        cmocka_unit_test(a_flat_lattice_is_refused),
        cmocka_unit_test(a_sheet_is_refused_only_where_its_thickness_is_rounding),
        cmocka_unit_test(a_point_on_a_collapsed_face_is_singular),
        cmocka_unit_test(a_point_takes_few_evaluations_and_leaves),
        cmocka_unit_test(a_seam_point_is_one_root_whatever_the_moves),
        cmocka_unit_test(bricks_without_room_give_the_same_results),
        cmocka_unit_test(folds_are_refused_only_beyond_the_limit),
        cmocka_unit_test(u_v_w_do_not_depend_on_the_unit),
        cmocka_unit_test(points_in_narrow_spans_are_inside),
        cmocka_unit_test(points_in_a_steep_shear_are_inside),
        cmocka_unit_test(points_of_a_symmetric_fold_are_multiple),
        cmocka_unit_test(the_root_with_the_sign_of_the_volume_is_taken),
        cmocka_unit_test(steep_weights_do_not_turn_the_volume_round),
        cmocka_unit_test(every_failed_allocation_is_reported),
        cmocka_unit_test(every_instruction_set_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
