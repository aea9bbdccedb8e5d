/* test_gltf_storage.c - numbers of every component type, and failing memory while results are stored. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/gltf_file.h"
#include "io/gltf/model/gltf_results.h"
#include "io/gltf/read/gltf_elements.h"
#include <math.h>
#include <unistd.h>

static const struct {
    int component, least, largest;
} types[] = {{GLTF_I8, -128, 127}, {GLTF_U8, 0, 255}, {GLTF_I16, -32768, 32767}, {GLTF_U16, 0, 65535}};
#define TYPES (sizeof types / sizeof *types)

static gltf_accessor accessor_of(int component, bool normalized)
{
    return (gltf_accessor){
        .component = component, .normalized = normalized, .columns = 1, .rows = 3, .count = 1};
}

static void write_integer(int component, int value, unsigned char *bytes)
{
    for (size_t i = 0; i < ffd_gltf_component_size(component); i++)
        bytes[i] = (unsigned char)((unsigned)value >> 8 * i);
}

/* Each integer of each type is decoded, fits, rounds to itself and is encoded unchanged, also over another
   one. */
static void every_integer_comes_back(void **state)
{
    (void)state;
    for (size_t t = 0; t < 2 * TYPES; t++) {
        const gltf_accessor a = accessor_of(types[t / 2].component, t % 2);
        const int least = types[t / 2].least, largest = types[t / 2].largest;
        for (int q = least; q <= largest; q++) {
            unsigned char bytes[4] = {0}, others[16] = {0}, element[GLTF_LARGEST_VECTOR];
            const size_t size = ffd_gltf_component_size(a.component);
            write_integer(a.component, q, bytes);
            const double value = ffd_gltf_read_number(bytes, a.component, a.normalized);
            const double exact = a.normalized ? fmax((double)q / largest, -1) : q;
            assert_true(value >= exact && value <= exact);
            const float results[3] = {(float)value, (float)value, (float)value};
            const float rounded = ffd_gltf_round(&a, value);
            assert_memory_equal(&rounded, results, sizeof rounded);
            assert_true(ffd_gltf_fits(&a, results, 3));
            write_integer(a.component, q < 0 ? 1 : q + 1 > largest ? 0 : q + 1, others);
            ffd_gltf_encode(&a, a.component, others, results, 3, element);
            const bool is_minus_one = a.normalized && q == -largest - 1; /* -1 has two representations */
            write_integer(a.component, is_minus_one ? q + 1 : q, bytes);
            assert_memory_equal(element, bytes, size);
            assert_memory_equal(element + size, bytes, size);
        }
    }
}

static void halves_go_to_the_even_step(void **state)
{
    (void)state;
    static const struct {
        double value;
        int expected;
    } cases[] = {{0.5, 0},   {1.5, 2},       {2.5, 2},       {-0.5, 0},
                 {-1.5, -2}, {2.4999999, 2}, {2.5000001, 3}, {1e6, 1000000}};
    const gltf_accessor plain = accessor_of(GLTF_I16, false), normalized = accessor_of(GLTF_I16, true);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const float found = ffd_gltf_round(&plain, cases[i].value), wanted = (float)cases[i].expected;
        assert_memory_equal(&found, &wanted, sizeof wanted); /* no -0 */
        const float part = ffd_gltf_round(&normalized, cases[i].value / 32767),
                    step = (float)(cases[i].expected / 32767.0);
        if (fabs(cases[i].value - floor(cases[i].value)) != 0.5) /* a half may no longer be exact */
            assert_memory_equal(&part, &step, sizeof step);
    }
    const gltf_accessor real = accessor_of(GLTF_FLOAT, false);
    assert_true(ffd_gltf_round(&real, 0.1) >= 0.1F && ffd_gltf_round(&real, 0.1) <= 0.1F);
}

static void what_does_not_fit_is_found(void **state)
{
    (void)state;
    for (size_t t = 0; t < 2 * TYPES; t++) {
        const gltf_accessor a = accessor_of(types[t / 2].component, t % 2);
        const double scale = a.normalized ? types[t / 2].largest : 1;
        const float beyond[] = {(float)((types[t / 2].largest + 1) / scale),
                                (float)((types[t / 2].least - 1) / scale),
                                (float)((types[t / 2].largest - 0.25) / scale), HUGE_VALF, NAN};
        for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++) {
            const float values[3] = {0, beyond[i], 0};
            assert_false(ffd_gltf_fits(&a, values, 3));
            assert_true(ffd_gltf_fits(&a, values, 1));
        }
    }
    const gltf_accessor real = accessor_of(GLTF_FLOAT, false);
    const float huge = 1e38F;
    assert_true(ffd_gltf_fits(&real, &huge, 1));
}

/* A component that keeps its value keeps its bytes: -128 does not become -127. The 4th component is
   unchanged, with the float that it decodes to. */
