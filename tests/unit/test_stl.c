/* STL: detecting the encoding, facets of text with any spacing, binary records, normals, saving and
   comparing, on files written here. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/mesh_bytes.h"
#include "base/little_endian.h"
#include "io/stl/stl_document.h"
#include "io/stl/stl_format.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const mesh_format *const stl = &ffd_stl_format;

static mesh_document *opened(const char *text)
{
    return opened_bytes(stl, text, strlen(text));
}

/* A record of a binary file. */
typedef struct record {
    float normal[3], corners[9];
    unsigned attribute;
} record;

static void put_float(byte_buffer *out, float value)
{
    unsigned char bytes[4];
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    store_u32(bytes, bits);
    ffd_buffer_append(out, bytes, sizeof bytes);
}

static byte_buffer binary(const char *header, const record *records, size_t count)
{
    byte_buffer out = {0};
    unsigned char head[STL_START] = {0};
    memcpy(head, header, strlen(header));
    store_u32(head + STL_HEADER, (uint32_t)count);
    ffd_buffer_append(&out, head, sizeof head);
    for (size_t i = 0; i < count; i++) {
        const unsigned char attribute[2] = {(unsigned char)records[i].attribute,
                                            (unsigned char)(records[i].attribute >> 8)};
        for (size_t a = 0; a < 3; a++)
            put_float(&out, records[i].normal[a]);
        for (size_t a = 0; a < 9; a++)
            put_float(&out, records[i].corners[a]);
        ffd_buffer_append(&out, attribute, sizeof attribute);
    }
    assert_false(out.failed);
    return out;
}

#define UP                                                                                                   \
    {                                                                                                        \
        0, 0, 1                                                                                              \
    }
#define FLAT                                                                                                 \
    {                                                                                                        \
        0, 0, 0, 1, 0, 0, 0, 1, 0                                                                            \
    }

/* Positions as "0,0,0 1,0,0 0,1,0", with a bar after each facet. */
static void append_contents(const mesh_document *document, byte_buffer *text)
{
    assert_int_equal(document->parts->normal_count, 0);
    append_positions(document, 3, text);
}

static void append_contents_of_text(const mesh_document *document, byte_buffer *text)
{
    assert_true(document->largest_coordinate == DBL_MAX);
    append_contents(document, text);
}

#define FACET(normal, corners) "facet normal " normal "\nouter loop\n" corners "endloop\nendfacet\n"
#define CORNERS "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
#define TEXT "solid a\n" FACET("0 0 1", CORNERS) "endsolid a\n"
#define IS_TEXT "0,0,0 1,0,0 0,1,0"

static void text_in_every_spacing_is_read(void **state)
{
    (void)state;
    static const read_text cases[] = {
        {TEXT, IS_TEXT},
        {"solid\n" FACET("0 0 1", CORNERS) "endsolid", IS_TEXT},
        {"\xEF\xBB\xBFsolid\n" FACET("0 0 1", CORNERS) "endsolid", IS_TEXT},
        {"\n\n  SOLID  A b\r\nFACET\tNORMAL 0 0 1\r\nOuter Loop\rVERTEX 0 0 0\r\n vertex +1 .0 "
         "0e5\nVertex\n0\n1E0\n0 "
         "EndLoop\nENDFACET\nEndSolid A b\n\n",
         IS_TEXT},
        {"solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet "
         "endsolid a",
         IS_TEXT},
        {"solid a facet of a wheel\n" FACET("0 0 1", CORNERS) "endsolid a facet of a wheel\n", IS_TEXT},
        {"solid solid endsolid\n" FACET("0 0 1", CORNERS) "endsolid solid\n", IS_TEXT},
        {"solid a\nendsolid a\nsolid b\n" FACET("0 0 1", CORNERS)
             FACET("1 0 0", CORNERS) "endsolid b\nsolid\n" FACET("0 1 0", CORNERS) "endsolid\n",
         IS_TEXT " | " IS_TEXT " | " IS_TEXT},
        {"solid a\nendsolid a\n", ""},
        /* normals written by programs without any */
        {"solid\n" FACET("nan -nan inf", CORNERS) "endsolid", IS_TEXT},
        {"solid\n" FACET("-1.#IND 1.#QNAN -1.#J", CORNERS) "endsolid", IS_TEXT},
        {"solid\n" FACET("0 0 1", "vertex nan 0 1e999\nvertex 1 2 3\nvertex 1 2 3\n") "endsolid",
         "nan,0,inf 1,2,3 1,2,3"},
    };
    assert_read(stl, cases, COUNT(cases), append_contents_of_text);
}

