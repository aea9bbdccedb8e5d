/* test_attribute_batch.c - normals and tangents in a batch get the same bits as one at a time, with each
   instruction set of this processor. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "deform/attribute.h"
#include <math.h>
#include <string.h>

#define ROUNDS 4000
#define MOST 41

typedef struct sample {
    double gradients[9 * MOST + 1], directions[4 * MOST + 1], normals[3 * MOST + 1];
    uint32_t points[MOST];
    uint8_t outcomes[MOST];
} sample;

/* Mostly ordinary numbers. */
static double number(draw *d, double size)
{
    static const double odd[] = {0, -0.0, 1e-200, -1e-160, 1e200, -1e160, 1e308, HUGE_VAL, -HUGE_VAL, 5e-324};
    const int choice = draw_int(d, 0, 300);
    if (choice == 0)
        return NAN;
    return choice < 11 ? odd[choice - 1] : draw_between(d, -size, size);
}

/* Draws F - I: sometimes 0, sometimes with det F = 0. */
static void draw_gradient(draw *d, double gradient[9])
{
    const int choice = draw_int(d, 0, 7);
    const double factor = draw_between(d, -1, 0);
    for (int i = 0; i < 9; i++)
        gradient[i] = choice == 0   ? (draw_int(d, 0, 1) ? 0 : -0.0)
                      : choice == 1 ? (i % 4 == 0 ? factor - (i == 0) : 0)
                      : choice == 2 ? (i % 4 == 0 ? -1 : 0)
                                    : number(d, 2);
}

static void draw_direction(draw *d, double v[3])
{
    const double size = draw_int(d, 0, 9) ? 1 : ldexp(1, draw_int(d, -540, 540));
    const bool is_zero = !draw_int(d, 0, 19);
    for (int a = 0; a < 3; a++)
        v[a] = is_zero ? 0 : size * number(d, 1);
}

/* Computes the expected results one at a time. */
static void expect(const attribute_batch *batch, const double *directions, bool tangents)
{
    for (size_t i = 0; i < batch->count; i++) {
        const double *const gradient = batch->gradients + 9 * (batch->points ? batch->points[i] : i);
        const double *const normal = batch->normals ? batch->normals + 3 * i : NULL;
        double result[3];
        const ffd_direction_outcome outcome =
            tangents ? ffd_deform_tangent(gradient, directions + i * batch->step, normal, result)
                     : ffd_deform_normal(gradient, directions + i * batch->step, result);
        if (outcome != batch->outcomes[i] ||
            memcmp(result, batch->directions + i * batch->step, sizeof result) != 0)
            fail_msg("direction %zu of %zu: %d %.17g %.17g %.17g, alone %d %.17g %.17g %.17g", i,
                     batch->count, batch->outcomes[i], batch->directions[i * batch->step],
                     batch->directions[i * batch->step + 1], batch->directions[i * batch->step + 2], outcome,
                     result[0], result[1], result[2]);
    }
}

static void check_batch(draw *d, sample *s, size_t counts[3])
{
    double before[4 * MOST];
    const size_t odd = (size_t)draw_int(d, 0, 1);
    const bool tangents = draw_int(d, 0, 1);
    const attribute_batch batch = {.gradients = s->gradients + odd,
                                   .points = draw_int(d, 0, 1) ? s->points : NULL,
                                   .count = (size_t)draw_int(d, 0, MOST),
                                   .directions = s->directions + odd,
                                   .step = tangents ? 4 : 3,
                                   .normals = tangents && draw_int(d, 0, 3) ? s->normals + odd : NULL,
                                   .outcomes = s->outcomes};
    for (size_t i = 0; i < MOST; i++) {
        draw_gradient(d, s->gradients + odd + 9 * i);
        draw_direction(d, before + i * batch.step);
        draw_direction(d, s->normals + odd + 3 * i);
        s->points[i] = (uint32_t)(draw_int(d, 0, 2) ? i : (size_t)draw_int(d, 0, MOST - 1));
    }
    for (ffd_isa isa = FFD_ISA_AUTO; isa <= FFD_ISA_NEON; isa++) {
        if (!ffd_isa_available(isa))
            continue;
        memcpy(batch.directions, before, batch.count * batch.step * sizeof *before);
        memset(s->outcomes, 0xff, sizeof s->outcomes);
        (tangents ? ffd_deform_tangents : ffd_deform_normals)(isa, &batch);
        expect(&batch, before, tangents);
    }
    for (size_t i = 0; i < batch.count; i++)
        counts[s->outcomes[i]]++;
}

static void batches_give_what_directions_get_alone(void **state)
{
    draw d = {draw_seed()};
    size_t counts[3] = {0};
    sample *s = malloc(sizeof *s);
    (void)state;
    assert_non_null(s);
    for (int round = 0; round < ROUNDS; round++)
        check_batch(&d, s, counts);
    free(s);
    for (int outcome = 0; outcome < 3; outcome++)
        assert_true(counts[outcome] > ROUNDS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(batches_give_what_directions_get_alone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