static void only_what_changes_is_encoded(void **state)
{
    (void)state;
    gltf_accessor a = accessor_of(GLTF_I8, true);
    a.rows = 4;
    const unsigned char original[4] = {0x80, 0x81, 64, 0x81};
    unsigned char element[GLTF_LARGEST_VECTOR];
    const float values[3] = {-1, -1, 1};
    ffd_gltf_encode(&a, GLTF_I8, original, values, 3, element);
    assert_memory_equal(element, "\x80\x81\x7f\x81", 4);
    ffd_gltf_encode(&a, GLTF_FLOAT, original, values, 3, element);
    assert_memory_equal(element, "\0\0\x80\xbf\0\0\x80\xbf\0\0\x80\x3f\0\0\x80\xbf", 16);
}

/* Enough vectors for whole SIMD groups and a remainder. */
static void bounds_are_those_of_all_vectors(void **state)
{
    (void)state;
    enum { MOST = 30 };
    draw d = {draw_seed()};
    for (size_t count = 1; count <= MOST; count++) {
        float xyz[3 * MOST], least[3] = {2, 2, 2}, largest[3] = {-2, -2, -2};
        for (size_t i = 0; i < 3 * count; i++) {
            xyz[i] = (float)draw_between(&d, -1, 1);
            least[i % 3] = fminf(least[i % 3], xyz[i]);
            largest[i % 3] = fmaxf(largest[i % 3], xyz[i]);
        }
        const gltf_tile_bounds found = ffd_gltf_find_bounds(xyz, count);
        assert_memory_equal(found.least, least, sizeof least);
        assert_memory_equal(found.largest, largest, sizeof largest);
    }
}

/* Elements are read in parts: a sparse element beyond the part is not written. */
static void a_sparse_element_behind_the_part(void **state)
{
    (void)state;
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":28,\"uri\":"
        "\"data:;base64,AQAAAAAAgD8AAABAAABAQAAAAAAAAAAAAAAAAA==\"}],\"bufferViews\":["
        "{\"buffer\":0,\"byteLength\":4},{\"buffer\":0,\"byteOffset\":4,\"byteLength\":12}],"
        "\"accessors\":[{\"componentType\":5126,\"count\":2,\"type\":\"VEC3\",\"sparse\":{\"count\":1,"
        "\"indices\":{\"bufferView\":0,\"componentType\":5121},\"values\":{\"bufferView\":1}},"
        "\"min\":[0,0,0],\"max\":[1,2,3]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"nodes\":[{\"mesh\":0}]}";
    mesh_document *document = NULL;
    ffd_error error;
    double xyz[6] = {7, 7, 7, 7, 7, 7};
    if (open_bytes(text, sizeof text - 1, "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &document, &error))
        fail_msg("%s", error.message);
    gltf->read(document, 0, MESH_POSITIONS, MESH_STORED, 0, 1, xyz);
    for (int i = 0; i < 6; i++)
        assert_true(xyz[i] == (i < 3 ? 0 : 7));
    gltf->read(document, 0, MESH_POSITIONS, MESH_STORED, 1, 1, xyz);
    for (int i = 0; i < 6; i++)
        assert_true(xyz[i] == (i < 3 ? i + 1 : 7));
    gltf->close(document);
}

/* A sparse accessor with zeros instead of a buffer; and integers that become floats, whose extension is
   removed. */
static void memory_may_run_out_anywhere(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "{\"asset\":{\"version\":\"2.0\"},\"accessors\":[{\"componentType\":5126,\"count\":2,\"type\":"
        "\"VEC3\","
        "\"min\":[0,0,0],\"max\":[0,0,0]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"nodes\":[{\"mesh\":0}]}",
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_mesh_quantization\"],"
        "\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"buffers\":[{\"byteLength\":12,\"uri\":"
        "\"data:;base64,AAAAAAAAAAAAAAAA\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":12}],"
        "\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5121,\"normalized\":true,\"count\":2,\"type\":\"VEC3\","
        "\"sparse\":{"
        "\"count\":1,\"indices\":{\"bufferView\":0,\"componentType\":5121},\"values\":{\"bufferView\":0}},"
        "\"min\":[0,0,0],\"max\":[0,0,0]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"nodes\":[{\"mesh\":0}]}"};
    char output[] = "/tmp/ffd-test-storage-XXXXXX";
    const int file = mkstemp(output);
    assert_true(file >= 0);
    close(file);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        unlink(output);
        ffd_status status = FFD_E_MEMORY;
        long successes = 0;
        for (; status == FFD_E_MEMORY; successes++) {
            ffd_error error = {0};
            assert_int_equal(access(output, F_OK), -1);
            ffd_alloc_fail_after(successes);
            status = run_all(texts[i], strlen(texts[i]), "m.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, add_one,
                             output, &error);
            ffd_alloc_fail_after(-1);
        }
        assert_int_equal(status, FFD_OK);
        assert_true(successes > 50);
        assert_int_equal(access(output, F_OK), 0);
    }
    unlink(output);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_integer_comes_back),        cmocka_unit_test(halves_go_to_the_even_step),
        cmocka_unit_test(what_does_not_fit_is_found),      cmocka_unit_test(only_what_changes_is_encoded),
        cmocka_unit_test(bounds_are_those_of_all_vectors), cmocka_unit_test(a_sparse_element_behind_the_part),
        cmocka_unit_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
