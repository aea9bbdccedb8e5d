/* test_deform.c - displacements, normals and tangents of lattices with known answers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "base/vector/vec.h"
#include <ffd/deform.h>
#include <float.h>

/* A cubic clamped unit cube, 6 points a side, undeformed. */
static ffd_lattice *cube(void)
{
    knot_vector knots[3];
    for (int a = 0; a < 3; a++)
        assert_int_equal(ffd_knots_make(KNOTS_CLAMPED, 3, 6, NULL, 0, "uvw"[a], &knots[a], NULL), FFD_OK);
    ffd_lattice *lattice = lattice_of_knots(knots);
    for (size_t n = 0; n < lattice->count; n++) {
        const size_t index[3] = {n % 6, n / 6 % 6, n / 36};
        for (int a = 0; a < 3; a++)
            lattice->rest[3 * n + (size_t)a] = ffd_knots_greville(&lattice->knots[a], index[a]);
    }
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    return lattice;
}

/* Moves every control point by the matrix (row-major). */
static void transform(ffd_lattice *lattice, const double m[9])
{
    for (size_t n = 0; n < lattice->count; n++)
        mat_apply(m, lattice->rest + 3 * n, lattice->deformed + 3 * n);
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
}

static void check_close(const double *a, const double *b, int count, double allowed)
{
    for (int i = 0; i < count; i++)
        if (!(fabs(a[i] - b[i]) <= allowed))
            fail_msg("value %d: %.17g is not %.17g", i, a[i], b[i]);
}

