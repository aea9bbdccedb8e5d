/* test_draco.c - decoding of Draco data: both methods, all types, contradictions between file and data, and
   corrupt data. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draco_sample.h"
#include "../support/draw.h"
#include "../support/repetitions.h"
#include "../support/sheet.h"
#include "io/gltf/read/draco.h"
#include "io/gltf/read/draco_floats.h"
#include "io/gltf/read/gltf_model.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 9
#define POINTS (SIDE * SIDE)
#define TRIANGLES (2 * (SIDE - 1) * (SIDE - 1))
#define MUTATIONS 4000

typedef struct grid {
    float positions[3 * POINTS], normals[3 * POINTS], texcoords[2 * POINTS];
    uint16_t joints[4 * POINTS];
    uint8_t factors[POINTS];
    uint32_t triangles[3 * TRIANGLES];
    sample_mesh mesh;
} grid;

static void make_grid(grid *g)
{
    for (uint32_t i = 0; i < POINTS; i++) {
        const float x = (float)(i % SIDE) / 8, y = (float)(i / SIDE) / 8;
        const float position[3] = {x, y, x * y}, normal[3] = {0.6f, 0, 0.8f};
        memcpy(g->positions + 3 * i, position, sizeof position);
        memcpy(g->normals + 3 * i, normal, sizeof normal);
        g->texcoords[2 * i] = x / 2;
        g->texcoords[2 * i + 1] = y * y;
        for (uint32_t c = 0; c < 4; c++)
            g->joints[4 * i + c] = (uint16_t)(i + 60 * c);
        g->factors[i] = (uint8_t)(3 * i);
    }
    sheet_triangles(SIDE, g->triangles);
    g->mesh = (sample_mesh){POINTS,    TRIANGLES,  g->positions, g->normals, g->texcoords,
                            g->joints, g->factors, g->triangles, NULL,       NULL};
}

static const memory_budget any_room = {.most = 100000000};
static const draco_claim grid_claim = {POINTS, 3 * TRIANGLES};

static draco_mesh *decode_grid(const sample_options *options)
{
    static grid g;
    ffd_error error = {0};
    size_t size;
    draco_mesh *mesh = NULL;
    make_grid(&g);
    unsigned char *bytes = make_draco(&g.mesh, options, &size);
    assert_non_null(bytes);
    if (ffd_draco_decode(bytes, size, &grid_claim, &any_room, &mesh, &error))
        fail_msg("%s", error.message);
    free(bytes);
    assert_int_equal(ffd_draco_point_count(mesh), POINTS);
    assert_int_equal(ffd_draco_corner_count(mesh), 3 * TRIANGLES);
    return mesh;
}

static void read_attribute(const draco_mesh *mesh, uint32_t id, int component, int components, size_t stride,
                           void *bytes)
{
    ffd_error error = {0};
    if (ffd_draco_attribute(mesh, id, component, components, stride, bytes, &error))
        fail_msg("%s", error.message);
}

static void sequential_data_comes_back_as_it_was(void **state)
{
    (void)state;
    static grid g;
    const sample_options options = {.metadata = true};
    draco_mesh *mesh = decode_grid(&options);
    float positions[3 * POINTS], texcoords[2 * POINTS], factors[POINTS];
    uint16_t joints[4 * POINTS];
    unsigned char spread[8 * POINTS], narrow[3 * TRIANGLES];
    uint32_t corners[3 * TRIANGLES];
    make_grid(&g);
    read_attribute(mesh, SAMPLE_POSITION, GLTF_FLOAT, 3, 12, positions);
    read_attribute(mesh, SAMPLE_TEXCOORD, GLTF_FLOAT, 2, 8, texcoords);
    read_attribute(mesh, SAMPLE_JOINTS, GLTF_U16, 4, 8, joints);
    assert_memory_equal(positions, g.positions, sizeof positions);
    assert_true(ffd_draco_step(mesh, SAMPLE_POSITION) == 0);
    assert_memory_equal(texcoords, g.texcoords, sizeof texcoords);
    assert_memory_equal(joints, g.joints, sizeof joints);
    memset(spread, 0xee, sizeof spread);
    read_attribute(mesh, SAMPLE_FACTOR, GLTF_U8, 1, 8, spread);
    read_attribute(mesh, SAMPLE_FACTOR, GLTF_FLOAT, 1, 4, factors);
    for (size_t i = 0; i < POINTS; i++) {
        assert_int_equal(spread[8 * i], g.factors[i]);
        assert_int_equal(spread[8 * i + 1], 0xee);
        assert_true(fabsf(factors[i] - (float)g.factors[i] / 255) <= 0); /* normalized */
    }
    assert_int_equal(ffd_draco_indices(mesh, GLTF_U32, (unsigned char *)corners, NULL), FFD_OK);
    assert_memory_equal(corners, g.triangles, sizeof corners);
    assert_int_equal(ffd_draco_indices(mesh, GLTF_U8, narrow, NULL), FFD_OK);
    for (size_t i = 0; i < 3 * TRIANGLES; i++)
        assert_int_equal(narrow[i], g.triangles[i]);
    ffd_draco_free(mesh);
}

