/* test_turns.c - no point at which a displacement turns space inside out is passed over: moves are scaled
   until det F falls just below 0 at some of the points, which are those of a cell or of a small box. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "../support/repetitions.h"
#include "base/vector/vec.h"
#include "deform/displacement.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LATTICES 600
#define POINTS 48

typedef struct sample {
    double uvw[3 * POINTS], delta[3 * POINTS], gradient[9 * POINTS];
    double rest_gradient[9 * POINTS]; /* with the moves as drawn */
    uint8_t moves[POINTS];
    uint32_t which[POINTS];
    turn_list turns;
    displacement_scratch scratch;
} sample;

/* Clamped; a box, or bent. Of some, whole layers move, all in one direction: bounds of quadratic ones are
   exact then. */
static ffd_lattice *random_lattice(draw *d, bool is_box)
{
    knot_vector knots[3];
    const int layers = draw_int(d, -1, 2);
    const double direction[3] = {draw_between(d, -1, 1), draw_between(d, -1, 1), draw_between(d, -1, 1)};
    double steps[16];
    for (size_t i = 0; i < 16; i++)
        steps[i] = draw_between(d, -1, 1);
    for (int a = 0; a < 3; a++) {
        const int degree = layers >= 0 ? 2 : draw_int(d, 0, 2) ? 3 : draw_int(d, 1, 5);
        const size_t points = (size_t)(degree + 1 + draw_int(d, 0, 3));
        assert_int_equal(ffd_knots_make(KNOTS_CLAMPED, degree, points, NULL, 0, "uvw"[a], &knots[a], NULL),
                         FFD_OK);
    }
    ffd_lattice *lattice = lattice_of_knots(knots);
    const double bend = is_box || draw_int(d, 0, 1) ? 0 : draw_between(d, 0, 0.3);
    for (size_t n = 0; n < lattice->count; n++) {
        const size_t index[3] = {n % lattice->size[0], n / lattice->size[0] % lattice->size[1],
                                 n / lattice->size[0] / lattice->size[1]};
        for (size_t a = 0; a < 3; a++) {
            lattice->rest[3 * n + a] = (double)index[a] + draw_between(d, -bend, bend);
            lattice->deformed[3 * n + a] =
                lattice->rest[3 * n + a] +
                (layers >= 0 ? steps[index[layers]] * direction[a] : draw_between(d, -1, 1));
        }
    }
    if (is_box) {
        /* Any frame will do for F. */
        lattice->form = REST_BOX_AFFINE;
        for (int i = 0; i < 9; i++)
            lattice->frame[i] = draw_between(d, -1, 1) + (i % 4 == 0 ? 4 : 0);
    }
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    return lattice;
}

/* Points in a box of some size in one cell, neighbours mostly beside each other. */
static void random_points(draw *d, const ffd_lattice *lattice, sample *s)
{
    const double size = ldexp(1, -draw_int(d, 0, 6));
    for (size_t a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const double *const t = knots->t + knots->spans[draw_int(d, 0, (int)knots->span_count - 1)];
        const double side = size * (t[1] - t[0]), first = draw_between(d, t[0], t[1] - side);
        for (size_t n = 0; n < POINTS; n++)
            s->uvw[3 * n + a] = draw_between(d, first, first + side);
    }
    for (size_t n = 0; n < POINTS; n++)
        s->which[n] = (uint32_t)n;
}

static double determinant_of(const double gradient[9], double scale)
{
    double f[9];
    for (int i = 0; i < 9; i++)
        f[i] = scale * gradient[i] + (i % 4 == 0);
    return mat_determinant(f);
}

/* Returns the least of many scales of the moves with det F < 0 at a point; 0 if there is none. */
static double turning_scale(const sample *s)
{
    for (double scale = 0.01; scale < 30; scale *= 1.005)
        for (size_t n = 0; n < POINTS; n++)
            if (determinant_of(s->rest_gradient + 9 * n, scale) < 0)
                return scale;
    return 0;
}

static void scale_moves(ffd_lattice *lattice, double scale)
{
    for (size_t i = 0; i < 3 * lattice->count; i++)
        lattice->deformed[i] = lattice->rest[i] + scale * lattice->difference[i];
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
}

static size_t found, passed_over; /* points that turn; others whose gradient was not needed */

static void check_points(const ffd_lattice *lattice, ffd_isa isa, sample *s)
{
    const displacement_batch batch = {.uvw = s->uvw,
                                      .stride = 3 * sizeof *s->uvw,
                                      .which = s->which,
                                      .count = POINTS,
                                      .delta = s->delta,
                                      .gradient = s->gradient,
                                      .turns = &s->turns,
                                      .only_turns = true,
                                      .moves = s->moves};
    bool is_listed[POINTS] = {false};
    s->turns.count = 0;
    ffd_displacement_scratch_clear(&s->scratch);
    ffd_displacements(lattice, isa, &batch, &s->scratch);
    for (size_t k = 0; k < s->turns.count; k++)
        is_listed[s->turns.points[k]] = true;
    for (size_t n = 0; n < POINTS; n++) {
        double delta[3], gradient[9];
        ffd_displacement(lattice, s->uvw + 3 * n, delta, gradient);
        const bool turns = determinant_of(gradient, 1) < 0;
        if (turns && !is_listed[n])
            fail_msg("point %zu turns (det F is %g), which is not found", n, determinant_of(gradient, 1));
        found += turns;
        passed_over += !is_listed[n];
    }
}

static void no_turn_is_passed_over(void **state)
{
    draw d = {draw_seed()};
    sample *s = calloc(1, sizeof *s);
    assert_non_null(s);
    for (int i = 0; i < repetitions(LATTICES); i++) {
        ffd_lattice *lattice = random_lattice(&d, i % 2);
        random_points(&d, lattice, s);
        for (size_t n = 0; n < POINTS; n++)
            ffd_displacement(lattice, s->uvw + 3 * n, s->delta, s->rest_gradient + 9 * n);
        const double scale = turning_scale(s);
        if (scale > 0) {
            scale_moves(lattice, scale);
            check_points(lattice, FFD_ISA_AUTO, s);
            scale_moves(lattice, 0.7); /* of what it was last */
            check_points(lattice, i % 3 ? FFD_ISA_AUTO : FFD_ISA_SCALAR, s);
        }
        ffd_lattice_destroy(&lattice);
    }
    free(s);
    assert_true((found > 0 && passed_over > 0) || is_memory_checked());
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_turn_is_passed_over)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
