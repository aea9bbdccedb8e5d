/* test_displacement.c - points in a batch get the same bits as one at a time, with each instruction set of
   this processor. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "../support/repetitions.h"
#include "base/vector/vec.h"
#include "deform/displacement.h"
#include <ffd/embedding.h>
#include <math.h>
#include <stdio.h>

#define LATTICES 60
#define ROUNDS 6

static const char *const names[] = {"auto", "scalar", "sse2", "avx2", "avx512"};

/* Degrees 1 to 9 (mostly 3), all kinds of knots; some control points stay. In some lattices layers along w
   move alike, by numbers without rounding. */
static ffd_lattice *random_lattice(draw *d, int number)
{
    static const knot_kind kinds[] = {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_UNIFORM, KNOTS_CLOSED};
    const bool is_cell = number % 11 == 10; /* there is only one */
    knot_vector knots[3];
    for (int a = 0; a < 3; a++) {
        const int degree = number % 2 ? draw_int(d, 1, number % 5 ? 4 : 9) : 3;
        const size_t points = (size_t)(degree + 1 + (is_cell ? 0 : draw_int(d, 1, 7)));
        const knot_kind kind = kinds[draw_int(d, 0, is_cell ? 2 : 3)];
        assert_int_equal(ffd_knots_make(kind, degree, points, NULL, 0, "uvw"[a], &knots[a], NULL), FFD_OK);
    }
    ffd_lattice *lattice = lattice_of_knots(knots);
    const double still = draw_unit(d);
    const double most = number % 12 == 3 ? 0.1 : number % 12 == 9 ? draw_between(d, 0.2, 2) : 2;
    for (size_t n = 0; n < lattice->count; n++) {
        const bool alike = number % 4 == 1, moves = draw_unit(d) > still;
        const size_t index[3] = {n % lattice->size[0], n / lattice->size[0] % lattice->size[1],
                                 n / lattice->size[0] / lattice->size[1]};
        for (size_t a = 0; a < 3; a++) {
            double *const p = lattice->rest + 3 * n + a;
            *p = (double)index[a] + (alike ? draw_int(d, -12, 12) / 64.0 : draw_between(d, -0.2, 0.2));
            if (alike)
                lattice->deformed[3 * n + a] = *p + (index[2] < 3 ? 0 : 0.375 + (double)a);
            else
                lattice->deformed[3 * n + a] = *p + (moves ? draw_between(d, -most, most) : 0);
        }
    }
    if (number % 7 == 0) {
        /* With weights, points are evaluated one by one. */
        lattice->rest_weights = malloc(lattice->count * sizeof(double));
        lattice->deformed_weights = malloc(lattice->count * sizeof(double));
        assert_true(lattice->rest_weights && lattice->deformed_weights);
        for (size_t n = 0; n < lattice->count; n++)
            lattice->rest_weights[n] = lattice->deformed_weights[n] = draw_between(d, 0.5, 2);
    }
    if (number % 3 == 0) {
        /* Treated as a box, from whose frame d uvw / d p is taken. */
        lattice->form = REST_BOX_AFFINE;
        for (int i = 0; i < 9; i++)
            lattice->frame[i] = draw_between(d, -1, 1) + (i % 4 == 0 ? 4 : 0);
    }
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    return lattice;
}

/* Some parameters are knots, ends of the domain, or near the end of a span. */
static void random_uvw(draw *d, const ffd_lattice *lattice, double uvw[3])
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const int span = knots->spans[draw_int(d, 0, (int)knots->span_count - 1)];
        const int choice = draw_int(d, 0, 9);
        uvw[a] = choice == 0   ? knots->t[span]
                 : choice == 1 ? ffd_knots_last(knots)
                 : choice == 2
                     ? knots->t[span + 1] - ldexp(knots->t[span + 1] - knots->t[span], -draw_int(d, 1, 50))
                     : draw_between(d, ffd_knots_first(knots), ffd_knots_last(knots));
    }
}

typedef struct sample {
    union {
        double numbers[3 * DISPLACEMENT_BATCH + 1];
        ffd_location locations[DISPLACEMENT_BATCH + 1];
    } uvw;
    double delta[3 * DISPLACEMENT_BATCH + 1], gradient[9 * DISPLACEMENT_BATCH + 1];
    uint8_t moves[DISPLACEMENT_BATCH];
    uint32_t which[DISPLACEMENT_BATCH];
    turn_list turns;
    displacement_scratch scratch;
} sample;

/* Whether the gradient of a point was not written, as where only turns are looked for. */
static bool leaves_gradient_out(const displacement_batch *batch, size_t n)
{
    double untouched[9];
    memset(untouched, 0xff, sizeof untouched);
    return batch->only_turns && memcmp(batch->gradient + 9 * n, untouched, sizeof untouched) == 0;
}

