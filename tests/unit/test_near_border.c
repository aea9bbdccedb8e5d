/* test_near_border.c - points that miss the volume by their rounding cell, or by the snap distance. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "../support/locations.h"
#include "../support/repetitions.h"
#include "base/vector/vec.h"
#include "embed/locator.h"
#include <ffd/embedding.h>

enum { POINTS = 600 };

static void box_map(const double g[3], double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = 0.1 * g[a];
}

static void separable_map(const double g[3], double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = 0.1 * g[a] * g[a] + 0.3 * g[a] - 0.1;
}

static void warped_map(const double g[3], double out[3])
{
    out[0] = g[0] + 0.1 * g[1] * g[1] + 0.05 * g[2];
    out[1] = g[1] + 0.15 * g[0] * g[2];
    out[2] = g[2] - 0.1 * g[0] * g[0];
}

static void far_map(const double g[3], double out[3])
{
    warped_map(g, out);
    out[0] += 1000;
    out[2] -= 30;
}

static void bent_map(const double g[3], double out[3])
{
    const double angle = 4.7 * g[1], radius = 1 + g[0];
    out[0] = radius * cos(angle);
    out[1] = radius * sin(angle);
    out[2] = g[2];
}

static const point_map maps[] = {box_map, separable_map, warped_map, far_map, bent_map};
enum { MAPS = sizeof maps / sizeof *maps };

static ffd_lattice *lattice_of(point_map map)
{
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {2, 2, 2}, {5, 5, 5}};
    ffd_lattice *lattice = lattice_of_kinds(&shape);
    lattice_map(lattice, map);
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    return lattice;
}

/* Draws u,v,w on a face, an edge or a corner. */
static void draw_on_border(draw *d, double uvw[3])
{
    for (int a = 0; a < 3; a++)
        uvw[a] = draw_int(d, 0, 2) == 0 ? draw_int(d, 0, 1) : draw_unit(d);
    uvw[draw_int(d, 0, 2)] = draw_int(d, 0, 1);
}

/* Half an ulp of x as float32. */
static double half_ulp(double x)
{
    const float near = (float)x;
    return 0.5 * fmax((double)nextafterf(near, HUGE_VALF) - (double)near,
                      (double)near - (double)nextafterf(near, -HUGE_VALF));
}

static size_t count_of(const ffd_location *found, ffd_vertex_status status)
{
    size_t count = 0;
    for (int i = 0; i < POINTS; i++)
        count += found[i].status == status;
    return count;
}

static void draw_border_point(draw *d, const ffd_lattice *lattice, double p[3])
{
    double uvw[3];
    draw_on_border(d, uvw);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
}

