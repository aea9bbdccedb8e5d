/* Evaluation of lattices: exact maps, arcs and corners, marks of moved points, refusals. */
#include "../support/lattice_by_hand.h"
#include <ffd/deform.h>
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static ffd_lattice *make(knot_kind kind, int du, int dv, int dw, size_t nu, size_t nv, size_t nw)
{
    const int degree[3] = {du, dv, dw};
    const size_t points[3] = {nu, nv, nw};
    knot_vector knots[3];
    for (int a = 0; a < 3; a++)
        assert_int_equal(ffd_knots_make(kind, degree[a], points[a], NULL, 0, "uvw"[a], &knots[a], NULL),
                         FFD_OK);
    return lattice_of_knots(knots);
}

/* Sets control points to (Greville u, 10 Greville v, 100 Greville w), so that C = (u, 10 v, 100 w). */
static void place_at_greville(ffd_lattice *lattice)
{
    for (size_t k = 0, point = 0; k < lattice->size[2]; k++)
        for (size_t j = 0; j < lattice->size[1]; j++)
            for (size_t i = 0; i < lattice->size[0]; i++, point++) {
                double *const p = lattice->rest + 3 * point;
                p[0] = ffd_knots_greville(&lattice->knots[0], i);
                p[1] = 10 * ffd_knots_greville(&lattice->knots[1], j);
                p[2] = 100 * ffd_knots_greville(&lattice->knots[2], k);
                memcpy(lattice->deformed + 3 * point, p, 3 * sizeof *p);
            }
}

static void finish(ffd_lattice *lattice)
{
    ffd_error error;
    if (finish_by_hand(lattice, &error))
        fail_msg("%s", error.message);
}

static void check_near(const double *a, const double *b, size_t count, double tolerance)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs(a[i] - b[i]) <= tolerance))
            fail_msg("entry %zu is %.17g, expected %.17g", i, a[i], b[i]);
}

static void getters_return_what_the_lattice_holds(void **state)
{
    (void)state;
    ffd_lattice *lattice = make(KNOTS_UNIFORM, 1, 2, 3, 4, 5, 6);
    finish(lattice);
    size_t size[3];
    int degree[3];
    double lo[3], hi[3];
    ffd_lattice_get_size(lattice, size);
    ffd_lattice_get_degree(lattice, degree);
    ffd_lattice_get_domain(lattice, lo, hi);
    for (int a = 0; a < 3; a++) {
        assert_int_equal(size[a], 4 + a);
        assert_int_equal(degree[a], 1 + a);
        assert_true(lo[a] == (1 + a) / (5.0 + 2 * a));
        assert_true(hi[a] == (4 + a) / (5.0 + 2 * a));
    }
    assert_ptr_equal(ffd_lattice_get_points(lattice, FFD_VOLUME_REST), lattice->rest);
    assert_ptr_equal(ffd_lattice_get_points(lattice, FFD_VOLUME_DEFORMED), lattice->deformed);
    assert_null(ffd_lattice_get_weights(lattice, FFD_VOLUME_REST));
    lattice_add_weights(lattice);
    assert_ptr_equal(ffd_lattice_get_weights(lattice, FFD_VOLUME_REST), lattice->rest_weights);
    assert_ptr_equal(ffd_lattice_get_weights(lattice, FFD_VOLUME_DEFORMED), lattice->deformed_weights);
    ffd_lattice_destroy(&lattice);
    assert_null(lattice);
    ffd_lattice_destroy(&lattice);
    ffd_lattice_destroy(NULL);
}

static void points_at_greville_abscissae_give_an_affine_map(void **state)
{
    (void)state;
    ffd_lattice *lattice = make(KNOTS_OPEN, 2, 3, 4, 5, 6, 7);
    place_at_greville(lattice);
    finish(lattice);
    const double uvw[3] = {0.3, 0.6, 0.85};
    double point[3], jacobian[9];
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, jacobian);
    check_near(point, (const double[]){0.3, 6, 85}, 3, 1e-13);
    check_near(jacobian, (const double[]){1, 0, 0, 0, 10, 0, 0, 0, 100}, 9, 1e-12);
    ffd_lattice_destroy(&lattice);
}

