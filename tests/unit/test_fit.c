/* ffd_fit_points, beside right answers (40-digit solves: files of tests/cli/authoring, the arguments), dense
   systems, and lattices that are known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/repetitions.h"
#include "base/file/input.h"
#include "base/memory/memory.h"
#include "fit/band.h"
#include "json/json_parse.h"
#include <ffd/fit.h>
#include <ffd/lattice.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { MOST_PAIRS = 5000 * 4 * 4 * 4 };

static int file_count;
static char **files;

static double source[3 * MOST_PAIRS], target[3 * MOST_PAIRS], weights[MOST_PAIRS], residuals[MOST_PAIRS];
static size_t exact[MOST_PAIRS];

static ffd_lattice *parsed(const char *text)
{
    ffd_lattice *lattice = NULL;
    ffd_error error = {0};
    if (ffd_lattice_parse(text, strlen(text), "test", &lattice, &error))
        fail_msg("%s", error.message);
    return lattice;
}

static ffd_fit_desc describe(const ffd_lattice *base, size_t count)
{
    ffd_fit_desc desc;
    ffd_fit_desc_init(&desc, sizeof desc);
    desc.base = base;
    desc.source = (ffd_span){.data = source, .count = count};
    desc.target = (ffd_span){.data = target, .count = count};
    desc.smoothing = FFD_FIT_GIVEN;
    return desc;
}

static ffd_lattice *fitted(const ffd_fit_desc *desc, ffd_fit_result *result)
{
    ffd_lattice *lattice = NULL;
    ffd_error error = {0};
    result->struct_size = sizeof *result;
    if (ffd_fit_points(desc, NULL, &lattice, residuals, result, &error))
        fail_msg("%s", error.message);
    return lattice;
}

/* A case of the files. */
typedef struct fit_case {
    file_input file;
    json_tree tree;
    uint32_t expect;
    size_t count, exact_count;
} fit_case;

static double number_of(const fit_case *c, uint32_t value)
{
    double number = NAN;
    assert_true(ffd_json_tree_number(&c->tree, value, &number));
    return number;
}

static void read_triples(const fit_case *c, uint32_t list, double *numbers)
{
    for (uint32_t row = ffd_json_tree_first(&c->tree, list); row != JSON_NONE;
         row = ffd_json_tree_after(&c->tree, row))
        for (uint32_t v = ffd_json_tree_first(&c->tree, row); v != JSON_NONE;
             v = ffd_json_tree_after(&c->tree, v))
            *numbers++ = number_of(c, v);
}

static void read_weights(fit_case *c)
{
    const uint32_t list = ffd_json_tree_member(&c->tree, 0, "weight");
    uint32_t value = list == JSON_NONE ? JSON_NONE : ffd_json_tree_first(&c->tree, list);
    for (size_t i = 0; i < c->count; i++) {
        const bool is_exact = value != JSON_NONE && c->tree.values[value].kind == JSON_STRING;
        weights[i] = value == JSON_NONE || is_exact ? 1 : number_of(c, value);
        if (is_exact)
            exact[c->exact_count++] = i;
        value = value == JSON_NONE ? value : ffd_json_tree_after(&c->tree, value);
    }
}

static fit_case read_case(const char *name)
{
    fit_case c = {.count = 0};
    assert_int_equal(ffd_file_load(name, &c.file, NULL), FFD_OK);
    const json_input text = {.text = (const char *)c.file.data, .size = c.file.size, .name = name};
    assert_int_equal(ffd_json_parse(&text, &c.tree, NULL), FFD_OK);
    const uint32_t before = ffd_json_tree_member(&c.tree, 0, "before");
    c.expect = ffd_json_tree_member(&c.tree, 0, "expect");
    c.count = ffd_json_tree_count(&c.tree, before);
    assert_true(c.count <= MOST_PAIRS);
    read_triples(&c, before, source);
    read_triples(&c, ffd_json_tree_member(&c.tree, 0, "after"), target);
    read_weights(&c);
    return c;
}