static void border_points_of_float32_are_inside(void **state)
{
    static double xyz[3 * POINTS], rounding[3 * POINTS];
    static ffd_location bare[POINTS], near[POINTS];
    draw d = {draw_seed()};
    for (int m = 0; m < MAPS; m++) {
        ffd_lattice *lattice = lattice_of(maps[m]);
        ffd_locator *locator;
        for (int i = 0; i < POINTS; i++) {
            draw_border_point(&d, lattice, xyz + 3 * i);
            for (int a = 0; a < 3; a++) {
                xyz[3 * i + a] = (double)(float)xyz[3 * i + a];
                rounding[3 * i + a] = half_ulp(xyz[3 * i + a]);
            }
        }
        assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
        assert_int_equal(ffd_locator_find(locator, xyz, POINTS, bare, NULL), FFD_OK);
        assert_true(count_of(bare, FFD_VERTEX_OUTSIDE) > POINTS / 10);
        const ffd_border_allowance allowance = {.rounding = rounding};
        assert_int_equal(ffd_locator_find_near(locator, xyz, POINTS, &allowance, near, NULL), FFD_OK);
        assert_int_equal(count_of(near, FFD_VERTEX_INSIDE), POINTS);
        for (int i = 0; i < POINTS; i++) {
            double back[3];
            if (bare[i].status == FFD_VERTEX_INSIDE)
                assert_true(same_locations(&bare[i], &near[i]));
            ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, near[i].uvw, back, NULL);
            for (int a = 0; a < 3; a++)
                back[a] -= xyz[3 * i + a];
            /* The nearest border point is no farther than the exact point that was rounded. */
            assert_true(vec_length(back) <= vec_length(rounding + 3 * i) * 1.0001 + 1e-13);
        }
        ffd_locator_destroy(&locator);
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

/* Rounding of a coordinate applies to that coordinate only. */
static void rounding_of_one_coordinate_moves_along_it(void **state)
{
    ffd_lattice *lattice = lattice_of(warped_map);
    ffd_locator *locator;
    ffd_location found[2];
    draw d = {draw_seed()};
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    for (int i = 0; i < 200; i++) {
        const double uvw[3] = {1, draw_between(&d, 0.1, 0.9), draw_between(&d, 0.1, 0.9)};
        double p[6], rounding[6] = {1e-6, 0, 0, 0, 1e-6, 0};
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
        p[0] += 0.99e-6;
        memcpy(p + 3, p, 3 * sizeof *p);
        const ffd_border_allowance allowance = {.rounding = rounding};
        assert_int_equal(ffd_locator_find_near(locator, p, 2, &allowance, found, NULL), FFD_OK);
        assert_int_equal(found[0].status, FFD_VERTEX_INSIDE);
        assert_true(found[0].uvw[0] == 1);
        assert_int_equal(found[1].status, FFD_VERTEX_OUTSIDE);
    }
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void a_point_no_farther_than_snap_is_at_the_nearest_border_point(void **state)
{
    draw d = {draw_seed()};
    for (int m = 0; m < MAPS; m++) {
        ffd_lattice *lattice = lattice_of(maps[m]);
        ffd_locator *locator;
        assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
        for (int i = 0; i < 100; i++) {
            const double uvw[3] = {0, draw_between(&d, 0.2, 0.8), draw_between(&d, 0.2, 0.8)};
            double p[3], jacobian[9], normal[3], far = 1e-5 * draw_between(&d, 0.1, 1);
            ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, jacobian);
            const double v[3] = {jacobian[1], jacobian[4], jacobian[7]},
                         w[3] = {jacobian[2], jacobian[5], jacobian[8]};
            vec_cross(w, v, normal);
            const double out =
                (normal[0] * jacobian[0] + normal[1] * jacobian[3] + normal[2] * jacobian[6] < 0 ? 1 : -1) *
                far / vec_length(normal);
            for (int a = 0; a < 3; a++)
                p[a] += out * normal[a];
            for (int more = 0; more < 2; more++) {
                const ffd_border_allowance allowance = {.snap = far * (more ? 1.0001 : 0.9999)};
                ffd_location found;
                assert_int_equal(ffd_locator_find_near(locator, p, 1, &allowance, &found, NULL), FFD_OK);
                assert_int_equal(found.status, more ? FFD_VERTEX_INSIDE : FFD_VERTEX_OUTSIDE);
                if (!more)
                    continue;
                assert_true(fabs(found.residual - far) <= 1e-5 * far);
                for (int a = 0; a < 3; a++)
                    assert_true(fabs(found.uvw[a] - uvw[a]) < 1e-6);
            }
        }
        ffd_locator_destroy(&locator);
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

/* A pipe of exact circles (P&T 7.5), radii 1 and 2, height 1. */
static ffd_lattice *pipe(void)
{
    static const double turn[12] = {0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1};
    static const double corners[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                         {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    knot_vector knots[3];
    assert_int_equal(ffd_knots_make(KNOTS_CLAMPED, 1, 2, NULL, 0, 'u', &knots[0], NULL), FFD_OK);
    assert_int_equal(ffd_knots_make(KNOTS_LIST, 2, 9, turn, 12, 'v', &knots[1], NULL), FFD_OK);
    assert_int_equal(ffd_knots_make(KNOTS_CLAMPED, 1, 2, NULL, 0, 'w', &knots[2], NULL), FFD_OK);
    ffd_lattice *lattice = lattice_of_knots(knots);
    lattice_add_weights(lattice);
    for (size_t n = 0; n < lattice->count; n++) {
        const size_t j = n / 2 % 9;
        double *p = lattice->rest + 3 * n;
        p[0] = (double)(1 + n % 2) * corners[j][0];
        p[1] = (double)(1 + n % 2) * corners[j][1];
        p[2] = (double)(n / 18);
        lattice->rest_weights[n] = lattice->deformed_weights[n] = j % 2 ? sqrt(0.5) : 1;
    }
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    return lattice;
}

/* On the axis of a pipe a whole circle is equally near. A snap that nearly reaches it would need more patches
   than a search may use. */
static void a_search_of_the_border_that_ends_at_its_limit_is_said(void **state)
{
    static const double axis[3] = {0, 0, 0.5};
    static const double snap[3] = {0.9, 1 - 1e-10, 1 + 1e-10};
    static const ffd_vertex_status status[3] = {FFD_VERTEX_OUTSIDE, FFD_VERTEX_SINGULAR, FFD_VERTEX_INSIDE};
    ffd_lattice *lattice = pipe();
    ffd_locator *locator;
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    for (int i = 0; i < 3; i++) {
        const ffd_border_allowance allowance = {.snap = snap[i]};
        ffd_location found;
        assert_int_equal(ffd_locator_find_near(locator, axis, 1, &allowance, &found, NULL), FFD_OK);
        assert_int_equal(found.status, status[i]);
        assert_int_equal(found.unresolved, status[i] == FFD_VERTEX_SINGULAR);
    }
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void every_instruction_set_gives_the_same_bits_with_an_allowance(void **state)
{
    static double xyz[3 * POINTS], rounding[3 * POINTS];
    static ffd_location one_by_one[POINTS], several[POINTS];
    draw d = {draw_seed()};
    for (int m = 0; m < MAPS; m += stride(3)) {
        ffd_lattice *lattice = lattice_of(maps[m]);
        ffd_locator *locator;
        for (int i = 0; i < POINTS; i++) {
            draw_border_point(&d, lattice, xyz + 3 * i);
            for (int a = 0; a < 3; a++) {
                xyz[3 * i + a] += draw_between(&d, -1e-7, 1e-7);
                rounding[3 * i + a] = draw_between(&d, 0, 1e-7);
            }
        }
        const ffd_border_allowance allowance = {.rounding = rounding, .snap = 5e-8};
        assert_int_equal(ffd_locator_create_for(lattice, FFD_ISA_SCALAR, &locator, NULL), FFD_OK);
        for (size_t i = 0; i < POINTS; i++) {
            const ffd_border_allowance own = {.rounding = rounding + 3 * i, .snap = 5e-8};
            assert_int_equal(ffd_locator_find_near(locator, xyz + 3 * i, 1, &own, &one_by_one[i], NULL),
                             FFD_OK);
        }
        ffd_locator_destroy(&locator);
        assert_true(count_of(one_by_one, FFD_VERTEX_OUTSIDE) > 0);
        for (ffd_isa isa = FFD_ISA_AUTO; isa <= FFD_ISA_NEON; isa++) {
            if (!ffd_isa_available(isa))
                continue;
            assert_int_equal(ffd_locator_create_for(lattice, isa, &locator, NULL), FFD_OK);
            assert_int_equal(ffd_locator_find_near(locator, xyz, POINTS, &allowance, several, NULL), FFD_OK);
            for (int i = 0; i < POINTS; i++) {
                assert_memory_equal(several[i].uvw, one_by_one[i].uvw, sizeof several[i].uvw);
                assert_memory_equal(&several[i].residual, &one_by_one[i].residual, sizeof(double));
                assert_int_equal(several[i].status, one_by_one[i].status);
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
        cmocka_unit_test(border_points_of_float32_are_inside),
        cmocka_unit_test(rounding_of_one_coordinate_moves_along_it),
        cmocka_unit_test(a_point_no_farther_than_snap_is_at_the_nearest_border_point),
        cmocka_unit_test(a_search_of_the_border_that_ends_at_its_limit_is_said),
        cmocka_unit_test(every_instruction_set_gives_the_same_bits_with_an_allowance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
