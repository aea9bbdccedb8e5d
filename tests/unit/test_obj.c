/* OBJ: statements, values, documents, saving and comparing, on files written here. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/mesh_bytes.h"
#include "io/obj/obj_document.h"
#include "io/obj/obj_format.h"
#include "io/obj/obj_number.h"
#include <math.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const mesh_format *const obj = &ffd_obj_format;

/* Statements */

static void append_word(char *text, size_t capacity, const char *before, text_word word)
{
    const size_t used = strlen(text);
    snprintf(text + used, capacity - used, "%s%.*s", before, (int)(word.last - word.first), word.first);
}

/* "v@1 1 2 3;f@2 1": keyword, line, arguments. */
static void statements_of(const char *bytes, size_t size, char *text, size_t capacity)
{
    obj_scan scan;
    text_word word;
    text[0] = 0;
    ffd_obj_scan_begin(&scan, bytes, size);
    while (ffd_obj_scan_next(&scan)) {
        append_word(text, capacity, text[0] ? ";" : "", scan.name);
        snprintf(text + strlen(text), capacity - strlen(text), "@%zu", scan.keyword_line);
        while (ffd_obj_scan_word(&scan, &word))
            append_word(text, capacity, " ", word);
    }
}

static void statements_are_split_into_words_with_their_lines(void **state)
{
    (void)state;
    static const struct {
        const char *text, *expected;
    } cases[] = {
        {"", ""},
        {"\n\n", ""},
        {"\xEF\xBB\xBFv 1", "v@1 1"},
        {"v 1 2\nf 3\n", "v@1 1 2;f@2 3"},
        {"v 1 2\r\n\r\nf 3\r\n", "v@1 1 2;f@3 3"},
        {"v 1 2\r\rf 3\r", "v@1 1 2;f@3 3"},
        {"v 1\nv 2\r\nv 3\rv 4\n\rv 5", "v@1 1;v@2 2;v@3 3;v@4 4;v@6 5"},
        {"\t v\t 1  2 \t\n", "v@1 1 2"},
        {"# c\nv 1# c\n#\nf 2 # d", "v@2 1;f@4 2"},
        {"usemtl a#b #c\ng #1\nv 1", "usemtl@1 a#b #c;g@2 #1;v@3 1"},
        {"v 1 \\\n2 \\\r\n 3\\\r4\nf 5", "v@1 1 2 3 4;f@5 5"},
        {"f 1\\\n/2", "f@1 1 /2"},
        {"v\\\n1", "v@1 1"},
        {"\\\nv 1", "v@2 1"},
        {"v 1 \\\n\nf 2", "v@1 1;f@3 2"},
        {"v 1\\", "v@1 1"},
        {"# C:\\\nv 1 # \\\nf 2", "v@2 1;f@3 2"},
        {"mtllib C:\\a\\b\nv 1", "mtllib@1 C:\\a\\b;v@2 1"},
        {"usemtl a\\\n#b", "usemtl@1 a #b"},
        {"curv 0 1 \\\n 2\nend\nvp 1", "curv@1 0 1 2;end@3;vp@4 1"},
        {"v", "v@1"},
        {"v 1 \\ \n2 \\\t\v\r\n 3\\ \r4\nf 5", "v@1 1 2 3 4;f@5 5"},
        {"f 1 # \\ \nf 2 \\ ", "f@1 1;f@2 2"},
        {"usemtl a\\ \nv 1", "usemtl@1 a\\;v@2 1"},
        {"x 1 \\ \nv 1", "x@1 1 \\;v@2 1"},
        {"v 1 2 3 \\ x\nf 1", "v@1 1 2 3 \\ x;f@2 1"},
        {"\\x 1", "\\x@1 1"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        char text[256];
        statements_of(cases[i].text, strlen(cases[i].text), text, sizeof text);
        assert_string_equal(text, cases[i].expected);
    }
}

/* Skipping words must lead to the same next statement. */
static void unread_words_do_not_move_the_next_statement(void **state)
{
    (void)state;
    static const char text[] = "v 1 2 \\ \n 3 # \\\nusemtl a \\\n#b\nf 1\n";
    for (int taken = 0; taken < 5; taken++) {
        obj_scan scan;
        text_word word;
        ffd_obj_scan_begin(&scan, text, sizeof text - 1);
        for (size_t s = 0; s < 3; s++) {
            static const size_t lines[] = {1, 3, 5};
            assert_true(ffd_obj_scan_next(&scan));
            assert_int_equal(scan.keyword_line, lines[s]);
            for (int i = 0; i < taken; i++)
                ffd_obj_scan_word(&scan, &word);
        }
        assert_false(ffd_obj_scan_next(&scan));
        assert_false(ffd_obj_scan_next(&scan));
    }
}

/* Values */

static text_word word_of(const char *text)
{
    return (text_word){text, text + strlen(text)};
}

static void only_words_that_are_numbers_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
    } good[] = {
        {"0", 0},
        {"+1", 1},
        {"-1.5", -1.5},
        {"2.", 2},
        {".5", 0.5},
        {"2.e1", 20},
        {"1E2", 100},
        {"3.1e-2", 0.031},
        {"3.1+e2", 3.1},
        {"-3.1-E2", -3.1},
        {"1e10", 1e10},
        {"inf", INFINITY},
        {"1e999", INFINITY},
        {"0.1", 0.1},
        {"123456789.987654321", 123456789.987654321},
    };
    static const char *const bad[] = {"x",   "1x",  "1,5", "1.0f", "--1", "+-1", "1e+2e",   "",
                                      "3+e", "3+2", "0x1", "1d0",  "+",   "1 2", "3.1+e2x", "1\xc2\xa0"};
    double value;
    for (size_t i = 0; i < COUNT(good); i++) {
        assert_true(ffd_obj_number(word_of(good[i].text), &value));
        assert_true(value == good[i].value);
    }
    assert_true(ffd_obj_number(word_of("-nan"), &value) && isnan(value));
    for (size_t i = 0; i < COUNT(bad); i++)
        assert_false(ffd_obj_number(word_of(bad[i]), &value));
}

