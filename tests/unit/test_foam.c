/* test_foam.c - meshes of OpenFOAM: words of their files, cells made of faces, what is missing, refusals,
   memory that runs out. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/fail.h"
#include "base/text/code_scan.h"
#include "io/foam/foam_format.h"
#include "io/volume/volume_document.h"
#include "mesh/selector.h"

#include "../support/mesh_file.h"

static const mesh_format *const foam = &ffd_foam_format;

#define COUNT(list) (sizeof(list) / sizeof *(list))
#define HEAD(class) "FoamFile\n{\n    format ascii;\n    class " class ";\n}\n"

/* Two cubes with a side in common: x from 0 to 1 and from 1 to 2. */
static const char points[] =
    HEAD("vectorField") "12\n(\n(0 0 0)\n(1 0 0)\n(2 0 0)\n(0 1 0)\n(1 1 0)\n(2 1 0)\n"
                        "(0 0 1)\n(1 0 1)\n(2 0 1)\n(0 1 1)\n(1 1 1)\n(2 1 1)\n)\n";
static const char faces[] =
    HEAD("faceList") "11\n(\n4(1 4 10 7)\n4(0 6 9 3)\n4(0 1 7 6)\n4(3 9 10 4)\n4(0 3 4 1)\n4(6 7 10 9)\n"
                     "4(2 5 11 8)\n4(1 2 8 7)\n4(4 10 11 5)\n4(1 4 5 2)\n4(7 8 11 10)\n)\n";
static const char owner[] = HEAD("labelList") "11(0 0 0 0 0 0 1 1 1 1 1)\n";
static const char noted_owner[] = "FoamFile { class labelList; note \"nFaces:11 nInternalFaces: 1\"; }\n"
                                  "11(0 0 0 0 0 0 1 1 1 1 1)\n";
static const char neighbour[] = HEAD("labelList") "1(1)\n";
static const char boundary[] =
    HEAD("polyBoundaryMesh") "2\n(\n left { type wall; inGroups 1(wall); nFaces 1; startFace 1; }\n"
                             " rest { transform { a (1 0 0); } startFace 2; nFaces 9; }\n)\n";
static const char zones[] = HEAD("regIOobject") "1(right { type cellZone; cellLabels List<label> 1(1); })\n";
static const char corners[] = HEAD("regIOobject") "1(right { type pointZone; pointLabels 2{0}; })\n";
static const char sides[] = HEAD("regIOobject") "1(middle { faceLabels List<label> 1(0);\n"
                                                " flipMap List<bool> 1{0}; })\n";

/* Files in memory. */
typedef struct side_file {
    const char *name, *text;
} side_file;

static const side_file all[] = {
    {"faces", faces},        {"owner", owner},     {"neighbour", neighbour}, {"boundary", boundary},
    {"pointZones", corners}, {"faceZones", sides}, {"cellZones", zones},     {NULL, NULL}};

static ffd_status find_side(void *user, const char *name, ffd_bytes *bytes)
{
    for (const side_file *file = user; file->name; file++)
        if (strcmp(file->name, name) == 0)
            *bytes = (ffd_bytes){file->text, strlen(file->text)};
    return FFD_OK;
}

static ffd_status open_with(const char *text, const side_file *files, mesh_document **document,
                            ffd_error *error)
{
    file_input input = {.data = (const unsigned char *)text, .size = strlen(text)};
    const ffd_source source = {.path = "points",
                               .format = FFD_FORMAT_FOAM,
                               .resolve = find_side,
                               .resolve_user = (void *)(uintptr_t)files};
    *error = (ffd_error){0};
    *document = NULL;
    return ffd_format_open(foam, &input, &source, document, error);
}

static mesh_document *opened_with(const side_file *files)
{
    mesh_document *document;
    ffd_error error;
    if (open_with(points, files, &document, &error))
        fail_msg("%s: %s", error.file, error.message);
    return document;
}

