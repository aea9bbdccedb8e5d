/* test_weights.c - weights of points in memory: the reference case, the bits of a job, weights of 0 and 1,
   some of the points, what is refused: test_weights FILE (tests/cli/authoring/weight-npy.json) */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_text.h"
#include "base/file/input.h"
#include "base/memory/memory.h"
#include "json/json_parse.h"
#include <ffd/ffd.h>
#include <math.h>

/* A bent sheet of SIDE x SIDE points, and a row of points at the places of its last row. */
#define SIDE ((size_t)41)
#define POINTS (SIDE * SIDE + SIDE)
#define TRIANGLES (2 * (SIDE - 1) * (SIDE - 1))

static const char *path;

typedef struct sheet {
    double points[3 * POINTS], normals[3 * POINTS], weights[POINTS];
    double slopes[3 * POINTS], gradients[9 * POINTS], moved[3 * POINTS];
    uint32_t triangles[3 * TRIANGLES];
    ffd_lattice *lattice;
    ffd_embedding *embedding;
} sheet;

static sheet one;

static ffd_span span(void *numbers, size_t count)
{
    return (ffd_span){numbers, count, FFD_FLOAT64, 0, 0};
}

static void fine(ffd_status status, const ffd_error *error)
{
    if (status)
        fail_msg("%s", error->message);
}

static ffd_embedding *embedded(const ffd_lattice *lattice, ffd_span points)
{
    ffd_embedding_desc desc;
    ffd_embedding *embedding;
    ffd_error error = {0};
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = lattice;
    desc.points = points;
    fine(ffd_embedding_create(&desc, NULL, &embedding, &error), &error);
    return embedding;
}

static void make_unit(double *v)
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] /= length;
}

static void fill(size_t at, size_t column, size_t row, draw *d)
{
    const double x = 2.0 * (double)column / (SIDE - 1) - 1, y = 2.0 * (double)row / (SIDE - 1) - 1;
    const double point[3] = {x, y, 0.3 * sin(2 * x) * y},
                 normal[3] = {-0.6 * cos(2 * x) * y, -0.3 * sin(2 * x), 1};
    for (size_t k = 0; k < 3; k++) {
        one.points[3 * at + k] = point[k];
        one.normals[3 * at + k] = normal[k];
    }
    make_unit(one.normals + 3 * at);
    one.weights[at] = draw_int(d, 0, 9) == 0 ? 0 : 0.5 + 0.5 * sin(3 * x + 2 * y);
}

static int begin(void **state)
{
    draw d = {draw_seed()};
    size_t t = 0;
    (void)state;
    for (size_t row = 0; row < SIDE; row++)
        for (size_t column = 0; column < SIDE; column++)
            fill(SIDE * row + column, column, row, &d);
    for (size_t column = 0; column < SIDE; column++)
        fill(SIDE * SIDE + column, column, SIDE - 1, &d);
    for (size_t row = 0; row + 1 < SIDE; row++)
        for (size_t column = 0; column + 1 < SIDE; column++) {
            /* The last row of triangles ends at the further points: a seam. */
            const uint32_t a = (uint32_t)(SIDE * row + column), above = a + (uint32_t)SIDE;
            const uint32_t corners[6] = {a, a + 1, above + 1, a, above + 1, above};
            memcpy(one.triangles + t, corners, sizeof corners);
            t += 6;
        }
    for (size_t i = 0; i < 3 * TRIANGLES; i += 7)
        if (one.triangles[i] >= SIDE * (SIDE - 1))
            one.triangles[i] += (uint32_t)SIDE;
    one.lattice = make(
        "\"size\":[5,4,4],\"rest\":{\"box\":{\"min\":[-1.2,-1.2,-1],\"max\":[1.2,1.2,1]}}",
        "{\"twist\":{\"axis\":\"z\",\"degrees\":40}},{\"at\":[-1,\"all\",\"all\"],\"by\":[0.3,0.1,-0.2]}");
    one.embedding = embedded(one.lattice, span(one.points, POINTS));
    return 0;
}

static int end(void **state)
{
    (void)state;
    ffd_embedding_destroy(&one.embedding);
    ffd_lattice_destroy(&one.lattice);
    return 0;
}