static void check_offsets(const fit_case *c, const ffd_lattice *made)
{
    static double expected[3 * 1000];
    const uint32_t offsets = ffd_json_tree_member(&c->tree, c->expect, "offsets");
    const double tolerance = number_of(c, ffd_json_tree_member(&c->tree, c->expect, "tolerance"));
    const double *const found = ffd_lattice_get_offsets(made);
    const size_t count = ffd_json_tree_count(&c->tree, offsets);
    assert_true(count <= 1000);
    read_triples(c, offsets, expected);
    for (size_t i = 0; i < 3 * count; i++)
        if (!(fabs(found[i] - expected[i]) <= tolerance))
            fail_msg("offset %zu: %.17g, not %.17g", i / 3, found[i], expected[i]);
}

static void check_figures(const fit_case *c, const ffd_fit_result *result)
{
    const uint32_t residual = ffd_json_tree_member(&c->tree, c->expect, "residual");
    const double max = number_of(c, ffd_json_tree_member(&c->tree, residual, "max"));
    const double rms = number_of(c, ffd_json_tree_member(&c->tree, residual, "rms"));
    double affine[12];
    read_triples(c, ffd_json_tree_member(&c->tree, c->expect, "affine"), affine);
    assert_true(fabs(result->residual_max - max) < 1e-12 && fabs(result->residual_rms - rms) < 1e-12);
    for (int i = 0; i < 12; i++)
        assert_true(fabs(result->affine[i] - affine[i]) < 1e-12);
    assert_true(c->exact_count == 0 ? isnan(result->residual_exact) : result->residual_exact < 1e-13);
    assert_true(result->exact == c->exact_count && result->dependent == 0 && result->used == c->count);
}

static void fits_are_the_right_answers(void **state)
{
    (void)state;
    assert_true(file_count > 0);
    for (int f = 0; f < file_count; f++) {
        fit_case c = read_case(files[f]);
        char *const text = ffd_json_tree_text(&c.tree, ffd_json_tree_member(&c.tree, 0, "base"));
        ffd_lattice *base = parsed(text);
        ffd_fit_desc desc = describe(base, c.count);
        ffd_fit_result result;
        desc.weights = weights;
        desc.exact = exact;
        desc.exact_count = c.exact_count;
        desc.handles = strstr(files[f], "handle-") != NULL;
        desc.smooth = number_of(&c, ffd_json_tree_member(&c.tree, 0, "smooth"));
        ffd_lattice *made = fitted(&desc, &result);
        check_offsets(&c, made);
        check_figures(&c, &result);
        ffd_lattice_destroy(&made);
        ffd_lattice_destroy(&base);
        ffd_free(text);
        ffd_json_tree_free(&c.tree);
        ffd_file_unload(&c.file);
    }
}

/* Places in the unit cube, and where a lattice takes them. */
static void draw_pairs(draw *d, const ffd_lattice *known, size_t count)
{
    ffd_embedding *embedding = NULL;
    ffd_embedding_desc desc;
    for (size_t i = 0; i < 3 * count; i++)
        source[i] = draw_between(d, 0.001, 0.999);
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = known;
    desc.points = (ffd_span){.data = source, .count = count};
    const ffd_span to = {.data = target, .count = count};
    assert_int_equal(ffd_embedding_create(&desc, NULL, &embedding, NULL), FFD_OK);
    assert_int_equal(ffd_embedding_deform(embedding, known, desc.points, to, NULL, NULL, NULL), FFD_OK);
    ffd_embedding_destroy(&embedding);
}

static ffd_lattice *box(const char *knots, const int size[3])
{
    char text[400];
    snprintf(text, sizeof text,
             "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[%d,%d,%d],\"knots\":[\"%s\",\"%s\",\"%s\"],"
             "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1]}}}",
             size[0], size[1], size[2], knots, knots, knots);
    return parsed(text);
}