/* Finds the original point at a decoded position. */
static uint32_t find_point(const grid *g, const float position[3])
{
    for (uint32_t i = 0; i < POINTS; i++) {
        float distance = 0;
        for (size_t c = 0; c < 3; c++)
            distance += fabsf(g->positions[3 * i + c] - position[c]);
        if (distance < 0.01f)
            return i;
    }
    fail_msg("a point at %g %g %g", (double)position[0], (double)position[1], (double)position[2]);
    return 0;
}

/* Edgebreaker reorders points and triangles, and quantizes. */
static void edgebreaker_data_comes_back_within_its_bits(void **state)
{
    (void)state;
    static grid g;
    const sample_options options = {.edgebreaker = true, .bits = 12};
    draco_mesh *mesh = decode_grid(&options);
    float positions[3 * POINTS], normals[3 * POINTS], texcoords[2 * POINTS];
    uint16_t joints[4 * POINTS];
    uint32_t corners[3 * TRIANGLES], points[POINTS];
    size_t area = 0;
    make_grid(&g);
    read_attribute(mesh, SAMPLE_POSITION, GLTF_FLOAT, 3, 12, positions);
    read_attribute(mesh, SAMPLE_NORMAL, GLTF_FLOAT, 3, 12, normals);
    read_attribute(mesh, SAMPLE_TEXCOORD, GLTF_FLOAT, 2, 8, texcoords);
    read_attribute(mesh, SAMPLE_JOINTS, GLTF_U16, 4, 8, joints);
    /* The longest side is 1; the error is at most half a step. */
    const double step = ffd_draco_step(mesh, SAMPLE_POSITION);
    assert_true(step >= 1 / 4095.0 && step < 1 / 4095.0 + 1e-6);
    assert_true(ffd_draco_step(mesh, SAMPLE_JOINTS) == 0 && ffd_draco_step(mesh, 1000) == 0);
    for (size_t i = 0; i < POINTS; i++) {
        points[i] = find_point(&g, positions + 3 * i);
        for (size_t c = 0; c < 3; c++)
            assert_true(fabs((double)positions[3 * i + c] - (double)g.positions[3 * points[i] + c]) <=
                        step / 2);
        assert_memory_equal(joints + 4 * i, g.joints + 4 * points[i], 8);
        for (size_t c = 0; c < 3; c++)
            assert_true(fabsf(normals[3 * i + c] - g.normals[3 * points[i] + c]) < 0.01f);
        for (size_t c = 0; c < 2; c++)
            assert_true(fabsf(texcoords[2 * i + c] - g.texcoords[2 * points[i] + c]) < 0.01f);
    }
    assert_int_equal(ffd_draco_indices(mesh, GLTF_U32, (unsigned char *)corners, NULL), FFD_OK);
    for (size_t t = 0; t < TRIANGLES; t++)
        for (size_t i = 0; i < TRIANGLES; i++)
            for (size_t turn = 0; turn < 3; turn++)
                area += points[corners[3 * t]] == g.triangles[3 * i + turn] &&
                        points[corners[3 * t + 1]] == g.triangles[3 * i + (turn + 1) % 3] &&
                        points[corners[3 * t + 2]] == g.triangles[3 * i + (turn + 2) % 3];
    assert_int_equal(area, TRIANGLES); /* each triangle once, none flipped */
    ffd_draco_free(mesh);
}

