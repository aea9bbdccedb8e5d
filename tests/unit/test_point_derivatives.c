/* test_point_derivatives.c - derivatives of embedded points by weights and by placeholders: central
   differences of the deformation, products that are those of the matrix, refusals, memory that runs out. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_text.h"
#include "base/memory/memory.h"
#include <ffd/ffd.h>
#include <math.h>
#include <stdlib.h>

#define POINTS ((size_t)200)
#define ROWS (3 * POINTS)

#define BOX "\"size\":[4,3,5],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}"
#define WEIGHTED                                                                                             \
    "\"size\":[3,3,3],\"weights\":[1,2,1,1,1,1,1,1,1,1,1,1,1,0.5,1,1,1,1,2,1,1,1,1,1,3,1,1],"                \
    "\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}"
#define ARCS                                                                                                 \
    "\"size\":[3,3,5],\"degree\":[2,2,2],\"knots\":[\"clamped\",\"clamped\",[0,0,0,1,1,2,2,2]],"             \
    "\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]}}"
#define PARAMETERS                                                                                           \
    ",\"parameters\":{\"A\":{\"default\":30},\"S\":{\"default\":[0.1,-0.2,0.1]},\"B\":{\"default\":0.2}}"

static ffd_embedding *embed(const ffd_lattice *lattice, const double *xyz)
{
    ffd_embedding_desc desc;
    ffd_embedding *embedding;
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = lattice;
    desc.points = (ffd_span){.data = (void *)(uintptr_t)xyz, .count = POINTS};
    desc.outside = FFD_OUTSIDE_EXTEND;
    desc.falloff = 0.4;
    assert_int_equal(ffd_embedding_create(&desc, NULL, &embedding, NULL), FFD_OK);
    return embedding;
}

/* Points inside and outside, one of them not finite. */
static void fill_points(double *xyz, draw *d)
{
    for (size_t i = 0; i < ROWS; i++)
        xyz[i] = draw_between(d, -1.3, 1.3);
    xyz[3 * 17 + 1] = (double)NAN;
}

static void deform(const ffd_embedding *embedding, const ffd_lattice *moved, const double *xyz, double *out)
{
    const ffd_span in = {.data = (void *)(uintptr_t)xyz, .count = POINTS},
                   to = {.data = out, .count = POINTS};
    assert_int_equal(ffd_embedding_deform(embedding, moved, in, to, NULL, NULL, NULL), FFD_OK);
}

/* Compares a matrix of ROWS x columns with its products with random vectors. */
static void products_agree(const double *jacobian, size_t columns, const double *change, const double *dx,
                           const double *dfdx, const double *back)
{
    for (size_t i = 0; i < ROWS; i++) {
        double sum = 0;
        for (size_t k = 0; k < columns; k++)
            sum += jacobian[i * columns + k] * change[k];
        assert_true(fabs(sum - dx[i]) < 1e-11 * (1 + fabs(sum)));
    }
    for (size_t k = 0; k < columns; k++) {
        double sum = 0;
        for (size_t i = 0; i < ROWS; i++)
            sum += jacobian[i * columns + k] * dfdx[i];
        assert_true(fabs(sum - back[k]) < 1e-10 * (1 + fabs(sum)));
    }
}