static void only_words_that_are_corners_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int64_t vertex, texcoord, normal;
        bool has_texcoord, has_normal;
    } good[] = {
        {"1", 1, 0, 0, false, false},
        {"1/2", 1, 2, 0, true, false},
        {"1//3", 1, 0, 3, false, true},
        {"1/2/3", 1, 2, 3, true, true},
        {"-1/-2/-3", -1, -2, -3, true, true},
        {"+1//+2", 1, 0, 2, false, true},
        {"1/", 1, 0, 0, false, false},
        {"1//", 1, 0, 0, false, false},
        {"1/2/", 1, 2, 0, true, false},
        {"0/0/0", 0, 0, 0, true, true},
        {"007", 7, 0, 0, false, false},
        {"4294967297//4294967298", INT64_C(4294967297), 0, INT64_C(4294967298), false, true},
    };
    static const char *const bad[] = {"",    "/",      "/1",      "//1", "x",     "1x",  "1/x", "1/2/x",
                                      "1.0", "1/2/3/", "1/2/3/4", "-",   "1/-/2", "--1", "1-2", "1\\2"};
    obj_corner corner;
    for (size_t i = 0; i < COUNT(good); i++) {
        assert_true(ffd_obj_corner(word_of(good[i].text), &corner));
        assert_true(corner.vertex.value == good[i].vertex);
        assert_true(corner.texcoord.value == good[i].texcoord);
        assert_true(corner.normal.value == good[i].normal);
        assert_int_equal(corner.texcoord.text.first < corner.texcoord.text.last, good[i].has_texcoord);
        assert_int_equal(corner.normal.text.first < corner.normal.text.last, good[i].has_normal);
    }
    for (size_t i = 0; i < COUNT(bad); i++)
        assert_false(ffd_obj_corner(word_of(bad[i]), &corner));
    /* More than 64 bits: out of every range, positive or negative. */
    size_t element;
    const obj_count full = {SIZE_MAX / 4096, SIZE_MAX / 4096};
    assert_true(ffd_obj_corner(word_of("18446744073709551617//-18446744073709551617"), &corner));
    assert_false(ffd_obj_find(corner.vertex.value, full, &element));
    assert_false(ffd_obj_find(corner.normal.value, full, &element));
}

/* Documents */

static mesh_document *opened(const char *text)
{
    return opened_bytes(obj, text, strlen(text));
}

/* All positions, and the x of each vertex's normals: "1,2|3|" for two, one and none. */
static void append_contents(const mesh_document *document, byte_buffer *text)
{
    const mesh_part *part = document->parts;
    append_positions(document, SIZE_MAX, text);
    for (size_t i = 0; part->normal_count && i < part->vertex_count; i++) {
        ffd_buffer_text(text, i ? "|" : " N ");
        for (uint32_t n = part->normal_start[i]; n < part->normal_start[i + 1]; n++) {
            double v[3];
            obj->read(document, 0, MESH_NORMALS, MESH_STORED, n, 1, v);
            ffd_buffer_format(text, "%s%g", n > part->normal_start[i] ? "," : "", v[0]);
        }
    }
}