static double determinant_of(const double gradient[9])
{
    double f[9];
    for (int i = 0; i < 9; i++)
        f[i] = gradient[i] + (i % 4 == 0);
    return mat_determinant(f);
}

static size_t left_out; /* gradients that are not 0 */

static void check_point(const ffd_lattice *lattice, const displacement_batch *batch, size_t n,
                        const char *isa)
{
    double delta[3], gradient[9];
    const int moves =
        ffd_displacement(lattice, ffd_batch_uvw(batch, n), delta, batch->gradient ? gradient : NULL);
    if (batch->gradient && leaves_gradient_out(batch, n)) {
        if (!(determinant_of(gradient) > 0))
            fail_msg("%s: point %zu turns (det F is %g), which is not found", isa, n,
                     determinant_of(gradient));
        left_out += gradient[0] != 0;
        memcpy(gradient, batch->gradient + 9 * n, sizeof gradient);
    }
    if (moves != batch->moves[n] || memcmp(delta, batch->delta + 3 * n, sizeof delta) != 0 ||
        (batch->gradient && memcmp(gradient, batch->gradient + 9 * n, sizeof gradient) != 0))
        fail_msg("%s: point %zu of %zu has another displacement than alone: %.17g %.17g", isa, n,
                 batch->count, batch->delta[3 * n], delta[0]);
}

/* Goes along w: anywhere, or near, as between the vertices of a fine mesh. */
static void step_from(draw *d, const ffd_lattice *lattice, const double last[3], double reach, double uvw[3])
{
    const double near = last[2] + reach * draw_between(d, -1, 1);
    const double end = ffd_knots_last(&lattice->knots[2]), first = ffd_knots_first(&lattice->knots[2]);
    memcpy(uvw, last, 2 * sizeof *uvw);
    if (reach > 0)
        uvw[2] = near < first ? first : near > end ? end : near;
}

/* Whole vectors of every width plus a remainder, at every alignment; u,v,w alone or in locations. */
static void check_batch(draw *d, const ffd_lattice *lattice, sample *s)
{
    static const size_t counts[] = {0, 1, 2, 3, 5, 7, 8, 9, 17, 64, 333, DISPLACEMENT_BATCH};
    const size_t wanted = counts[draw_int(d, 0, 11)];
    const size_t odd = (size_t)draw_int(d, 0, 1);
    const double reach = draw_int(d, 0, 1) ? ldexp(1, -draw_int(d, 3, 20)) : 0;
    displacement_batch batch = {.uvw = s->uvw.numbers + odd,
                                .stride = draw_int(d, 0, 1) ? 3 * sizeof(double) : sizeof(ffd_location),
                                .which = s->which,
                                .delta = s->delta + odd,
                                .gradient = draw_int(d, 0, 2) ? s->gradient + 1 - odd : NULL,
                                .moves = s->moves};
    batch.turns = batch.gradient && draw_int(d, 0, 2) ? &s->turns : NULL;
    batch.only_turns = batch.turns && draw_int(d, 0, 3);
    for (size_t n = 0; n < DISPLACEMENT_BATCH; n++) {
        random_uvw(d, lattice, (double *)ffd_batch_uvw(&batch, n));
        /* Neighbours are mostly in the same cell. */
        if (n > 0 && draw_int(d, 0, reach > 0 ? 40 : 3))
            step_from(d, lattice, ffd_batch_uvw(&batch, n - 1), reach, (double *)ffd_batch_uvw(&batch, n));
        if (batch.count < wanted && (wanted == DISPLACEMENT_BATCH || draw_int(d, 0, 4)))
            s->which[batch.count++] = (uint32_t)n;
    }
    for (ffd_isa isa = FFD_ISA_AUTO; isa <= FFD_ISA_NEON; isa++) {
        if (!ffd_isa_available(isa))
            continue;
        memset(s->delta, 0xff, sizeof s->delta);
        memset(s->gradient, 0xff, sizeof s->gradient);
        s->turns.count = 0;
        /* With cells kept from the last batch, or without. */
        if (draw_int(d, 0, 1))
            ffd_displacement_scratch_clear(&s->scratch);
        ffd_displacements(lattice, isa, &batch, &s->scratch);
        for (size_t k = 0; k < batch.count; k++)
            check_point(lattice, &batch, s->which[k], names[isa]);
    }
}

static void batches_give_what_points_get_alone(void **state)
{
    draw d = {draw_seed()};
    sample *s = calloc(1, sizeof *s);
    assert_non_null(s);
    for (int i = 0; i < repetitions(LATTICES); i++) {
        ffd_lattice *lattice = random_lattice(&d, i);
        ffd_displacement_scratch_clear(&s->scratch);
        s->scratch.kept.threads = i % 4 == 0 ? 1000 : i % 4;
        for (int round = 0; round < ROUNDS; round += stride(3))
            check_batch(&d, lattice, s);
        ffd_lattice_destroy(&lattice);
    }
    free(s);
    assert_true(left_out > 0 || is_memory_checked());
    (void)state;
}

