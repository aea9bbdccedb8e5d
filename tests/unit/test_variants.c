/* test_variants.c - many variants of the control points in one call: the bits of single calls, for each
   instruction set, number of threads, form and type; progress, refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_text.h"
#include "../support/repetitions.h"
#include "spline/bezier.h"
#include "spline/knots.h"
#include <ffd/ffd.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POINTS ((size_t)700)
#define MOST ((size_t)19)

/* Of each degree and kind of knots, closed, curved and with weights; the last has far more cells than points
   need. */
static const char *const rests[] = {
    "\"size\":[5,4,6],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}",
    "\"size\":[4,4,4],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}",
    "\"size\":[2,5,3],\"degree\":[1,4,2],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}",
    "\"size\":[7,6,7],\"degree\":[2,3,3],\"knots\":[\"uniform\",\"open\",\"uniform\"],"
    "\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}",
    "\"size\":[3,6,3],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[0.3,1],"
    "\"height\":2}}",
    "\"size\":[3,3,3],\"weights\":[1,2,1,1,1,1,1,1,1,1,1,1,1,0.5,1,1,1,1,2,1,1,1,1,1,3,1,1],"
    "\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}",
    "\"size\":[40,38,44],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}",
};
#define RESTS (sizeof rests / sizeof *rests)

typedef struct scene {
    ffd_lattice *lattice;
    ffd_embedding *embedding;
    size_t control_points, count; /* count: of variants */
    size_t size[3];
    double xyz[3 * POINTS], weights[POINTS];
    double *offsets; /* u fastest */
    bool is_weighted;
} scene;

/* Displacements as they come: all, few, alike, rounded, none, alike in one half. */
static double draw_offset(draw *d, const size_t size[3], size_t variant, size_t number)
{
    switch (variant % 6) {
    case 0:
        return draw_between(d, -0.1, 0.1);
    case 1:
        return draw_int(d, 0, 9) == 0 ? draw_between(d, -0.1, 0.1) : 0;
    case 2:
        return 0.01 * (double)(1 + number % 3);
    case 3:
        return draw_int(d, -1, 1) * 0.25;
    case 4:
        return 0;
    default:
        return number / 3 % size[0] <= size[0] / 2 ? 0.1 * (double)(1 + number % 3)
                                                   : draw_between(d, -0.1, 0.1);
    }
}

static void begin(size_t rest, ffd_outside outside, size_t count, draw *d, scene *s)
{
    ffd_embedding_desc desc;
    ffd_error error = {0};
    *s = (scene){.lattice = make(rests[rest], ""), .count = count};
    ffd_lattice_get_size(s->lattice, s->size);
    s->control_points = s->size[0] * s->size[1] * s->size[2];
    for (size_t i = 0; i < 3 * POINTS; i++) /* some on faces and knots */
        s->xyz[i] = draw_int(d, 0, 3) == 0 ? draw_int(d, -4, 4) * 0.25 : draw_between(d, -1.1, 1.1);
    s->xyz[3 * 17 + 1] = (double)NAN;
    s->xyz[3 * 18 + 2] = -0.0;
    for (size_t i = 0; i < POINTS; i++)
        s->weights[i] = draw_int(d, 0, 4) * 0.25;
    s->offsets = malloc(3 * s->control_points * (count + 1) * sizeof *s->offsets);
    assert_non_null(s->offsets);
    for (size_t v = 0; v < count; v++)
        for (size_t i = 0; i < 3 * s->control_points; i++)
            s->offsets[3 * s->control_points * v + i] = draw_offset(d, s->size, v, i);
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = s->lattice;
    desc.points = (ffd_span){.data = s->xyz, .count = POINTS};
    desc.outside = outside;
    desc.falloff = outside == FFD_OUTSIDE_EXTEND ? 0.15 : 0;
    if (ffd_embedding_create(&desc, NULL, &s->embedding, &error))
        fail_msg("%s", error.message);
}

static void end(scene *s)
{
    ffd_embedding_destroy(&s->embedding);
    ffd_lattice_destroy(&s->lattice);
    free(s->offsets);
}

static size_t bytes_of(ffd_number type)
{
    return 3 * POINTS * (type == FFD_FLOAT32 ? sizeof(float) : sizeof(double));
}