static ffd_lattice *moved_at_random(draw *d, const ffd_lattice *base)
{
    ffd_lattice *known = NULL;
    size_t size[3];
    assert_int_equal(ffd_lattice_copy(base, &known, NULL), FFD_OK);
    ffd_lattice_get_size(base, size);
    for (size_t i = 0; i < size[0] * size[1] * size[2]; i++) {
        const double offset[3] = {draw_between(d, -0.1, 0.1), draw_between(d, -0.1, 0.1),
                                  draw_between(d, -0.1, 0.1)};
        assert_int_equal(ffd_lattice_set_offsets(known, &i, 1, offset, NULL), FFD_OK);
    }
    return known;
}

/* Without smoothing the lattice comes back that has made the targets. */
static void known_lattices_are_recovered(void **state)
{
    draw d = {draw_seed()};
    (void)state;
    static const size_t times[] = {2, 3, 8, 40, 300, 5000}; /* as many pairs as control points */
    for (int n = 0; n < 12; n++) {
        const int most = times[n / 2] == 5000 ? 4 : 6;
        const int size[3] = {draw_int(&d, 4, most), draw_int(&d, 4, most), draw_int(&d, 4, most)};
        const bool clamped = n % 2 == 0;
        ffd_lattice *base = box(clamped ? "clamped" : "open", size), *known = moved_at_random(&d, base);
        const size_t points = (size_t)size[0] * (size_t)size[1] * (size_t)size[2],
                     limit = (size_t)repetitions(MOST_PAIRS),
                     pairs = points * times[n / 2] < limit ? points * times[n / 2] : limit;
        ffd_fit_result result;
        draw_pairs(&d, known, pairs);
        const ffd_fit_desc desc = describe(base, pairs);
        ffd_lattice *made = fitted(&desc, &result);
        const double *const found = ffd_lattice_get_offsets(made), *const right =
                                                                       ffd_lattice_get_offsets(known);
        for (size_t i = 0; i < 3 * points; i++)
            if (!(fabs(found[i] - right[i]) <= (clamped ? 1e-9 : 1e-7)))
                fail_msg("%d,%d,%d: offset %zu: %.17g, not %.17g", size[0], size[1], size[2], i / 3, found[i],
                         right[i]);
        ffd_lattice_destroy(&made);
        ffd_lattice_destroy(&known);
        ffd_lattice_destroy(&base);
    }
}

/* Returns the entry of a random band matrix that is positive definite. */
static double entry_of(const double *factor, size_t n, size_t i, size_t j)
{
    double sum = i == j ? 1 : 0;
    for (size_t k = 0; k < n; k++)
        sum += factor[n * i + k] * factor[n * j + k];
    return sum;
}

static void band_systems_are_solved(void **state)
{
    enum { MOST = 300 };
    static double factor[MOST * MOST], x[3 * MOST], y[3 * MOST];
    draw d = {draw_seed()};
    (void)state;
    for (int round = 0; round < 12; round++) {
        const size_t n = (size_t)draw_int(&d, 1, MOST), reach = (size_t)draw_int(&d, 0, (int)n - 1);
        band_matrix band;
        bool is_positive;
        assert_int_equal(ffd_band_make(n, reach, &band, NULL), FFD_OK);
        ffd_band_clear(&band, draw_int(&d, 1, 3));
        for (size_t i = 0; i < n; i++)
            for (size_t k = 0; k < n; k++)
                factor[n * i + k] = k <= i && i - k <= reach ? draw_between(&d, -1, 1) : 0;
        for (size_t i = 0; i < 3 * n; i++)
            x[i] = draw_between(&d, -1, 1);
        memset(y, 0, sizeof y);
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) {
                const size_t high = i > j ? i : j, low = i > j ? j : i;
                if (high - low > reach)
                    continue;
                const double entry = entry_of(factor, n, i, j);
                if (j <= i)
                    *ffd_band_entry(&band, i, j) = entry;
                for (size_t c = 0; c < 3; c++)
                    y[3 * i + c] += entry * x[3 * j + c];
            }
        const band_run run = {.isa = FFD_ISA_AUTO, .threads = draw_int(&d, 1, 3)};
        assert_int_equal(ffd_band_factor(&band, &run, &is_positive, NULL), FFD_OK);
        assert_true(is_positive);
        ffd_band_forward(&band, y, 3);
        ffd_band_backward(&band, y, 3);
        for (size_t i = 0; i < 3 * n; i++)
            if (!(fabs(y[i] - x[i]) < 1e-9))
                fail_msg("%zu rows, reach %zu: %.17g, not %.17g", n, reach, y[i], x[i]);
        ffd_band_free(&band);
    }
}