static void every_dialect_is_read(void **state)
{
    (void)state;
    static const read_text cases[] = {
        {"o\n# nothing\n", ""},
        {"v 1 2 3\nv 4 5 6\n", "1,2,3 4,5,6"},
        {"v 1 2 3\rv 4 5 6", "1,2,3 4,5,6"},
        {"v 1 2 3\r\n\tv\t4 5  6 \r\n", "1,2,3 4,5,6"},
        {"v 1 2 3 0.5\nv 4 5 6 .1 .2 .3\nv 7 8 9 1 .1 .2 .3 x\n", "1,2,3 4,5,6 7,8,9"},
        {"v 1 \\\n2 \\\r\n3 # c\n", "1,2,3"},
        {"v nan 2 -inf\n", "nan,2,-inf"},
        {"vn 7 0 0\nv 1 2 3\n", "1,2,3"},
        {"f 1//1 2//1 1//2\nv 1 2 3\nv 4 5 6\nvn 7 0 0\nvn 8 0 0\n", "1,2,3 4,5,6 N 7,8|7"},
        {"v 1 1 1\nvn 1 0 0\nf -1//-1\nv 2 2 2\nvn 2 0 0\nf -1//-1 -2//-1 1//1\n", "1,1,1 2,2,2 N 1,2|2"},
        {"v 1 1 1\nvn 1 0 0\nvn 2 0 0\nvn 3 0 0\nf 1//3 1//1 1//3 1//2 1\n", "1,1,1 N 1,2,3"},
        {"v 1 1 1\nvn 1 0 0\nl 1\np 1\nf 1/9\ncurv 0 1 9 9\nvp 1\nfoo x\n", "1,1,1"},
        {"v 1 1 1\nf 1/1/1 1//5 1//0 1//-1\n", "1,1,1"},
        {"mtllib ../../x.mtl\nv 1 1 1\nusemtl a b\ns off\n", "1,1,1"},
    };
    assert_read(obj, cases, COUNT(cases), append_contents);
}

static void a_vertex_can_have_a_hundred_normals(void **state)
{
    (void)state;
    char text[4096] = "v 0 0 0\n";
    for (int i = 0; i < 100; i++)
        sprintf(text + strlen(text), "vn %d 0 0\n", i);
    strcat(text, "f");
    for (int i = 0; i < 200; i++)
        sprintf(text + strlen(text), " 1//%d", 1 + i * 37 % 100);
    mesh_document *document = opened(text);
    assert_int_equal(document->parts->normal_count, 100);
    for (int i = 0; i < 100; i++) {
        double v[3];
        obj->read(document, 0, MESH_NORMALS, MESH_STORED, (size_t)i, 1, v);
        assert_true(v[0] == i);
    }
    obj->close(document);
}

static void broken_files_are_refused_with_their_line(void **state)
{
    (void)state;
    static const refused_text cases[] = {
        {"v 1 2\n", FFD_E_INVALID, 1, "a vertex needs 3 numbers, found 2"},
        {"\nv", FFD_E_INVALID, 2, "a vertex needs 3 numbers, found 0"},
        {"v 1 2 # 3\n", FFD_E_INVALID, 1, "a vertex needs 3 numbers, found 2"},
        {"v 1 2 3\r\nv 1 x 3\r\n", FFD_E_INVALID, 2, "coordinate y of a vertex is not a number: \"x\""},
        {"v 1 2 \\\r 1,5", FFD_E_INVALID, 2, "coordinate z of a vertex is not a number: \"1,5\""},
        {"vn 1 2\n", FFD_E_INVALID, 1, "a normal needs 3 numbers, found 2"},
        {"v 0 0 0\nvn 1 2 3e\n", FFD_E_INVALID, 2, "coordinate z of a normal is not a number: \"3e\""},
        {"v 0 0 0\nf 1 2 1\n", FFD_E_INVALID, 2, "vertex index 2 is out of range: the file has 1"},
        {"v 0 0 0\nf 1 1\\\n -2\nv 0 0 0\n", FFD_E_INVALID, 3,
         "vertex index -2 is out of range: 1 comes before it"},
        {"v 0 0 0\nf 1 0 1\n", FFD_E_INVALID, 2, "vertex index 0 is out of range: indices start at 1"},
        {"v 0 0 0\nf 1 4294967297 1\n", FFD_E_INVALID, 2,
         "vertex index 4294967297 is out of range: the file has 1"},
        {"v 0 0 0\nf 99999999999999999999999999 1\n", FFD_E_INVALID, 2,
         "vertex index 99999999999999999999999999 is out of range: the file has 1"},
        {"v 0 0 0\nvn 0 0 1\nf 1//1 1//2 1\n", FFD_E_INVALID, 3,
         "normal index 2 is out of range: the file has 1"},
        {"v 0 0 0\nf 1//-1 1//2 1\nvn 0 0 1\n", FFD_E_INVALID, 2,
         "normal index -1 is out of range: 0 come before it"},
        {"v 0 0 0\nvn 0 0 1\nf 1//0\n", FFD_E_INVALID, 3,
         "normal index 0 is out of range: indices start at 1"},
        {"v 0 0 0\nf 1 a 1\n", FFD_E_INVALID, 2, "not a corner (v, v/t, v//n or v/t/n): \"a\""},
        {"v 0 0 0\nf 1/1/1/1\n", FFD_E_INVALID, 2, "not a corner (v, v/t, v//n or v/t/n): \"1/1/1/1\""},
        {"v 0 0 0\nl 1 2\n", FFD_E_INVALID, 2, "vertex index 2 is out of range: the file has 1"},
        {"v 0 0 0\np x\n", FFD_E_INVALID, 2, "not a corner (v, v/t, v//n or v/t/n): \"x\""},
        {"v 0 0 1234567890123456789012345678901234567890x\n", FFD_E_INVALID, 1,
         "coordinate z of a vertex is not a number: \"1234567890123456789012345678901234567890\""},
        {"", FFD_E_INVALID, 1, "the file has no content"},
        {"\n# nothing\nx 1\n", FFD_E_INVALID, 1, "is not an OBJ file: it has no statement of one"},
        {"\xff\xfev", FFD_E_INVALID, 1,
         "is not an OBJ file, which is text in ASCII or UTF-8; it seems to be UTF-16 text"},
    };
    assert_refused(obj, cases, COUNT(cases), is_words);
}