/* Returns the results of single calls, one after the other. */
static char *one_by_one(const scene *s, ffd_number type, bool are_points)
{
    char *const made = malloc(s->count * bytes_of(type) + 1);
    const ffd_span in = {.data = (void *)(uintptr_t)s->xyz, .count = POINTS};
    assert_non_null(made);
    for (size_t v = 0; v < s->count; v++) {
        const double *const offsets = s->offsets + 3 * s->control_points * v;
        const ffd_span out = {.data = made + v * bytes_of(type), .count = POINTS, .type = type};
        ffd_lattice *moved;
        assert_int_equal(ffd_lattice_copy(s->lattice, &moved, NULL), FFD_OK);
        assert_int_equal(are_points ? ffd_lattice_set_points(moved, NULL, s->control_points, offsets, NULL)
                                    : ffd_lattice_set_offsets(moved, NULL, s->control_points, offsets, NULL),
                         FFD_OK);
        assert_int_equal(s->is_weighted
                             ? ffd_embedding_deform_weighted(s->embedding, moved, s->weights, NULL, in, out,
                                                             NULL, NULL, NULL)
                             : ffd_embedding_deform(s->embedding, moved, in, out, NULL, NULL, NULL),
                         FFD_OK);
        ffd_lattice_destroy(&moved);
    }
    return made;
}

/* Returns the values with w fastest. */
static double *by_w(const scene *s)
{
    const size_t *const n = s->size;
    double *const made = malloc(3 * s->control_points * (s->count + 1) * sizeof *made);
    assert_non_null(made);
    for (size_t v = 0; v < s->count; v++)
        for (size_t i = 0; i < s->control_points; i++) {
            const size_t u = i % n[0], y = i / n[0] % n[1], w = i / n[0] / n[1];
            memcpy(made + 3 * (s->control_points * v + (u * n[1] + y) * n[2] + w),
                   s->offsets + 3 * (s->control_points * v + i), 3 * sizeof *made);
        }
    return made;
}

static void compare(const scene *s, const ffd_variants *variants, ffd_number type, const char *expected)
{
    char *const made = malloc(s->count * bytes_of(type) + 1);
    const ffd_span in = {.data = (void *)(uintptr_t)s->xyz, .count = POINTS};
    const ffd_span out = {.data = made, .count = s->count * POINTS, .type = type};
    ffd_run_options run;
    assert_non_null(made);
    ffd_run_options_init(&run, sizeof run);
    for (int isa = FFD_ISA_AUTO; isa <= FFD_ISA_NEON; isa++)
        for (int threads = 1; threads <= 3; threads += 2) {
            if (isa != FFD_ISA_AUTO && !ffd_isa_available((ffd_isa)isa))
                continue;
            ffd_error error = {0};
            run.isa = (ffd_isa)isa;
            run.threads = threads;
            memset(made, 1, s->count * bytes_of(type));
            if (ffd_embedding_deform_variants(s->embedding, variants, in, out, &run, &error))
                fail_msg("%s", error.message);
            assert_memory_equal(made, expected, s->count * bytes_of(type));
        }
    free(made);
}

static void compare_forms(scene *s, ffd_number type)
{
    for (int are_points = 0; are_points <= 1; are_points++) {
        ffd_variants variants;
        char *const expected = one_by_one(s, type, are_points);
        double *const turned = by_w(s);
        ffd_variants_init(&variants, sizeof variants);
        variants.count = s->count;
        variants.values = s->offsets;
        variants.are_points = are_points;
        variants.weights = s->is_weighted ? s->weights : NULL;
        compare(s, &variants, type, expected);
        variants.values = turned;
        variants.w_fastest = true;
        compare(s, &variants, type, expected);
        free(turned);
        free(expected);
    }
}

static void variants_have_the_bits_of_single_calls(void **state)
{
    static const size_t counts[] = {1, 2, 5, 8, MOST};
    draw d = {draw_seed()};
    for (size_t r = 0; r < RESTS; r++)
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            scene s;
            if (is_memory_checked() && (c == 1 || c == 4 || r + 1 == RESTS))
                continue;
            begin(r, c % 2 ? FFD_OUTSIDE_EXTEND : FFD_OUTSIDE_KEEP, counts[c], &d, &s);
            s.is_weighted = c == 2;
            compare_forms(&s, c % 2 ? FFD_FLOAT32 : FFD_FLOAT64);
            end(&s);
        }
    (void)state;
}

static void the_short_form_takes_offsets(void **state)
{
    draw d = {draw_seed()};
    scene s;
    begin(0, FFD_OUTSIDE_KEEP, 3, &d, &s);
    char *const expected = one_by_one(&s, FFD_FLOAT64, false);
    double *const made = malloc(3 * bytes_of(FFD_FLOAT64));
    assert_non_null(made);
    const ffd_span in = {.data = s.xyz, .count = POINTS};
    const ffd_span out = {.data = made, .count = 3 * POINTS};
    assert_int_equal(ffd_embedding_deform_many(s.embedding, 3, s.offsets, in, out, NULL, NULL), FFD_OK);
    assert_memory_equal(made, expected, 3 * bytes_of(FFD_FLOAT64));
    assert_int_equal(ffd_embedding_deform_many(s.embedding, 1, s.offsets, in, in, NULL, NULL), FFD_OK);
    assert_memory_equal(s.xyz, expected, bytes_of(FFD_FLOAT64));
    free(made);
    free(expected);
    end(&s);
    (void)state;
}

