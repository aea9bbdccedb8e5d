/* test_meshopt.c - views of EXT_meshopt_compression: every mode and filter, and corrupt streams. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "base/memory/memory.h"
#include "mesh/meshopt/meshopt_filters.h"
#include "mesh/meshopt/meshopt_library.h"
#include "mesh/meshopt/meshopt_stream.h"
#include <math.h>
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

#define COUNT 700
#define CAPACITY 40000
#define MUTATIONS 4000
#define RUNS 150

typedef struct stream {
    meshopt_view view;
    unsigned char bytes[CAPACITY];
} stream;

static void fill_indices(uint32_t *indices)
{
    for (uint32_t i = 0; i < COUNT / 3 * 3; i++)
        indices[i] = i / 3 + i % 3 * (1 + i % 5);
}

static void finish(stream *s, size_t size)
{
    assert_in_range(size, 1, CAPACITY);
    s->view.size = size;
    s->view.bytes = s->bytes;
}

static void make_attributes(stream *s, size_t stride, const void *elements)
{
    s->view = (meshopt_view){.mode = MESHOPT_ATTRIBUTES, .count = COUNT, .stride = stride};
    finish(s, meshopt_encodeVertexBuffer(s->bytes, CAPACITY, elements, COUNT, stride));
}

static void make_triangles(stream *s, size_t stride, int version)
{
    uint32_t indices[COUNT];
    fill_indices(indices);
    s->view = (meshopt_view){.mode = MESHOPT_TRIANGLES, .count = COUNT / 3 * 3, .stride = stride};
    meshopt_encodeIndexVersion(version);
    finish(s, meshopt_encodeIndexBuffer(s->bytes, CAPACITY, indices, COUNT / 3 * 3));
}

static void make_indices(stream *s, size_t stride)
{
    uint32_t indices[COUNT];
    fill_indices(indices);
    s->view = (meshopt_view){.mode = MESHOPT_INDICES, .count = COUNT / 3 * 3, .stride = stride};
    meshopt_encodeIndexVersion(1);
    finish(s, meshopt_encodeIndexSequence(s->bytes, CAPACITY, indices, COUNT / 3 * 3));
}

/* Decodes into a block of the exact size. */
static ffd_status decode(const meshopt_view *view, unsigned char **bytes, ffd_error *error)
{
    *bytes = NULL;
    const ffd_status status = ffd_meshopt_check(view, error);
    if (status)
        return status;
    assert_true(view->count * view->stride <= 1024 * (uint64_t)view->size);
    *bytes = ffd_alloc((size_t)view->count, (size_t)view->stride);
    assert_non_null(*bytes);
    return ffd_meshopt_decode(view, *bytes, error);
}

static void attributes_come_back(void **state)
{
    (void)state;
    draw d = {1};
    for (size_t stride = 4; stride <= 256; stride += 36) {
        unsigned char *elements = malloc(COUNT * stride), *bytes = NULL;
        static stream s;
        ffd_error error = {0};
        for (size_t i = 0; i < COUNT * stride; i++)
            elements[i] = (unsigned char)(i / stride + draw_number(&d) % 7);
        s.view = (meshopt_view){.mode = MESHOPT_ATTRIBUTES, .count = COUNT, .stride = stride};
        unsigned char *room = malloc(meshopt_encodeVertexBufferBound(COUNT, stride));
        s.view.size = meshopt_encodeVertexBuffer(room, meshopt_encodeVertexBufferBound(COUNT, stride),
                                                 elements, COUNT, stride);
        s.view.bytes = room;
        assert_int_equal(decode(&s.view, &bytes, &error), FFD_OK);
        assert_memory_equal(bytes, elements, COUNT * stride);
        ffd_free(bytes);
        free(room);
        free(elements);
    }
}

/* Elements of which some columns are constant, some walk in steps of up to 2^n, and some are noise. */
static void fill_elements(draw *d, unsigned char *elements, size_t count, size_t stride)
{
    for (size_t b = 0; b < stride; b++) {
        const uint32_t range = 1u << draw_number(d) % 9;
        unsigned value = draw_number(d);
        for (size_t i = 0; i < count; i++) {
            value += draw_number(d) % range;
            elements[i * stride + b] = (unsigned char)value;
        }
    }
}