static void broken_texts_are_refused_with_their_line(void **state)
{
    (void)state;
    static const refused_text cases[] = {
        {"solid a\n", FFD_E_INVALID, 2, "the file ends where facet or endsolid is expected"},
        {"solid a\nface normal 0 0 1\n", FFD_E_INVALID, 2, "expected facet or endsolid, found \"face\""},
        {"solid a\nfacet\nouter loop\n", FFD_E_INVALID, 3, "expected normal, found \"outer\""},
        {"solid a\nfacet normal 0 0\nouter loop\n", FFD_E_INVALID, 3,
         "expected a number of the normal, found \"outer\""},
        {"solid a\nfacet normal 0 0 1,0\nouter loop\nvertex", FFD_E_INVALID, 4,
         "the file ends where a coordinate is expected"},
        {"solid a\nfacet normal 0 0 x\nouter loop\n", FFD_E_INVALID, 2,
         "expected a number of the normal, found \"x\""},
        {"solid a\nfacet normal 0 0 1\nouter lop\n", FFD_E_INVALID, 3, "expected loop, found \"lop\""},
        {"solid a\n" FACET("0 0 1", "vertex 0 0 0\nvertex 1 0\nvertex 0 1 0\n"), FFD_E_INVALID, 6,
         "expected a coordinate, found \"vertex\""},
        {"solid a\n" FACET("0 0 1", "vertex 0 0 0\nvertex 1 0 0x\nvertex 0 1 0\n"), FFD_E_INVALID, 5,
         "expected a coordinate, found \"0x\""},
        {"solid a\n" FACET("0 0 1", "vertex 0 0 0\nvertex 1 0 0\n"), FFD_E_INVALID, 6,
         "expected vertex, found \"endloop\""},
        {"solid a\n" FACET("0 0 1", CORNERS "vertex 1 1 0\n"), FFD_E_INVALID, 7,
         "expected endloop, found \"vertex\""},
        {"solid a\n" FACET("0 0 1", CORNERS), FFD_E_INVALID, 9,
         "the file ends where facet or endsolid is expected"},
        {TEXT "facet", FFD_E_INVALID, 10, "expected solid, found \"facet\""},
        {TEXT "solid", FFD_E_INVALID, 10, "the file ends where facet or endsolid is expected"},
    };
    assert_refused(stl, cases, COUNT(cases), is_words);
}

/* Binary files */

static void binary_is_read_whatever_its_header_says(void **state)
{
    (void)state;
    static const record records[2] = {{UP, FLAT, 0x1234}, {{0, 0, 0}, {1, 2, 3, 4, 5, 6, -0.1F, 8, 9}, 0}};
    static const char *const headers[] = {"", "made by a test", "solid a\nfacet normal 0 0 1\nouter loop\n"};
    for (size_t h = 0; h < COUNT(headers); h++)
        for (size_t count = 0; count <= 2; count++)
            for (int behind = 0; behind < 2; behind++) {
                static const char *const expected[] = {"", IS_TEXT, IS_TEXT " | 1,2,3 4,5,6 -0.1,8,9"};
                byte_buffer contents = {0};
                byte_buffer file = binary(headers[h], records, count);
                ffd_buffer_append(&file, "behind", behind ? 6 : 0);
                mesh_document *document = opened_bytes(stl, file.data, file.size);
                append_contents(document, &contents);
                assert_int_equal(contents.size, strlen(expected[count]));
                assert_memory_equal(contents.data, expected[count], contents.size);
                assert_true(document->largest_coordinate == (double)FLT_MAX);
                assert_int_equal(stl->begin_results(document, &(mesh_results){.directions = true}, NULL),
                                 FFD_OK);
                assert_saved(document, file.data, file.size);
                stl->close(document);
                ffd_buffer_free(&contents);
                ffd_buffer_free(&file);
            }
}