static void arrays_of_any_stride_are_taken(void **state)
{
    draw d = {draw_seed()};
    scene s;
    begin(1, FFD_OUTSIDE_KEEP, 9, &d, &s);
    double *const expected = (double *)(void *)one_by_one(&s, FFD_FLOAT64, false);
    double *const made = calloc(9 * POINTS, 7 * sizeof *made);
    assert_non_null(made);
    const ffd_span in = {.data = s.xyz, .count = POINTS};
    const ffd_span out = {.data = made + 6,
                          .count = 9 * POINTS,
                          .stride = 7 * sizeof *made,
                          .step = -2 * (ptrdiff_t)sizeof *made};
    assert_int_equal(ffd_embedding_deform_many(s.embedding, 9, s.offsets, in, out, NULL, NULL), FFD_OK);
    for (size_t i = 0; i < 9 * POINTS; i++)
        for (size_t c = 0; c < 3; c++) {
            assert_memory_equal(made + 7 * i + 6 - 2 * c, expected + 3 * i + c, sizeof *made);
            assert_true(made[7 * i + 1 + 2 * c] == 0);
        }
    free(made);
    free(expected);
    end(&s);
    (void)state;
}

static void nothing_to_do_is_done(void **state)
{
    draw d = {draw_seed()};
    scene s;
    begin(0, FFD_OUTSIDE_KEEP, 0, &d, &s);
    const ffd_span in = {.data = s.xyz, .count = POINTS}, out = {.count = 0};
    assert_int_equal(ffd_embedding_deform_many(s.embedding, 0, NULL, in, out, NULL, NULL), FFD_OK);
    end(&s);
    (void)state;
}

/* Numbers with which a block is not computed. */
static void large_numbers_have_the_same_bits(void **state)
{
    draw d = {draw_seed()};
    scene s;
    begin(0, FFD_OUTSIDE_KEEP, 9, &d, &s);
    s.offsets[3 * s.control_points * 4 + 5] = 1e300;
    ffd_variants variants;
    char *const expected = one_by_one(&s, FFD_FLOAT64, false);
    ffd_variants_init(&variants, sizeof variants);
    variants.count = 9;
    variants.values = s.offsets;
    compare(&s, &variants, FFD_FLOAT64, expected);
    free(expected);
    end(&s);
    (void)state;
}

static ffd_status fails(const scene *s, const ffd_variants *variants, size_t rows, ffd_number type,
                        const ffd_run_options *run, ffd_error *error)
{
    static double made[3 * POINTS * MOST];
    const ffd_span in = {.data = (void *)(uintptr_t)s->xyz, .count = POINTS};
    const ffd_span out = {.data = made, .count = rows * POINTS, .type = type};
    return ffd_embedding_deform_variants(s->embedding, variants, in, out, run, error);
}

static void what_is_wrong_names_the_variant(void **state)
{
    draw d = {draw_seed()};
    scene s;
    ffd_variants variants;
    ffd_error error = {0};
    begin(0, FFD_OUTSIDE_KEEP, 10, &d, &s);
    ffd_variants_init(&variants, sizeof variants);
    variants.count = 10;
    variants.values = s.offsets;
    assert_int_equal(fails(&s, &variants, 9, FFD_FLOAT64, NULL, &error), FFD_E_ARGUMENT);
    assert_non_null(strstr(error.message, "the array of results has"));
    for (size_t i = 0; i < 3 * s.control_points; i++)
        s.offsets[3 * s.control_points * 3 + i] = 1e39;
    assert_int_equal(fails(&s, &variants, 10, FFD_FLOAT64, NULL, &error), FFD_OK);
    assert_int_equal(fails(&s, &variants, 10, FFD_FLOAT32, NULL, &error), FFD_E_INVALID);
    assert_non_null(strstr(error.message, "variant 3: point "));
    assert_non_null(strstr(error.message, "would be too large for float32"));
    s.offsets[3 * s.control_points * 2 + 7] = (double)NAN;
    assert_int_equal(fails(&s, &variants, 10, FFD_FLOAT64, NULL, &error), FFD_E_INVALID);
    assert_non_null(strstr(error.message, "variant 2: "));
    variants.count = 1;
    variants.values = s.offsets + 3 * s.control_points * 2;
    assert_int_equal(fails(&s, &variants, 1, FFD_FLOAT64, NULL, &error), FFD_E_INVALID);
    assert_null(strstr(error.message, "variant"));
    s.weights[5] = 2;
    variants.values = s.offsets;
    variants.weights = s.weights;
    assert_int_equal(fails(&s, &variants, 1, FFD_FLOAT64, NULL, &error), FFD_E_INVALID);
    assert_non_null(strstr(error.message, "the weight of point 5"));
    variants.weights = NULL;
    variants.values = NULL;
    assert_int_equal(fails(&s, &variants, 1, FFD_FLOAT64, NULL, &error), FFD_E_ARGUMENT);
    variants.struct_size += 8;
    assert_int_equal(fails(&s, &variants, 1, FFD_FLOAT64, NULL, &error), FFD_E_ARGUMENT);
    end(&s);
    (void)state;
}