/* Fails unless both decoders make the same elements of a stream. */
static void compare_decoders(const meshopt_view *view)
{
    const size_t length = (size_t)(view->count * view->stride);
    unsigned char *ours = malloc(length), *theirs = malloc(length);
    ffd_error error = {0};
    assert_int_equal(ffd_meshopt_check(view, &error), FFD_OK);
    assert_int_equal(ffd_meshopt_library_decode(view, theirs, &error), FFD_OK);
    if (ffd_meshopt_read(view, ours, &error))
        fail_msg("%s", error.message);
    assert_memory_equal(ours, theirs, length);
    free(ours);
    free(theirs);
}

static void our_decoder_gives_the_bytes_of_the_library(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    static unsigned char elements[256 * COUNT], bytes[300 * COUNT];
    uint32_t indices[COUNT];
    for (int run = 0; run < RUNS; run++) {
        const size_t stride = 4 * (1 + draw_number(&d) % 64), count = 1 + draw_number(&d) % COUNT;
        meshopt_view view = {.count = count, .stride = stride, .bytes = bytes};
        fill_elements(&d, elements, count, stride);
        view.size = meshopt_encodeVertexBuffer(bytes, sizeof bytes, elements, count, stride);
        compare_decoders(&view);
        const size_t corners = 3 * (1 + draw_number(&d) % (COUNT / 3));
        for (size_t i = 0; i < corners; i++)
            indices[i] = draw_number(&d) % 20 ? (uint32_t)(i / 3 + i % 3 * (1 + draw_number(&d) % 5))
                                              : draw_number(&d) & 0x7fffffff;
        meshopt_encodeIndexVersion(1);
        view = (meshopt_view){MESHOPT_TRIANGLES, MESHOPT_NONE, corners, run % 2 ? 2 : 4, .bytes = bytes};
        view.size = meshopt_encodeIndexBuffer(bytes, sizeof bytes, indices, corners);
        compare_decoders(&view);
        view.mode = MESHOPT_INDICES;
        view.size = meshopt_encodeIndexSequence(bytes, sizeof bytes, indices, corners);
        compare_decoders(&view);
    }
}

static uint32_t read_index(const unsigned char *bytes, size_t i, size_t stride)
{
    uint32_t value = 0;
    for (size_t b = 0; b < stride; b++)
        value |= (uint32_t)bytes[i * stride + b] << (8 * b);
    return value;
}

/* The codec may rotate a triangle's corners, but keeps its winding and its place. */
static void check_triangle(const uint32_t *wanted, const uint32_t found[3])
{
    for (size_t turn = 0; turn < 3; turn++)
        if (wanted[0] == found[turn] && wanted[1] == found[(turn + 1) % 3] &&
            wanted[2] == found[(turn + 2) % 3])
            return;
    fail_msg("%u %u %u instead of %u %u %u", found[0], found[1], found[2], wanted[0], wanted[1], wanted[2]);
}

static void indices_come_back(void **state)
{
    (void)state;
    static stream s;
    uint32_t indices[COUNT];
    fill_indices(indices);
    for (int run = 0; run < 6; run++) {
        const size_t stride = run % 2 ? 2 : 4;
        unsigned char *bytes = NULL;
        ffd_error error = {0};
        if (run < 4)
            make_triangles(&s, stride, run / 2);
        else
            make_indices(&s, stride);
        assert_int_equal(decode(&s.view, &bytes, &error), FFD_OK);
        for (size_t i = 0; i < COUNT / 3; i++) {
            uint32_t found[3];
            for (size_t c = 0; c < 3; c++)
                found[c] = read_index(bytes, 3 * i + c, stride);
            check_triangle(indices + 3 * i, found);
            if (run >= 4)
                assert_int_equal(found[0], indices[3 * i]);
        }
        ffd_free(bytes);
    }
}

/* Draws a unit vector. */
static void make_unit(draw *d, int dimensions, float unit[4])
{
    double square = 0, value[4] = {0};
    for (int c = 0; c < dimensions; c++) {
        value[c] = (double)draw_number(d) / 2147483648.0 - 0.5;
        square += value[c] * value[c];
    }
    for (int c = 0; c < 4; c++)
        unit[c] = (float)(value[c] / sqrt(square));
}