static void weights_are_differences(void **state)
{
    static const char *const rests[] = {BOX, WEIGHTED};
    static double xyz[ROWS], ahead[ROWS], behind[ROWS], dx[ROWS], dfdx[ROWS];
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    for (size_t i = 0; i < ROWS; i++)
        dfdx[i] = draw_between(&d, -1, 1);
    for (size_t r = 0; r < sizeof rests / sizeof *rests; r++) {
        ffd_lattice *const lattice = make(rests[r], "{\"twist\":{\"axis\":\"z\",\"degrees\":40}}");
        ffd_lattice *moved;
        ffd_embedding *embedding = embed(lattice, xyz);
        size_t size[3];
        ffd_lattice_get_size(lattice, size);
        const size_t n = size[0] * size[1] * size[2];
        double *const weights = ffd_alloc(n, sizeof *weights), *const jacobian =
                                                                   ffd_alloc(n, ROWS * sizeof(double));
        double *const ordered = ffd_alloc(n, ROWS * sizeof(double)), *const back = ffd_alloc(n, sizeof *back);
        double largest = 0;
        for (size_t j = 0; j < n; j++)
            weights[j] = r == 0 ? 1 : draw_between(&d, 0.5, 2);
        assert_int_equal(ffd_lattice_copy(lattice, &moved, NULL), FFD_OK);
        if (r > 0)
            assert_int_equal(ffd_lattice_set_weights(moved, NULL, n, weights, NULL), FFD_OK);
        assert_int_equal(ffd_embedding_weights(embedding, moved, false, jacobian, NULL, NULL), FFD_OK);
        assert_int_equal(ffd_embedding_weights(embedding, moved, true, ordered, NULL, NULL), FFD_OK);
        for (size_t j = 0; j < n; j++) {
            const size_t u = j % size[0], v = j / size[0] % size[1], w = j / (size[0] * size[1]);
            const double weight = weights[j], step = 1e-5 * weight;
            ffd_lattice *stepped;
            assert_int_equal(ffd_lattice_copy(moved, &stepped, NULL), FFD_OK);
            for (int way = 0; way < 2; way++) {
                weights[j] = way ? weight - step : weight + step;
                assert_int_equal(ffd_lattice_set_weights(stepped, NULL, n, weights, NULL), FFD_OK);
                deform(embedding, stepped, xyz, way ? behind : ahead);
            }
            weights[j] = weight;
            for (size_t i = 0; i < ROWS; i++) {
                const double found = jacobian[i * n + j];
                assert_true(ordered[i * n + (u * size[1] + v) * size[2] + w] == found);
                largest = fmax(largest, fabs(found));
                if (isfinite(xyz[i]))
                    assert_true(fabs((ahead[i] - behind[i]) / (2 * step) - found) < 1e-8);
            }
            ffd_lattice_destroy(&stepped);
        }
        assert_true(largest > 0.01);
        assert_int_equal(ffd_embedding_weights_times(embedding, moved, weights, dx, NULL, NULL), FFD_OK);
        assert_int_equal(ffd_embedding_weights_transposed(embedding, moved, dfdx, back, NULL, NULL), FFD_OK);
        products_agree(jacobian, n, weights, dx, dfdx, back);
        ffd_free(weights);
        ffd_free(jacobian);
        ffd_free(ordered);
        ffd_free(back);
        ffd_embedding_destroy(&embedding);
        ffd_lattice_destroy(&moved);
        ffd_lattice *gone = lattice;
        ffd_lattice_destroy(&gone);
    }
    (void)state;
}

/* Reads a lattice of a rest and moves, with the placeholders of PARAMETERS; one of them has another value. */
static ffd_status read(const char *rest, const char *moves, const char *name, double value,
                       ffd_lattice **lattice, ffd_error *error)
{
    char text[4096], number[40];
    bool used = false;
    snprintf(text, sizeof text, "{\"format\":\"ffd-lattice\",\"version\":1,%s%s,\"moves\":[%s]}", rest,
             PARAMETERS, moves);
    snprintf(number, sizeof number, "%.17g", value);
    return ffd_lattice_parse_set(text, strlen(text), "t.json", &(ffd_setting){name, number}, 1, &used,
                                 lattice, error);
}