typedef struct heard {
    double last;
    int calls, most;
} heard;

static bool tell(void *user, double done)
{
    heard *const t = user;
    assert_true(done >= t->last && done <= 1);
    t->last = done;
    return ++t->calls < t->most;
}

static void progress_ends_at_1_and_cancels(void **state)
{
    draw d = {draw_seed()};
    scene s;
    ffd_variants variants;
    ffd_run_options run;
    ffd_error error = {0};
    ffd_run_options_init(&run, sizeof run);
    run.progress = tell;
    ffd_variants_init(&variants, sizeof variants);
    for (size_t r = 0; r < RESTS - 1; r++) {
        heard told = {0, 0, 1000};
        begin(r, FFD_OUTSIDE_KEEP, MOST, &d, &s);
        variants.count = MOST;
        variants.values = s.offsets;
        run.user = &told;
        run.threads = 1 + (int)(r % 2);
        assert_int_equal(fails(&s, &variants, MOST, FFD_FLOAT64, &run, &error), FFD_OK);
        assert_true(told.calls > 0 && (run.threads > 1 || told.last == 1));
        told.calls = 0;
        told.last = 0;
        told.most = 1;
        assert_int_equal(fails(&s, &variants, MOST, FFD_FLOAT64, &run, &error), FFD_E_CANCELLED);
        end(&s);
    }
    (void)state;
}

/* What the kernels leave out of the conversion to Bezier form. */
static void the_outer_functions_are_in_one_bezier_point(void **state)
{
    static const double list[] = {0, 0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.5, 1, 1, 1.5, 2};
    for (int degree = 1; degree <= MAX_DEGREE; degree++)
        for (int kind = 0; kind < 4; kind++) {
            static const knot_kind kinds[] = {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_CLOSED, KNOTS_LIST};
            knot_vector knots;
            const size_t order = (size_t)degree + 1;
            if (kind == 3 && degree != 3)
                continue;
            assert_int_equal(ffd_knots_make(kinds[kind], degree, kind == 3 ? 9 : order + 5,
                                            kind == 3 ? list : NULL, kind == 3 ? 13 : 0, 'u', &knots, NULL),
                             FFD_OK);
            for (size_t s = 0; s < knots.span_count; s++)
                for (size_t r = 0; r < order; r++) {
                    const double *const row = knots.extractions + (s * order + r) * order;
                    assert_true((r == 0 || row[0] == 0) && (r + 1 == order || row[order - 1] == 0));
                }
            ffd_knots_free(&knots);
        }
    (void)state;
}

static void a_basis_in_the_order_of_python_has_the_same_entries(void **state)
{
    draw d = {draw_seed()};
    for (size_t r = 0; r < RESTS - 1; r++) {
        scene s;
        ffd_csr plain, turned;
        begin(r, FFD_OUTSIDE_EXTEND, 0, &d, &s);
        assert_int_equal(ffd_embedding_basis(s.embedding, NULL, &plain, NULL, NULL), FFD_OK);
        assert_int_equal(ffd_embedding_basis_ordered(s.embedding, NULL, true, &turned, NULL, NULL), FFD_OK);
        assert_memory_equal(plain.starts, turned.starts, (POINTS + 1) * sizeof *plain.starts);
        const size_t *const n = s.size;
        for (size_t i = 0; i < POINTS; i++)
            for (size_t e = plain.starts[i]; e < plain.starts[i + 1]; e++) {
                const size_t at = plain.indices[e];
                const size_t wanted = (at % n[0] * n[1] + at / n[0] % n[1]) * n[2] + at / n[0] / n[1];
                size_t f = turned.starts[i];
                while (f < turned.starts[i + 1] && turned.indices[f] != wanted)
                    f++;
                assert_true(f < turned.starts[i + 1]);
                assert_memory_equal(&turned.values[f], &plain.values[e], sizeof(double));
                assert_true(e == plain.starts[i] || turned.indices[e] > turned.indices[e - 1]);
            }
        ffd_csr_free(&plain);
        ffd_csr_free(&turned);
        end(&s);
    }
    (void)state;
}