/* Deforms the sheet with these weights, and with slopes of its triangles. */
static void deform(const double *weights, const ffd_run_options *options, double *moved, double *gradients)
{
    ffd_error error = {0};
    fine(ffd_weight_slopes(span(one.points, POINTS), weights, one.triangles, TRIANGLES, one.slopes, options,
                           &error),
         &error);
    fine(ffd_embedding_deform_weighted(one.embedding, one.lattice, weights, one.slopes,
                                       span(one.points, POINTS), span(moved, POINTS), gradients, options,
                                       &error),
         &error);
}

/* The numbers of a member of the reference case, one after the other. */
static size_t numbers_of(const json_tree *tree, uint32_t array, double *numbers)
{
    size_t count = 0;
    for (uint32_t v = array + 1; v < tree->values[array].next; v++)
        count += ffd_json_tree_number(tree, v, &numbers[count]);
    return count;
}

static void assert_near(const double *found, const double *expected, size_t count, double tolerance)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs(found[i] - expected[i]) <= tolerance))
            fail_msg("number %zu is %.17g, not %.17g", i, found[i], expected[i]);
}

static void the_reference_case(void **state)
{
    enum { MOST = 64 };
    static double points[3 * MOST], normals[3 * MOST], weights[MOST], corners[3 * MOST], slopes[3 * MOST],
        gradients[9 * MOST], moved[3 * MOST], expected[3 * MOST];
    static uint32_t triangles[3 * MOST];
    file_input file;
    json_tree tree;
    ffd_lattice *lattice;
    ffd_error error = {0};
    double tolerance;
    (void)state;
    fine(ffd_file_load(path, &file, &error), &error);
    const char *const text = (const char *)file.data;
    const json_input input = {.text = text, .size = file.size, .name = path};
    fine(ffd_json_parse(&input, &tree, &error), &error);
    const uint32_t expect = ffd_json_tree_member(&tree, 0, "expect"),
                   described = ffd_json_tree_member(&tree, 0, "lattice");
    const size_t count = numbers_of(&tree, ffd_json_tree_member(&tree, 0, "weight"), weights),
                 triangle_count = numbers_of(&tree, ffd_json_tree_member(&tree, 0, "triangles"), corners) / 3;
    assert_true(count > 0 && triangle_count > 0);
    assert_int_equal(numbers_of(&tree, ffd_json_tree_member(&tree, 0, "before"), points), 3 * count);
    numbers_of(&tree, ffd_json_tree_member(&tree, 0, "normals"), normals);
    for (size_t i = 0; i < 3 * triangle_count; i++)
        triangles[i] = (uint32_t)corners[i];
    fine(ffd_lattice_parse(text + tree.values[described].begin,
                           tree.values[described].end - tree.values[described].begin, "case", &lattice,
                           &error),
         &error);
    ffd_embedding *embedding = embedded(lattice, span(points, count));
    /* Weights beside 0 to 1 are refused here, where the command clamps them. */
    assert_int_equal(ffd_embedding_deform_weighted(embedding, lattice, weights, NULL, span(points, count),
                                                   span(moved, count), NULL, NULL, &error),
                     FFD_E_INVALID);
    for (size_t i = 0; i < count; i++)
        weights[i] = fmin(fmax(weights[i], 0), 1);
    fine(ffd_weight_slopes(span(points, count), weights, triangles, triangle_count, slopes, NULL, &error),
         &error);
    fine(ffd_embedding_deform_weighted(embedding, lattice, weights, slopes, span(points, count),
                                       span(moved, count), gradients, NULL, &error),
         &error);
    fine(ffd_normals_deform(gradients, span(normals, count), span(normals, count), NULL, NULL, &error),
         &error);
    assert_int_equal(numbers_of(&tree, ffd_json_tree_member(&tree, expect, "after"), expected), 3 * count);
    assert_true(ffd_json_tree_number(&tree, ffd_json_tree_member(&tree, expect, "tolerance"), &tolerance));
    assert_near(moved, expected, 3 * count, tolerance);
    assert_int_equal(numbers_of(&tree, ffd_json_tree_member(&tree, expect, "normals"), expected), 3 * count);
    assert_true(
        ffd_json_tree_number(&tree, ffd_json_tree_member(&tree, expect, "normal_tolerance"), &tolerance));
    assert_near(normals, expected, 3 * count, tolerance);
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&lattice);
    ffd_json_tree_free(&tree);
    ffd_file_unload(&file);
}