/* The same bits for any number of threads and any instruction set. */
static void threads_and_instructions_change_nothing(void **state)
{
    draw d = {draw_seed()};
    ffd_lattice *base = box("open", (const int[]){9, 8, 7}), *known = moved_at_random(&d, base);
    const size_t bytes = sizeof(double) * 3 * 9 * 8 * 7;
    ffd_lattice *made[2] = {NULL, NULL};
    draw_pairs(&d, known, 9000);
    ffd_fit_desc desc = describe(base, 9000);
    desc.smoothing = FFD_FIT_AUTO;
    for (ffd_isa isa = FFD_ISA_SCALAR; isa <= FFD_ISA_NEON; isa++) {
        ffd_run_options options;
        ffd_run_options_init(&options, sizeof options);
        options.isa = isa;
        options.threads = isa == FFD_ISA_SCALAR ? 1 : draw_int(&d, 2, 4);
        if (!ffd_isa_available(isa))
            continue;
        ffd_lattice **const to = &made[isa == FFD_ISA_SCALAR ? 0 : 1];
        assert_int_equal(ffd_fit_points(&desc, &options, to, NULL, NULL, NULL), FFD_OK);
        assert_memory_equal(ffd_lattice_get_offsets(*to), ffd_lattice_get_offsets(made[0]), bytes);
        if (isa != FFD_ISA_SCALAR)
            ffd_lattice_destroy(to);
    }
    ffd_lattice_destroy(&made[0]);
    ffd_lattice_destroy(&known);
    ffd_lattice_destroy(&base);
    (void)state;
}

static void refuse(const ffd_fit_desc *desc, ffd_status status, const char *says)
{
    ffd_lattice *lattice = NULL;
    ffd_error error = {0};
    assert_int_equal(ffd_fit_points(desc, NULL, &lattice, NULL, NULL, &error), status);
    assert_null(lattice);
    if (!strstr(error.message, says))
        fail_msg("\"%s\" does not say \"%s\"", error.message, says);
}

static void what_cannot_be_met_is_refused(void **state)
{
    draw d = {draw_seed()};
    ffd_lattice *base = box("clamped", (const int[]){4, 4, 4}), *known = moved_at_random(&d, base);
    draw_pairs(&d, known, 30);
    ffd_fit_desc desc = describe(base, 30);
    memcpy(source + 3 * 8, source + 3 * 2, 3 * sizeof *source); /* rows 2 and 8 at one place */
    memcpy(target + 3 * 8, target + 3 * 2, 3 * sizeof *target);
    target[3 * 8] += 0.012;
    for (size_t i = 0; i < 9; i++)
        exact[i] = i;
    desc.exact = exact;
    desc.exact_count = 9;
    desc.smooth = 0.01;
    refuse(&desc, FFD_E_UNMET, "2 and 8 contradict each other by 0.012");
    target[3 * 8] = target[3 * 2];
    ffd_fit_result result;
    ffd_lattice *made = fitted(&desc, &result);
    assert_true(result.dependent == 1 && result.exact == 9 && result.residual_exact < 1e-13);
    ffd_lattice_destroy(&made);
    desc.exact_count = 0;
    desc.smoothing = FFD_FIT_WITHIN;
    desc.within = 1e-300;
    source[3 * 8] += 1e-9; /* nearly one place, with another target */
    target[3 * 8] += 0.012;
    refuse(&desc, FFD_E_UNMET, "no smoothing brings all pairs within 1e-300");
    desc.within = 0.02;
    made = fitted(&desc, &result);
    assert_true(result.residual_max <= 0.02 && result.smooth_chosen_by == FFD_FIT_BY_WITHIN);
    ffd_lattice_destroy(&made);
    source[4] = 7;
    desc.exact_count = 2;
    refuse(&desc, FFD_E_EMBEDDING, "the exact pair 1 is not inside");
    source[4] = NAN;
    refuse(&desc, FFD_E_INVALID, "pair 1 has a coordinate that is not finite");
    ffd_lattice_destroy(&known);
    ffd_lattice_destroy(&base);
    (void)state;
}

