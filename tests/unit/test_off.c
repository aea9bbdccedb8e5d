/* OFF: headers, vertices and faces in every layout, saving and comparing, on files written here. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/mesh_bytes.h"
#include "io/off/off_document.h"
#include "io/off/off_format.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const mesh_format *const off = &ffd_off_format;

static mesh_document *opened(const char *text)
{
    return opened_bytes(off, text, strlen(text));
}

/* Vertices as "1,2,3 4,5,6", normals likewise, faces as "0,1,2 1,2". */
static void append_contents(const mesh_document *document, byte_buffer *text)
{
    const mesh_part *part = document->parts;
    mesh_faces faces;
    append_positions(document, SIZE_MAX, text);
    for (size_t i = 0; i < part->normal_count; i++) {
        double n[3];
        off->read(document, 0, MESH_NORMALS, MESH_STORED, i, 1, n);
        ffd_buffer_format(text, "%s%g,%g,%g", i ? " " : " N ", n[0], n[1], n[2]);
    }
    assert_int_equal(off->faces(document, MESH_STORED, &faces, NULL), FFD_OK);
    for (size_t f = 0; f < faces.face_count; f++) {
        ffd_buffer_text(text, f ? " " : " F ");
        for (size_t c = faces.start[f]; c < faces.start[f + 1]; c++)
            ffd_buffer_format(text, "%s%u", c > faces.start[f] ? "," : "", (unsigned)faces.corners[c]);
    }
    if (faces.lines || faces.points)
        ffd_buffer_format(text, " L%zu P%zu", faces.lines, faces.points);
    ffd_mesh_faces_free(&faces);
}

#define TRIANGLE "0 0 0\n1 0 0\n0 1 0\n"
#define IS_TRIANGLE "0,0,0 1,0,0 0,1,0 F 0,1,2"