/* What a job writes. */
typedef struct output {
    char *bytes;
    size_t size;
} output;

static ffd_status take(void *user, const char *name, const void *bytes, size_t size)
{
    output *const o = user;
    (void)name;
    assert_null(o->bytes);
    o->bytes = malloc(size);
    o->size = size;
    memcpy(o->bytes, bytes, size);
    return FFD_OK;
}

/* Appends the sheet as a binary PLY of doubles. Returns the size of its head. */
static size_t write_ply(char *text, size_t *size)
{
    const int head = sprintf(
        text,
        "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty double x\nproperty double y\n"
        "property double z\nproperty double nx\nproperty double ny\nproperty double nz\n"
        "element face %zu\nproperty list uchar uint vertex_indices\nend_header\n",
        POINTS, TRIANGLES);
    char *to = text + head;
    for (size_t i = 0; i < POINTS; i++) {
        memcpy(to, one.points + 3 * i, 24);
        memcpy(to + 24, one.normals + 3 * i, 24);
        to += 48;
    }
    for (size_t t = 0; t < TRIANGLES; t++) {
        *to = 3;
        memcpy(to + 1, one.triangles + 3 * t, 12);
        to += 13;
    }
    *size = (size_t)(to - text);
    return (size_t)head;
}

static size_t write_npy(char *text, const double *weights)
{
    const int length = sprintf(
        text, "\x93NUMPY\x01%cX%c{'descr': '<f8', 'fortran_order': False, 'shape': (%zu,), }", 0, 0, POINTS);
    memset(text + length, ' ', (size_t)(128 - length));
    text[8] = 118;
    text[127] = '\n';
    memcpy(text + 128, weights, 8 * POINTS);
    return 128 + 8 * POINTS;
}

static void the_bits_of_a_job(void **state)
{
    static char mesh[1 << 20], array[1 << 16];
    size_t size;
    const size_t head = write_ply(mesh, &size);
    ffd_deform_desc desc;
    output out = {NULL, 0};
    ffd_error error = {0};
    ffd_job_result result = {.struct_size = sizeof result};
    double *numbers = malloc(48 * POINTS);
    (void)state;
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input.path = "in.ply";
    desc.input.bytes = (ffd_bytes){mesh, size};
    desc.output = "out.ply";
    desc.lattices = &(ffd_lattice_source){.object = one.lattice};
    desc.lattice_count = 1;
    desc.weight.bytes = (ffd_bytes){array, write_npy(array, one.weights)};
    desc.sink = take;
    desc.sink_user = &out;
    fine(ffd_deform_run(&desc, &result, &error), &error);
    assert_int_equal(out.size, size);
    memcpy(numbers, out.bytes + head, 48 * POINTS);
    deform(one.weights, NULL, one.moved, one.gradients);
    fine(ffd_normals_deform(one.gradients, span(one.normals, POINTS), span(one.normals, POINTS), NULL, NULL,
                            &error),
         &error);
    for (size_t i = 0; i < POINTS; i++) {
        assert_memory_equal(numbers + 6 * i, one.moved + 3 * i, 24);
        assert_memory_equal(numbers + 6 * i + 3, one.normals + 3 * i, 24);
    }
    uint64_t zero = 0;
    for (size_t i = 0; i < POINTS; i++)
        zero += one.weights[i] <= 0;
    assert_int_equal(result.weight.zero, zero);
    /* An array with a name of the caller's; a text that is no file has no bytes. */
    free(out.bytes);
    out.bytes = NULL;
    desc.weight.source = "1-mask.npy";
    fine(ffd_deform_run(&desc, &result, &error), &error);
    assert_int_equal(result.weight.one, zero);
    free(out.bytes);
    out.bytes = NULL;
    desc.weight.source = "color:r";
    assert_int_equal(ffd_deform_run(&desc, &result, &error), FFD_E_ARGUMENT);
    free(numbers);
}