/* Rounded after the product and after the sum. A fused operation would round once and give another last
   bit. */
static void floats_are_rounded_after_each_operation(void **state)
{
    (void)state;
    static const float least[3] = {-0.3f, 1.7f, 1e-3f};
    const draco_quantization quantization = {3, least, 2.9f, 11};
    const float step = 2.9f / 2047;
    size_t fused = 0;
    for (int32_t q = 0; q < 2048; q++) {
        const int32_t integers[3] = {q, 2047 - q, q};
        float floats[3];
        ffd_draco_dequantize(&quantization, integers, 1, floats);
        for (size_t c = 0; c < 3; c++) {
            volatile const float product = (float)integers[c] * step;
            volatile const float sum = product + least[c];
            const float as_one = fmaf((float)integers[c], step, least[c]);
            assert_memory_equal(&floats[c], (const void *)&sum, sizeof sum);
            fused += memcmp(&floats[c], &as_one, sizeof as_one) != 0;
        }
    }
    assert_true(fused > 100);
}

/* Compared with the library's own header, which this program compiles without fused operations. */
static void normals_are_unfolded_as_the_library_does(void **state)
{
    (void)state;
    for (int bits = 2; bits <= 30; bits += 7)
        for (uint64_t i = 0; i < 1000; i++) {
            const int32_t most = (int32_t)((1u << bits) - 2);
            const int32_t place[2] = {(int32_t)(i * 7919 % ((uint64_t)most + 1)),
                                      (int32_t)(i * i * 104729 % ((uint64_t)most + 1))};
            float found[3], expected[3];
            ffd_draco_unfold_normals(bits, place, 1, found);
            unfold_as_draco(bits, place, expected);
            assert_memory_equal(found, expected, sizeof found);
        }
}

static void what_does_not_fit_the_accessor_is_refused(void **state)
{
    (void)state;
    static const struct {
        uint32_t id;
        int component, components;
        const char *message;
    } cases[] = {
        {SAMPLE_POSITION, GLTF_FLOAT, 2,
         "attribute 3 of the Draco data has 3 components, its accessor has 2"},
        {77, GLTF_FLOAT, 3, "the Draco data has no attribute 77"},
        {SAMPLE_JOINTS, GLTF_U8, 4,
         "point 76 of the Draco data has a value in attribute 300 that the accessor's component type does "
         "not "
         "hold"},
    };
    const sample_options options = {0};
    draco_mesh *mesh = decode_grid(&options);
    unsigned char bytes[16 * POINTS];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ffd_error error = {0};
        assert_int_equal(ffd_draco_attribute(mesh, cases[i].id, cases[i].component, cases[i].components, 16,
                                             bytes, &error),
                         FFD_E_INVALID);
        assert_string_equal(error.message, cases[i].message);
    }
    ffd_draco_free(mesh);
}

static void check_refusal(const unsigned char *bytes, size_t size, const draco_claim *claim,
                          ffd_status status, const char *message)
{
    ffd_error error = {0};
    draco_mesh *mesh = NULL;
    assert_int_equal(ffd_draco_decode(bytes, size, claim, &any_room, &mesh, &error), status);
    assert_null(mesh);
    assert_string_equal(error.message, message);
}

