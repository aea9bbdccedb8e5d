/* PLY: values, headers, rows, documents, saving and comparing, on files written here. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/mesh_bytes.h"
#include "../support/repetitions.h"
#include "base/text/buffer.h"
#include "io/ply/ply_document.h"
#include "io/ply/ply_format.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const mesh_format *const ply = &ffd_ply_format;

static mesh_document *opened(const void *bytes, size_t size)
{
    return opened_bytes(ply, bytes, size);
}

/* Values */

static text_word word_of(const char *bytes, size_t size)
{
    return (text_word){bytes, bytes + size};
}

static void every_type_is_loaded_and_stored(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        number_type type;
        size_t size;
        const char *bytes; /* big endian */
        double value;
    } cases[] = {
        {"char", NUMBER_INT8, 1, "\x80", -128},
        {"int8", NUMBER_INT8, 1, "\x7f", 127},
        {"uchar", NUMBER_UINT8, 1, "\x80", 128},
        {"uint8", NUMBER_UINT8, 1, "\xff", 255},
        {"short", NUMBER_INT16, 2, "\xff\xfe", -2},
        {"int16", NUMBER_INT16, 2, "\x01\x02", 258},
        {"ushort", NUMBER_UINT16, 2, "\xff\xfe", 65534},
        {"uint16", NUMBER_UINT16, 2, "\x00\x01", 1},
        {"int", NUMBER_INT32, 4, "\x80\x00\x00\x00", -2147483648.0},
        {"int32", NUMBER_INT32, 4, "\x00\x01\x00\x02", 65538},
        {"uint", NUMBER_UINT32, 4, "\xff\xff\xff\xff", 4294967295.0},
        {"uint32", NUMBER_UINT32, 4, "\x80\x00\x00\x00", 2147483648.0},
        {"float", NUMBER_FLOAT, 4, "\xbf\xc0\x00\x00", -1.5},
        {"float32", NUMBER_FLOAT, 4, "\x00\x00\x00\x01", 1.401298464324817e-45},
        {"double", NUMBER_DOUBLE, 8, "\x3f\xf0\x00\x00\x00\x00\x00\x01", 1.0000000000000002},
        {"float64", NUMBER_DOUBLE, 8, "\xc0\x00\x00\x00\x00\x00\x00\x00", -2},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        number_type type;
        char turned[8];
        double value = 0;
        const size_t size = cases[i].size;
        assert_true(ffd_ply_type_of(word_of(cases[i].name, strlen(cases[i].name)), &type));
        assert_int_equal(type, cases[i].type);
        assert_int_equal(ffd_type_size(type), size);
        for (size_t k = 0; k < size && k < sizeof turned; k++)
            turned[k] = cases[i].bytes[size - 1 - k];
        assert_true(ffd_ply_load(PLY_BIG_ENDIAN, type, word_of(cases[i].bytes, size), &value));
        assert_true(value == cases[i].value);
        assert_true(ffd_ply_load(PLY_LITTLE_ENDIAN, type, word_of(turned, size), &value));
        assert_true(value == cases[i].value);
        if (!number_is_real(type))
            continue;
        char stored[FFD_NUMBER_CAPACITY];
        assert_int_equal(ffd_ply_store(PLY_BIG_ENDIAN, type, value, stored), size);
        assert_memory_equal(stored, cases[i].bytes, size);
        assert_int_equal(ffd_ply_store(PLY_LITTLE_ENDIAN, type, value, stored), size);
        assert_memory_equal(stored, turned, size);
    }
    number_type type;
    static const char *const unknown[] = {"", "Float", "float16", "long", "int64", "floats", "list"};
    for (size_t i = 0; i < COUNT(unknown); i++)
        assert_false(ffd_ply_type_of(word_of(unknown[i], strlen(unknown[i])), &type));
}

static void ascii_numbers_are_rounded_and_written_by_type(void **state)
{
    (void)state;
    /* Slightly above the midpoint of 1 and the next float: too little for a double to show. */
    static const char above[] = "1.000000059604644775390625000000001";
    double value;
    char text[FFD_NUMBER_CAPACITY];
    assert_true(ffd_ply_load(PLY_ASCII, NUMBER_FLOAT, word_of(above, strlen(above)), &value));
    assert_true(value == 1 + (double)FLT_EPSILON);
    assert_true(ffd_ply_load(PLY_ASCII, NUMBER_DOUBLE, word_of(above, strlen(above)), &value));
    assert_true(value == 1 + (double)FLT_EPSILON / 2);
    assert_true(ffd_ply_load(PLY_ASCII, NUMBER_FLOAT, word_of("1e39", 4), &value));
    assert_true(isinf(value));
    assert_true(ffd_ply_load(PLY_ASCII, NUMBER_FLOAT, word_of("-1e-46", 6), &value));
    assert_true(value == 0 && signbit(value));
    assert_false(ffd_ply_load(PLY_ASCII, NUMBER_FLOAT, word_of("1x", 2), &value));
    assert_false(ffd_ply_load(PLY_ASCII, NUMBER_INT32, word_of("one", 3), &value));
    assert_int_equal(ffd_ply_store(PLY_ASCII, NUMBER_FLOAT, number_round(NUMBER_FLOAT, 0.1), text), 3);
    assert_memory_equal(text, "0.1", 3);
    assert_int_equal(ffd_ply_store(PLY_ASCII, NUMBER_DOUBLE, (double)0.1F, text), 19);
    assert_memory_equal(text, "0.10000000149011612", 19);
}