static void weights_of_0_and_of_1(void **state)
{
    static double plain[3 * POINTS], derivatives[9 * POINTS], weights[POINTS];
    ffd_error error = {0};
    (void)state;
    fine(ffd_embedding_deform(one.embedding, one.lattice, span(one.points, POINTS), span(plain, POINTS),
                              derivatives, NULL, &error),
         &error);
    for (size_t i = 0; i < POINTS; i++)
        weights[i] = 1;
    deform(weights, NULL, one.moved, one.gradients);
    assert_memory_equal(one.moved, plain, sizeof plain);
    assert_memory_equal(one.gradients, derivatives, sizeof derivatives);
    for (size_t i = 0; i < 3 * POINTS; i++)
        assert_true(one.slopes[i] == 0 && !signbit(one.slopes[i]));
    memset(weights, 0, sizeof weights);
    deform(weights, NULL, one.moved, one.gradients);
    assert_memory_equal(one.moved, one.points, sizeof one.points);
    for (size_t i = 0; i < 9 * POINTS; i++)
        assert_true(one.gradients[i] == 0);
    /* One by one, beside others; and w d is what the displacement is times the weight. */
    deform(one.weights, NULL, one.moved, NULL);
    for (size_t i = 0; i < 3 * POINTS; i++) {
        const double w = one.weights[i / 3];
        if (w <= 0)
            assert_memory_equal(&one.moved[i], &one.points[i], 8);
        assert_true(fabs(one.moved[i] - (one.points[i] + w * (plain[i] - one.points[i]))) <= 1e-15);
    }
}

static void some_threads_and_instruction_sets(void **state)
{
    static double moved[3 * POINTS], gradients[9 * POINTS], slopes[3 * POINTS], some[3 * POINTS];
    uint32_t list[POINTS / 3 + 1];
    size_t count = 0;
    ffd_error error = {0};
    (void)state;
    deform(one.weights, NULL, moved, gradients);
    memcpy(slopes, one.slopes, sizeof slopes);
    for (int isa = FFD_ISA_AUTO; isa <= FFD_ISA_NEON; isa++)
        for (int threads = 1; threads <= 7 && ffd_isa_available((ffd_isa)isa); threads += 2) {
            ffd_run_options options;
            ffd_run_options_init(&options, sizeof options);
            options.threads = threads;
            options.isa = (ffd_isa)isa;
            deform(one.weights, &options, one.moved, one.gradients);
            assert_memory_equal(one.moved, moved, sizeof moved);
            assert_memory_equal(one.gradients, gradients, sizeof gradients);
            assert_memory_equal(one.slopes, slopes, sizeof slopes);
        }
    for (size_t i = 1; i < POINTS; i += 3)
        list[count++] = (uint32_t)i;
    memset(some, 0x55, sizeof some);
    fine(ffd_embedding_deform_some_weighted(one.embedding, one.lattice, list, count, one.weights, slopes,
                                            span(one.points, POINTS), span(some, POINTS), NULL, NULL, &error),
         &error);
    for (size_t i = 0; i < POINTS; i++)
        if (i % 3 == 1)
            assert_memory_equal(some + 3 * i, moved + 3 * i, 24);
        else
            assert_int_equal(((unsigned char *)some)[24 * i], 0x55);
}