static void what_the_file_says_otherwise_is_refused(void **state)
{
    (void)state;
    static grid g;
    make_grid(&g);
    for (int edgebreaker = 0; edgebreaker < 2; edgebreaker++) {
        const sample_options options = {.edgebreaker = edgebreaker, .bits = 11};
        const draco_claim fewer = {POINTS - 1, 3 * TRIANGLES}, more = {POINTS + 1, UINT64_MAX},
                          other = {POINTS, 3 * TRIANGLES + 3};
        size_t size;
        unsigned char *bytes = make_draco(&g.mesh, &options, &size);
        assert_non_null(bytes);
        check_refusal(bytes, size, &fewer, FFD_E_INVALID,
                      "the Draco data's count of points is 81, that of its accessors 80");
        check_refusal(bytes, size, &more, FFD_E_INVALID,
                      "the Draco data's count of points is 81, that of its accessors 82");
        check_refusal(bytes, size, &other, FFD_E_INVALID,
                      "the Draco data's count of triangles is 128, that of its indices 387");
        free(bytes);
    }
}

static void other_data_is_refused(void **state)
{
    (void)state;
    static grid g;
    make_grid(&g);
    const sample_options cloud = {.as_points = true, .bits = 8}, plain = {0};
    size_t size;
    unsigned char *bytes = make_draco(&g.mesh, &cloud, &size);
    assert_non_null(bytes);
    check_refusal(bytes, size, &grid_claim, FFD_E_UNSUPPORTED,
                  "Draco data of type 0 is not supported, only triangle meshes are");
    free(bytes);
    bytes = make_draco(&g.mesh, &plain, &size);
    assert_non_null(bytes);
    check_refusal(bytes, 10, &grid_claim, FFD_E_INVALID, "the compressed data has no Draco header");
    bytes[6] = 3;
    check_refusal(bytes, size, &grid_claim, FFD_E_UNSUPPORTED,
                  "Draco bitstream version 2.3 is not known, only up to 2.2");
    bytes[6] = 2;
    bytes[8] = 9;
    check_refusal(bytes, size, &grid_claim, FFD_E_UNSUPPORTED, "Draco encoding method 9 is not known");
    free(bytes);
}

/* A header that asks for 2^31 triangles, in agreement with the file. */
static void memory_is_asked_for_in_proportion(void **state)
{
    (void)state;
    static const unsigned char edgebreaker[] = {'D',  'R',  'A',  'C',  'O',  2, 2, 1, 1,
                                                0,    0,    0,             /* standard */
                                                0xff, 0xff, 0xff, 0xff, 3, /* 2^30-1 points */
                                                0xff, 0xff, 0xff, 0xff, 4, /* triangles */
                                                1,    0xff, 0xff, 0xff, 0xff, 4, 0, 0, 0};
    const draco_claim huge = {1u << 30, 3 * (uint64_t)0x4fffffff};
    check_refusal(edgebreaker, sizeof edgebreaker, &huge, FFD_E_LIMIT,
                  "needs more than the 100 MB of memory allowed (input.memory raises this)");
}

/* A tree in which each node promises as many children as there are bytes. */
static void metadata_is_skipped(void **state)
{
    (void)state;
    enum { NODES = 200000 };
    unsigned char *bytes = calloc(NODES, 3), *at = bytes;
    static const unsigned char header[] = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0x80, 0, 0};
    memcpy(bytes, header, sizeof header);
    for (at += sizeof header; at + 8 < bytes + 3 * NODES; at += 5) {
        const unsigned char node[] = {0x80, 0x80, 8, 0, 0}; /* 2^17 children; no name, no entries */
        memcpy(at, node, sizeof node);
    }
    check_refusal(bytes, 3 * NODES, &grid_claim, FFD_E_INVALID, "the metadata of the Draco data is broken");
    free(bytes);
}

static ffd_status try_number(unsigned char *bytes, size_t size, size_t at, uint32_t number)
{
    const draco_claim claim = {POINTS, 3 * TRIANGLES};
    draco_mesh *mesh = NULL;
    ffd_error error = {0};
    unsigned char kept[4];
    memcpy(kept, bytes + at, sizeof kept);
    for (size_t i = 0; i < sizeof kept; i++)
        bytes[at + i] = (unsigned char)(number >> 8 * i);
    const ffd_status status = ffd_draco_decode(bytes, size, &claim, &any_room, &mesh, &error);
    memcpy(bytes + at, kept, sizeof kept);
    ffd_draco_free(mesh);
    return status;
}