static void only_whole_counts_are_accepted(void **state)
{
    (void)state;
    size_t count;
    assert_true(ffd_ply_load_count(PLY_ASCII, NUMBER_UINT8, word_of("3", 1), &count) && count == 3);
    assert_int_equal(ffd_ply_load_count(PLY_ASCII, NUMBER_INT32, word_of("4294967296", 10), &count),
                     SIZE_MAX > UINT32_MAX);
    static const char *const bad[] = {"-1", "1.5", "nan", "1e300", "inf", "x", "9007199254740992"};
    for (size_t i = 0; i < COUNT(bad); i++)
        assert_false(ffd_ply_load_count(PLY_ASCII, NUMBER_INT32, word_of(bad[i], strlen(bad[i])), &count));
    assert_false(ffd_ply_load_count(PLY_BIG_ENDIAN, NUMBER_INT8, word_of("\xff", 1), &count));
    assert_true(ffd_ply_load_count(PLY_BIG_ENDIAN, NUMBER_UINT8, word_of("\xff", 1), &count) && count == 255);
}

/* Refusals */

#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define ASCII "ply\nformat ascii 1.0\n"
#define LITTLE "ply\nformat binary_little_endian 1.0\n"
#define ONE ASCII "element vertex 1\n" XYZ
#define FACE "element face 1\nproperty list uchar int vertex_indices\n"