static void words_end_at_marks_and_comments(void **state)
{
    static const char text[] = "/* a\n b */ 12(ab/c {x//y\n;\"q \\\" r\"\r\n7/*";
    text_scan scan;
    text_word word;
    ffd_text_begin(&scan, text, strlen(text), false);
    assert_false(ffd_code_mark(&scan, '('));
    assert_true(ffd_code_word(&scan, &word) && ffd_text_is(word, "12"));
    assert_int_equal(scan.line, 2);
    assert_false(ffd_code_word(&scan, &word));
    assert_true(ffd_code_mark(&scan, '('));
    assert_true(ffd_code_word(&scan, &word) && ffd_text_is(word, "ab/c"));
    assert_true(ffd_code_mark(&scan, '{'));
    assert_true(ffd_code_word(&scan, &word) && ffd_text_is(word, "x"));
    assert_false(ffd_code_string(&scan, &word));
    assert_true(ffd_code_mark(&scan, ';'));
    assert_true(ffd_code_string(&scan, &word) && ffd_text_is(word, "q \\\" r"));
    assert_true(ffd_code_word(&scan, &word) && ffd_text_is(word, "7"));
    assert_int_equal(scan.line, 4);
    assert_false(ffd_code_find(&scan)); /* a comment without an end */
    (void)state;
}

static void a_string_without_an_end_is_none(void **state)
{
    static const char text[] = " \"ab\\\"";
    text_scan scan;
    text_word word;
    ffd_text_begin(&scan, text, strlen(text), false);
    assert_false(ffd_code_string(&scan, &word));
    assert_false(ffd_code_word(&scan, &word));
    (void)state;
}

/* The volume of a polyhedron by the divergence theorem: positive if its faces look outwards. */
static double volume_of(const mesh_document *document, size_t cell)
{
    size_t count;
    double sum = 0;
    const uint32_t *const words = ffd_cell_words(&ffd_volume_of(document)->cells, cell, &count);
    for (size_t at = 1; at < count; at += 1 + words[at])
        for (size_t c = 2; c < words[at]; c++) {
            const uint32_t triangle[] = {words[at + 1], words[at + c], words[at + c + 1]};
            double p[3][3];
            for (int i = 0; i < 3; i++)
                foam->read(document, 0, MESH_POSITIONS, MESH_STORED, triangle[i], 1, p[i]);
            for (int a = 0; a < 3; a++) {
                const int b = (a + 1) % 3, d = (a + 2) % 3;
                sum += p[0][a] * (p[1][b] * p[2][d] - p[1][d] * p[2][b]);
            }
        }
    return sum / 6;
}

static void cells_are_polyhedra_whose_faces_look_outwards(void **state)
{
    mesh_document *const document = opened_with(all);
    assert_int_equal(ffd_volume_of(document)->cells.count, 2);
    for (size_t c = 0; c < 2; c++)
        assert_float_equal(volume_of(document, c), 1, 0);
    foam->close(document);
    (void)state;
}

static size_t faces_of(const mesh_document *document, size_t *inside)
{
    mesh_faces made;
    assert_int_equal(foam->faces(document, MESH_STORED, &made, NULL), FFD_OK);
    const size_t count = made.face_count;
    for (size_t c = 0; c < made.start[count]; c++)
        assert_true(made.corners[c] < 12);
    *inside = made.repeated;
    ffd_mesh_faces_free(&made);
    return count;
}

#define WITHOUT_CELLS "its points and outer faces, without cells"
#define POINTS_ALONE "its points alone, without faces and cells"

static void what_is_missing_is_said(void **state)
{
    static const side_file packed[] = {{"faces.gz", ""}, {NULL, NULL}}, nothing[] = {{NULL, NULL}},
                           bare[] = {{"faces", faces}, {"owner", owner}, {NULL, NULL}},
                           noted[] = {{"faces", faces}, {"owner", noted_owner}, {NULL, NULL}},
                           ownerless[] = {{"faces", faces}, {"neighbour", neighbour}, {NULL, NULL}},
                           whole[] = {
                               {"faces", faces}, {"owner", owner}, {"neighbour", neighbour}, {NULL, NULL}};
    static const struct {
        const side_file *files;
        size_t faces, cells;
        const char *says;
    } cases[] = {
        {nothing, 0, 0, "the file faces is not beside it: the mesh is taken as " POINTS_ALONE},
        {packed, 0, 0,
         "the file faces is not beside it (only compressed, which is not read: unpack it with gunzip): the "
         "mesh is "
         "taken as " POINTS_ALONE},
        {bare, 0, 0, "the file neighbour is not beside it: the mesh is taken as " POINTS_ALONE},
        {noted, 10, 0, "the file neighbour is not beside it: the mesh is taken as " WITHOUT_CELLS},
        {ownerless, 10, 0, "the file owner is not beside it: the mesh is taken as " WITHOUT_CELLS},
        {whole, 10, 2, ""},
        {all, 10, 2, ""},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        size_t inside;
        mesh_document *const document = opened_with(cases[i].files);
        assert_int_equal(document->flaws.count, *cases[i].says != 0);
        assert_string_equal(document->flaws.list[0].message, cases[i].says);
        assert_int_equal(faces_of(document, &inside), cases[i].faces);
        assert_int_equal(inside, 0); /* all points are on outer faces */
        assert_int_equal(ffd_volume_of(document)->cells.count, cases[i].cells);
        foam->close(document);
    }
    (void)state;
}