static void every_dialect_is_read(void **state)
{
    (void)state;
    static const read_text cases[] = {
        {"OFF\n3 1 0\n" TRIANGLE "3 0 1 2\n", IS_TRIANGLE},
        {"OFF 3 1 0\n" TRIANGLE "3 0 1 2", IS_TRIANGLE},
        {"OFF3 1 0\n" TRIANGLE "3 0 1 2", IS_TRIANGLE},
        {"3 1 0\n" TRIANGLE "3 0 1 2\n", IS_TRIANGLE},
        {"OFF\n3 1\n" TRIANGLE "3 0 1 2\n", IS_TRIANGLE},
        {"OFF\n3\n1\n2\n" TRIANGLE "3 0 1 2\n", IS_TRIANGLE},
        {"OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n", IS_TRIANGLE},
        {"OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2", IS_TRIANGLE},
        {"\xEF\xBB\xBFOFF\n3 1 0\n" TRIANGLE "3 0 1 2\n", IS_TRIANGLE},
        {"# a\nOFF # b\n\n# c\n3 1 0 # d\n\n\t\n0 0 0# e\n#\n 1\t0 0\n\n0 1 0\n# f\n3 0 1 2 # g\n",
         IS_TRIANGLE},
        {"OFF\n3 1 0\n+0 0.0 .0\n1.e0 0e5 -0\n0 10e-1 0\n3 0 1 2\n", "0,0,0 1,0,-0 0,1,0 F 0,1,2"},
        /* colours, with and without a keyword that says so */
        {"COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 .5 1 1\n0 1 0 3\n3 0 1 2\n", IS_TRIANGLE},
        {"OFF\n3 1 0\n0 0 0 255 0 0\n1 0 0\n0 1 0 3\n3 0 1 2 0.1 0.2 0.3 1\n", IS_TRIANGLE},
        {"OFF\n3 1 0\n" TRIANGLE "3 0 1 2 some map\n", IS_TRIANGLE},
        {"NOFF\n1 0 0\n1 2 3 0 0 1\n", "1,2,3 N 0,0,1"},
        {"NOFF\n1 0 0\n1 2 3 0 0 1 255 255 255\n", "1,2,3 N 0,0,1"},
        {"CNOFF\n1 0 0\n1 2 3 0 1 0 9 9 9 9\n", "1,2,3 N 0,1,0"},
        {"NCOFF\n1 0 0\n1 2 3 0 1 0 9 9 9 9\n", "1,2,3 N 0,1,0"},
        {"STOFF\n1 0 0\n1 2 3 .5 .5\n", "1,2,3"},
        {"STCNOFF\n2 0 0\n1 2 3 0 1 0 9 9 9 9 .5 .5\n4 5 6 1 0 0 9 9 9 9 .5 .5\n",
         "1,2,3 4,5,6 N 0,1,0 1,0,0"},
        /* fewer lines than vertices and faces: split into words */
        {"OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2", IS_TRIANGLE},
        {"OFF 3 1 0 0 0 0 1\n0 0 0 1 0 3\n 0 1 2 7 7 7", IS_TRIANGLE},
        {"COFF 2 0 0 1 2 3 9 9 9 9 4 5 6 9 9 9 9", "1,2,3 4,5,6"},
        {"STCNOFF 2 1 0 1 2 3 0 1 0 9 9 9 9 .5 .5 4 5 6 1 0 0 9 9 9 9 .5 .5 3 0 1 0 1 1 1",
         "1,2,3 4,5,6 N 0,1,0 1,0,0 F 0,1,0"},
        /* faces of all sizes */
        {"OFF\n3 5 0\n" TRIANGLE "4 0 1 2 1\n2 0 1\n1 2\n0\n3 2 1 0\n",
         "0,0,0 1,0,0 0,1,0 F 0,1,2,1  2,1,0 L1 P1"},
        {"OFF\n0 0 0\n", ""},
        {"OFF 0 0", ""},
        {"OFF\n1 0 0\n1 2 3\n\nmore # than\nthat", "1,2,3"},
        {"OFF\n2 0 0\nnan 2 3\n1 -inf 1e999\n", "nan,2,3 1,-inf,inf"},
    };
    assert_read(off, cases, COUNT(cases), append_contents);
}