static const refused_text refused[] = {
    {"", FFD_E_INVALID, 1, "\"ply\""},
    {"plyx\n", FFD_E_INVALID, 1, "\"ply\""},
    {" ply\nformat ascii 1.0\nend_header\n", FFD_E_INVALID, 1, "\"ply\""},
    {"\xef\xbb\xbf ply\n", FFD_E_INVALID, 1, "\"ply\""},
    {"ply", FFD_E_INVALID, 1, "end_header"},
    {"ply\n", FFD_E_INVALID, 1, "end_header"},
    {"ply\nend_header\n", FFD_E_INVALID, 2, "format"},
    {"ply\nformat ascii 1.0\nformat ascii 1.0\n", FFD_E_INVALID, 3, "second format"},
    {"ply\nformat ascii\n", FFD_E_INVALID, 2, "version"},
    {"ply\nformat ascii 1.0 x\n", FFD_E_INVALID, 2, "version"},
    {"ply\nformat binary_middle_endian 1.0\n", FFD_E_INVALID, 2, "binary_middle_endian"},
    {"ply\nformat ascii 2.0\n", FFD_E_UNSUPPORTED, 2, "2.0"},
    {ASCII "elements vertex 1\n", FFD_E_INVALID, 3, "elements"},
    {ASCII "element vertex\n", FFD_E_INVALID, 3, "count"},
    {ASCII "element vertex 1 2\n", FFD_E_INVALID, 3, "count"},
    {ASCII "element vertex -1\n", FFD_E_INVALID, 3, "-1"},
    {ASCII "element vertex 1.0\n", FFD_E_INVALID, 3, "1.0"},
    {ASCII "element vertex 18446744073709551616\n", FFD_E_INVALID, 3, "18446744073709551616"},
    {ASCII "property float x\n", FFD_E_INVALID, 3, "before any element"},
    {ASCII "element vertex 1\nproperty float\n", FFD_E_INVALID, 4, "a type and a name"},
    {ASCII "element vertex 1\nproperty float x y\n", FFD_E_INVALID, 4, "a type and a name"},
    {ASCII "element vertex 1\nproperty\n", FFD_E_INVALID, 4, "a type and a name"},
    {ASCII "element vertex 1\nproperty half x\n", FFD_E_INVALID, 4, "half"},
    {ASCII "element vertex 1\nproperty list uchar x\n", FFD_E_INVALID, 4, "two types"},
    {ASCII "element vertex 1\nproperty list uchar list x\n", FFD_E_INVALID, 4, "\"list\""},
    {ASCII "element vertex 1\nproperty list float int x\n", FFD_E_INVALID, 4, "whole"},
    {ASCII "element vertex 1\nproperty float x\nproperty int x\n", FFD_E_INVALID, 5, "line 4"},
    {ASCII "element vertex 0\n" XYZ "element vertex 0\n", FFD_E_INVALID, 7, "line 3"},
    {ASCII "end_header\n", FFD_E_INVALID, 0, "no element vertex"},
    {ASCII "element vertex 0\nproperty float x\nproperty float y\nend_header\n", FFD_E_INVALID, 3,
     "property z"},
    {ASCII "element vertex 0\nproperty float x\nproperty list uchar float y\nproperty float z\nend_header\n",
     FFD_E_INVALID, 3, "property y"},
    {ONE, FFD_E_INVALID, 6, "end_header"},
    {ONE "comment end_header\n", FFD_E_INVALID, 7, "end_header"},
    {ONE "end_header\n", FFD_E_INVALID, 3, "1 row"},
    {ONE "end_header\n1 2\n", FFD_E_INVALID, 3, "1 row"},
    {ONE "end_header\n1 2    \n", FFD_E_INVALID, 8, "the line ends before z"},
    {ONE "end_header\n1 2 3 4\n", FFD_E_INVALID, 8, "\"4\""},
    {ONE "end_header\n\n\n1 two 3\n", FFD_E_INVALID, 10, "\"two\""},
    {ONE "end_header\n\r\n\r1 two 3\n", FFD_E_INVALID, 10, "\"two\""},
    {ONE "end_header\n         \n", FFD_E_INVALID, 9, "the file ends before it"},
    {ONE FACE "end_header\n1 2 3\n3 0 0\n", FFD_E_INVALID, 11, "the line ends before vertex_indices"},
    {ONE FACE "end_header\n1 2 3\n-3 0 0\n", FFD_E_INVALID, 11, "\"-3\""},
    {ONE FACE "end_header\n1 2 3\nthree 0 0\n", FFD_E_INVALID, 11, "\"three\""},
    {ONE FACE "end_header\n1 2 3\n9000000000000000 0 0\n", FFD_E_INVALID, 11, "vertex_indices"},
    {ONE FACE "end_header\n1 2 3\n1 0 0\n", FFD_E_INVALID, 11, "goes on"},
    {ASCII "element vertex 9223372036854775809\n" XYZ "end_header\n1 2 3\n", FFD_E_INVALID, 3, "rows"},
    {ASCII "element vertex 4294967296\n" XYZ "end_header\n", FFD_E_INVALID, 3, "rows"},
    {LITTLE "element vertex 1\n" XYZ "end_header\n01234567890", FFD_E_INVALID, 3, "1 row of 12 bytes"},
    {LITTLE "element vertex 1537228672809129302\n" XYZ "end_header\n01234567", FFD_E_INVALID, 3, "rows"},
    {LITTLE "element face 2\nproperty list char int vertex_index\nelement vertex 1\n" XYZ
            "end_header\n\x01\x01\x01\x01\x01\xff"
            "0123456789ab",
     FFD_E_INVALID, 0, "row 1 (counted from 0) of element face: not the count of list vertex_index: \"-1\""},
    {LITTLE "element face 1\nproperty list uint int vertex_index\nelement vertex 1\n" XYZ
            "end_header\n\xff\xff\xff\xff"
            "0123456789ab",
     FFD_E_INVALID, 0, "the file ends before or in vertex_index"},
    {LITTLE "element face 1\nproperty list uchar int vertex_index\nelement vertex 1\n" XYZ "end_header\n\x02"
            "0123456789ab",
     FFD_E_INVALID, 0, "row 0 (counted from 0) of element vertex: the file ends before or in"},
};

static void broken_files_are_refused_with_their_line(void **state)
{
    (void)state;
    assert_refused(ply, refused, COUNT(refused), has_words);
}

static void declarations_are_refused_only_beyond_the_limit(void **state)
{
    (void)state;
    for (int elements = 0; elements < 2; elements++)
        for (int excess = 0; excess < 2; excess++) {
            byte_buffer text = {0};
            mesh_document *document = NULL;
            ffd_error error;
            ffd_buffer_text(&text, ASCII "element vertex 0\n" XYZ);
            const int more = PLY_DECLARATIONS_MAX - (elements ? 1 : 3) + excess;
            for (int i = 0; i < more; i++)
                ffd_buffer_format(&text, elements ? "element e%d 0\n" : "property int p%d\n", i);
            ffd_buffer_text(&text, "end_header\n");
            assert_int_equal(open_bytes(ply, text.data, text.size, &document, &error),
                             excess ? FFD_E_LIMIT : FFD_OK);
            if (document)
                ply->close(document);
            ffd_buffer_free(&text);
        }
}

/* Files of all kinds, generated from one description */

/* A square pyramid, with unrelated elements and properties around it. */
typedef struct sample_kind {
    ply_encoding encoding;
    bool wide;            /* double coordinates */
    const char *line_end; /* of the header and of ascii rows */
} sample_kind;

typedef struct sample {
    byte_buffer bytes;
    sample_kind kind;
} sample;