/* A header of 80 letters that begins with "solid" contains no NUL: the size decides. */
static void a_full_header_that_says_solid_is_still_binary(void **state)
{
    (void)state;
    static const record records[1] = {{UP, FLAT, 0}};
    byte_buffer file =
        binary("solid 6789012345678901234567890123456789012345678901234567890123456789012345678", records, 1);
    file.data[STL_HEADER - 1] = '0';
    mesh_document *document = opened_bytes(stl, file.data, file.size);
    assert_int_equal(document->parts->vertex_count, 3);
    stl->close(document);
    ffd_buffer_free(&file);
}

static void binary_that_is_too_short_is_refused(void **state)
{
    (void)state;
    static const record records[1] = {{UP, FLAT, 0}};
    static const struct {
        uint32_t stated;
        size_t size;
        const char *message;
    } cases[] = {
        {1, 0,
         "is not an STL file: it neither begins with \"solid\" nor has, with 0 bytes, the 84 of a binary "
         "file's "
         "header"},
        {1, 83,
         "is not an STL file: it neither begins with \"solid\" nor has, with 83 bytes, the 84 of a binary "
         "file's "
         "header"},
        {1, 84, "1 facet is stated, which takes 134 bytes: the file has 84"},
        {1, 133, "1 facet is stated, which takes 134 bytes: the file has 133"},
        {2, 134, "2 facets are stated, which take 184 bytes: the file has 134"},
        {UINT32_MAX, 134, "4294967295 facets are stated, which take 214748364834 bytes: the file has 134"},
    };
    byte_buffer file = binary("x", records, 1);
    for (size_t i = 0; i < COUNT(cases); i++) {
        mesh_document *document;
        ffd_error error;
        store_u32((unsigned char *)file.data + STL_HEADER, cases[i].stated);
        assert_int_equal(open_bytes(stl, file.data, cases[i].size, &document, &error), FFD_E_INVALID);
        assert_string_equal(error.message, cases[i].message);
        assert_int_equal(error.line, 0);
    }
    ffd_buffer_free(&file);
}

/* Normals */

static void only_facets_of_finite_area_have_a_normal(void **state)
{
    (void)state;
    static const struct {
        double corners[9], normal[3];
        bool found;
    } cases[] = {
        {FLAT, UP, true},
        {{0, 0, 0, 0, 1, 0, 1, 0, 0}, {0, 0, -1}, true},
        {{5, 5, 5, 5, 8, 5, 5, 5, 9}, {1, 0, 0}, true},
        {{0, 0, 0, 1e-200, 0, 0, 0, 1e-200, 0}, UP, true},
        {{0, 0, 0, 1e300, 0, 0, 0, 1e300, 0}, UP, true},
        {{0, 0, 0, 1, 0, 0, 0, 1e-9, 0}, UP, true},
        {{0, 0, 0, 0, 0, 0, 0, 1, 0}, {0}, false},
        {{0, 0, 0, 1, 1, 1, 2, 2, 2}, {0}, false},
        {{0.1, 0.1, 0.1, 0.2, 0.2, 0.2, 0.3, 0.3, 0.3}, {0}, false},
        {{-1e308, 0, 0, 1e308, 0, 0, 0, 1e308, 0}, {0}, false},
        {{NAN, 0, 0, 1, 0, 0, 0, 1, 0}, {0}, false},
        {{0, 0, 0, 1, 0, 0, 0, INFINITY, 0}, {0}, false},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        double normal[3] = {0};
        assert_int_equal(ffd_stl_normal(cases[i].corners, normal), cases[i].found);
        for (int a = 0; cases[i].found && a < 3; a++)
            assert_true(normal[a] == cases[i].normal[a]);
    }
}

/* Checks the facet of a text after its corners were rotated (x y z to z x y). */
static void assert_turned(const char *normal, bool renew, const char *expected)
{
    static const double turned[9] = {0, 0, 0, 0, 1, 0, 0, 0, 1};
    static const uint8_t changed[3] = {1, 1, 1};
    char before[256], after[256];
    snprintf(before, sizeof before,
             "solid\n facet normal %s\nouter loop\n" CORNERS "endloop endfacet\nendsolid", normal);
    snprintf(after, sizeof after,
             "solid\n facet normal %s\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop "
             "endfacet\nendsolid",
             expected);
    mesh_document *document = opened(before);
    assert_int_equal(stl->begin_results(document, &(mesh_results){.directions = renew}, NULL), FFD_OK);
    stl->write(document, 0, MESH_POSITIONS, 0, 3, turned, changed);
    assert_saved(document, after, strlen(after));
    stl->close(document);
}