/* Returns the decoded elements of a filter. Free it with ffd_free. */
static unsigned char *decode_filtered(size_t stride, const void *elements, meshopt_filter filter)
{
    static stream s;
    unsigned char *bytes = NULL;
    ffd_error error = {0};
    make_attributes(&s, stride, elements);
    s.view.filter = filter;
    assert_int_equal(decode(&s.view, &bytes, &error), FFD_OK);
    return bytes;
}

static void octahedral_filter_gives_unit_vectors(void **state)
{
    (void)state;
    static float units[4 * COUNT];
    draw d = {3};
    for (size_t i = 0; i < COUNT; i++)
        make_unit(&d, 3, units + 4 * i);
    for (size_t stride = 4; stride <= 8; stride += 4) {
        unsigned char elements[8 * COUNT];
        meshopt_encodeFilterOct(elements, COUNT, stride, stride == 4 ? 8 : 12, units);
        unsigned char *bytes = decode_filtered(stride, elements, MESHOPT_OCTAHEDRAL);
        for (size_t i = 0; i < COUNT; i++)
            for (size_t c = 0; c < 3; c++) {
                const unsigned char *at = bytes + i * stride + c * (stride / 4);
                const double value =
                    stride == 4 ? (signed char)at[0] / 127.0 : (int16_t)(at[0] | at[1] << 8) / 32767.0;
                assert_true(fabs(value - (double)units[4 * i + c]) < (stride == 4 ? 0.02 : 0.002));
            }
        ffd_free(bytes);
    }
}

static void quaternion_filter_gives_rotations(void **state)
{
    (void)state;
    static float units[4 * COUNT];
    unsigned char elements[8 * COUNT];
    draw d = {4};
    for (size_t i = 0; i < COUNT; i++)
        make_unit(&d, 4, units + 4 * i);
    meshopt_encodeFilterQuat(elements, COUNT, 8, 14, units);
    unsigned char *bytes = decode_filtered(8, elements, MESHOPT_QUATERNION);
    for (size_t i = 0; i < COUNT; i++) {
        double dot = 0;
        for (size_t c = 0; c < 4; c++)
            dot += (int16_t)(bytes[8 * i + 2 * c] | bytes[8 * i + 2 * c + 1] << 8) / 32767.0 *
                   (double)units[4 * i + c];
        assert_true(fabs(dot) > 0.999); /* q and -q are the same rotation */
    }
    ffd_free(bytes);
}

static int nearest(long double value)
{
    return (int)(value < 0 ? ceill(value - 0.5L) : floorl(value + 0.5L));
}

/* The direction that KHR_meshopt_compression assigns to three integers, in steps of the largest one. */
static void expect_direction(const int from[3], int largest, int to[3])
{
    long double v[3] = {(long double)from[0] / from[2], (long double)from[1] / from[2]};
    v[2] = 1 - fabsl(v[0]) - fabsl(v[1]);
    const long double t = v[2] < 0 ? -v[2] : 0;
    for (int a = 0; a < 2; a++)
        v[a] += v[a] < 0 ? t : -t;
    const long double length = sqrtl(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int a = 0; a < 3; a++)
        to[a] = nearest(v[a] / length * largest);
}

/* Every pair of 8 bits, and pairs of 4 to 16 bits: exact to the last bit, on every processor. */
static void octahedral_filter_is_exact(void **state)
{
    (void)state;
    draw d = {7};
    for (int x = -127; x <= 127; x++)
        for (int y = -127; y <= 127; y++) {
            unsigned char bytes[4] = {(unsigned char)(x & 255), (unsigned char)(y & 255), 127, 9};
            int expected[3];
            expect_direction((const int[]){x, y, 127}, 127, expected);
            ffd_meshopt_unfold(bytes, 1, 4);
            for (int a = 0; a < 3; a++)
                assert_int_equal((signed char)bytes[a], expected[a]);
            assert_int_equal(bytes[3], 9);
        }
    for (int i = 0; i < 20000; i++) {
        const int one = (1 << (3 + i % 13)) - 1, range = 2 * one + 1;
        const int from[3] = {(int)(draw_number(&d) % (unsigned)range) - one,
                             (int)(draw_number(&d) % (unsigned)range) - one, one};
        int16_t v[4] = {(int16_t)from[0], (int16_t)from[1], (int16_t)one, -5};
        int expected[3];
        expect_direction(from, 32767, expected);
        ffd_meshopt_unfold((unsigned char *)v, 1, 8);
        for (int a = 0; a < 3; a++)
            assert_int_equal(v[a], expected[a]);
        assert_int_equal(v[3], -5);
    }
    int16_t none[8] = {0, 0, 0, 1, -32768, -32768, 0, 1};
    ffd_meshopt_unfold((unsigned char *)none, 2, 8);
    assert_true(none[0] == 0 && none[1] == 0 && none[2] == 0);
}