/* Saving */

typedef struct edit {
    char stream; /* 'v' or 'n'; 0 ends the list */
    size_t item; /* vertex, or pair of a vertex and a normal */
    double xyz[3];
} edit;

static void apply(mesh_document *document, const edit *edits)
{
    const uint8_t changed = 1;
    assert_int_equal(obj->begin_results(document, &(mesh_results){.directions = true}, NULL), FFD_OK);
    for (; edits->stream; edits++)
        if (edits->stream == 'v') {
            assert_true(edits->item < document->parts->vertex_count);
            obj->write(document, 0, MESH_POSITIONS, edits->item, 1, edits->xyz, &changed);
        } else {
            assert_true(edits->item < document->parts->normal_count);
            obj->write(document, 0, MESH_NORMALS, edits->item, 1, edits->xyz, &changed);
        }
}

static void assert_edited(const char *text, const edit *edits, const char *expected)
{
    mesh_document *document = opened(text);
    apply(document, edits);
    assert_saved(document, expected, strlen(expected));
    obj->close(document);
}

static void only_changed_coordinates_get_new_text(void **state)
{
    (void)state;
    const edit nothing[] = {{0}};
    const edit same[] = {{'v', 0, {1, 2, 3}}, {0}};
    const edit first[] = {{'v', 0, {0.1, 2, -1e300}}, {0}};
    const edit second[] = {{'v', 1, {7, 8, 9}}, {0}};
    const edit zero[] = {{'v', 0, {-0.0, 0, 0}}, {0}};
    static const char odd[] =
        "\xEF\xBB\xBF\r# c\r\n v\t1.0  2.00 3.1+e2 .5 x # c\\\nv 4 \\\r\n 5e0 \\\r 6#7\nl 1 2";
    assert_edited(odd, nothing, odd);
    assert_edited("v 1.0 2.00 3e0", same, "v 1.0 2.00 3e0");
    assert_edited("v 1.0 2.00 3 .1 .2 .3\n", first, "v 0.1 2.00 -1e+300 .1 .2 .3\n");
    assert_edited(odd, first,
                  "\xEF\xBB\xBF\r# c\r\n v\t0.1  2.00 -1e+300 .5 x # c\\\nv 4 \\\r\n 5e0 \\\r 6#7\nl 1 2");
    assert_edited(odd, second,
                  "\xEF\xBB\xBF\r# c\r\n v\t1.0  2.00 3.1+e2 .5 x # c\\\nv 7 \\\r\n 8 \\\r 9#7\nl 1 2");
    assert_edited("v 0 0 0\n", zero, "v -0 0 0\n");
}

static void kept_values_are_not_looked_at(void **state)
{
    (void)state;
    const double xyz[6] = {9, 9, 9, 8, 8, 8};
    const uint8_t changed[2] = {0, 1};
    mesh_document *document = opened("v 1 1 1\nv 1 1 1\nvn 1 1 1\nvn 1 1 1\nf 1//1 2//2");
    assert_int_equal(obj->begin_results(document, &(mesh_results){.directions = true}, NULL), FFD_OK);
    obj->write(document, 0, MESH_POSITIONS, 0, 2, xyz, changed);
    obj->write(document, 0, MESH_NORMALS, 0, 2, xyz, changed);
    static const char expected[] = "v 1 1 1\nv 8 8 8\nvn 1 1 1\nvn 8 8 8\nf 1//1 2//2";
    assert_saved(document, expected, sizeof expected - 1);
    obj->close(document);
}

#define CORNERS "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1.0\n"