static void normals_are_renewed_on_the_side_they_were(void **state)
{
    (void)state;
    assert_turned("0 0 1.0", true, "1 0 0");
    assert_turned("0 0.0\t0.99", true, "1 0.0\t0"); /* an unchanged number keeps its text */
    assert_turned("0 0 1.0", false, "0 0 1.0");
    assert_turned("0 0 -1", true, "-1 0 0"); /* opposite to the order of the corners */
    assert_turned("0 0.0 -0", true, "0 0.0 -0");
    assert_turned("nan nan nan", true, "1 0 0");
    assert_turned("-1.#IND -1.#IND -1.#IND", true, "1 0 0");
}

static void only_facets_that_turn_get_new_normals(void **state)
{
    (void)state;
    static const record records[4] = {
        {{0, 0, 2}, FLAT, 7}, {{0, 0, 2}, FLAT, 8}, {{0, 0, 2}, FLAT, 9}, {{0}, FLAT, 10}};
    record after[4];
    double place[36];
    uint8_t changed[12] = {0, 1, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1};
    memcpy(after, records, sizeof after);
    for (size_t i = 0; i < 36; i++)
        place[i] = (double)records[i / 9].corners[i % 9];
    place[5] = -1.1; /* the first facet turns about its side on y */
    for (size_t i = 18; i < 27; i++)
        place[i] = 1.0 / 3; /* the third one collapses */
    place[29] = 5;          /* a corner of the fourth one */
    after[0].corners[5] = -1.1F;
    for (size_t i = 0; i < 9; i++)
        after[2].corners[i] = (float)(1.0 / 3);
    after[3].corners[2] = 5;
    /* Computed from the corner as written, a float. */
    const double rise = (double)-1.1F, length = sqrt(1 + rise * rise);
    after[0].normal[0] = (float)(-rise / length);
    after[0].normal[2] = (float)(1 / length);
    byte_buffer before_file = binary("solid", records, 4), after_file = binary("solid", after, 4);
    mesh_document *document = opened_bytes(stl, before_file.data, before_file.size);
    assert_int_equal(stl->begin_results(document, &(mesh_results){.directions = true}, NULL), FFD_OK);
    stl->write(document, 0, MESH_POSITIONS, 0, 12, place, changed);
    file_input saved;
    assert_int_equal(save_bytes(document, &saved, NULL), FFD_OK);
    assert_int_equal(saved.size, after_file.size);
    for (size_t i = 0; i < saved.size; i++) {
        /* the first normal, up to the last bit of a float */
        const bool normal = i >= STL_START && i < STL_START + 3 * sizeof(float);
        assert_true(saved.data[i] == (unsigned char)after_file.data[i] || normal);
    }
    double normal[3];
    ffd_stl_load(saved.data + STL_START, normal);
    for (int a = 0; a < 3; a++)
        assert_true(fabs(normal[a] - (double)after[0].normal[a]) < 1e-7);
    ffd_file_unload(&saved);
    stl->close(document);
    ffd_buffer_free(&before_file);
    ffd_buffer_free(&after_file);
}

static void text_is_written_in_double_precision(void **state)
{
    (void)state;
    static const char before[] =
        "solid\n" FACET("0 0 1", "vertex 1.0 2.00 3\nvertex 1 0 0\nvertex 0 1 0\n") "endsolid",
                      after[] = "solid\n" FACET(
                          "0 0 1", "vertex 1.0 0.1 1e-300\nvertex 1 0 0\nvertex 0 1 0\n") "endsolid";
    const double place[3] = {1, 0.1, 1e-300};
    const uint8_t changed = 1;
    mesh_document *document = opened(before);
    assert_int_equal(stl->begin_results(document, &(mesh_results){.directions = false}, NULL), FFD_OK);
    stl->write(document, 0, MESH_POSITIONS, 0, 1, place, &changed);
    assert_saved(document, after, sizeof after - 1);
    stl->close(document);
}

/* Topology, description, comparison */