/* At the ends of a clamped direction the corner control points are interpolated exactly. */
static void corners_are_exact(void **state)
{
    draw d = {draw_seed()};
    for (int round = 0; round < 50; round++) {
        knot_vector knots[3];
        for (int a = 0; a < 3; a++) {
            const int degree = draw_int(&d, 1, 9);
            assert_int_equal(ffd_knots_make(KNOTS_CLAMPED, degree, (size_t)(degree + 1 + draw_int(&d, 0, 9)),
                                            NULL, 0, "uvw"[a], &knots[a], NULL),
                             FFD_OK);
        }
        ffd_lattice *lattice = lattice_of_knots(knots);
        for (size_t i = 0; i < 3 * lattice->count; i++) {
            lattice->rest[i] = draw_between(&d, -1, 1);
            lattice->deformed[i] = draw_between(&d, -1, 1);
        }
        assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
        for (int corner = 0; corner < 8; corner++) {
            size_t n = 0;
            double uvw[3], delta[3];
            for (size_t a = 3; a-- > 0;) {
                uvw[a] = corner >> a & 1;
                n = n * lattice->size[a] + (corner >> a & 1 ? lattice->size[a] - 1 : 0);
            }
            assert_int_equal(ffd_displacement(lattice, uvw, delta, NULL), 1);
            assert_memory_equal(delta, lattice->difference + 3 * n, sizeof delta);
        }
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

/* Moves a single point, number i of a row, in a lattice of one cell. Where 1 - u is `rest`, value and slope
   of its function have an error of a few ulps, however small they are. */
static void check_function(int degree, int i, double rest, double distance)
{
    const double u = 1 - rest;
    double binomial = 1, delta[3], by_uvw[9];
    knot_vector knots[3];
    for (int k = 0; k < i; k++)
        binomial = binomial * (degree - k) / (k + 1);
    for (int a = 0; a < 3; a++)
        assert_int_equal(ffd_knots_make(KNOTS_CLAMPED, a == 0 ? degree : 1, a == 0 ? (size_t)degree + 1 : 2,
                                        NULL, 0, "uvw"[a], &knots[a], NULL),
                         FFD_OK);
    ffd_lattice *lattice = lattice_of_knots(knots);
    lattice->deformed[3 * lattice_index(lattice, (size_t)i, 0, 1)] = distance;
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    const double uvw[3] = {u, 0.5, 0.25};
    const long double share = 0.5L * 0.25L * binomial * (long double)distance,
                      value = share * powl(u, i) * powl(rest, degree - i),
                      up = i > 0 ? share * i * powl(u, i - 1) * powl(rest, degree - i) : 0,
                      down = i < degree ? share * (degree - i) * powl(u, i) * powl(rest, degree - i - 1) : 0;
    assert_int_equal(ffd_displacement_by_uvw(lattice, uvw, delta, by_uvw), 1);
    if (fabsl(delta[0] - value) > 1e-14L * value + 1e-320L ||
        fabsl(by_uvw[0] - (up - down)) > 1e-14L * (up + down) + 1e-320L ||
        fabsl(by_uvw[1] + 2 * value) > 2e-14L * value + 1e-320L)
        fail_msg("degree %d, function %d at 1 - %g, by %g: %.17g, not %.17Lg; %.17g, not %.17Lg; %.17g",
                 degree, i, rest, distance, delta[0], value, by_uvw[0], up - down, by_uvw[1]);
    ffd_lattice_destroy(&lattice);
}

static void functions_are_exact_at_the_ends_of_spans(void **state)
{
    static const double distances[] = {1, 0.3, 1e-290, 1e300};
    for (int degree = 1; degree <= 9; degree++)
        for (int i = 0; i <= degree; i++)
            for (int k = 0; k <= 53; k++)
                check_function(degree, i, k < 53 ? ldexp(1, -k) : 0, distances[k % 4]);
    (void)state;
}

static void what_is_not_there_is_not_available(void **state)
{
    assert_true(ffd_isa_available(FFD_ISA_AUTO) && ffd_isa_available(FFD_ISA_SCALAR));
    assert_true(ffd_isa_available(ffd_isa_best()) && ffd_isa_best() != FFD_ISA_AUTO);
    assert_false(ffd_isa_available((ffd_isa)(FFD_ISA_NEON + 1)));
    assert_string_equal(ffd_isa_name(FFD_ISA_AVX2), "avx2");
    assert_string_equal(ffd_isa_name((ffd_isa)(FFD_ISA_NEON + 1)), "unknown");
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(batches_give_what_points_get_alone),
        cmocka_unit_test(corners_are_exact),
        cmocka_unit_test(functions_are_exact_at_the_ends_of_spans),
        cmocka_unit_test(what_is_not_there_is_not_available),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