/* The data contains the number of orientations for predicting texture coordinates. As many as there are
   corners are accepted, one more is not. */
static void orientations_are_limited(void **state)
{
    (void)state;
    static grid g;
    const sample_options options = {.edgebreaker = true, .bits = 10};
    size_t size, found = 0;
    make_grid(&g);
    const sample_mesh mesh = {POINTS, TRIANGLES, g.positions, NULL, g.texcoords,
                              NULL,   NULL,      g.triangles, NULL, NULL};
    unsigned char *bytes = make_draco(&mesh, &options, &size);
    assert_non_null(bytes);
    for (size_t at = 11; at + 4 <= size; at++) {
        bool limit = true;
        for (uint32_t k = 0; k < 16 && limit; k++)
            limit = try_number(bytes, size, at, 3 * TRIANGLES - k) == FFD_OK &&
                    try_number(bytes, size, at, 3 * TRIANGLES + 1 + k) == FFD_E_INVALID;
        found += limit;
    }
    assert_int_equal(found, 1);
    free(bytes);
}

/* Truncated and changed data ends in success or a refusal; sanitizers check memory. */
static void broken_data_does_no_harm(void **state)
{
    (void)state;
    static grid g;
    draw d = {11};
    const size_t mutations = is_under_valgrind() ? MUTATIONS / 4 : MUTATIONS;
    size_t refused = 0;
    make_grid(&g);
    for (int kind = 0; kind < 4; kind++) {
        const sample_options options = {
            .edgebreaker = kind % 2, .bits = kind < 2 ? 10 : 0, .metadata = kind == 3};
        size_t size;
        unsigned char *bytes = make_draco(&g.mesh, &options, &size);
        assert_non_null(bytes);
        for (size_t run = 0; run < mutations / 4; run++) {
            const size_t kept = draw_number(&d) % 4 ? size : draw_number(&d) % size;
            unsigned char *changed = malloc(kept ? kept : 1);
            memcpy(changed, bytes, kept);
            for (uint32_t flips = 1 + draw_number(&d) % 3; flips > 0 && kept > 0; flips--)
                changed[draw_number(&d) % kept] ^= (unsigned char)(1 << draw_number(&d) % 8);
            const draco_claim points = {POINTS, UINT64_MAX};
            draco_mesh *mesh = NULL;
            ffd_error error = {0};
            ffd_status status =
                ffd_draco_decode(changed, kept, run % 2 ? &points : &grid_claim, &any_room, &mesh, &error);
            unsigned char values[16 * POINTS];
            if (status == FFD_OK)
                status = ffd_draco_attribute(mesh, SAMPLE_POSITION, GLTF_FLOAT, 3, 12, values, &error);
            if (status == FFD_OK) {
                unsigned char *corners = malloc(ffd_draco_corner_count(mesh) + 1);
                status = ffd_draco_indices(mesh, GLTF_U8, corners, &error);
                free(corners);
            }
            assert_true(status == FFD_OK || status == FFD_E_INVALID || status == FFD_E_UNSUPPORTED ||
                        status == FFD_E_LIMIT || status == FFD_E_MEMORY);
            refused += status != FFD_OK;
            ffd_draco_free(mesh);
            free(changed);
        }
        free(bytes);
    }
    assert_in_range(refused, mutations / 10, mutations);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sequential_data_comes_back_as_it_was),
        cmocka_unit_test(edgebreaker_data_comes_back_within_its_bits),
        cmocka_unit_test(floats_are_rounded_after_each_operation),
        cmocka_unit_test(normals_are_unfolded_as_the_library_does),
        cmocka_unit_test(what_does_not_fit_the_accessor_is_refused),
        cmocka_unit_test(what_the_file_says_otherwise_is_refused),
        cmocka_unit_test(other_data_is_refused),
        cmocka_unit_test(memory_is_asked_for_in_proportion),
        cmocka_unit_test(metadata_is_skipped),
        cmocka_unit_test(orientations_are_limited),
        cmocka_unit_test(broken_data_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