static void put(sample *s, number_type type, double value)
{
    char bytes[FFD_NUMBER_CAPACITY];
    const ply_encoding encoding = s->kind.encoding;
    if (encoding == PLY_ASCII || number_is_real(type)) {
        size_t size = ffd_ply_store(encoding, type, number_round(type, value), bytes);
        ffd_buffer_append(&s->bytes, bytes, size);
        if (encoding == PLY_ASCII)
            ffd_buffer_text(&s->bytes, " ");
        return;
    }
    const size_t size = ffd_type_size(type);
    const uint32_t bits = (uint32_t)(int64_t)value;
    for (size_t i = 0; i < size; i++)
        bytes[i] = (char)(bits >> (8 * (encoding == PLY_BIG_ENDIAN ? size - 1 - i : i)));
    ffd_buffer_append(&s->bytes, bytes, size);
}

static void end_row(sample *s)
{
    if (s->kind.encoding == PLY_ASCII)
        ffd_buffer_text(&s->bytes, s->kind.line_end);
}

static void put_header(sample *s)
{
    const char *lines[] = {
        "ply",
        "comment made by a test",
        s->kind.encoding == PLY_ASCII           ? "format ascii 1.0"
        : s->kind.encoding == PLY_LITTLE_ENDIAN ? "format binary_little_endian 1.0"
                                                : "format binary_big_endian 1.0",
        "obj_info a pyramid",
        "element camera 1",
        "property list ushort short shutter",
        "property uint view",
        "element vertex 5",
        "property uchar red",
        s->kind.wide ? "property double z" : "property float z",
        s->kind.wide ? "property float64 x" : "property float32 x",
        "property list uchar double weights",
        "property float nx",
        s->kind.wide ? "property double y" : "property float y",
        "property float ny",
        "property double nz",
        "property char flag",
        "element nothing 1000000000000",
        "element face 5",
        "property float quality",
        "property list uchar int vertex_indices",
        "property list uchar float texcoord",
        "element edge 2",
        "property int vertex1",
        "property int vertex2",
        "end_header",
    };
    for (size_t i = 0; i < COUNT(lines); i++) {
        ffd_buffer_text(&s->bytes, lines[i]);
        ffd_buffer_text(&s->bytes, s->kind.line_end);
    }
}

static const double corners[5][3] = {{-1, -1, 0.1}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1.25}};
static const int pyramid[5][4] = {{3, 2, 1, 0}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}};

static void put_rows(sample *s)
{
    const number_type wide = s->kind.wide ? NUMBER_DOUBLE : NUMBER_FLOAT;
    put(s, NUMBER_UINT16, 2);
    put(s, NUMBER_INT16, -3);
    put(s, NUMBER_INT16, 2570); /* two line feed bytes in binary */
    put(s, NUMBER_UINT32, 4294967295.0);
    end_row(s);
    for (size_t v = 0; v < 5; v++) {
        put(s, NUMBER_UINT8, 10);
        put(s, wide, corners[v][2]);
        put(s, wide, corners[v][0]);
        put(s, NUMBER_UINT8, (double)v);
        for (size_t i = 0; i < v; i++)
            put(s, NUMBER_DOUBLE, 0.1 * (double)i);
        put(s, NUMBER_FLOAT, 0);
        put(s, wide, corners[v][1]);
        put(s, NUMBER_FLOAT, 0);
        put(s, NUMBER_DOUBLE, 1);
        put(s, NUMBER_INT8, -5);
        end_row(s);
    }
    for (size_t f = 0; f < 5; f++) {
        const int count = f == 0 ? 4 : 3;
        put(s, NUMBER_FLOAT, 0.5);
        put(s, NUMBER_UINT8, count);
        for (int i = 0; i < count; i++)
            put(s, NUMBER_INT32, pyramid[f][i]);
        put(s, NUMBER_UINT8, 0);
        end_row(s);
    }
    for (int e = 0; e < 2; e++) {
        put(s, NUMBER_INT32, e);
        put(s, NUMBER_INT32, 4);
        end_row(s);
    }
}

static sample make_sample(sample_kind kind)
{
    sample s = {.kind = kind};
    put_header(&s);
    put_rows(&s);
    assert_false(s.bytes.failed);
    return s;
}

#define KINDS 18

static sample_kind kind_of(size_t i)
{
    static const char *const line_ends[] = {"\n", "\r\n", "\r"};
    return (sample_kind){(ply_encoding)(i % 3), i / 9 == 1, line_ends[i / 3 % 3]};
}