static void shared_normals_are_split_only_where_they_differ(void **state)
{
    (void)state;
    const edit all[] = {{'n', 0, {0, 1, 1}}, {'n', 1, {0, 1, 1}}, {'n', 2, {0, 1, 1}}, {0}};
    const edit one[] = {{'n', 1, {1, 0, 0}}, {0}};
    const edit first_moves[] = {{'n', 0, {1, 0, 0}}, {0}};
    const edit all_differ[] = {{'n', 0, {1, 0, 0}}, {'n', 1, {2, 0, 0}}, {'n', 2, {3, 0, 0.5}}, {0}};
    const edit both[] = {{'n', 0, {1, 0, 0}}, {'n', 1, {2, 0, 0}}, {0}};
    const edit two_alike[] = {{'n', 0, {1, 0, 0}}, {'n', 1, {2, 0, 0}}, {'n', 2, {2, 0, 0}}, {0}};
    const struct {
        const char *text;
        const edit *edits;
        const char *expected;
    } cases[] = {
        /* all agree: in place; an unchanged number keeps its text */
        {CORNERS "f 1//1 2//1 3//1\n", all, "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 1 1.0\nf 1//1 2//1 3//1\n"},
        /* a value that is still in use stays */
        {CORNERS "f 1//1 2//1 3//1\n", one, CORNERS "vn 1 0 0\nf 1//1 2//2 3//1\n"},
        {CORNERS "f 1//1 2//1 3//1\n", first_moves, CORNERS "vn 1 0 0\nf 1//2 2//1 3//1\n"},
        /* otherwise the first vertex's value takes its line */
        {CORNERS "f 1//1 2//1 3//1\n", all_differ,
         "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nvn 2 0 0\nvn 3 0 0.5\nf 1//1 2//2 3//3\n"},
        {CORNERS "f 1//1 2//1 3//1\nf 3/4/1 2/5/1 1\n", two_alike,
         "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nvn 2 0 0\nf 1//1 2//2 3//2\nf 3/4/2 2/5/2 1\n"},
        /* two `vn` with the same new value are not merged, and unused ones stay */
        {"v 0 0 0\nvn 1 1 1\nvn 5 5 5\nvn 2 2 2\nf 1//1 1//3", both,
         "v 0 0 0\nvn 1 0 0\nvn 5 5 5\nvn 2 0 0\nf 1//1 1//3"},
        /* after the last `vn`, whatever follows it */
        {"vn 0 0 1\r\nv 0 0 0\r\nv 0 0 0\r\nf 1//1 2//1\r\n", one,
         "vn 0 0 1\r\nvn 1 0 0\r\nv 0 0 0\r\nv 0 0 0\r\nf 1//1 2//2\r\n"},
        {"vn 0 0 1\rv 0 0 0\nv 0 0 0\nf 1//1 2//1", one, "vn 0 0 1\rvn 1 0 0\rv 0 0 0\nv 0 0 0\nf 1//1 2//2"},
        {"v 0 0 0\rv 0 0 0\rf 1//1 2//1\rvn 0 0 1", one,
         "v 0 0 0\rv 0 0 0\rf 1//1 2//2\rvn 0 0 1\rvn 1 0 0\r"},
        {"v 0 0 0\nv 0 0 0\nf 1//1 2//1\nvn 0 0 1 \\", one,
         "v 0 0 0\nv 0 0 0\nf 1//1 2//2\nvn 0 0 1 \\\n\nvn 1 0 0\n"},
        {"v 0 0 0\r\nv 0 0 0\r\nf 1//1 2//1\r\nvn 0 0 1 \\\r\n", one,
         "v 0 0 0\r\nv 0 0 0\r\nf 1//1 2//2\r\nvn 0 0 1 \\\r\n\r\nvn 1 0 0\r\n"},
        {"vn 0 0 1 # \\\nv 0 0 0\nv 0 0 0\nf 1//1 2//1\n", one,
         "vn 0 0 1 # \\\n\nvn 1 0 0\nv 0 0 0\nv 0 0 0\nf 1//1 2//2\n"},
        {"vn 0 0 \\\n1\nv 0 0 0\nv 0 0 0\nf 1//1 \\\n2//1", one,
         "vn 0 0 \\\n1\nvn 1 0 0\nv 0 0 0\nv 0 0 0\nf 1//1 \\\n2//2"},
        /* relative indices: appended at the end of the file */
        {CORNERS "f -3//-1 -2//-1 -1//-1\n", one, CORNERS "f -3//-1 -2//2 -1//-1\nvn 1 0 0\n"},
        {CORNERS "f -3//-1 -2//-1 -1//-1", one, CORNERS "f -3//-1 -2//2 -1//-1\nvn 1 0 0\n"},
        {CORNERS "f -3//-1 -2//-1 -1//-1 \\", one, CORNERS "f -3//-1 -2//2 -1//-1 \\\n\nvn 1 0 0\n"},
        {CORNERS "f -3//-1 -2//-1 -1//-1\n# \\", one, CORNERS "f -3//-1 -2//2 -1//-1\n# \\\n\nvn 1 0 0\n"},
        {CORNERS "f 1//1 2//1 3//1\nsurf 0 1 0 1 -1/1/-1\n", one,
         CORNERS "f 1//1 2//2 3//1\nsurf 0 1 0 1 -1/1/-1\nvn 1 0 0\n"},
        /* relative indices before the last `vn` do not matter */
        {"v 0 0 0\nv 0 0 0\nvn 0 0 1\nf -2//-1 -1//-1\nvn 0 1 0\nf 1//2\n", one,
         "v 0 0 0\nv 0 0 0\nvn 0 0 1\nf -2//-1 -1//-1\nvn 1 0 0\nf 1//2\n"},
        /* a continued face, tabs, texcoords, comments */
        {"v 0 0 0\nv 0 0 0\nvn 0 0 1\nf\t1/7/1\\\r\n  2/8/01# c\n", one,
         "v 0 0 0\nv 0 0 0\nvn 0 0 1\nvn 1 0 0\nf\t1/7/1\\\r\n  2/8/2# c\n"},
    };
    for (size_t i = 0; i < COUNT(cases); i++)
        assert_edited(cases[i].text, cases[i].edits, cases[i].expected);
}