/* C = (u v, v w, u w) with 2 x 2 x 2 control points of degree 1. J by hand; rows are x, y, z. */
static void degree_one_is_trilinear(void **state)
{
    (void)state;
    ffd_lattice *lattice = make(KNOTS_CLAMPED, 1, 1, 1, 2, 2, 2);
    for (size_t i = 0; i < 8; i++) {
        const double u = i & 1, v = i >> 1 & 1, w = i >> 2;
        double *const p = lattice->rest + 3 * i;
        p[0] = u * v;
        p[1] = v * w;
        p[2] = u * w;
    }
    finish(lattice);
    double point[3], jacobian[9];
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, (const double[]){0.25, 0.5, 0.75}, point, jacobian);
    check_near(point, (const double[]){0.125, 0.375, 0.1875}, 3, 0);
    check_near(jacobian, (const double[]){0.5, 0.25, 0, 0, 0.75, 0.5, 0.75, 0, 0.25}, 9, 0);
    double alone[3];
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, (const double[]){0.25, 0.5, 0.75}, alone, NULL);
    check_near(alone, point, 3, 0);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_DEFORMED, (const double[]){0.25, 0.5, 0.75}, alone, NULL);
    check_near(alone, (const double[]){0, 0, 0}, 3, 0);
    ffd_lattice_destroy(&lattice);
}

/* The corners of a clamped volume are exactly its corner control points; parameters outside are clamped to
   them. */
static void corners_are_exact_and_parameters_are_clamped(void **state)
{
    (void)state;
    ffd_lattice *lattice = make(KNOTS_CLAMPED, 3, 2, 9, 7, 5, 12);
    for (size_t i = 0; i < 3 * lattice->count; i++)
        lattice->rest[i] = 1 / (3.0 + (double)i);
    finish(lattice);
    for (int corner = 0; corner < 8; corner++) {
        const size_t at[3] = {corner & 1 ? 6 : 0, corner & 2 ? 4 : 0, corner & 4 ? 11 : 0};
        const double uvw[3] = {at[0] ? 1 : 0, at[1] ? 1 : 0, at[2] ? 1 : 0};
        const double beyond[3] = {at[0] ? 1.5 : -2, at[1] ? INFINITY : -1e-300, at[2] ? 7 : -INFINITY};
        double point[3];
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, NULL);
        check_near(point, lattice->rest + 3 * lattice_index(lattice, at[0], at[1], at[2]), 3, 0);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, beyond, point, NULL);
        check_near(point, lattice->rest + 3 * lattice_index(lattice, at[0], at[1], at[2]), 3, 0);
    }
    ffd_lattice_destroy(&lattice);
}

/* A quarter of the unit circle as a rational quadratic (P&T 7.3: weights 1, 1, 2), extruded along v and w. */
static ffd_lattice *quarter_cylinder(void)
{
    ffd_lattice *const lattice = make(KNOTS_CLAMPED, 2, 1, 1, 3, 2, 2);
    lattice_add_weights(lattice);
    const double arc[3][3] = {{1, 0, 1}, {1, 1, 1}, {0, 1, 2}};
    for (size_t k = 0, point = 0; k < 2; k++)
        for (size_t j = 0; j < 2; j++)
            for (size_t i = 0; i < 3; i++, point++) {
                double *const p = lattice->rest + 3 * point;
                const double radius = 1 + (double)j;
                p[0] = radius * arc[i][0];
                p[1] = radius * arc[i][1];
                p[2] = (double)k;
                lattice->rest_weights[point] = lattice->deformed_weights[point] = arc[i][2];
            }
    return lattice;
}

static void rational_arcs_are_exact_circles(void **state)
{
    (void)state;
    ffd_lattice *lattice = quarter_cylinder();
    finish(lattice);
    for (int i = 0; i <= 20; i++) {
        const double u = i / 20.0, v = 0.4, w = 0.7;
        double point[3], jacobian[9];
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, (const double[]){u, v, w}, point, jacobian);
        /* (1-u^2, 2u)/(1+u^2) and its derivative (-4u, 2(1-u^2))/(1+u^2)^2 */
        const double s = 1 + u * u;
        const double x = (1 - u * u) / s, y = 2 * u / s;
        check_near(point, (const double[]){1.4 * x, 1.4 * y, 0.7}, 3, 8 * DBL_EPSILON);
        check_near(
            jacobian,
            (const double[]){1.4 * -4 * u / (s * s), x, 0, 1.4 * 2 * (1 - u * u) / (s * s), y, 0, 0, 0, 1}, 9,
            32 * DBL_EPSILON);
        assert_true(fabs(point[0] * point[0] + point[1] * point[1] - 1.96) < 1e-14);
    }
    ffd_lattice_destroy(&lattice);
}