/* Pairs that are far off do not lead the others astray, if that is asked for. */
static void outliers_count_less(void **state)
{
    draw d = {draw_seed()};
    ffd_lattice *base = box("clamped", (const int[]){4, 4, 4}), *known = moved_at_random(&d, base);
    double off[2];
    draw_pairs(&d, known, 3000);
    for (size_t i = 0; i < 300; i++)
        target[3 * (10 * i) + i % 3] += 0.5;
    for (int robust = 0; robust < 2; robust++) {
        ffd_fit_desc desc = describe(base, 3000);
        ffd_fit_result result;
        desc.robust = robust;
        desc.smooth = 1e-6;
        ffd_lattice *made = fitted(&desc, &result);
        const double *const found = ffd_lattice_get_offsets(made), *const right =
                                                                       ffd_lattice_get_offsets(known);
        double squares = 0;
        for (size_t i = 0; i < 3 * 64; i++)
            squares += (found[i] - right[i]) * (found[i] - right[i]);
        off[robust] = sqrt(squares);
        assert_true(robust ? result.downweighted >= 300 && result.downweighted < 1000
                           : result.downweighted == 0);
        ffd_lattice_destroy(&made);
    }
    assert_true(off[1] < 0.1 * off[0]);
    ffd_lattice_destroy(&known);
    ffd_lattice_destroy(&base);
    (void)state;
}

/* An S that was chosen is raised until the lattice does not fold; one that is given stays. */
static void folds_are_avoided(void **state)
{
    draw d = {draw_seed()};
    ffd_lattice *base = box("open", (const int[]){8, 8, 8});
    ffd_fit_result result;
    (void)state;
    for (size_t i = 0; i < 2000; i++) {
        for (size_t c = 0; c < 3; c++) {
            source[3 * i + c] = draw_between(&d, 0.1, 0.9);
            target[3 * i + c] = source[3 * i + c] + draw_between(&d, -0.2, 0.2);
        }
        source[3 * i] = 0.5; /* nothing tells of what is beside this plane */
    }
    ffd_fit_desc desc = describe(base, 2000);
    desc.smooth = 1e-8;
    ffd_lattice *made = fitted(&desc, &result);
    assert_true(result.folds.verdict == FFD_FOLDS_SOME && result.smooth_chosen_by == FFD_FIT_BY_CALLER);
    ffd_lattice_destroy(&made);
    desc.smoothing = FFD_FIT_AUTO;
    made = fitted(&desc, &result);
    assert_true(result.folds.verdict == FFD_FOLDS_NONE && result.smooth >= 0.01);
    ffd_lattice_destroy(&made);
    ffd_lattice_destroy(&base);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fits_are_the_right_answers),
        cmocka_unit_test(known_lattices_are_recovered),
        cmocka_unit_test(band_systems_are_solved),
        cmocka_unit_test(threads_and_instructions_change_nothing),
        cmocka_unit_test(what_cannot_be_met_is_refused),
        cmocka_unit_test(outliers_count_less),
        cmocka_unit_test(folds_are_avoided),
    };
    file_count = argc - 1;
    files = argv + 1;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