static void every_encoding_reads_and_saves_the_same_mesh(void **state)
{
    (void)state;
    for (size_t k = 0; k < KINDS; k++) {
        sample s = make_sample(kind_of(k));
        mesh_document *d = opened(s.bytes.data, s.bytes.size);
        mesh_faces faces;
        double xyz[15], normals[15];
        assert_int_equal(d->part_count, 1);
        assert_int_equal(d->parts[0].vertex_count, 5);
        assert_int_equal(d->parts[0].normal_count, 5);
        ply->read(d, 0, MESH_POSITIONS, MESH_STORED, 0, 5, xyz);
        ply->read(d, 0, MESH_NORMALS, MESH_STORED, 0, 5, normals);
        for (size_t i = 0; i < 15; i++) {
            const double expected = corners[i / 3][i % 3];
            assert_true(xyz[i] == (s.kind.wide ? expected : (double)(float)expected));
            assert_true(normals[i] == (i % 3 == 2 ? 1 : 0));
        }
        assert_int_equal(ply->check(d, NULL), FFD_OK);
        assert_int_equal(ply->faces(d, MESH_STORED, &faces, NULL), FFD_OK);
        assert_int_equal(faces.face_count, 5);
        assert_int_equal(faces.lines, 2);
        for (size_t f = 0; f < 5; f++) {
            assert_int_equal(faces.start[f + 1] - faces.start[f], f == 0 ? 4 : 3);
            for (size_t i = faces.start[f]; i < faces.start[f + 1]; i++)
                assert_int_equal(faces.corners[i], pyramid[f][i - faces.start[f]]);
        }
        ffd_mesh_faces_free(&faces);
        assert_saved(d, s.bytes.data, s.bytes.size);
        ply->close(d);
        ffd_buffer_free(&s.bytes);
    }
}

/* Two coordinates of one vertex and the normal of another one change: all other bytes stay. */
static void only_changed_values_are_written(void **state)
{
    (void)state;
    for (size_t k = 0; k < KINDS; k++) {
        sample s = make_sample(kind_of(k));
        mesh_document *d = opened(s.bytes.data, s.bytes.size);
        const double moved[6] = {9, 9, 9, 1.3, -1, 1e-7}, turned[3] = {0, 0.6, 0.8};
        const double narrow[3] = {(double)1.3F, -1, (double)1e-7F};
        const uint8_t second[2] = {0, 1}, first[1] = {1};
        ffd_error error;
        file_input saved;
        double found[15], expected[15];
        assert_int_equal(ply->begin_results(d, &(mesh_results){.directions = true}, NULL), FFD_OK);
        ply->write(d, 0, MESH_POSITIONS, 0, 2, moved, second);
        ply->write(d, 0, MESH_NORMALS, 3, 1, turned, first);
        assert_int_equal(save_bytes(d, &saved, &error), FFD_OK);

        mesh_document *after = opened(saved.data, saved.size);
        ply->read(d, 0, MESH_POSITIONS, MESH_STORED, 0, 5, expected);
        memcpy(expected + 3, s.kind.wide ? moved + 3 : narrow, sizeof narrow);
        ply->read(after, 0, MESH_POSITIONS, MESH_STORED, 0, 5, found);
        assert_memory_equal(found, expected, sizeof found);
        ply->read(d, 0, MESH_NORMALS, MESH_STORED, 0, 5, expected);
        expected[10] = (double)0.6F;
        expected[11] = 0.8;
        ply->read(after, 0, MESH_NORMALS, MESH_STORED, 0, 5, found);
        assert_memory_equal(found, expected, sizeof found);

        /* With the old values restored, the numbers have their old texts or bytes: 1, 0 and 0, 1. */
        assert_int_equal(ply->begin_results(after, &(mesh_results){.directions = true}, NULL), FFD_OK);
        ply->read(d, 0, MESH_POSITIONS, MESH_STORED, 0, 5, expected);
        ply->write(after, 0, MESH_POSITIONS, 1, 1, expected + 3, first);
        ply->read(d, 0, MESH_NORMALS, MESH_STORED, 0, 5, expected);
        ply->write(after, 0, MESH_NORMALS, 3, 1, expected + 9, first);
        assert_saved(after, s.bytes.data, s.bytes.size);
        ply->close(after);
        ffd_file_unload(&saved);
        ply->close(d);
        ffd_buffer_free(&s.bytes);
    }
}

static void unchanged_numbers_keep_their_text(void **state)
{
    (void)state;
    static const char header[] = ASCII "element vertex 2\nproperty float x\nproperty double y\n"
                                       "property float z\nend_header\n";
    char before[256], after[256];
    const double moved[6] = {1.1, 1.1, 0.5, 0, 0, 0};
    const uint8_t changed[2] = {1, 0};
    snprintf(before, sizeof before, "%s 1.000 \t+2.50E0  .5  \n\n1e0 -0.0 0.100000001490116", header);
    snprintf(after, sizeof after, "%s 1.1 \t1.1  .5  \n\n1e0 -0.0 0.100000001490116", header);
    mesh_document *d = opened(before, strlen(before));
    assert_int_equal(ply->begin_results(d, &(mesh_results){.directions = true}, NULL), FFD_OK);
    ply->write(d, 0, MESH_POSITIONS, 0, 2, moved, changed);
    assert_saved(d, after, strlen(after));
    ply->close(d);
}