static void a_closed_direction_goes_round(void **state)
{
    (void)state;
    ffd_lattice *lattice = make(KNOTS_CLOSED, 3, 1, 2, 5, 4, 3);
    for (size_t i = 0; i < 3 * lattice->count; i++)
        lattice->rest[i] = (double)(i * i % 31);
    finish(lattice);
    double start[3], end[3], start_jacobian[9], end_jacobian[9];
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, (const double[]){0, 0.3, 0.6}, start, start_jacobian);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, (const double[]){nextafter(1, 0), 0.3, 0.6}, end,
                         end_jacobian);
    check_near(end, start, 3, 1e-13);
    check_near(end_jacobian, start_jacobian, 9, 1e-11);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, (const double[]){1, 0.3, 0.6}, end, end_jacobian);
    check_near(end, start, 3, 0);
    check_near(end_jacobian, start_jacobian, 9, 0);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, (const double[]){-1, 2.3, -0.4}, end, NULL);
    check_near(end, start, 3, 1e-13);
    ffd_lattice_destroy(&lattice);
}

static void a_cell_has_its_points_and_weights_in_order(void **state)
{
    (void)state;
    ffd_lattice *lattice = make(KNOTS_CLOSED, 2, 1, 1, 3, 2, 2);
    lattice_add_weights(lattice);
    for (size_t i = 0; i < lattice->count; i++) {
        for (size_t c = 0; c < 3; c++)
            lattice->rest[3 * i + c] = (double)(10 * i + c);
        lattice->rest_weights[i] = (double)(i + 1);
    }
    finish(lattice);
    /* Along u functions 1,2,3 use points 1,2,0; along v functions 1,2 use points 1,0; along w 0,1. */
    const int span[3] = {3, 2, 1};
    const size_t expected[12] = {4, 5, 3, 1, 2, 0, 10, 11, 9, 7, 8, 6};
    double points[36], weights[12];
    ffd_lattice_cell_points(lattice, lattice->rest, span, points);
    ffd_lattice_cell_weights(lattice, lattice->rest_weights, span, weights);
    for (size_t i = 0; i < 12; i++) {
        for (size_t c = 0; c < 3; c++)
            assert_true(points[3 * i + c] == (double)(10 * expected[i] + c));
        assert_true(weights[i] == (double)(expected[i] + 1));
    }
    double untouched = 42;
    ffd_lattice_cell_weights(lattice, NULL, span, &untouched);
    assert_true(untouched == 42);
    ffd_lattice_destroy(&lattice);
}

static void moved_points_and_weights_are_marked(void **state)
{
    (void)state;
    ffd_lattice *lattice = quarter_cylinder();
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    finish(lattice);
    assert_true(lattice->diagonal == 3); /* of a box of 2 by 2 by 1 */
    assert_false(lattice->weights_moved);
    for (size_t i = 0; i < lattice->count; i++)
        assert_int_equal(lattice->moved[i], 0);

    lattice->deformed[3 * 4 + 1] += 0.5;
    lattice->deformed_weights[7] = 3;
    finish(lattice);
    assert_true(lattice->weights_moved);
    for (size_t i = 0; i < lattice->count; i++)
        assert_int_equal(lattice->moved[i], i == 4 || i == 7);
    for (size_t c = 0; c < 3 * lattice->count; c++)
        assert_true(lattice->difference[c] == (c == 13 ? 0.5 : 0));

    lattice->deformed_weights[7] = lattice->rest_weights[7];
    finish(lattice);
    assert_false(lattice->weights_moved);
    assert_int_equal(lattice->moved[7], 0);
    ffd_lattice_destroy(&lattice);
}

static void the_diagonal_survives_extreme_sizes(void **state)
{
    (void)state;
    const double sizes[] = {1e200, 1e-200, 0};
    for (int i = 0; i < 3; i++) {
        ffd_lattice *lattice = make(KNOTS_CLAMPED, 1, 1, 1, 2, 2, 2);
        lattice->rest[0] = 3 * sizes[i];
        lattice->rest[1] = -4 * sizes[i];
        finish(lattice);
        assert_true(fabs(lattice->diagonal - 5 * sizes[i]) <= 5 * sizes[i] * 4 * DBL_EPSILON);
        ffd_lattice_destroy(&lattice);
    }
}

static void check_refusal(ffd_lattice *lattice, const char *message)
{
    ffd_error error = {0};
    assert_int_equal(finish_by_hand(lattice, &error), FFD_E_INVALID);
    assert_string_equal(error.message, message);
}