static void normals_stay_when_they_are_not_renewed(void **state)
{
    (void)state;
    static const char text[] = CORNERS "f 1//1 2//1 3//1\n";
    const double xyz[3] = {5, 5, 5};
    const uint8_t changed = 1;
    mesh_document *document = opened(text);
    assert_int_equal(obj->begin_results(document, &(mesh_results){.directions = false}, NULL), FFD_OK);
    obj->write(document, 0, MESH_NORMALS, 0, 1, xyz, &changed);
    assert_saved(document, text, sizeof text - 1);
    obj->close(document);
}

static void without_results_the_same_bytes_are_saved(void **state)
{
    (void)state;
    static const char text[] = CORNERS "f 1//1 2//1 3//1 # no end";
    mesh_document *document = opened(text);
    assert_saved(document, text, sizeof text - 1);
    obj->close(document);
}

/* More text than a block, changed and unchanged. */
static void files_larger_than_a_block_are_saved_whole(void **state)
{
    (void)state;
    const size_t count = 40000, capacity = count * 64 + 1000000;
    char *text = malloc(capacity), *expected = malloc(capacity);
    assert_true(text && expected);
    size_t used = 0, expected_used = 0;
    for (size_t i = 0; i < count; i++) {
        used += (size_t)sprintf(text + used, "v %zu.0 %zu -1\n", i, i);
        expected_used += (size_t)sprintf(expected + expected_used, "v %zu.0 %zu %zu.5\n", i, i, i);
    }
    memset(text + used, '#', 900000);
    memset(expected + expected_used, '#', 900000);
    text[used + 900000] = expected[expected_used + 900000] = 0;
    mesh_document *document = opened(text);
    assert_int_equal(obj->begin_results(document, &(mesh_results){.directions = true}, NULL), FFD_OK);
    for (size_t i = 0; i < count; i++) {
        const double xyz[3] = {(double)i, (double)i, (double)i + 0.5};
        const uint8_t changed = 1;
        obj->write(document, 0, MESH_POSITIONS, i, 1, xyz, &changed);
    }
    assert_saved(document, expected, strlen(expected));
    obj->close(document);
    free(text);
    free(expected);
}

/* Faces and description */