static void broken_files_are_refused_with_their_line(void **state)
{
    (void)state;
    static const refused_text cases[] = {
        {"", FFD_E_INVALID, 1, "the file has no content"},
        {"# only\n\n", FFD_E_INVALID, 3, "the file has no content"},
        {"off\n1 0 0\n", FFD_E_INVALID, 1,
         "the file does not begin with OFF (COFF, NOFF, STOFF ..) but with \"off\""},
        {"\nPLY\n", FFD_E_INVALID, 2,
         "the file does not begin with OFF (COFF, NOFF, STOFF ..) but with \"PLY\"; it seems to be a PLY "
         "file"},
        {"CCOFF 0 0 0", FFD_E_INVALID, 1,
         "the file does not begin with OFF (COFF, NOFF, STOFF ..) but with \"CCOFF\""},
        {"OFFX 0 0 0", FFD_E_INVALID, 1,
         "the file does not begin with OFF (COFF, NOFF, STOFF ..) but with \"OFFX\""},
        {"4OFF\n1 0 0\n1 2 3 1\n", FFD_E_UNSUPPORTED, 1,
         "vertices with more or less than three coordinates are not supported: \"4OFF\""},
        {"nOFF\n3\n1 0 0\n1 2 3\n", FFD_E_UNSUPPORTED, 1,
         "vertices with more or less than three coordinates are not supported: \"nOFF\""},
        {"STCN4nOFF 5\n", FFD_E_UNSUPPORTED, 1,
         "vertices with more or less than three coordinates are not supported: \"STCN4nOFF\""},
        {"OFF BINARY\n\x01\x02", FFD_E_UNSUPPORTED, 1, "the binary form of OFF is not supported: \"BINARY\""},
        {"CNOFF binary\n", FFD_E_UNSUPPORTED, 1, "the binary form of OFF is not supported: \"binary\""},
        {"OFF\n", FFD_E_INVALID, 2, "the file ends before the number of vertices"},
        {"OFF\n3", FFD_E_INVALID, 2, "the file ends before the number of faces"},
        {"OFF\n-3 1 0\n", FFD_E_INVALID, 2, "the number of vertices is not a whole number: \"-3\""},
        {"OFF\n3 1.5 0\n", FFD_E_INVALID, 2, "the number of faces is not a whole number: \"1.5\""},
        {"OFF\n1 0 0 0\n1 2 3\n", FFD_E_INVALID, 2,
         "the numbers of vertices, faces and edges are followed by \"0\""},
        {"OFF\n4611686018427387904 1 0\n1 2 3\n", FFD_E_INVALID, 2,
         "4611686018427387904 vertices and 1 face are stated, more than the 7 bytes that follow can hold"},
        {"OFF\n99999999999999999999999 1 0\n1 2 3\n", FFD_E_INVALID, 2,
         "18446744073709551615 vertices and 1 face are stated, more than the 7 bytes that follow can hold"},
        {"OFF\n1 9223372036854775809 0\n1 2 3\n", FFD_E_INVALID, 2,
         "1 vertex and 9223372036854775809 faces are stated, more than the 7 bytes that follow can hold"},
        {"OFF\n2 0 0\n1 2 3\n", FFD_E_INVALID, 2,
         "2 vertices and 0 faces are stated, more than the 7 bytes that follow can hold"},
        {"OFF\n2 0 0\n1 2 3 4 5 6\n", FFD_E_INVALID, 4, "the file ends after 1 of 2 vertices"},
        {"OFF\n2 0 0\n1.0 2.0 3.0\n", FFD_E_INVALID, 4, "the file ends after 1 of 2 vertices"},
        {"OFF\n2 1 0\n1 2 3\n1 2 \n3 0 1 0\n", FFD_E_INVALID, 4, "a vertex needs 3 numbers, found 2"},
        {"NOFF\n1 1 0\n1 2 3 0 0\n3 0 0 0\n", FFD_E_INVALID, 3, "a vertex needs 6 numbers, found 5"},
        {"OFF\n1 1 0\n1 two 3\n3 0 0 0\n", FFD_E_INVALID, 3,
         "coordinate y of a vertex is not a number: \"two\""},
        {"NOFF\n1 1 0\n1 2 3 0 0 1x\n3 0 0 0\n", FFD_E_INVALID, 3,
         "coordinate z of a normal is not a number: \"1x\""},
        {"OFF\n1 0 0\n1 2 3 red\n", FFD_E_INVALID, 3, "what follows a vertex is not a number: \"red\""},
        {"OFF\n1 0 0\n1 2 3 1 2 3 4 5\n", FFD_E_INVALID, 3, "a vertex has 7 numbers at most, found 8"},
        {"COFF\n1 0 0\n1 2 3\n", FFD_E_INVALID, 3, "a vertex has 4 numbers at least, found 3"},
        {"STOFF\n1 0 0\n1 2 3 1\n", FFD_E_INVALID, 3, "a vertex has 5 numbers at least, found 4"},
        {"OFF\n3 2 0\n" TRIANGLE "3 0 1 2\n", FFD_E_INVALID, 7, "the file ends after 1 of 2 faces"},
        {"OFF\n3 1 0\n" TRIANGLE "3 0 1 3\n", FFD_E_INVALID, 6,
         "there is no vertex 3, only 3 (counted from 0)"},
        {"OFF\n3 1 0\n" TRIANGLE "3 0 1 4294967296\n", FFD_E_INVALID, 6,
         "there is no vertex 4294967296, only 3 (counted from 0)"},
        {"OFF\n3 1 0\n" TRIANGLE "3 0 1 99999999999999999999\n", FFD_E_INVALID, 6,
         "there is no vertex 99999999999999999999, only 3 (counted from 0)"},
        {"OFF\n3 1 0\n" TRIANGLE "3 0 1 -1\n", FFD_E_INVALID, 6, "a corner is not a whole number: \"-1\""},
        {"OFF\n3 1 0\n" TRIANGLE "3.0 0 1 2\n", FFD_E_INVALID, 6,
         "a face's number of corners is not a whole number: \"3.0\""},
        {"OFF\n3 1 0\n" TRIANGLE "4 0 1 2\n", FFD_E_INVALID, 6, "a face states 4 corners, found 3"},
        {"OFF\n3 1 0\n" TRIANGLE "99999999999999999999 0 1 2\n", FFD_E_INVALID, 6,
         "a face states 99999999999999999999 corners, found 3"},
        {"OFF 3 1 0 0 0 0 1 0 0 0 1 0 9 0 1 2", FFD_E_INVALID, 1, "a face states 9 corners, found 3"},
    };
    assert_refused(off, cases, COUNT(cases), is_words);
}