static void broken_points_and_weights_are_refused(void **state)
{
    (void)state;
    ffd_lattice *lattice = make(KNOTS_CLAMPED, 1, 1, 1, 2, 3, 4);
    lattice_add_weights(lattice);
    double *const p = lattice->rest + 3 * lattice_index(lattice, 1, 0, 2);
    double *const q = lattice->deformed + 3 * lattice_index(lattice, 0, 2, 3);
    p[1] = NAN;
    check_refusal(lattice, "rest point 1,0,2: y is nan, not a finite number");
    p[1] = 0;
    q[2] = -INFINITY;
    check_refusal(lattice, "deformed point 0,2,3: z is -inf, not a finite number");
    q[2] = 0;
    lattice->rest_weights[5] = 0;
    check_refusal(lattice, "the weight of rest point 1,2,0 is 0, not positive and finite");
    lattice->rest_weights[5] = -2;
    check_refusal(lattice, "the weight of rest point 1,2,0 is -2, not positive and finite");
    lattice->rest_weights[5] = 1;
    lattice->deformed_weights[23] = NAN;
    check_refusal(lattice, "the weight of deformed point 1,2,3 is nan, not positive and finite");
    lattice->deformed_weights[23] = 1e300;
    lattice->deformed[3 * 23] = 1e20;
    check_refusal(lattice, "deformed point 1,2,3: weight 1e+300 times x, 1e+20, is not finite");
    lattice->deformed_weights[23] = 1;
    lattice->rest[3 * 23] = -1.5e308;
    lattice->deformed[3 * 23] = 1.5e308;
    check_refusal(lattice,
                  "deformed point 1,2,3: the distance from -1.5e+308 to 1.5e+308 is too large for a double");
    lattice->rest[0] = 1.5e308;
    check_refusal(lattice,
                  "the rest points reach from -1.5e+308 to 1.5e+308 in x, which is too far for a double");
    ffd_lattice_destroy(&lattice);
}

/* Points of a cubic cell are multiplied by up to 27: the products must not overflow either. */
static void points_too_far_to_compute_with_are_refused(void **state)
{
    (void)state;
    static const double middle[3] = {0.5, 0.5, 0.5};
    ffd_lattice *lattice = make(KNOTS_CLAMPED, 3, 3, 3, 4, 4, 4);
    const size_t n = 3 * lattice_index(lattice, 1, 2, 1);
    double delta[3], gradient[9];
    lattice->rest[n] = 0;
    lattice->deformed[n] = -7e306;
    check_refusal(lattice, "deformed point 1,2,1: the distance from 0 to -7e+306 is too large for a double");
    lattice->rest[n] = lattice->deformed[n] = 7e306;
    check_refusal(lattice, "rest point 1,2,1: 7e+306 is too large to compute with");
    lattice->rest[n] = 0;
    lattice->deformed[n] = 6.6e306;
    finish(lattice);
    assert_int_equal(ffd_displacement(lattice, middle, delta, gradient), 1);
    assert_true(fabs(delta[0] / (6.6e306 * 27 / 512) - 1) <= 1e-14);
    ffd_lattice_destroy(&lattice);
}

static void each_failed_allocation_is_reported(void **state)
{
    (void)state;
    for (long successes = 0; successes < 2; successes++) {
        ffd_lattice *lattice = make(KNOTS_CLAMPED, 1, 1, 1, 2, 2, 2);
        ffd_alloc_fail_after(successes);
        const ffd_status status = finish_by_hand(lattice, NULL);
        ffd_alloc_fail_after(-1);
        assert_int_equal(status, FFD_E_MEMORY);
        finish(lattice);
        ffd_lattice_destroy(&lattice);
    }
}

static void evaluating_without_points_gives_nan(void **state)
{
    (void)state;
    ffd_lattice *lattice = make(KNOTS_CLAMPED, 1, 1, 1, 2, 2, 2);
    ffd_free(lattice->rest);
    lattice->rest = NULL;
    double point[3] = {0}, jacobian[9] = {0};
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, (const double[]){0, 0, 0}, point, jacobian);
    assert_true(isnan(point[0]) && isnan(point[1]) && isnan(point[2]));
    for (int i = 0; i < 9; i++)
        assert_true(isnan(jacobian[i]));
    assert_null(ffd_lattice_get_points(lattice, FFD_VOLUME_REST));
    ffd_lattice_destroy(&lattice);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(getters_return_what_the_lattice_holds),
        cmocka_unit_test(points_at_greville_abscissae_give_an_affine_map),
        cmocka_unit_test(degree_one_is_trilinear),
        cmocka_unit_test(corners_are_exact_and_parameters_are_clamped),
        cmocka_unit_test(rational_arcs_are_exact_circles),
        cmocka_unit_test(a_closed_direction_goes_round),
        cmocka_unit_test(a_cell_has_its_points_and_weights_in_order),
        cmocka_unit_test(moved_points_and_weights_are_marked),
        cmocka_unit_test(the_diagonal_survives_extreme_sizes),
        cmocka_unit_test(broken_points_and_weights_are_refused),
        cmocka_unit_test(points_too_far_to_compute_with_are_refused),
        cmocka_unit_test(each_failed_allocation_is_reported),
        cmocka_unit_test(evaluating_without_points_gives_nan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