static void what_is_wrong_is_refused_by_its_index(void **state)
{
    const double wrong[] = {-1e-300, 1 + 1e-15, (double)NAN, (double)INFINITY, -(double)INFINITY};
    static double weights[POINTS];
    const uint32_t list[] = {3, 77}, apart[] = {3, 78}, beyond[] = {0, 1, (uint32_t)POINTS};
    const ffd_span in = span(one.points, POINTS), out = span(one.moved, POINTS);
    ffd_error error = {0};
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        memcpy(weights, one.weights, sizeof weights);
        weights[77] = wrong[i];
        assert_int_equal(ffd_embedding_deform_weighted(one.embedding, one.lattice, weights, NULL, in, out,
                                                       NULL, NULL, &error),
                         FFD_E_INVALID);
        assert_non_null(strstr(error.message, "point 77"));
        assert_int_equal(ffd_weight_slopes(in, weights, one.triangles, TRIANGLES, one.slopes, NULL, &error),
                         FFD_E_INVALID);
        assert_non_null(strstr(error.message, "point 77"));
        assert_int_equal(ffd_embedding_deform_some_weighted(one.embedding, one.lattice, list, 2, weights,
                                                            NULL, in, out, NULL, NULL, &error),
                         FFD_E_INVALID);
        /* The others are not looked at. */
        fine(ffd_embedding_deform_some_weighted(one.embedding, one.lattice, apart, 2, weights, NULL, in, out,
                                                NULL, NULL, &error),
             &error);
    }
    assert_int_equal(
        ffd_embedding_deform_weighted(one.embedding, one.lattice, NULL, NULL, in, out, NULL, NULL, &error),
        FFD_E_ARGUMENT);
    assert_int_equal(ffd_weight_slopes(in, NULL, one.triangles, TRIANGLES, one.slopes, NULL, &error),
                     FFD_E_ARGUMENT);
    assert_int_equal(ffd_weight_slopes(in, one.weights, NULL, 1, one.slopes, NULL, &error), FFD_E_ARGUMENT);
    assert_int_equal(ffd_weight_slopes(in, one.weights, one.triangles, TRIANGLES, NULL, NULL, &error),
                     FFD_E_ARGUMENT);
    assert_int_equal(ffd_weight_slopes(in, one.weights, beyond, 1, one.slopes, NULL, &error), FFD_E_ARGUMENT);
    assert_non_null(strstr(error.message, "triangle 0"));
    /* Nothing is no error. */
    fine(ffd_weight_slopes(in, one.weights, NULL, 0, one.slopes, NULL, &error), &error);
    for (size_t i = 0; i < 3 * POINTS; i++)
        assert_true(one.slopes[i] == 0);
    fine(ffd_weight_slopes(span(NULL, 0), NULL, NULL, 0, NULL, NULL, &error), &error);
}

static bool stop(void *user, double done)
{
    (void)done;
    ++*(int *)user;
    return false;
}

static void calls_can_be_cancelled(void **state)
{
    ffd_run_options options;
    ffd_error error = {0};
    int calls = 0;
    (void)state;
    ffd_run_options_init(&options, sizeof options);
    options.progress = stop;
    options.user = &calls;
    assert_int_equal(ffd_weight_slopes(span(one.points, POINTS), one.weights, one.triangles, TRIANGLES,
                                       one.slopes, &options, &error),
                     FFD_E_CANCELLED);
    assert_int_equal(ffd_embedding_deform_weighted(one.embedding, one.lattice, one.weights, NULL,
                                                   span(one.points, POINTS), span(one.moved, POINTS), NULL,
                                                   &options, &error),
                     FFD_E_CANCELLED);
    assert_true(calls >= 2);
}

static void every_allocation_may_fail(void **state)
{
    ffd_error error = {0};
    size_t failures = 0;
    ffd_status status = FFD_E_MEMORY;
    (void)state;
    for (long n = 0; status != FFD_OK; n++) {
        ffd_alloc_fail_after(n);
        status = ffd_weight_slopes(span(one.points, POINTS), one.weights, one.triangles, TRIANGLES,
                                   one.slopes, NULL, &error);
        ffd_alloc_fail_after(-1);
        assert_true(status == FFD_OK || status == FFD_E_MEMORY);
        failures += status != FFD_OK;
    }
    assert_true(failures >= 2);
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_reference_case),
        cmocka_unit_test(weights_of_0_and_of_1),
        cmocka_unit_test(some_threads_and_instruction_sets),
        cmocka_unit_test(what_is_wrong_is_refused_by_its_index),
        cmocka_unit_test(calls_can_be_cancelled),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(the_bits_of_a_job), /* last: it deforms the normals */
    };
    path = count > 1 ? arguments[1] : "";
    return cmocka_run_group_tests(tests, begin, end);
}