static void faces_are_read_and_lines_and_points_counted(void **state)
{
    (void)state;
    mesh_document *document =
        opened("v 1 2 3\nv 4 5 6\nf 1 2 3 -1\nv 7 8 9\nf\nf 3/1/1 -3 \\\n2\nl 1 2\nl 1 2 3\np 1\nvn 0 0 1");
    mesh_faces faces;
    assert_int_equal(obj->faces(document, MESH_STORED, &faces, NULL), FFD_OK);
    static const size_t start[] = {0, 4, 4, 7};
    static const uint32_t corners[] = {0, 1, 2, 1, 2, 0, 1};
    static const double positions[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    assert_int_equal(faces.vertex_count, 3);
    assert_int_equal(faces.face_count, 3);
    assert_int_equal(faces.lines, 2);
    assert_int_equal(faces.points, 1);
    assert_memory_equal(faces.start, start, sizeof start);
    assert_memory_equal(faces.corners, corners, sizeof corners);
    assert_memory_equal(faces.positions, positions, sizeof positions);
    ffd_mesh_faces_free(&faces);
    obj->close(document);
}

static void assert_text_described(const char *text, const char *expected)
{
    mesh_document *document = opened(text);
    assert_described(document, expected);
    obj->close(document);
}

static void a_description_counts_what_the_file_has(void **state)
{
    (void)state;
    assert_text_described("s off",
                          "{\"vertices\": 0, \"vertices_with_color\": 0, \"normals\": 0, \"texcoords\": 0, "
                          "\"faces\": 0, \"triangles\": 0, \"quads\": 0, \"ngons\": 0, \"lines\": 0, "
                          "\"points\": 0, \"groups\": 0, \"objects\": 0, \"materials\": 0, "
                          "\"line_endings\": \"none\"}\n");
    assert_text_described(
        "v 0 0 0 1 1 1\r\nv 0 0 0 1\r\nv 0 0 0 1 1 1 1\r\nvn 0 0 1\r\nvt 0\r\nvt 0\r\n"
        "g a b\r\ng b\r\ng a c\r\no one\r\no one two\r\nusemtl m 1\r\nusemtl m 2\r\nusemtl m 1\r\n"
        "f 1 2\r\nf 1 2 3\r\nf 1 2 3 1\r\nf 1 2 3 1 2\r\nf 1 2 3 1 2 3\r\nl 1 2\r\np 1 2\r\np 3\r\n",
        "{\"vertices\": 3, \"vertices_with_color\": 2, \"normals\": 1, \"texcoords\": 2, "
        "\"faces\": 5, \"triangles\": 1, \"quads\": 1, \"ngons\": 2, \"lines\": 1, "
        "\"points\": 2, \"groups\": 3, \"objects\": 2, \"materials\": 2, "
        "\"line_endings\": \"CRLF\"}\n");
    static const struct {
        const char *text, *ends;
    } cases[] = {{"v 0 0 0\n", "\"LF\""}, {"v 0 0 0\r", "\"CR\""}, {"v 0 0 0\r\n\n", "\"mixed\""}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        char expected[512];
        snprintf(expected, sizeof expected,
                 "{\"vertices\": 1, \"vertices_with_color\": 0, \"normals\": 0, \"texcoords\": 0, "
                 "\"faces\": 0, \"triangles\": 0, \"quads\": 0, \"ngons\": 0, \"lines\": 0, "
                 "\"points\": 0, \"groups\": 0, \"objects\": 0, \"materials\": 0, \"line_endings\": %s}\n",
                 cases[i].ends);
        assert_text_described(cases[i].text, expected);
    }
}

/* Comparison */

static void a_comparison_names_the_first_difference(void **state)
{
    (void)state;
    static const struct {
        const char *a, *b;
        double tolerance;
        const char *difference;
        uint64_t compared;
        double max;
    } cases[] = {
        {"o", "o", 0, "", 0, 0},
        {"v 1 2 3\n", "v 1 2 3\n", 0, "", 1, 0},
        {"v 1 2 3\n# c\n\nf 1 1 1", "\xEF\xBB\xBF  v\t1.0 2e0 \\\r +3.00 # x\r\nf 1 -1 \\\r\n01\r\n", 0, "",
         1, 0},
        {"v 1 2 3\n", "v 1.25 2 3\n", 0, "vertex 1 (line 1): x differs by 0.25", 1, 0.25},
        {"v 1 2 3\n", "v 1.25 2 3\n", 0.25, "", 1, 0.25},
        {"v 1 2 3\n", "v 1.25 2 3\n", 0.2, "vertex 1 (line 1): x differs by 0.25", 1, 0.25},
        {"v 0 0 0\nv 1 2 3\nv 4 5 6\n", "#\nv 0 0 0\nv 1 2 4\nv 4 9 6\n", 0,
         "vertex 2 (lines 2 and 3): z differs by 1", 3, 4},
        {"v nan 0 inf\n", "v NaN 0 INF\n", 0, "", 1, 0},
        {"v nan 0 0\n", "v 1 0 0\n", 9, "vertex 1 (line 1): x: nan and 1", 1, INFINITY},
        {"v inf 0 0\n", "v -inf 0 0\n", 9, "vertex 1 (line 1): x: inf and -inf", 1, INFINITY},
        {"v 1 2 3 1\n", "v 1 2 3 1.0\n", 0, "", 1, 0},
        {"v 1 2 3 1\n", "v 1 2 3 2\n", 9, "vertex 1 (line 1): \"1\" and \"2\"", 1, 0},
        {"v 1 2 3 1\n", "v 1 2 3\n", 9, "vertex 1 (line 1): \"1\" is only in the first", 1, 0},
        {"v 1 2 3\n", "v 1 2 3 4 5 6\n", 9, "vertex 1 (line 1): \"4\" is only in the second", 1, 0},
        {"v 1 2 3\n", "v 1 2 3\nv 4 5 6", 9, "v (line 2) is only in the second", 1, 0},
        {"v 1 2 3\nf 1", "v 1 2 3\n", 9, "f (line 2) is only in the first", 1, 0},
        {"v 1 2 3\nvn 0 0 1\n", "v 1 2 3\nvn 0 0 1.5\n", 9,
         "normal 1 (line 2): z of the normal differs by 0.5", 1, 0},
        {"vt 0 1\n", "vt 0 1.5\n", 9, "texcoord 1 (line 1): \"1\" and \"1.5\"", 0, 0},
        {"v 1 2 3\nvt 0\n", "v 1 2 3\nvn 0 0 0\n", 9, "texcoord 1 (line 2): \"vt\" and \"vn\"", 1, 0},
        {"v 0 0 0\nv 0 0 0\nf 1 2 1\n", "v 0 0 0\nv 0 0 0\nf -2 -1 -2\n", 0, "", 2, 0},
        {"v 0 0 0\nv 0 0 0\nf 1 2 1\n", "v 0 0 0\nv 0 0 0\nf -2 -1 -1\n", 0, "f (line 3): \"1\" and \"-1\"",
         2, 0},
        {"v 0 0 0\nvt 0\nf 1/1\n", "v 0 0 0\nvt 0\nf 1\n", 0, "f (line 3): \"1/1\" and \"1\"", 1, 0},
        {"v 0 0 0\nf 1/9\n", "v 0 0 0\nf 1/9/\n", 0, "", 1, 0},
        {"v 0 0 0\nvn 0 0 0\nf 1//1\n", "v 0 0 0\nvn 0 0 0\nf 1\n", 0, "f (line 3): \"1//1\" and \"1\"", 1,
         0},
        {"l\n", "l\n", 0, "", 0, 0},
        {"usemtl 1\n", "usemtl 1.0\n", 0, "usemtl (line 1): \"1\" and \"1.0\"", 0, 0},
        {"mtllib a.mtl\n", "mtllib b.mtl\n", 0, "mtllib (line 1): \"a.mtl\" and \"b.mtl\"", 0, 0},
        {"g a b\n", "g a c\n", 0, "g (line 1): \"b\" and \"c\"", 0, 0},
        {"s\nfoo \x01"
         "a\n",
         "s\nfoo b\n", 0, "foo (line 2): \"?a\" and \"b\"", 0, 0},
        {"v 1 2 3\nv 0 0 0\nf 1 2 2", "v 1 2 4\nv 0 5 0\nf 1 2 1", 0, "vertex 1 (line 1): z differs by 1", 2,
         5},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        mesh_document *a = opened(cases[i].a), *b = opened(cases[i].b);
        const ffd_comparison comparison = compared(a, b, cases[i].tolerance, 0);
        assert_string_equal(comparison.first.text, cases[i].difference);
        assert_int_equal(comparison.equal, !cases[i].difference[0]);
        assert_int_equal(comparison.positions_compared, cases[i].compared);
        assert_true(comparison.position_difference_max == cases[i].max);
        obj->close(b);
        obj->close(a);
    }
}

/* Broken files, and no memory */

static void every_failed_allocation_is_reported(void **state)
{
    (void)state;
    static const byte_seed seed = BYTE_SEED(CORNERS "g a\no b\nusemtl c\nf 1//1 2//1 3//1\n");
    use_with_failing_memory(obj, &seed);
}

static void mutated_files_are_read_or_refused(void **state)
{
    (void)state;
    static const byte_seed seeds[] = {
        BYTE_SEED(CORNERS "vt 0 0\nf 1/1/1 2/1/-1 3//1 -1\nl 1 2\np 1\ng a b\nusemtl c\n"),
        BYTE_SEED("\xEF\xBB\xBFv 1 2 \\\r\n3 # c\r\nv 4 5 6 1 0 0\r\nvn 0 1 0\rvn 1 0 0\n"
                  "f 1//1 \\\n 2//2 -2//-1\\"),
        BYTE_SEED("f 1//2 2//1 1\nv nan inf -1e999\nv .5 5. 5e-1\nvn 0 0 1\nvn 0 0 1\n"
                  "cstype bezier\nsurf 0 1 0 1 1/1/-1\nend"),
    };
    use_mutations(obj, seeds, COUNT(seeds), 6000, "0123456789-+/.\\#\r\n\t vnftlpe:\x80");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statements_are_split_into_words_with_their_lines),
        cmocka_unit_test(unread_words_do_not_move_the_next_statement),
        cmocka_unit_test(only_words_that_are_numbers_are_read),
        cmocka_unit_test(only_words_that_are_corners_are_read),
        cmocka_unit_test(every_dialect_is_read),
        cmocka_unit_test(a_vertex_can_have_a_hundred_normals),
        cmocka_unit_test(broken_files_are_refused_with_their_line),
        cmocka_unit_test(only_changed_coordinates_get_new_text),
        cmocka_unit_test(kept_values_are_not_looked_at),
        cmocka_unit_test(shared_normals_are_split_only_where_they_differ),
        cmocka_unit_test(normals_stay_when_they_are_not_renewed),
        cmocka_unit_test(without_results_the_same_bytes_are_saved),
        cmocka_unit_test(files_larger_than_a_block_are_saved_whole),
        cmocka_unit_test(faces_are_read_and_lines_and_points_counted),
        cmocka_unit_test(a_description_counts_what_the_file_has),
        cmocka_unit_test(a_comparison_names_the_first_difference),
        cmocka_unit_test(every_failed_allocation_is_reported),
        cmocka_unit_test(mutated_files_are_read_or_refused),
    };
    return cmocka_run_group_tests(tests, NULL, remove_saved);
}