/* Results */

static void only_changed_values_get_new_text(void **state)
{
    (void)state;
    static const struct {
        const char *before, *after;
    } cases[] = {
        {"NOFF # c\n2 0 0\n 1.0\t2.00 3e0   0 0.0 1.0 255 0 0 # d\r\n4 5 6 1 0 0\nrest",
         "NOFF # c\n2 0 0\n 1.0\t0.1 -1e+300   0 1 1.0 255 0 0 # d\r\n4 5 6 1 0 0\nrest"},
        {"NOFF 2 0 0 1.0 2.00\t3e0  0 0.0 1.0 4 5 6 1 0 0",
         "NOFF 2 0 0 1.0 0.1\t-1e+300  0 1 1.0 4 5 6 1 0 0"},
    };
    const double place[6] = {1, 0.1, -1e300, 9, 9, 9}, direction[6] = {0, 1, 1, 9, 9, 9};
    const uint8_t changed[2] = {1, 0}; /* an unchanged vertex is not read */
    for (size_t i = 0; i < COUNT(cases); i++) {
        mesh_document *document = opened(cases[i].before);
        assert_int_equal(off->begin_results(document, &(mesh_results){.directions = true}, NULL), FFD_OK);
        off->write(document, 0, MESH_POSITIONS, 0, 2, place, changed);
        off->write(document, 0, MESH_NORMALS, 0, 2, direction, changed);
        assert_saved(document, cases[i].after, strlen(cases[i].after));
        off->close(document);
    }
}

static void normals_stay_when_they_are_not_renewed(void **state)
{
    (void)state;
    static const char text[] = "NOFF 1 0 0\n1 2 3 0 0 1\n", expected[] = "NOFF 1 0 0\n-1 2 3.5 0 0 1\n";
    const double place[3] = {-1, 2, 3.5}, direction[3] = {1, 0, 0};
    const uint8_t changed = 1;
    mesh_document *document = opened(text);
    assert_int_equal(off->begin_results(document, &(mesh_results){.directions = false}, NULL), FFD_OK);
    off->write(document, 0, MESH_POSITIONS, 0, 1, place, &changed);
    off->write(document, 0, MESH_NORMALS, 0, 1, direction, &changed);
    assert_saved(document, expected, sizeof expected - 1);
    off->close(document);
}

static void the_sign_of_zero_is_written(void **state)
{
    (void)state;
    static const char text[] = "OFF 1 0 0\n0 -0 -0.0\n";
    const double place[3] = {-0.0, 0.0, -0.0};
    const uint8_t changed = 1;
    mesh_document *document = opened(text);
    assert_int_equal(off->begin_results(document, &(mesh_results){.directions = true}, NULL), FFD_OK);
    off->write(document, 0, MESH_POSITIONS, 0, 1, place, &changed);
    assert_saved(document, "OFF 1 0 0\n-0 0 -0.0\n", 20);
    off->close(document);
}