static void placeholders_are_differences(void **state)
{
    static const char *const samples[][2] = {
        {BOX, "{\"by\":{\"$\":\"S\"},\"at\":[-1,\"all\",\"all\"]},{\"twist\":{\"axis\":\"z\",\"degrees\":{\"$"
              "\":\"A\"}}}"},
        {WEIGHTED, "{\"rotate\":{\"axis\":[1,2,0],\"degrees\":{\"$\":\"A\"}}},{\"by\":{\"$\":\"S\"},"
                   "\"weight\":{\"$\":\"B\"}}"},
        {ARCS, "{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"exact\":true,\"degrees\":{\"$\":\"A\"}}},{"
               "\"by\":{\"$\":\"S\"}}"},
    };
    static double xyz[ROWS], ahead[ROWS], behind[ROWS], dx[ROWS], dfdx[ROWS], jacobian[8 * ROWS];
    draw d = {draw_seed()};
    fill_points(xyz, &d);
    for (size_t i = 0; i < ROWS; i++)
        dfdx[i] = draw_between(&d, -1, 1);
    for (size_t s = 0; s < sizeof samples / sizeof *samples; s++) {
        ffd_lattice *lattice, *stepped;
        assert_int_equal(read(samples[s][0], samples[s][1], "A", 35, &lattice, NULL), FFD_OK);
        ffd_embedding *embedding = embed(lattice, xyz);
        const size_t m = ffd_lattice_get_column_count(lattice);
        assert_int_equal(m, s == 1 ? 5 : 4);
        assert_int_equal(ffd_embedding_parameters(embedding, lattice, jacobian, NULL, NULL), FFD_OK);
        size_t column = 0;
        char *name = NULL;
        for (; column < m; column++) {
            ffd_free(name);
            assert_int_equal(ffd_lattice_get_column(lattice, column, &name, NULL), FFD_OK);
            if (strcmp(name, "A") == 0)
                break;
        }
        assert_string_equal(name, "A");
        ffd_free(name);
        for (int way = 0; way < 2; way++) {
            assert_int_equal(
                read(samples[s][0], samples[s][1], "A", way ? 35 - 1e-4 : 35 + 1e-4, &stepped, NULL), FFD_OK);
            deform(embedding, stepped, xyz, way ? behind : ahead);
            ffd_lattice_destroy(&stepped);
        }
        double largest = 0;
        for (size_t i = 0; i < ROWS; i++) {
            const double found = jacobian[i * m + column];
            largest = fmax(largest, fabs(found));
            if (isfinite(xyz[i]))
                assert_true(fabs((ahead[i] - behind[i]) / 2e-4 - found) < 1e-9);
        }
        assert_true(largest > 0.001);
        const double change[] = {0.3, -0.1, 0.2, 0.7, 0.4};
        double back[5];
        assert_int_equal(ffd_embedding_parameters_times(embedding, lattice, change, dx, NULL, NULL), FFD_OK);
        assert_int_equal(ffd_embedding_parameters_transposed(embedding, lattice, dfdx, back, NULL, NULL),
                         FFD_OK);
        products_agree(jacobian, m, change, dx, dfdx, back);
        ffd_embedding_destroy(&embedding);
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

static void columns_are_named_in_the_order_of_their_use(void **state)
{
    static const char *const wanted[] = {"S[0]", "S[1]", "S[2]", "A"};
    ffd_lattice *lattice;
    ffd_error error;
    char *name;
    assert_int_equal(read(BOX,
                          "{\"by\":{\"$\":\"S\"}},{\"twist\":{\"axis\":\"z\",\"degrees\":{\"$\":\"A\"}}}",
                          "A", 1, &lattice, NULL),
                     FFD_OK);
    assert_int_equal(ffd_lattice_get_column_count(lattice), 4);
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(ffd_lattice_get_column(lattice, i, &name, NULL), FFD_OK);
        assert_string_equal(name, wanted[i]);
        ffd_free(name);
    }
    assert_int_equal(ffd_lattice_get_column(lattice, 4, &name, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.message, "there is no column 4: the lattice has 4");
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void what_has_no_derivative_is_refused(void **state)
{
    static double xyz[ROWS], out[8 * ROWS];
    draw d = {draw_seed()};
    ffd_lattice *lattice, *other = make(WEIGHTED, "");
    ffd_error error;
    fill_points(xyz, &d);
    assert_int_equal(
        read(BOX, "{\"jitter\":{\"sigma\":0.1,\"seed\":{\"$\":\"A\"}}}", "A", 3, &lattice, &error),
        FFD_E_INVALID);
    assert_string_equal(error.message, "there is no derivative by \"A\": here it is the seed of a jitter");
    assert_int_equal(read(BOX, "{\"by\":{\"$\":\"S\"}}", "B", 1, &lattice, NULL), FFD_OK);
    ffd_embedding *embedding = embed(lattice, xyz);
    assert_int_equal(ffd_embedding_parameters(embedding, other, out, NULL, &error), FFD_E_INVALID);
    assert_int_equal(ffd_embedding_weights(embedding, other, false, out, NULL, &error), FFD_E_INVALID);
    assert_int_equal(ffd_embedding_weights_transposed(embedding, other, out, out, NULL, &error),
                     FFD_E_INVALID);
    assert_int_equal(ffd_lattice_set_offsets(lattice, NULL, 1, (double[]){1, 0, 0}, NULL), FFD_OK);
    assert_int_equal(ffd_embedding_parameters_times(embedding, lattice, out, out, NULL, &error),
                     FFD_E_INVALID);
    assert_string_equal(error.message,
                        "control points of the lattice were set: they do not follow its placeholders");
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&lattice);
    ffd_lattice_destroy(&other);
    (void)state;
}

static void memory_may_run_out_anywhere(void **state)
{
    static double xyz[ROWS], out[8 * ROWS];
    draw d = {draw_seed()};
    ffd_lattice *lattice;
    fill_points(xyz, &d);
    assert_int_equal(
        read(ARCS, "{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"exact\":true,\"degrees\":{\"$\":\"A\"}}}",
             "A", 35, &lattice, NULL),
        FFD_OK);
    ffd_embedding *embedding = embed(lattice, xyz);
    const double one = 1;
    for (int call = 0; call < 3; call++) {
        ffd_status status = FFD_E_MEMORY;
        for (long fails = 0; status != FFD_OK; fails++) {
            ffd_alloc_fail_after(fails);
            status = call == 0 ? ffd_embedding_parameters(embedding, lattice, out, NULL, NULL)
                     : call == 1
                         ? ffd_embedding_parameters_times(embedding, lattice, &one, out, NULL, NULL)
                         : ffd_embedding_parameters_transposed(embedding, lattice, xyz, out, NULL, NULL);
            ffd_alloc_fail_after(-1);
            assert_true(status == FFD_OK || status == FFD_E_MEMORY);
            assert_true(fails < 1000);
        }
    }
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_are_differences),
        cmocka_unit_test(placeholders_are_differences),
        cmocka_unit_test(columns_are_named_in_the_order_of_their_use),
        cmocka_unit_test(what_has_no_derivative_is_refused),
        cmocka_unit_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