/* Several tiles, with rows that are shorter than others. */
static void rows_of_a_long_basis_are_those_of_its_product(void **state)
{
    enum { LONG = 9500 };
    static double xyz[3 * LONG], product[3 * LONG], dq[3 * 120];
    draw d = {draw_seed()};
    ffd_lattice *lattice = make(rests[0], "");
    ffd_embedding_desc desc;
    ffd_embedding *embedding;
    ffd_csr matrix;
    for (size_t i = 0; i < 3 * LONG; i++)
        xyz[i] = draw_int(&d, 0, 3) == 0 ? draw_int(&d, -4, 5) * 0.25 : draw_between(&d, -1.1, 1.1);
    for (size_t i = 0; i < 3 * 120; i++)
        dq[i] = draw_between(&d, -1, 1);
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = lattice;
    desc.points = (ffd_span){.data = xyz, .count = LONG};
    assert_int_equal(ffd_embedding_create(&desc, NULL, &embedding, NULL), FFD_OK);
    assert_int_equal(ffd_embedding_basis(embedding, NULL, &matrix, NULL, NULL), FFD_OK);
    assert_int_equal(ffd_embedding_basis_times(embedding, NULL, dq, product, NULL, NULL), FFD_OK);
    for (size_t i = 0; i < LONG; i++) {
        double sum[3] = {0, 0, 0};
        for (size_t e = matrix.starts[i]; e < matrix.starts[i + 1]; e++)
            for (size_t c = 0; c < 3; c++)
                sum[c] += matrix.values[e] * dq[3 * (size_t)matrix.indices[e] + c];
        assert_memory_equal(sum, product + 3 * i, sizeof sum);
    }
    ffd_csr_free(&matrix);
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void many_evaluations_have_the_bits_of_one(void **state)
{
    draw d = {draw_seed()};
    for (size_t r = 0; r < RESTS; r++) {
        scene s;
        double low[3], high[3], uvw[3 * POINTS], made[3 * POINTS], expected[3 * POINTS];
        begin(r, FFD_OUTSIDE_KEEP, 1, &d, &s);
        assert_int_equal(ffd_lattice_set_offsets(s.lattice, NULL, s.control_points, s.offsets, NULL), FFD_OK);
        ffd_lattice_get_domain(s.lattice, low, high);
        for (size_t i = 0; i < 3 * POINTS; i++)
            uvw[i] = draw_int(&d, 0, 5) == 0
                         ? low[i % 3] + (high[i % 3] - low[i % 3]) * draw_int(&d, -1, 5) * 0.25
                         : draw_between(&d, low[i % 3], high[i % 3]);
        for (size_t i = 0; i < POINTS; i++)
            ffd_lattice_evaluate(s.lattice, FFD_VOLUME_DEFORMED, uvw + 3 * i, expected + 3 * i, NULL);
        for (int isa = FFD_ISA_AUTO; isa <= FFD_ISA_NEON; isa++) {
            ffd_run_options run;
            ffd_run_options_init(&run, sizeof run);
            run.isa = (ffd_isa)isa;
            if (isa != FFD_ISA_AUTO && !ffd_isa_available((ffd_isa)isa))
                continue;
            assert_int_equal(ffd_lattice_evaluate_many(s.lattice, FFD_VOLUME_DEFORMED, uvw, POINTS, made,
                                                       NULL, &run, NULL),
                             FFD_OK);
            assert_memory_equal(made, expected, sizeof made);
        }
        end(&s);
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variants_have_the_bits_of_single_calls),
        cmocka_unit_test(the_short_form_takes_offsets),
        cmocka_unit_test(arrays_of_any_stride_are_taken),
        cmocka_unit_test(nothing_to_do_is_done),
        cmocka_unit_test(large_numbers_have_the_same_bits),
        cmocka_unit_test(what_is_wrong_names_the_variant),
        cmocka_unit_test(progress_ends_at_1_and_cancels),
        cmocka_unit_test(the_outer_functions_are_in_one_bezier_point),
        cmocka_unit_test(a_basis_in_the_order_of_python_has_the_same_entries),
        cmocka_unit_test(rows_of_a_long_basis_are_those_of_its_product),
        cmocka_unit_test(many_evaluations_have_the_bits_of_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
