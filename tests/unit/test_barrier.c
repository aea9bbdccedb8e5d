/* test_barrier.c - the barrier against folds: its coefficients bound the determinant, its gradient is that of
 * differences. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "../support/lattice_maps.h"
#include "../support/repetitions.h"
#include "base/vector/vec.h"
#include "spline/knots.h"
#include <ffd/fold.h>
#include <math.h>

static draw dice;

static const knot_kind kinds[] = {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_UNIFORM, KNOTS_CLOSED};

/* v goes round an axis. */
static void ring_map(const double g[3], double out[3])
{
    const double angle = 6.283185307179586 * g[1];
    out[0] = (1 + g[0]) * cos(angle);
    out[1] = (1 + g[0]) * sin(angle);
    out[2] = g[2];
}

/* A warped lattice of random knots, whose control points are shaken. A closed v is a ring of at least four
   control points: with two there and back are the same, and the volume is 0. */
static ffd_lattice *shaken(double by)
{
    lattice_kinds shape;
    for (int a = 0; a < 3; a++) {
        shape.degree[a] = 1 + (int)(draw_number(&dice) % 4);
        shape.size[a] = (size_t)shape.degree[a] + 1 + draw_number(&dice) % 3;
        shape.kind[a] = kinds[draw_number(&dice) % (a == 1 ? 4 : 3)];
        if (shape.kind[a] == KNOTS_CLOSED && shape.size[a] < 4)
            shape.size[a] = 4;
    }
    ffd_lattice *const lattice = lattice_of_kinds(&shape);
    lattice_map(lattice, shape.kind[1] == KNOTS_CLOSED ? ring_map : warped_map);
    for (size_t i = 0; i < 3 * lattice->count; i++)
        lattice->deformed[i] = lattice->rest[i] + by * (2 * draw_unit(&dice) - 1);
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    return lattice;
}

static ffd_barrier barrier_of(const ffd_lattice *lattice, const double *deformed, double floor,
                              double *gradient)
{
    ffd_barrier found = {.struct_size = sizeof found};
    assert_int_equal(ffd_folds_barrier(lattice, deformed, floor, NULL, 0, 1, &found, gradient, NULL), FFD_OK);
    return found;
}

static void a_box_at_rest_has_ones(void **state)
{
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_UNIFORM}, {3, 2, 1}, {5, 4, 3}};
    ffd_lattice *const lattice = lattice_of_kinds(&shape);
    size_t cells = 1;
    for (int a = 0; a < 3; a++)
        cells *= lattice->knots[a].span_count;
    double *p = lattice->rest;
    for (size_t n = 0; n < lattice->count; n++, p += 3)
        for (int a = 0; a < 3; a++) {
            const size_t at = a == 0 ? n % 5 : a == 1 ? n / 5 % 4 : n / 20;
            p[a] = 7 + 3 * (a + 1) * ffd_knots_greville(&lattice->knots[a], at);
        }
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof *p);
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    double gradient[3 * 60];
    const ffd_barrier low = barrier_of(lattice, NULL, 0.1, gradient),
                      high = barrier_of(lattice, NULL, 3, NULL);
    assert_true(fabs(low.least - 1) < 1e-13);
    assert_true(low.value == 0);
    for (size_t i = 0; i < sizeof gradient / sizeof *gradient; i++)
        assert_true(gradient[i] == 0);
    /* Each coefficient misses the floor by 2. */
    assert_true(fabs(high.value - 4.0 * 9 * 6 * 3 * (double)cells) < 1e-9 * high.value);
    ffd_lattice_destroy((ffd_lattice *[]){lattice});
    (void)state;
}

/* det J of a volume at u,v,w. */
static double determinant_at(const ffd_lattice *lattice, ffd_volume volume, const double uvw[3])
{
    double x[3], jacobian[9];
    ffd_lattice_evaluate(lattice, volume, uvw, x, jacobian);
    return mat_determinant(jacobian);
}

static void draw_place(const ffd_lattice *lattice, double uvw[3])
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        uvw[a] = ffd_knots_first(knots) + draw_unit(&dice) * (ffd_knots_last(knots) - ffd_knots_first(knots));
    }
}