static void quaternion_filter_is_exact(void **state)
{
    (void)state;
    draw d = {8};
    for (int i = 0; i < 20000; i++) {
        const int one = (1 << (3 + i % 13)) - 1, range = 2 * one + 1, largest = i / 13 % 4;
        int16_t q[4];
        long double rest = 1;
        int expected[4];
        for (int a = 0; a < 3; a++) {
            const int part = ((int)(draw_number(&d) % (unsigned)range) - one) * 9 / 10;
            const long double value = part / (one * sqrtl(2.0L));
            q[a] = (int16_t)part;
            rest -= value * value;
            expected[(largest + 1 + a) % 4] = nearest(value * 32767);
        }
        expected[largest] = nearest(rest > 0 ? sqrtl(rest) * 32767 : 0);
        q[3] = (int16_t)((one & ~3) | largest);
        ffd_meshopt_complete_rotations((unsigned char *)q, 1);
        for (int a = 0; a < 4; a++)
            assert_int_equal(q[a], expected[a]);
    }
}

/* The whole range of exponents that the extension allows, and all signs. */
static void exponential_filter_is_exact(void **state)
{
    (void)state;
    draw d = {10};
    for (int i = 0; i < 20000; i++) {
        const int exponent = i % 201 - 100;
        const int mantissa = (int)(draw_number(&d) % (1u << (1 + i % 24))) - (1 << i % 24);
        unsigned char bytes[4] = {(unsigned char)(mantissa & 255), (unsigned char)(mantissa >> 8 & 255),
                                  (unsigned char)(mantissa >> 16 & 255), (unsigned char)(exponent & 255)};
        float value;
        ffd_meshopt_scale(bytes, 1, 4);
        memcpy(&value, bytes, sizeof value);
        assert_true((long double)value == ldexpl(mantissa, exponent));
    }
}

/* The colour that KHR_meshopt_compression assigns to four integers; bits: of each, with the marker of alpha.
 */
static void expect_color(const int from[4], int bits, int largest, int to[4])
{
    const int scale = (1 << bits) - 1, alpha = from[3] - (1 << (bits - 1));
    const int exact[4] = {from[0] + from[1] - from[2], from[0] + from[2], from[0] - from[1] - from[2],
                          2 * alpha + alpha % 2};
    for (int c = 0; c < 4; c++) {
        const int value = nearest((long double)exact[c] * largest / scale);
        to[c] = value < 0 ? 0 : value > largest ? largest : value;
    }
}

static void color_filter_is_exact(void **state)
{
    (void)state;
    draw d = {12};
    for (int i = 0; i < 20000; i++) {
        const int is_short = i % 2, bits = 2 + i / 2 % (is_short ? 15 : 7), scale = (1 << bits) - 1;
        const int half = 1 << (bits - 1);
        const int from[4] = {(int)(draw_number(&d) % (unsigned)(scale + 1)),
                             (int)(draw_number(&d) % (unsigned)scale) - half + 1,
                             (int)(draw_number(&d) % (unsigned)scale) - half + 1,
                             half + (int)(draw_number(&d) % (unsigned)half)};
        unsigned char bytes[8];
        int expected[4];
        for (int c = 0; c < 4; c++)
            for (int b = 0; b <= is_short; b++)
                bytes[(1 + is_short) * c + b] = (unsigned char)((unsigned)from[c] >> (8 * b) & 255);
        expect_color(from, bits, is_short ? 65535 : 255, expected);
        ffd_meshopt_mix_colors(bytes, 1, is_short ? 8 : 4);
        for (int c = 0; c < 4; c++)
            assert_int_equal(is_short ? bytes[2 * c] | bytes[2 * c + 1] << 8 : bytes[c], expected[c]);
    }
    unsigned char none[4] = {200, 3, 5, 0};
    ffd_meshopt_mix_colors(none, 1, 4);
    assert_true(none[0] == 0 && none[1] == 0 && none[2] == 0 && none[3] == 0);
}

