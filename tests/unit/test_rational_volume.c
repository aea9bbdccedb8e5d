/* test_rational_volume.c - the volume of a lattice with weights: that of the box, however steep they are. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "../support/repetitions.h"
#include "embed/frame/rational_volume.h"
#include <math.h>

static void box_map(const double g[3], double out[3])
{
    out[0] = 1000 + 3 * g[0];
    out[1] = 0.5 * g[1] - 0.25;
    out[2] = 1e-3 * g[2];
}

static void turned_map(const double g[3], double out[3])
{
    const double p[3] = {2 * g[0], 3 * g[1], g[2]};
    out[0] = 0.6 * p[0] - 0.8 * p[1] + 5;
    out[1] = 0.8 * p[0] + 0.6 * p[1];
    out[2] = -p[2] + 0.3 * p[0];
}

/* With knots that are clamped each face of the box is mapped to itself, whatever the weights. */
static ffd_lattice *weighted_box(draw *d, int most, point_map map, double steepness)
{
    lattice_kinds shape;
    for (int a = 0; a < 3; a++) {
        shape.kind[a] = KNOTS_CLAMPED;
        shape.degree[a] = draw_int(d, 1, most);
        shape.size[a] = (size_t)shape.degree[a] + (size_t)draw_int(d, 1, 3);
    }
    ffd_lattice *const lattice = lattice_of_kinds(&shape);
    lattice_map(lattice, map);
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    lattice_add_weights(lattice);
    const bool few = draw_int(d, 0, 1);
    for (size_t i = 0; i < lattice->count; i++)
        if (!few || draw_int(d, 0, 9) == 0)
            lattice->rest_weights[i] = pow(10, steepness * draw_between(d, -0.5, 0.5));
    return lattice;
}

static double relative_error(const rational_volume *found, double volume)
{
    return fabs(ldexp(found->triple, found->exponent) / 3 / volume - 1);
}

static void a_box_has_its_volume_whatever_the_weights(void **state)
{
    draw d = {1};
    for (int i = 0; i < 24; i += stride(7)) {
        const double steepness = i % 4 == 0 ? 0.3 : i % 4 == 1 ? 3 : i % 4 == 2 ? 8 : 12;
        ffd_lattice *lattice = weighted_box(&d, i % 8 == 7 ? 6 : 3, i % 2 ? turned_map : box_map, steepness);
        rational_volume found;
        assert_int_equal(ffd_rational_volume(lattice, &found, NULL), FFD_OK);
        const double error = relative_error(&found, i % 2 ? -6 : 1.5e-3),
                     doubt = found.doubt / fabs(found.triple);
        /* The map itself is rounded, far from 0. */
        assert_true(error <= doubt + (i % 2 ? 1e-14 : 1e-12) && doubt < 1e-5);
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

/* Weights that the parts do not suffice for: the doubt says so. */
static void the_doubt_holds_for_any_weights(void **state)
{
    draw d = {2};
    int certain = 0, uncertain = 0;
    for (int i = 0; i < 9; i += stride(5)) {
        ffd_lattice *lattice = weighted_box(&d, 3, turned_map, i % 3 == 0 ? 16 : i % 3 == 1 ? 40 : 600);
        rational_volume found;
        assert_int_equal(ffd_rational_volume(lattice, &found, NULL), FFD_OK);
        const bool is_certain = fabs(found.triple) > 2 * found.doubt;
        if (is_certain)
            assert_true(relative_error(&found, -6) <= found.doubt / fabs(found.triple) + 1e-14);
        certain += is_certain;
        uncertain += !is_certain;
        ffd_lattice_destroy(&lattice);
    }
    if (!is_memory_checked()) /* which tries two of the nine */
        assert_true(certain > 0 && uncertain > 0);
    (void)state;
}

static void every_failed_allocation_is_reported(void **state)
{
    draw d = {3};
    ffd_lattice *lattice = weighted_box(&d, 3, box_map, 4);
    rational_volume found;
    ffd_status status = FFD_E_MEMORY;
    long failing = 0;
    for (; status; failing++) {
        assert_true(failing < 100);
        ffd_alloc_fail_after(failing);
        status = ffd_rational_volume(lattice, &found, NULL);
        ffd_alloc_fail_after(-1);
        if (status)
            assert_int_equal(status, FFD_E_MEMORY);
    }
    assert_true(failing > 8);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_has_its_volume_whatever_the_weights),
        cmocka_unit_test(the_doubt_holds_for_any_weights),
        cmocka_unit_test(every_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