/* A cell needs no neighbour to be closed. */
static void a_single_cell_needs_no_neighbours(void **state)
{
    static const side_file files[] = {
        {"faces", HEAD("faceList") "5(4(1 4 10 7) 4(0 6 9 3) 4(0 1 7 6) 4(3 9 10 4) 4(0 3 4 1))"},
        {"owner", HEAD("labelList") "5{0}"},
        {NULL, NULL}};
    size_t inside;
    mesh_document *const document = opened_with(files);
    assert_int_equal(faces_of(document, &inside), 5);
    assert_int_equal(ffd_volume_of(document)->cells.count, 1);
    foam->close(document);
    (void)state;
}

static void patches_and_zones_are_groups(void **state)
{
    static const struct {
        const char *name;
        uint8_t marks[12];
    } groups[] = {{"left", {1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}},
                  {"rest", {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}},
                  {"middle", {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}},
                  {"right", {1, 1, 1, 0, 1, 1, 0, 1, 1, 0, 1, 1}}}; /* of points and of cells */
    mesh_document *const document = opened_with(all);
    for (size_t i = 0; i < COUNT(groups); i++) {
        const mesh_selector selector = {SELECT_GROUP, groups[i].name, strlen(groups[i].name), "only"};
        uint8_t marks[12] = {0};
        assert_int_equal(foam->selectors->mark(document, &selector, marks, NULL), FFD_OK);
        assert_memory_equal(marks, groups[i].marks, sizeof marks);
    }
    foam->close(document);
    (void)state;
}

static void the_message_of_an_unknown_group_names_the_missing_file(void **state)
{
    static const side_file nothing[] = {{NULL, NULL}}, some[] = {{"faces", faces}, {NULL, NULL}};
    static const mesh_selector selector = {SELECT_GROUP, "left", 4, "only"};
    uint8_t marks[12];
    ffd_error error;
    mesh_document *document = opened_with(nothing);
    assert_int_equal(foam->selectors->mark(document, &selector, marks, &error), FFD_E_ARGUMENT);
    assert_non_null(
        strstr(error.message, "(the file faces, without which no patches are known, is not beside it)"));
    foam->close(document);
    document = opened_with(some);
    assert_int_equal(foam->selectors->mark(document, &selector, marks, &error), FFD_E_ARGUMENT);
    assert_non_null(strstr(error.message, "(the file boundary, which names patches, is not beside it)"));
    foam->close(document);
    (void)state;
}

static void memory_may_run_out_anywhere(void **state)
{
    ffd_status status = FFD_E_MEMORY;
    long successes = 0;
    for (; status; successes++) {
        mesh_document *document;
        ffd_error error;
        ffd_alloc_fail_after(successes);
        status = open_with(points, all, &document, &error);
        ffd_alloc_fail_after(-1);
        if (status) {
            assert_int_equal(status, FFD_E_MEMORY);
            assert_non_null(strstr(error.message, "out of memory"));
        } else
            foam->close(document);
    }
    assert_true(successes > 30);
    (void)state;
}