static void an_undeformed_lattice_moves_nothing(void **state)
{
    ffd_lattice *lattice = cube();
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    const double uvw[3] = {0.3, 0.6, 1};
    double delta[3] = {1, 1, 1}, gradient[9] = {1};
    assert_int_equal(ffd_displacement(lattice, uvw, delta, gradient), 0);
    for (int i = 0; i < 9; i++)
        assert_true(gradient[i] == 0 && !signbit(gradient[i]) && delta[i % 3] == 0);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void a_translation_moves_every_point_alike(void **state)
{
    draw d = {draw_seed()};
    ffd_lattice *lattice = cube();
    const double by[3] = {0.5, -0.25, 4};
    for (size_t i = 0; i < 3 * lattice->count; i++)
        lattice->deformed[i] += by[i % 3];
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    const double zero[9] = {0};
    for (int i = 0; i < 100; i++) {
        const double uvw[3] = {draw_unit(&d), draw_unit(&d), draw_unit(&d)};
        double delta[3], gradient[9];
        assert_int_equal(ffd_displacement(lattice, uvw, delta, gradient), 1);
        check_close(delta, by, 3, 64 * DBL_EPSILON);
        check_close(gradient, zero, 9, 1e-13);
        assert_int_equal(ffd_displacement(lattice, uvw, delta, NULL), 1);
    }
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void linear_maps_carry_points_normals_and_tangents(void **state)
{
    draw d = {draw_seed()};
    static const double maps[][9] = {
        {0, -1, 0, 1, 0, 0, 0, 0, 1},         /* a quarter turn */
        {2, 0, 0, 0, 1, 0, 0, 0, 0.5},        /* stretch */
        {-1, 0, 0, 0, 1, 0, 0, 0, 1},         /* mirror */
        {1, 0.5, 0, 0, 1, 0.25, 0.125, 0, 1}, /* shear */
    };
    for (size_t m = 0; m < 4; m++) {
        ffd_lattice *lattice = cube();
        transform(lattice, maps[m]);
        double cofactor[9];
        mat_cofactor(maps[m], cofactor);
        for (int i = 0; i < 50; i++) {
            const double uvw[3] = {draw_unit(&d), draw_unit(&d), draw_unit(&d)};
            double delta[3], gradient[9], expected[3], f[9], n[3] = {0.6, 0, 0.8}, t[3] = {0.8, 0, -0.6};
            assert_int_equal(ffd_displacement(lattice, uvw, delta, gradient), 1);
            mat_apply(maps[m], uvw, expected);
            for (int a = 0; a < 3; a++)
                expected[a] -= uvw[a];
            check_close(delta, expected, 3, 1e-14);
            for (int k = 0; k < 9; k++)
                f[k] = gradient[k] + (k % 4 == 0);
            check_close(f, maps[m], 9, 1e-12);

            mat_apply(cofactor, n, expected);
            const double length = vec_length(expected);
            for (int a = 0; a < 3; a++)
                expected[a] /= length;
            assert_int_equal(ffd_deform_normal(gradient, n, n), FFD_DIRECTION_CARRIED);
            check_close(n, expected, 3, 1e-12);
            assert_int_equal(ffd_deform_tangent(gradient, t, n, t), FFD_DIRECTION_CARRIED);
            assert_true(fabs(vec_dot(t, n)) < 1e-14 && fabs(vec_length(t) - 1) < 1e-14);
        }
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

static void a_control_point_acts_in_its_spans_only(void **state)
{
    ffd_lattice *lattice = cube();
    lattice->deformed[0] -= 0.1; /* control point 0,0,0 acts only in the first span of each direction */
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    const double inside[3] = {0.1, 0.2, 0.3}, outside[3] = {0.1, 0.2, 0.34};
    double delta[3], gradient[9];
    assert_int_equal(ffd_displacement(lattice, inside, delta, gradient), 1);
    assert_true(delta[0] < 0 && delta[1] == 0 && delta[2] == 0);
    assert_int_equal(ffd_displacement(lattice, outside, delta, gradient), 0);
    assert_true(delta[0] == 0);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void a_moved_weight_moves_points_near_it_only(void **state)
{
    ffd_lattice *lattice = cube();
    lattice_add_weights(lattice);
    lattice->deformed_weights[lattice_index(lattice, 1, 1, 1)] = 3;
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    const double uvw[3] = {0.4, 0.5, 0.45}, far[3] = {0.99, 0.99, 0.99};
    double delta[3], gradient[9], rest[3], deformed[3];
    assert_int_equal(ffd_displacement(lattice, uvw, delta, gradient), 1);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, rest, NULL);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_DEFORMED, uvw, deformed, NULL);
    for (int a = 0; a < 3; a++)
        assert_true(delta[a] == deformed[a] - rest[a]);
    assert_true(delta[0] != 0);
    assert_int_equal(ffd_displacement(lattice, far, delta, gradient), 0);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void a_collapsed_direction_keeps_its_bits(void **state)
{
    /* Everything is flattened to z = 0: the normal of a vertical face loses its direction, that of a
       horizontal one does not. */
    const double gradient[9] = {0, 0, 0, 0, 0, 0, 0, 0, -1}, zero[9] = {0};
    const double level[3] = {0, 0, 1}, upright[3] = {1, 0, 0};
    double result[3];
    assert_int_equal(ffd_deform_normal(gradient, level, result), FFD_DIRECTION_CARRIED);
    assert_true(result[2] == 1);
    assert_int_equal(ffd_deform_normal(gradient, upright, result), FFD_DIRECTION_COLLAPSED);
    assert_memory_equal(result, upright, sizeof result);
    assert_int_equal(ffd_deform_tangent(gradient, level, upright, result), FFD_DIRECTION_COLLAPSED);
    assert_int_equal(ffd_deform_tangent(gradient, upright, NULL, result), FFD_DIRECTION_CARRIED);
    assert_memory_equal(result, upright, sizeof result);
    /* Without motion the bits stay, even of vectors that are not unit vectors. */
    const double odd[3] = {3, -0.0, 1e-300};
    assert_int_equal(ffd_deform_normal(zero, odd, result), FFD_DIRECTION_KEPT);
    assert_memory_equal(result, odd, sizeof result);
    (void)state;
}

/* Everything collapses to a line: what is left of a normal, or of a tangent across the line, is rounding. */
static void a_collapse_to_rounding_counts_as_collapsed(void **state)
{
    draw d = {draw_seed()};
    for (int i = 0; i < 50; i++) {
        const double to[3] = {draw_between(&d, 0.1, 1), draw_between(&d, 0.1, 1), draw_between(&d, 0.1, 1)};
        const double by[3] = {draw_between(&d, 0.1, 1), draw_between(&d, 0.1, 1), draw_between(&d, 0.1, 1)};
        const double normal[3] = {0.6, 0, 0.8}, tangent[3] = {by[1], -by[0], 0};
        double gradient[9], result[3];
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                gradient[3 * r + c] = to[r] * by[c] - (r == c);
        assert_int_equal(ffd_deform_normal(gradient, normal, result), FFD_DIRECTION_COLLAPSED);
        assert_memory_equal(result, normal, sizeof result);
        assert_int_equal(ffd_deform_tangent(gradient, tangent, NULL, result), FFD_DIRECTION_COLLAPSED);
        assert_memory_equal(result, tangent, sizeof result);
    }
    (void)state;
}

/* A vector without direction before does not count as collapsed. */
static void what_had_no_direction_has_not_collapsed(void **state)
{
    const double gradient[9] = {0, 0, 0, 0, 1, 0, 0, 0, -0.5};
    const double without[][3] = {{0, -0.0, 0}, {1, NAN, 0}, {0, 0, INFINITY}};
    for (size_t i = 0; i < 3; i++) {
        double result[3];
        assert_int_equal(ffd_deform_normal(gradient, without[i], result), FFD_DIRECTION_KEPT);
        assert_memory_equal(result, without[i], sizeof result);
        assert_int_equal(ffd_deform_tangent(gradient, without[i], NULL, result), FFD_DIRECTION_KEPT);
        assert_memory_equal(result, without[i], sizeof result);
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_undeformed_lattice_moves_nothing),
        cmocka_unit_test(a_translation_moves_every_point_alike),
        cmocka_unit_test(linear_maps_carry_points_normals_and_tangents),
        cmocka_unit_test(a_control_point_acts_in_its_spans_only),
        cmocka_unit_test(a_moved_weight_moves_points_near_it_only),
        cmocka_unit_test(a_collapsed_direction_keeps_its_bits),
        cmocka_unit_test(what_had_no_direction_has_not_collapsed),
        cmocka_unit_test(a_collapse_to_rounding_counts_as_collapsed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