/* Description and comparison */

static void a_description_counts_what_the_file_has(void **state)
{
    (void)state;
    mesh_document *document =
        opened("STCOFF\r\n3 4 0\r\n0 0 0 255 255 255 1 1\r\n1 0 0 1 0 0\r\n0 1 0 1 1 1 1 0 0\r\n"
               "3 0 1 2\r\n4 0 1 2 0 7\r\n2 0 1\r\n5 0 1 2 0 1\r\n\r\n# c\r\nrest");
    assert_described(
        document,
        "{\"keyword\": \"STCOFF\", \"vertices\": 3, \"vertices_with_color\": 3, \"normals\": 0, "
        "\"texcoords\": 3, "
        "\"faces\": 3, \"faces_with_color\": 1, \"triangles\": 1, \"quads\": 1, \"ngons\": 1, \"lines\": 1, "
        "\"points\": 0, \"bytes_behind\": 4, \"line_endings\": \"CRLF\"}\n");
    off->close(document);
}

static void a_comparison_names_the_first_difference(void **state)
{
    (void)state;
    static const char base[] = "NOFF\n3 1 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1 255\n3 0 1 2 0.5\n";
    static const struct {
        const char *text;
        double tolerance;
        const char *difference; /* NULL: equal */
    } cases[] = {
        {"NOFF\n3 1 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1 255\n3 0 1 2 0.5\n", 0, NULL},
        {"NOFF 3 1\r\n0 0.0 0 0 0 1 # c\r1e0 0 0 0 0 1\n\n0 1 0 0 -0 1 255\n3 0 01 2 .50\nrest", 0, NULL},
        {"NOFF 3 1 3\n0 0 0 0 0 1\n1.5 0 0 0 0 1\n0 1 0 0 0 1 255\n3 0 1 2 0.5\n", 0.5, NULL},
        {"NOFF\n3 1 3\n0 0 0 0 0 1\n1.5 0 0 0 0 1\n0 1 0 0 0 1 255\n3 0 1 2 0.5\n", 0.25,
         "vertex 1 counted from 0 (line 4): x differs by 0.5"},
        {"NOFF\n\n3 1 3\n0 0 0 0 0 1\n1 nan 0 0 0 1\n0 1 0 0 0 1 255\n3 0 1 2 0.5\n", 9,
         "vertex 1 counted from 0 (lines 4 and 5): y: 0 and nan"},
        {"NOFF\n3 1 3\n0 0 0 0 0 1\n1 0 0 0 0.5 1\n0 1 0 0 0 1 255\n3 0 1 2 0.5\n", 9,
         "vertex 1 counted from 0 (line 4): y of the normal differs by 0.5"},
        {"NOFF\n3 1 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1 254\n3 0 1 2 0.5\n", 9,
         "vertex 2 counted from 0 (line 5): followed by \"255\" and \"254\""},
        {"NOFF\n3 1 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1 255.0\n3 0 1 2 0.5\n", 9,
         "vertex 2 counted from 0 (line 5): followed by \"255\" and \"255.0\""},
        {"NOFF\n3 1 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2 0.5\n", 9,
         "vertex 2 counted from 0 (line 5): followed by \"255\" and \"\""},
        {"NOFF\n3 1 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1 255\n3 0 1 2\n", 9,
         "face 0 counted from 0 (line 6): followed by \"0.5\" and \"\""},
        {"NOFF\n3 1 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1 255\n3 0 2 1 0.5\n", 9,
         "face 0 counted from 0 (line 6): vertices \"1\" and \"2\""},
        {"NOFF\n3 1 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1 255\n4 0 1 2 0\n", 9,
         "face 0 counted from 0 (line 6): corners \"3\" and \"4\""},
        {"OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.5\n", 9, "normals of vertices are only in the first"},
        {"CNOFF\n3 1 3\n0 0 0 0 0 1 1\n1 0 0 0 0 1 1\n0 1 0 0 0 1 255\n3 0 1 2 0.5\n", 9,
         "colors of vertices are only in the second"},
        {"NOFF\n2 1 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n3 0 1 0 0.5\n", 9, "3 and 2 vertices"},
        {"NOFF\n3 0 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1 255\n", 9, "1 and 0 faces"},
    };
    mesh_document *a = opened(base);
    for (size_t i = 0; i < COUNT(cases); i++) {
        mesh_document *b = opened(cases[i].text);
        const ffd_comparison result = compared(a, b, cases[i].tolerance, 0);
        assert_int_equal(result.equal, cases[i].difference == NULL);
        if (strcmp(result.first.text, cases[i].difference ? cases[i].difference : "") != 0)
            fail_msg("case %zu: %s", i, result.first.text);
        if (result.equal)
            assert_int_equal(result.positions_compared, 3);
        off->close(b);
    }
    off->close(a);
}