static void mixed_line_ends_are_read_and_kept(void **state)
{
    (void)state;
    static const char text[] = ASCII "element vertex 3\n" XYZ "end_header\n0 0 0\r1 0 0\r\n\n0 1 0";
    mesh_document *d = opened(text, strlen(text));
    double xyz[9];
    ply->read(d, 0, MESH_POSITIONS, MESH_STORED, 0, 3, xyz);
    assert_true(xyz[3] == 1 && xyz[7] == 1);
    assert_saved(d, text, strlen(text));
    ply->close(d);
}

/* Properties that results cannot be stored in */

static void coordinates_of_a_whole_type_are_refused(void **state)
{
    (void)state;
    static const char text[] =
        ASCII "element vertex 1\nproperty float x\nproperty short y\nproperty float z\n"
              "end_header\n1 2 3\n";
    mesh_document *d = opened(text, strlen(text));
    ffd_error error;
    double xyz[3];
    ply->read(d, 0, MESH_POSITIONS, MESH_STORED, 0, 1, xyz);
    assert_true(xyz[1] == 2);
    assert_int_equal(ply->check(d, &error), FFD_E_UNSUPPORTED);
    assert_int_equal(error.line, 3);
    assert_non_null(strstr(error.message, "y of the vertices is of type short"));
    ply->close(d);
}

static void normals_of_a_whole_type_can_only_be_kept(void **state)
{
    (void)state;
    static const char text[] =
        ASCII "element vertex 1\n" XYZ "property char nx\nproperty char ny\nproperty float nz\n"
              "end_header\n1 2 3 0 0 1\n";
    mesh_document *d = opened(text, strlen(text));
    ffd_error error;
    assert_int_equal(d->parts[0].normal_count, 0);
    assert_int_equal(ply->begin_results(d, &(mesh_results){.directions = true}, &error), FFD_E_UNSUPPORTED);
    assert_int_equal(ply->begin_results(d, &(mesh_results){.directions = false}, &error), FFD_OK);
    ply->close(d);
}

static void two_of_three_normal_properties_are_no_normals(void **state)
{
    (void)state;
    static const char text[] = ASCII "element vertex 1\n" XYZ "property float nx\nproperty float nz\n"
                                     "end_header\n1 2 3 zero 1\n";
    mesh_document *d = opened(text, strlen(text));
    assert_int_equal(d->parts[0].normal_count, 0);
    assert_int_equal(ply->begin_results(d, &(mesh_results){.directions = true}, NULL), FFD_OK);
    assert_saved(d, text, strlen(text));
    ply->close(d);
}

static void the_largest_coordinate_is_that_of_the_type(void **state)
{
    (void)state;
    static const char narrow[] = ASCII "element vertex 0\n" XYZ "end_header\n";
    static const char wide[] = ASCII "element vertex 0\nproperty double x\nproperty double y\n"
                                     "property double z\nend_header";
    mesh_document *d = opened(narrow, strlen(narrow));
    assert_true(d->largest_coordinate == (double)FLT_MAX);
    ply->close(d);
    d = opened(wide, strlen(wide));
    assert_true(d->largest_coordinate == DBL_MAX);
    ply->close(d);
}

/* Faces */

static ffd_status faces_of(const char *text, mesh_faces *faces, ffd_error *error)
{
    mesh_document *d = opened(text, strlen(text));
    const ffd_status status = ply->faces(d, MESH_STORED, faces, error);
    ply->close(d);
    return status;
}