/* An exponent for each element. */
static void encode_exponents(unsigned char *elements, int bits, const float *values)
{
#if MESHOPTIMIZER_VERSION >= 200
    meshopt_encodeFilterExp(elements, COUNT, 12, bits, values, meshopt_EncodeExpSharedVector);
#else
    meshopt_encodeFilterExp(elements, COUNT, 12, bits, values);
#endif
}

static void exponential_filter_gives_floats(void **state)
{
    (void)state;
    static float values[3 * COUNT];
    unsigned char elements[12 * COUNT];
    draw d = {5};
    for (size_t i = 0; i < 3 * COUNT; i++)
        values[i] = (float)draw_number(&d) / 1048576.0f - 1000.0f;
    encode_exponents(elements, 20, values);
    unsigned char *bytes = decode_filtered(12, elements, MESHOPT_EXPONENTIAL);
    for (size_t i = 0; i < 3 * COUNT; i++) {
        float value;
        memcpy(&value, bytes + 4 * i, sizeof value);
        assert_true(fabs((double)value - (double)values[i]) < 0.01);
    }
    ffd_free(bytes);
}

/* Every number is a multiple of 2 to the smallest exponent in its column. */
static void exponential_filter_tells_its_steps(void **state)
{
    (void)state;
    static float values[3 * COUNT];
    unsigned char elements[12 * COUNT], bytes[12 * COUNT];
    int8_t exponents[MESHOPT_COLUMNS];
    draw d = {6};
    for (size_t i = 0; i < 3 * COUNT; i++)
        values[i] = i % 7 == 0 ? 0 : (float)((double)(draw_bits(&d) >> 40) - 0x1p23) * (float)(1 + i % 3);
    for (int bits = 4; bits <= 24; bits += 10) {
        stream s;
        encode_exponents(elements, bits, values);
        make_attributes(&s, 12, elements);
        s.view.filter = MESHOPT_EXPONENTIAL;
        s.view.exponents = exponents;
        assert_int_equal(ffd_meshopt_check(&s.view, NULL), FFD_OK);
        assert_int_equal(ffd_meshopt_decode(&s.view, bytes, NULL), FFD_OK);
        for (size_t c = 0; c < 3; c++) {
            int least = INT8_MAX;
            for (size_t i = 0; i < COUNT; i++) {
                const unsigned char *const stored =
                    elements + 12 * i + 4 * c; /* a factor of 3 bytes, then an exponent */
                float value;
                memcpy(&value, bytes + 12 * i + 4 * c, sizeof value);
                const double multiple = ldexp((double)value, -exponents[c]);
                assert_true(multiple == floor(multiple));
                if ((stored[0] || stored[1] || stored[2]) && (int8_t)stored[3] < least)
                    least = (int8_t)stored[3];
            }
            assert_int_equal(exponents[c], least);
        }
    }
}

static void check_refusal(const meshopt_view *view, ffd_status status, const char *message)
{
    ffd_error error = {0};
    unsigned char *bytes = NULL;
    assert_int_equal(decode(view, &bytes, &error), status);
    assert_string_equal(error.message, message);
    ffd_free(bytes);
}