static void the_least_coefficient_bounds_the_determinant(void **state)
{
    for (int round = 0; round < (is_memory_checked() ? 3 : 30); round++) {
        ffd_lattice *lattice = shaken(0.15);
        const ffd_barrier found = barrier_of(lattice, NULL, 0.1, NULL);
        double sum = 0, least = HUGE_VAL;
        /* The mean at rest, by many places; det J is not far from it in these lattices. */
        for (int i = 0; i < 4000; i++) {
            double uvw[3];
            draw_place(lattice, uvw);
            sum += determinant_at(lattice, FFD_VOLUME_REST, uvw) / 4000;
            const double det = determinant_at(lattice, FFD_VOLUME_DEFORMED, uvw);
            least = det < least ? det : least;
        }
        if (sum > 0 && !(found.least <= least / sum + 0.1 * fabs(least / sum) + 1e-3))
            fail_msg("least coefficient %g, determinant %g", found.least, least / sum);
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

static void the_gradient_is_that_of_differences(void **state)
{
    for (int round = 0; round < (is_memory_checked() ? 3 : 20); round++) {
        ffd_lattice *lattice = shaken(0.3);
        const size_t count = 3 * lattice->count;
        double *const gradient = malloc(count * sizeof *gradient), *const q = malloc(count * sizeof *q);
        assert_non_null(gradient);
        assert_non_null(q);
        memcpy(q, lattice->deformed, count * sizeof *q);
        const ffd_barrier found = barrier_of(lattice, NULL, 0.8, gradient);
        double greatest = 0;
        for (size_t i = 0; i < count; i++)
            greatest = fmax(greatest, fabs(gradient[i]));
        for (int sample = 0; sample < 12; sample++) {
            const size_t i = draw_number(&dice) % count;
            const double step = 1e-5, kept = q[i];
            q[i] = kept + step;
            const double above = barrier_of(lattice, q, 0.8, NULL).value;
            q[i] = kept - step;
            const double below = barrier_of(lattice, q, 0.8, NULL).value;
            q[i] = kept;
            if (!(fabs((above - below) / (2 * step) - gradient[i]) <= 1e-5 * (greatest + found.value)))
                fail_msg("number %zu: %.10g, by differences %.10g", i, gradient[i],
                         (above - below) / (2 * step));
        }
        free(gradient);
        free(q);
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

/* More cells than a round, so that rounds follow each other. */
static void threads_and_cells_change_nothing(void **state)
{
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {1, 1, 2}, {18, 17, 20}};
    ffd_lattice *lattice = lattice_of_kinds(&shape);
    lattice_map(lattice, warped_map);
    for (size_t i = 0; i < 3 * lattice->count; i++)
        lattice->deformed[i] = lattice->rest[i] + 0.05 * (2 * draw_unit(&dice) - 1);
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    const size_t count = 3 * lattice->count;
    double *const one = malloc(count * sizeof *one), *const two = malloc(count * sizeof *two);
    ffd_barrier found[2] = {{.struct_size = sizeof *found}, {.struct_size = sizeof *found}};
    assert_int_equal(ffd_folds_barrier(lattice, NULL, 0.5, NULL, 0, 1, &found[0], one, NULL), FFD_OK);
    assert_int_equal(ffd_folds_barrier(lattice, NULL, 0.5, NULL, 0, 3, &found[1], two, NULL), FFD_OK);
    assert_memory_equal(one, two, count * sizeof *one);
    assert_memory_equal(&found[0].value, &found[1].value, sizeof found->value);
    assert_true(found[0].value > 0);
    /* A place in every cell is the same as all cells; one place is one cell. */
    const size_t cells = 17 * 16 * 18;
    double *const uvw = malloc(3 * cells * sizeof *uvw);
    for (size_t n = 0; n < cells; n++) {
        const size_t at[3] = {n % 17, n / 17 % 16, n / 17 / 16};
        for (int a = 0; a < 3; a++) {
            const knot_vector *const knots = &lattice->knots[a];
            const int span = knots->spans[at[a]];
            uvw[3 * n + (size_t)a] = (knots->t[span] + knots->t[span + 1]) / 2;
        }
    }
    assert_int_equal(ffd_folds_barrier(lattice, NULL, 0.5, uvw, cells, 2, &found[1], two, NULL), FFD_OK);
    assert_memory_equal(one, two, count * sizeof *one);
    uvw[3] = NAN;
    double part = 0;
    for (size_t n = 0; n < 2; n++) {
        assert_int_equal(ffd_folds_barrier(lattice, NULL, 0.5, uvw + 3 * n, 1, 2, &found[1], two, NULL),
                         FFD_OK);
        part += found[1].value;
        assert_true(n == 0 || (found[1].value == 0 && isinf(found[1].least)));
    }
    assert_true(part < found[0].value);
    free(uvw);
    free(one);
    free(two);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void what_cannot_be_is_refused(void **state)
{
    const lattice_kinds shape = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {1, 1, 1}, {2, 2, 2}};
    ffd_lattice *lattice = lattice_of_kinds(&shape);
    ffd_barrier found = {.struct_size = sizeof found};
    double q[24] = {0};
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    assert_int_equal(ffd_folds_barrier(lattice, NULL, 0.1, NULL, 0, 1, &found, NULL, NULL), FFD_E_INVALID);
    lattice_map(lattice, warped_map);
    memcpy(lattice->deformed, lattice->rest, 24 * sizeof(double));
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    assert_int_equal(ffd_folds_barrier(lattice, NULL, NAN, NULL, 0, 1, &found, NULL, NULL), FFD_E_ARGUMENT);
    assert_int_equal(ffd_folds_barrier(lattice, NULL, 0.1, NULL, 0, -1, &found, NULL, NULL), FFD_E_ARGUMENT);
    q[5] = INFINITY;
    assert_int_equal(ffd_folds_barrier(lattice, q, 0.1, NULL, 0, 1, &found, NULL, NULL), FFD_E_ARGUMENT);
    found.struct_size = 3;
    assert_int_equal(ffd_folds_barrier(lattice, NULL, 0.1, NULL, 0, 1, &found, NULL, NULL), FFD_E_ARGUMENT);
    found.struct_size = sizeof found;
    lattice_add_weights(lattice);
    assert_int_equal(ffd_folds_barrier(lattice, NULL, 0.1, NULL, 0, 1, &found, NULL, NULL),
                     FFD_E_UNSUPPORTED);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_at_rest_has_ones),
        cmocka_unit_test(the_least_coefficient_bounds_the_determinant),
        cmocka_unit_test(the_gradient_is_that_of_differences),
        cmocka_unit_test(threads_and_cells_change_nothing),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    dice.state = draw_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