static void bad_faces_are_refused_with_their_line(void **state)
{
    (void)state;
    static const refused_text cases[] = {
        {ONE FACE "end_header\n1 2 3\n2 0 1\n", FFD_E_INVALID, 11, "face 0: there is no vertex 1, only 1"},
        {ONE FACE "end_header\n1 2 3\n1 -1\n", FFD_E_INVALID, 11, "there is no vertex -1, only 1"},
        {ONE FACE "end_header\n1 2 3\n1 0.5\n", FFD_E_INVALID, 11, "there is no vertex 0.5, only 1"},
        {ONE FACE "end_header\n1 2 3\n1 a\n", FFD_E_INVALID, 11, "there is no vertex a, only 1"},
        {LITTLE "element face 1\nproperty list char int vertex_index\nelement vertex 1\n" XYZ
                "end_header\n\x01\xff\xff\xff\xff"
                "0123456789ab",
         FFD_E_INVALID, 0, "there is no vertex -1, only 1"},
        {ONE
         "element tristrips 2\nproperty list int int vertex_indices\nend_header\n1 2 3\n1 0\n4 0 0 -1 1\n",
         FFD_E_INVALID, 12, "strip 1: there is no vertex 1, only 1"},
        {ONE "element tristrips 1\nproperty list int int vertex_indices\nend_header\n1 2 3\n1 -2\n",
         FFD_E_INVALID, 11, "strip 0: there is no vertex -2, only 1"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        mesh_faces faces;
        ffd_error error = {0};
        assert_int_equal(faces_of(cases[i].text, &faces, &error), cases[i].status);
        assert_int_equal(error.line, cases[i].line);
        if (!strstr(error.message, cases[i].says))
            fail_msg("case %zu: %s", i, error.message);
        assert_null(faces.start);
    }
}

static void missing_or_empty_face_lists_give_no_faces(void **state)
{
    (void)state;
    static const char *const texts[] = {
        ONE "end_header\n1 2 3\n",
        ONE "element face 0\nproperty list uchar int vertex_index\nend_header\n1 2 3\n",
        ONE "element face 4000000000000000000\nend_header\n1 2 3\n",
        ONE "element face 1\nproperty int vertex_index\nend_header\n1 2 3\n7\n",
        ONE "element tristrips 0\nproperty list int int vertex_indices\nend_header\n1 2 3\n",
        ONE "element tristrips 1\nproperty list int int vertex_indices\nend_header\n1 2 3\n5 0 0 0 -1 -1\n",
        ONE "element tristrips 1\nproperty int n\nend_header\n1 2 3\n5\n",
    };
    for (size_t i = 0; i < COUNT(texts); i++) {
        mesh_faces faces;
        assert_int_equal(faces_of(texts[i], &faces, NULL), FFD_OK);
        assert_int_equal(faces.face_count, 0);
        assert_int_equal(faces.start[0], 0);
        assert_int_equal(faces.vertex_count, 1);
        ffd_mesh_faces_free(&faces);
    }
}

/* Comparing */

static ffd_comparison compared_samples(const sample *a, const sample *b, double tolerance)
{
    mesh_document *x = opened(a->bytes.data, a->bytes.size), *y = opened(b->bytes.data, b->bytes.size);
    const ffd_comparison result = compared(x, y, tolerance, 0);
    ply->close(x);
    ply->close(y);
    return result;
}

static void encodings_of_one_mesh_compare_equal(void **state)
{
    (void)state;
    for (size_t i = 0; i < KINDS; i++)
        for (size_t k = 0; k < KINDS; k++) {
            sample a = make_sample(kind_of(i)), b = make_sample(kind_of(k));
            const ffd_comparison result = compared_samples(&a, &b, 0);
            assert_int_equal(result.equal, i / 9 == k / 9);
            if (result.equal)
                assert_int_equal(result.positions_compared, 5);
            else
                assert_non_null(strstr(result.first.text, "property z: types"));
            ffd_buffer_free(&a.bytes);
            ffd_buffer_free(&b.bytes);
        }
}

static sample text_sample(const char *text)
{
    sample s = {0};
    ffd_buffer_text(&s.bytes, text);
    return s;
}

static void a_comparison_names_the_first_difference(void **state)
{
    (void)state;
    static const char base[] = ONE "property uchar red\n" FACE "end_header\n1 2 3 4\n2 0 0\n";
    static const struct {
        const char *text;
        double tolerance;
        const char *says; /* NULL: equal */
    } cases[] = {
        {ONE "comment x\nproperty uint8 red\n" FACE "end_header\n\n1.0 2e0 3 4.0\n 2 0 0", 0, NULL},
        {ONE "property uchar red\n" FACE "end_header\n1 2.5 3 4\n2 0 0\n", 0.5, NULL},
        {ONE "property uchar red\n" FACE "end_header\n1 2.5 3 4\n2 0 0\n", 0.25,
         "vertex 0 counted from 0 (line 11): y differs by 0.5"},
        {ONE "property uchar red\n" FACE "end_header\n1 2 nan 4\n2 0 0\n", 9, "z: 3 and nan"},
        {ONE "property uchar red\n" FACE "end_header\n\n1 2 3 5\n2 0 0\n", 9,
         "vertex 0 counted from 0 (lines 11 and 12): red: 4 and 5"},
        {ONE "property uchar red\n" FACE "end_header\n1 2 3 4\n1 0\n", 9, "vertex_indices: 2 and 1"},
        {ONE "property uchar red\n" FACE "end_header\n1 2 3 4\n2 0 1\n", 9, "vertex_indices: 0 and 1"},
        {ONE "property uchar blue\n" FACE "end_header\n1 2 3 4\n2 0 0\n", 9,
         "properties: \"red\" and \"blue\""},
        {ONE "property char red\n" FACE "end_header\n1 2 3 4\n2 0 0\n", 9, "red: types uchar and char"},
        {ONE "property list uchar uchar red\n" FACE "end_header\n1 2 3 0\n2 0 0\n", 9, "only in the second"},
        {ONE FACE "end_header\n1 2 3\n2 0 0\n", 9, "4 and 3 properties"},
        {ONE "property uchar red\nend_header\n1 2 3 4\n", 9, "2 and 1 elements"},
        {ONE "property uchar red\nelement edge 1\nproperty int a\nend_header\n1 2 3 4\n1\n", 9,
         "elements: \"face\" and \"edge\""},
        {ONE "property uchar red\n"
             "element face 2\nproperty list uchar int vertex_indices\nend_header\n1 2 3 4\n2 0 0\n0\n",
         9, "element face has 1 and 2 rows"},
        {ONE "obj_info x\nproperty uchar red\n" FACE "end_header\n1 2 3 4\n2 0 0\n", 9, "0 and 1 lines"},
        {ONE "comment TextureFile x\nproperty uchar red\n" FACE "end_header\n1 2 3 4\n2 0 0\n", 9, "lines"},
    };
    sample a = text_sample(base);
    for (size_t i = 0; i < COUNT(cases); i++) {
        sample b = text_sample(cases[i].text);
        const ffd_comparison result = compared_samples(&a, &b, cases[i].tolerance);
        assert_int_equal(result.equal, cases[i].says == NULL);
        if (cases[i].says && !strstr(result.first.text, cases[i].says))
            fail_msg("case %zu: %s", i, result.first.text);
        ffd_buffer_free(&b.bytes);
    }
    ffd_buffer_free(&a.bytes);
}

/* Hostile files */

static void truncated_files_are_refused(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (size_t k = 0; k < 3; k++) {
        sample s = make_sample(kind_of(k));
        for (size_t size = 0; size < s.bytes.size; size++) {
            const ffd_status status = use_bytes(ply, s.bytes.data, size, 1, &d);
            if (s.kind.encoding != PLY_ASCII || size + 3 < s.bytes.size)
                /* "1." is another version. */
                assert_true(status == FFD_E_INVALID || (status == FFD_E_UNSUPPORTED && size < 60));
        }
        assert_int_equal(use_bytes(ply, s.bytes.data, s.bytes.size, 1, &d), FFD_OK);
        ffd_buffer_free(&s.bytes);
    }
}

static void files_with_a_changed_byte_are_read_or_refused(void **state)
{
    (void)state;
    static const char values[] = {0, '\n', '\r', ' ', '9', '-', 'e', (char)0x80, (char)0xff};
    draw d = {draw_seed()};
    const size_t apart = (size_t)stride(5);
    size_t opened_files = 0, refused_files = 0;
    for (size_t k = 0; k < 3; k++) {
        sample s = make_sample(kind_of(k));
        for (size_t at = 0; at < s.bytes.size; at += apart)
            for (size_t v = 0; v < COUNT(values); v++) {
                const char kept = s.bytes.data[at];
                s.bytes.data[at] = values[v];
                const bool opens = use_bytes(ply, s.bytes.data, s.bytes.size, 16, &d) == FFD_OK;
                opened_files += opens;
                refused_files += !opens;
                s.bytes.data[at] = kept;
            }
        ffd_buffer_free(&s.bytes);
    }
    assert_true(opened_files > 1000 / apart && refused_files > 1000 / apart);
}

static void every_failed_allocation_is_reported(void **state)
{
    (void)state;
    for (size_t k = 0; k < 3; k++) {
        sample s = make_sample(kind_of(k));
        const byte_seed seed = {s.bytes.data, s.bytes.size};
        use_with_failing_memory(ply, &seed);
        ffd_buffer_free(&s.bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_is_loaded_and_stored),
        cmocka_unit_test(ascii_numbers_are_rounded_and_written_by_type),
        cmocka_unit_test(only_whole_counts_are_accepted),
        cmocka_unit_test(broken_files_are_refused_with_their_line),
        cmocka_unit_test(declarations_are_refused_only_beyond_the_limit),
        cmocka_unit_test(every_encoding_reads_and_saves_the_same_mesh),
        cmocka_unit_test(only_changed_values_are_written),
        cmocka_unit_test(unchanged_numbers_keep_their_text),
        cmocka_unit_test(mixed_line_ends_are_read_and_kept),
        cmocka_unit_test(coordinates_of_a_whole_type_are_refused),
        cmocka_unit_test(normals_of_a_whole_type_can_only_be_kept),
        cmocka_unit_test(two_of_three_normal_properties_are_no_normals),
        cmocka_unit_test(the_largest_coordinate_is_that_of_the_type),
        cmocka_unit_test(bad_faces_are_refused_with_their_line),
        cmocka_unit_test(missing_or_empty_face_lists_give_no_faces),
        cmocka_unit_test(encodings_of_one_mesh_compare_equal),
        cmocka_unit_test(a_comparison_names_the_first_difference),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(files_with_a_changed_byte_are_read_or_refused),
        cmocka_unit_test(every_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, remove_saved);
}