static void what_cannot_be_is_refused_before_there_is_memory(void **state)
{
    (void)state;
    static stream s, changed;
    const float zeros[4 * COUNT] = {0};
    make_attributes(&s, 16, zeros);
    changed = s;
    changed.view.bytes = changed.bytes;
    changed.view.count = (uint64_t)1 << 53;
    check_refusal(&changed.view, FFD_E_INVALID,
                  "209 bytes cannot hold 9007199254740992 elements of mode ATTRIBUTES");
    changed.view = s.view;
    changed.view.stride = 18;
    check_refusal(&changed.view, FFD_E_INVALID, "byteStride 18 is not allowed with mode ATTRIBUTES");
    changed.view.stride = 260;
    check_refusal(&changed.view, FFD_E_INVALID, "byteStride 260 is not allowed with mode ATTRIBUTES");
    changed.view = s.view;
    changed.view.filter = MESHOPT_QUATERNION;
    check_refusal(&changed.view, FFD_E_INVALID,
                  "the filter is not allowed with mode ATTRIBUTES and byteStride 16");
    changed.view = s.view;
    changed.view.mode = MESHOPT_INDICES;
    changed.view.stride = 4;
    check_refusal(&changed.view, FFD_E_INVALID, "the compressed data is not of mode INDICES");
    changed.view = s.view;
    changed.view.size = 0;
    check_refusal(&changed.view, FFD_E_INVALID, "the compressed data is not of mode ATTRIBUTES");
    changed.view = s.view;
    changed.view.bytes = changed.bytes;
    changed.bytes[0] += 2;
    check_refusal(&changed.view, FFD_E_UNSUPPORTED,
                  "version 2 of the meshopt codec for ATTRIBUTES is not known, only up to 1");
    make_triangles(&s, 4, 1);
    s.view.count--;
    check_refusal(&s.view, FFD_E_INVALID, "count 698 is not a multiple of 3");
    s.view.count = 3000000000;
    check_refusal(&s.view, FFD_E_INVALID, "764 bytes cannot hold 3000000000 elements of mode TRIANGLES");
}

/* Truncated and changed streams end in success or FFD_E_INVALID; sanitizers check memory. */
static void broken_streams_do_no_harm(void **state)
{
    (void)state;
    static stream s;
    draw d = {9};
    size_t refused = 0;
    float values[2 * COUNT]; /* for elements of up to 8 bytes */
    for (size_t i = 0; i < 2 * COUNT; i++)
        values[i] = (float)(draw_number(&d) % 1000);
    for (size_t run = 0; run < MUTATIONS; run++) {
        unsigned char *bytes = NULL;
        ffd_error error = {0};
        switch (run % 4) {
        case 0:
            make_attributes(&s, 4, values);
            s.view.filter = run % 8 ? MESHOPT_OCTAHEDRAL : MESHOPT_EXPONENTIAL;
            break;
        case 1:
            make_triangles(&s, run % 8 < 4 ? 2 : 4, run % 3 ? 1 : 0);
            break;
        case 2:
            make_indices(&s, run % 8 < 4 ? 2 : 4);
            break;
        default:
            make_attributes(&s, 8, values);
            s.view.count = COUNT / 2; /* the stream has more */
            s.view.filter = MESHOPT_QUATERNION;
            break;
        }
        for (uint32_t flips = draw_number(&d) % 4; flips > 0; flips--)
            s.bytes[draw_number(&d) % s.view.size] ^= (unsigned char)(1 << draw_number(&d) % 8);
        if (draw_number(&d) % 2)
            s.view.size -= draw_number(&d) % s.view.size;
        unsigned char *exact = malloc(s.view.size); /* so that reading past its end is detected */
        memcpy(exact, s.bytes, s.view.size);
        s.view.bytes = exact;
        const ffd_status status = decode(&s.view, &bytes, &error);
        assert_true(status == FFD_OK || status == FFD_E_INVALID || status == FFD_E_UNSUPPORTED);
        refused += status != FFD_OK;
        ffd_free(bytes);
        free(exact);
    }
    assert_in_range(refused, MUTATIONS / 4, MUTATIONS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(attributes_come_back),
        cmocka_unit_test(indices_come_back),
        cmocka_unit_test(octahedral_filter_gives_unit_vectors),
        cmocka_unit_test(quaternion_filter_gives_rotations),
        cmocka_unit_test(octahedral_filter_is_exact),
        cmocka_unit_test(quaternion_filter_is_exact),
        cmocka_unit_test(our_decoder_gives_the_bytes_of_the_library),
        cmocka_unit_test(exponential_filter_is_exact),
        cmocka_unit_test(color_filter_is_exact),
        cmocka_unit_test(exponential_filter_gives_floats),
        cmocka_unit_test(exponential_filter_tells_its_steps),
        cmocka_unit_test(what_cannot_be_is_refused_before_there_is_memory),
        cmocka_unit_test(broken_streams_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