static void facets_share_vertices_of_one_position(void **state)
{
    (void)state;
    static const record records[3] = {
        {UP, FLAT, 0}, {UP, {1, 0, 0, 1, 1, 0, -0.0F, 1, 0}, 0}, {UP, {0, 0, 0, NAN, 0, 0, NAN, 0, 0}, 0}};
    static const uint32_t corners[9] = {0, 1, 2, 1, 4, 2, 0, 7, 7};
    byte_buffer file = binary("", records, 3);
    mesh_document *document = opened_bytes(stl, file.data, file.size);
    mesh_faces faces;
    assert_int_equal(stl->faces(document, MESH_STORED, &faces, NULL), FFD_OK);
    assert_int_equal(faces.vertex_count, 9);
    assert_int_equal(faces.face_count, 3);
    assert_int_equal(faces.repeated, 4);
    assert_memory_equal(faces.corners, corners, sizeof corners);
    for (size_t i = 0; i <= 3; i++)
        assert_int_equal(faces.start[i], 3 * i);
    ffd_mesh_faces_free(&faces);
    stl->close(document);
    ffd_buffer_free(&file);
}

static void a_description_counts_what_the_file_has(void **state)
{
    (void)state;
    static const record records[2] = {{UP, FLAT, 0x8000}, {UP, {0}, 0}};
    static const char text[] = "solid a  b \r\n" FACET("0 0 1", CORNERS) "endsolid\nsolid\nendsolid";
    byte_buffer file = binary("a\nb  ", records, 2);
    mesh_document *document = opened_bytes(stl, file.data, file.size);
    assert_described(
        document,
        "{\"encoding\": \"binary\", \"facets\": 2, \"degenerate_facets\": 1, \"header\": \"a\\nb\", "
        "\"facets_with_attribute\": 1, \"bytes_behind\": 0}\n");
    stl->close(document);
    ffd_buffer_free(&file);
    document = opened(text);
    assert_described(
        document,
        "{\"encoding\": \"ascii\", \"facets\": 1, \"degenerate_facets\": 0, \"names\": [\"a  b\", \"\"], "
        "\"solids\": 2, \"line_endings\": \"mixed\"}\n");
    stl->close(document);
}

static void assert_compared(const byte_buffer *a, const byte_buffer *b, double tolerance,
                            const char *difference)
{
    mesh_document *x = opened_bytes(stl, a->data, a->size), *y = opened_bytes(stl, b->data, b->size);
    const ffd_comparison result = compared(x, y, tolerance, 0);
    assert_string_equal(result.first.text, difference ? difference : "");
    stl->close(x);
    stl->close(y);
}

static void a_comparison_of_texts_names_the_difference(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double tolerance;
        const char *difference;
    } cases[] = {
        {TEXT, 0, NULL},
        {"SOLID a facet normal 0 -0 1e0\nOUTER loop vertex 0 0 0.0 vertex 1 0 0 vertex 0 1 0 endloop "
         "endfacet endsolid",
         0, NULL},
        {"solid b\n" FACET("0 0 1", CORNERS) "endsolid b\n", 9,
         "solid 0 counted from 0 is named \"a\" and \"b\""},
        {"solid a\nendsolid\nsolid a\n" FACET("0 0 1", CORNERS) "endsolid a\n", 9,
         "solid 0 counted from 0 has more facets in the first"},
        {TEXT "solid c\nendsolid", 9, "solid 1 counted from 0 is only in the second"},
        {"solid a\n" FACET("0 0 1", "vertex 0 0 0\nvertex 1 0 0.5\nvertex 0 1 0\n") "endsolid a\n", 0.5,
         NULL},
        {"solid a\n" FACET("0 0 1", "vertex 0 0 0\nvertex 1 0 0.5\nvertex 0 1 0\n") "endsolid a\n", 0.25,
         "facet 0 counted from 0 (line 2), corner 1: z differs by 0.5"},
        {"solid a\n\n" FACET("0 0 1", "vertex 0 0 0\nvertex 1 nan 0\nvertex 0 1 0\n") "endsolid a\n", 9,
         "facet 0 counted from 0 (lines 2 and 3), corner 1: y: 0 and nan"},
        {"solid a\n" FACET("0 0 0.5", CORNERS) "endsolid a\n", 9,
         "facet 0 counted from 0 (line 2): z of the normal differs by 0.5"},
        {"solid a\nendsolid a\n", 9, "1 and 0 facets"},
    };
    byte_buffer a = {0};
    ffd_buffer_text(&a, TEXT);
    for (size_t i = 0; i < COUNT(cases); i++) {
        byte_buffer b = {0};
        ffd_buffer_text(&b, cases[i].text);
        assert_compared(&a, &b, cases[i].tolerance, cases[i].difference);
        ffd_buffer_free(&b);
    }
    ffd_buffer_free(&a);
}