/* Broken files, and no memory */

static const byte_seed seeds[] = {
    BYTE_SEED("OFF\n4 2 0\n" TRIANGLE "1 1 0.5\n3 0 1 2\n4 0 1 3 2 255 0 0\n# end\n"),
    BYTE_SEED("CNOFF # c\r\n2 2 3\r\n0.25 -1e-3 2 0 0 1 1 0 .5 1\r\n1 2 3 0 1 0 1 0 .5 1\r\n2 0 1\r\n1 1"),
    BYTE_SEED("STCNOFF 2 1 1 1 2 3 0 1 0 9 9 9 9 .5 .5 4 5 6 1 0 0 9 9 9 9 .5 .5 3 0 1 0 1 1 1"),
    BYTE_SEED("3 1 0\n0 0 0 1 2 3\n1 0 0\n0 1 0 9\n3 0 1 2\n"),
};

static void truncated_files_are_read_or_refused(void **state)
{
    (void)state;
    use_truncations(off, seeds, COUNT(seeds));
}

static void mutated_files_are_read_or_refused(void **state)
{
    (void)state;
    use_mutations(off, seeds, COUNT(seeds), 6000, "0123456789-+.#\r\n\t OFCNSTe4nB");
}

static void every_failed_allocation_is_reported(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(seeds); i++)
        use_with_failing_memory(off, &seeds[i]);
}

/* In a message a long word is truncated at a whole character. */
static void a_cut_word_ends_with_a_whole_character(void **state)
{
    (void)state;
    char text[60];
    for (size_t before = 30; before <= 40; before++) {
        memset(text, 'x', before);
        memcpy(text + before, "\xf0\x9f\x90\x84\xc3\xa4\xe2\x82\xac", 9);
        memset(text + before + 9, 'x', 11);
        const int shown = ffd_text_display_size((text_word){text, text + before + 20});
        assert_in_range(shown, 37, 40);
        assert_true((text[shown] & 0xc0) != 0x80);
    }
    assert_int_equal(ffd_text_display_size((text_word){text, text + 40}), 40);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_dialect_is_read),
        cmocka_unit_test(broken_files_are_refused_with_their_line),
        cmocka_unit_test(only_changed_values_get_new_text),
        cmocka_unit_test(normals_stay_when_they_are_not_renewed),
        cmocka_unit_test(the_sign_of_zero_is_written),
        cmocka_unit_test(a_description_counts_what_the_file_has),
        cmocka_unit_test(a_comparison_names_the_first_difference),
        cmocka_unit_test(truncated_files_are_read_or_refused),
        cmocka_unit_test(a_cut_word_ends_with_a_whole_character),
        cmocka_unit_test(mutated_files_are_read_or_refused),
        cmocka_unit_test(every_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, remove_saved);
}