/* Texts of points, and what they are refused with. */
static void broken_points_are_refused(void **state)
{
    static const refused_text cases[] = {
        {"", FFD_E_INVALID, 0, "does not begin with FoamFile"},
        {"v 0 0 0\n", FFD_E_INVALID, 0, "does not begin with FoamFile; it seems to be an OBJ file"},
        {"\x1f\x8b\x08", FFD_E_UNSUPPORTED, 0,
         "is compressed, which is not supported: unpack it with gunzip"},
        {"FoamFile x", FFD_E_INVALID, 1, "\"x\" is in the place of the \"{\" of the header"},
        {"FoamFile\n{ a", FFD_E_INVALID, 2, "the end of the file is in the place of the end of an entry"},
        {"FoamFile{ a (b; ]", FFD_E_INVALID, 1, "the end of the file is in the place of the end of an entry"},
        {"FoamFile{ a b) ; }", FFD_E_INVALID, 1, "\")\" is in the place of the end of an entry"},
        {"FoamFile{ (a); }", FFD_E_INVALID, 1, "\"(\" is in the place of an entry of the header"},
        {"FoamFile{ format base64; }", FFD_E_UNSUPPORTED, 0,
         "the format \"base64\" is not supported: only ascii and binary are"},
        {"FoamFile{ format binary; arch \"MSB;label=32;scalar=64\"; }", FFD_E_UNSUPPORTED, 1,
         "binary numbers of the arch \"MSB;label=32;scalar=64\" are not supported: only LSB, with 32 or 64 "
         "bits, is"},
        {"FoamFile{ format binary; arch \"LSB;scalar=128\"; }", FFD_E_UNSUPPORTED, 1,
         "binary numbers of the arch \"LSB;scalar=128\" are not supported: only LSB, with 32 or 64 bits, is"},
        {"FoamFile{ class labelList; }", FFD_E_INVALID, 0, "the class is \"labelList\", not vectorField"},
        {"FoamFile{ class decomposedBlockData; }", FFD_E_UNSUPPORTED, 0,
         "the class is \"decomposedBlockData\", not vectorField"},
        {"FoamFile{ }", FFD_E_INVALID, 0, "the class is \"\", not vectorField"},
        {HEAD("vectorField"), FFD_E_INVALID, 6, "the end of the file is not the number of points"},
        {HEAD("vectorField") "x", FFD_E_INVALID, 6, "\"x\" is not the number of points"},
        {HEAD("vectorField") "-1()", FFD_E_INVALID, 6, "\"-1\" is not the number of points"},
        {HEAD("vectorField") "1 [", FFD_E_INVALID, 6, "\"[\" is in the place of the \"(\" of points"},
        {HEAD("vectorField") "9((0 0 0))", FFD_E_INVALID, 6,
         "the file ends too early: 8 bytes are left for 9 points"},
        {HEAD("vectorField") "18446744073709551615((0 0 0))", FFD_E_INVALID, 6,
         "the file ends too early: 8 bytes are left for 18446744073709551615 points"},
        {HEAD("vectorField") "1((0 0))", FFD_E_INVALID, 6,
         "point 0 (counted from 0) needs 3 numbers in parentheses"},
        {HEAD("vectorField") "1((0 0 0 0))", FFD_E_INVALID, 6,
         "point 0 (counted from 0) needs 3 numbers in parentheses"},
        {HEAD("vectorField") "2((0 0 0)\n1 1 1)     ", FFD_E_INVALID, 7,
         "point 1 (counted from 0) needs 3 numbers in parentheses"},
        {HEAD("vectorField") "1((0 y 0))", FFD_E_INVALID, 6,
         "point 0 (counted from 0) has \"y\", which is not a number"},
        {HEAD("vectorField") "1((0 0 0)\n(1 1 1))", FFD_E_INVALID, 7,
         "\"(\" is in the place of the \")\" of points"},
        {HEAD("vectorField") "3000000{(0 0 0)}", FFD_E_LIMIT, 0,
         "needs more than the 100 MB of memory allowed (input.memory raises this)"},
        {HEAD("vectorField") "3{(0 0 0)", FFD_E_INVALID, 6,
         "the end of the file is in the place of the \"}\" of points"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        mesh_document *document;
        ffd_error error;
        const ffd_status status = open_bytes(foam, cases[i].text, strlen(cases[i].text), &document, &error);
        if (status != cases[i].status || error.line != cases[i].line ||
            strcmp(error.message, cases[i].says) != 0)
            fail_msg("case %zu: status %d, line %zu: %s", i, status, error.line, error.message);
        assert_null(document);
    }
    (void)state;
}

/* Texts of a file beside the points, and what they are refused with. */
static const struct {
    const char *name, *text, *says;
} broken[] = {
    {"faces", "faces", "does not begin with FoamFile"},
    {"faces", HEAD("labelList") "0", "the class is \"labelList\", not faceList or faceCompactList"},
    {"faces", HEAD("faceList") "1(4(0 1 2))", "\")\" is not a whole number"},
    {"faces", HEAD("faceList") "1(2(0 1))   ", "face 0 (counted from 0) has 2 corners"},
    {"faces", HEAD("faceList") "1(3(0 1 12))",
     "face 0 (counted from 0) has the point 12, but there are only 12"},
    {"faces", HEAD("faceList") "1(3(0 1 -2))", "\"-2\" is not a whole number"},
    {"faces", HEAD("faceList") "1(3(0 1 4294967295))",
     "4294967295 is too large for one of the corners of a face"},
    {"faces", HEAD("faceList") "1(3{1})      ", "\"{\" is in the place of the \"(\" of corners of a face"},
    {"faces", HEAD("faceCompactList") "2(1 3) 3(0 1 2)", "the first face begins at 1, not at 0"},
    {"faces", HEAD("faceCompactList") "3(0 3 2) 3(0 1 2)", "face 1 (counted from 0) ends before it begins"},
    {"faces", HEAD("faceCompactList") "2(0 3) 4(0 1 2 3)", "the faces end at 3 of 4 corners"},
    {"owner", HEAD("labelList") "2(0 1)", "has 2 cells, but there are 11 faces"},
    {"owner", HEAD("faceList") "2(0 1)", "the class is \"faceList\", not labelList"},
    {"owner", HEAD("labelList") "11(0 0 0 0 0 0 1 1 1 1 99)",
     "owner and neighbour beside it have the cell 99, but there are only 11 faces"},
    {"neighbour", HEAD("labelList") "1(0)",
     "owner and neighbour beside it have the cell 0 on both sides of face 0"},
    {"neighbour", HEAD("labelList") "12(1 1 1 1 1 1 1 1 1 1 1 1)", "has 12 cells, but there are 11 faces"},
    {"boundary", HEAD("a") "1(left { nFaces 1; })", "the patch \"left\" has no nFaces and startFace"},
    {"boundary", HEAD("a") "1(left { nFaces 1; startFace x; })", "\"x\" is not the number of a face"},
    {"boundary", HEAD("a") "1(left { nFaces 2; startFace 10; })",
     "the patch \"left\" has 2 faces from 10 on, but there are only 11"},
    {"boundary", HEAD("a") "1(left { nFaces 18446744073709551615; startFace 1; })",
     "the patch \"left\" has 18446744073709551615 faces from 1 on, but there are only 11"},
    {"boundary", HEAD("a") "1(left 1)", "\"1\" is in the place of the \"{\" of its dictionary"},
    {"boundary", HEAD("a") "2(left { nFaces 1; startFace 1; })",
     "\")\" is in the place of the name of a patch"},
    {"pointZones", HEAD("a") "1(z { pointLabels List<label> 1(12); })",
     "the zone \"z\" has the member 12, but there are only 12"},
    {"faceZones", HEAD("a") "1(z { faceLabels List<label> 1(11); })",
     "the zone \"z\" has the member 11, but there are only 11"},
    {"cellZones", HEAD("a") "1(z { cellLabels List<label> 1(2); })",
     "the zone \"z\" has the member 2, but there are only 2"},
    {"cellZones", HEAD("a") "1(z { cellLabels List<label> 3{0}; })",
     "\"{\" is in the place of the \"(\" of members of a zone"},
};

static void broken_files_beside_the_points_are_refused(void **state)
{
    for (size_t i = 0; i < COUNT(broken); i++) {
        side_file files[COUNT(all)];
        mesh_document *document;
        ffd_error error;
        memcpy(files, all, sizeof all);
        for (size_t f = 0; files[f].name; f++)
            if (strcmp(files[f].name, broken[i].name) == 0)
                files[f].text = broken[i].text;
        const ffd_status status = open_with(points, files, &document, &error);
        if (status != FFD_E_INVALID || strcmp(error.message, broken[i].says) != 0)
            fail_msg("case %zu: status %d: %s", i, status, error.message);
        const bool by_both = strstr(broken[i].says, "beside it");
        assert_string_equal(error.file, by_both ? "points" : broken[i].name);
        assert_null(document);
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_end_at_marks_and_comments),
        cmocka_unit_test(a_string_without_an_end_is_none),
        cmocka_unit_test(cells_are_polyhedra_whose_faces_look_outwards),
        cmocka_unit_test(what_is_missing_is_said),
        cmocka_unit_test(a_single_cell_needs_no_neighbours),
        cmocka_unit_test(patches_and_zones_are_groups),
        cmocka_unit_test(the_message_of_an_unknown_group_names_the_missing_file),
        cmocka_unit_test(memory_may_run_out_anywhere),
        cmocka_unit_test(broken_points_are_refused),
        cmocka_unit_test(broken_files_beside_the_points_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