static void a_comparison_of_binary_names_the_difference(void **state)
{
    (void)state;
    static const record one[1] = {{UP, FLAT, 7}}, none[1] = {{UP, FLAT, 0}};
    byte_buffer a = binary("head", one, 1), same = binary("head", one, 1), plain = binary("head", none, 1),
                other = binary("heap", one, 1), text = {0};
    ffd_buffer_text(&same, "behind");
    ffd_buffer_text(&text, TEXT);
    assert_compared(&a, &same, 0, NULL);
    assert_compared(&a, &plain, 0, "facet 0 counted from 0: attribute 7 and 0");
    assert_compared(&a, &other, 0, "the headers of 80 bytes are not the same");
    assert_compared(&plain, &text, 0, NULL);
    assert_compared(&text, &a, 0, "facet 0 counted from 0: attribute 0 and 7");
    ffd_buffer_free(&a);
    ffd_buffer_free(&same);
    ffd_buffer_free(&plain);
    ffd_buffer_free(&other);
    ffd_buffer_free(&text);
}

/* Broken files, and no memory */

static const char plain_seed[] = TEXT,
                  odd_seed[] = "SOLID a b\r\n" FACET("nan 0 -1.#IND", CORNERS)
                      FACET("1 0 0", "vertex .5 5e-1 -1E0\rvertex 1 2 3 vertex\t1 2 4\n") "ENDSOLID\nsolid\n"
                                                                                          "endsolid";

static void with_seeds(void (*use)(const byte_seed *seeds, size_t count))
{
    static const record records[2] = {{UP, FLAT, 7}, {{0}, {1, 2, 3, 4, 5, 6, 7, 8, 9}, 0}};
    byte_buffer file = binary("solid", records, 2);
    const byte_seed seeds[] = {
        {plain_seed, sizeof plain_seed - 1}, {odd_seed, sizeof odd_seed - 1}, {file.data, file.size}};
    use(seeds, COUNT(seeds));
    ffd_buffer_free(&file);
}

static void truncate_seeds(const byte_seed *seeds, size_t count)
{
    use_truncations(stl, seeds, count);
}

static void mutate_seeds(const byte_seed *seeds, size_t count)
{
    use_mutations(stl, seeds, count, 6000, "0123456789-+.#e\r\n\t sofn\1\2");
}

static void starve_seeds(const byte_seed *seeds, size_t count)
{
    for (size_t i = 0; i < count; i++)
        use_with_failing_memory(stl, &seeds[i]);
}

static void truncated_files_are_read_or_refused(void **state)
{
    (void)state;
    with_seeds(truncate_seeds);
}

static void mutated_files_are_read_or_refused(void **state)
{
    (void)state;
    with_seeds(mutate_seeds);
}

static void every_failed_allocation_is_reported(void **state)
{
    (void)state;
    with_seeds(starve_seeds);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_in_every_spacing_is_read),
        cmocka_unit_test(broken_texts_are_refused_with_their_line),
        cmocka_unit_test(binary_is_read_whatever_its_header_says),
        cmocka_unit_test(a_full_header_that_says_solid_is_still_binary),
        cmocka_unit_test(binary_that_is_too_short_is_refused),
        cmocka_unit_test(only_facets_of_finite_area_have_a_normal),
        cmocka_unit_test(normals_are_renewed_on_the_side_they_were),
        cmocka_unit_test(only_facets_that_turn_get_new_normals),
        cmocka_unit_test(text_is_written_in_double_precision),
        cmocka_unit_test(facets_share_vertices_of_one_position),
        cmocka_unit_test(a_description_counts_what_the_file_has),
        cmocka_unit_test(a_comparison_of_texts_names_the_difference),
        cmocka_unit_test(a_comparison_of_binary_names_the_difference),
        cmocka_unit_test(truncated_files_are_read_or_refused),
        cmocka_unit_test(mutated_files_are_read_or_refused),
        cmocka_unit_test(every_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, remove_saved);
}
