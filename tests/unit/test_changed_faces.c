/* A mesh file that is overwritten while it is in use: faces, and the places of numbers, are read twice, and
   differ the second time. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/mesh_bytes.h"
#include "io/formats.h"
#include "mesh/difference.h"
#include "mesh/mesh.h"
#include <string.h>

#define SIZE 250
#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Two texts of equal length: when the document is opened, and when its faces are read. */
typedef struct changed_text {
    ffd_format format;
    const char *before, *after;
} changed_text;

#define OBJ_START "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\n"
#define OFF_START "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
#define PLY_START(element)                                                                                   \
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "           \
    "z\n" element "end_header\n"
#define PLY_LISTS(name)                                                                                      \
    PLY_START("element " name " 1\nproperty list uint uint vertex_index\n") "0 0 0\n1 0 0\n"
static const changed_text texts[] = {
    {FFD_FORMAT_OBJ, OBJ_START "f 1//1 2 3\nf 2 3 4\n", OBJ_START "f 1 2 3 4 1 2 3 4 \n"},  /* more corners */
    {FFD_FORMAT_OBJ, OBJ_START "f 1//1 2 3\nf 2 3 4\n", OBJ_START "f 1 2 3\n#         \n"}, /* fewer faces */
    {FFD_FORMAT_OBJ, OBJ_START "f 1//1 2 3\nf 2 3 4\n", OBJ_START "f 1 2 3\nf 1 2\nf 1\n"}, /* more faces */
    {FFD_FORMAT_OBJ, OBJ_START "f 1//1 2 3\nf 2 3 4\n",
     OBJ_START "f 1 2 3\nf 2 3 99 \n"}, /* no such vertex */
    {FFD_FORMAT_OFF, OFF_START "3 0 1 2\n3 1 2 3\n", OFF_START "3 0 1 2\n9 8 8 8\n"},
    {FFD_FORMAT_OFF, OFF_START "3 0 1 2\n3 1 2 3\n", OFF_START "3 0 1 2\n2 1 2 3\n"},
    {FFD_FORMAT_OFF, OFF_START "3 0 1 2\n3 1 2 3\n", OFF_START "3 0 1 2\n3 1 2 7\n"},
    {FFD_FORMAT_PLY, PLY_LISTS("face") "5 0 1 0 1 0\n", PLY_LISTS("face") "4294967295\n"},
    {FFD_FORMAT_PLY, PLY_LISTS("tristrips") "5 0 1 0 1 0\n", PLY_LISTS("tristrips") "4294967295\n"},
};

/* Overwrites the bytes of an open document, as another program may overwrite a mapped file. */
static void overwrite(char *bytes, const char *text)
{
    assert_true(strlen(text) <= strlen(bytes));
    memcpy(bytes, text, strlen(text));
}

/* Opens a copy of the text. */
static mesh_document *opened_copy(ffd_format format, const char *text, char bytes[SIZE])
{
    assert_true(strlen(text) < SIZE);
    memcpy(bytes, text, strlen(text) + 1);
    return opened_bytes(ffd_format_table(format), bytes, strlen(text));
}

static void other_faces_are_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(texts); i++) {
        char bytes[SIZE];
        mesh_document *const document = opened_copy(texts[i].format, texts[i].before, bytes);
        mesh_faces faces;
        ffd_error error;
        overwrite(bytes, texts[i].after);
        assert_int_equal(document->format->faces(document, MESH_STORED, &faces, &error), FFD_E_IO);
        assert_non_null(strstr(error.message, "has changed while it was read"));
        assert_null(faces.start);
        document->format->close(document);
    }
}

static void other_corners_have_no_normals(void **state)
{
    (void)state;
    static const char before[] = OBJ_START "f 1//1 2 3\nf 2 3 4\n", *const after[] = {
                                                                        OBJ_START "f 1//1 3 2\nf 2 3 4\n",
                                                                        OBJ_START "f 1 2 3 4 1 2 3 4 \n",
                                                                        OBJ_START "f 1 2 3 \n#        \n"};
    for (size_t i = 0; i < COUNT(after); i++) {
        char bytes[SIZE];
        mesh_document *const document = opened_copy(FFD_FORMAT_OBJ, before, bytes);
        mesh_faces faces;
        uint32_t normals[6];
        assert_int_equal(document->format->faces(document, MESH_STORED, &faces, NULL), FFD_OK);
        assert_int_equal(document->format->corner_normals(document, &faces, normals, NULL), FFD_OK);
        overwrite(bytes, after[i]);
        assert_int_equal(document->format->corner_normals(document, &faces, normals, NULL), FFD_E_IO);
        ffd_mesh_faces_free(&faces);
        document->format->close(document);
    }
}

/* A count of corners that would take more memory than there is, and hours to walk through. */
static const changed_text large_counts[] = {
    {FFD_FORMAT_OFF, OFF_START "3 0 1 2\n3 1 2 3\n", OFF_START "4294967295\n3 1\n"},
    {FFD_FORMAT_PLY, PLY_LISTS("face") "5 0 1 0 1 0\n", PLY_LISTS("face") "4294967295\n"},
};

static void a_count_is_no_larger_than_the_file(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(large_counts); i++) {
        char bytes[SIZE];
        mesh_document *const document = opened_copy(large_counts[i].format, large_counts[i].before, bytes);
        ffd_comparison comparison = {.struct_size = sizeof comparison};
        mesh_model model = {.wants_details = true};
        overwrite(bytes, large_counts[i].after);
        assert_int_equal(document->format->model(document, MESH_STORED, &model, NULL), FFD_E_IO);
        ffd_difference_begin(&comparison, 0, 0);
        assert_int_equal(document->format->compare(document, document, &comparison, NULL), FFD_OK);
        ffd_model_free(&model);
        document->format->close(document);
    }
}

#define STL_FACET "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
static const changed_text saved_texts[] = {
    {FFD_FORMAT_OBJ, "v 0 0 0\nv 1 0 0\nvn 0 0 1\n", "v 0 0 0\nv 1 0 0\nv  0 0 1\n"}, /* more vertices */
    {FFD_FORMAT_OBJ, "v 0 0 0\nv 1 0 0\n", "v 0 0 0\n# 1 0 0\n"},                     /* fewer vertices */
    {FFD_FORMAT_OFF, "OFF\n2 0 0\n0 0 0\n1 0 0\n", "OFF\n2 0 0\n0 0 0\n1    \n"},
    {FFD_FORMAT_PLY, PLY_START("") "0 0 0\n1 0 0\n", PLY_START("") "0 0 0\n1    \n"},
    {FFD_FORMAT_STL, "solid\n" STL_FACET "endfacet\nendsolid\n", "solid\nendsolid\n"},
};

/* The numbers that are replaced are found in the text again. */
static void another_text_is_not_saved(void **state)
{
    static const double moved[3] = {7, 8, 9};
    static const uint8_t changed = 1;
    (void)state;
    for (size_t i = 0; i < COUNT(saved_texts); i++) {
        char bytes[SIZE];
        mesh_document *const document = opened_copy(saved_texts[i].format, saved_texts[i].before, bytes);
        file_input saved;
        ffd_error error;
        assert_int_equal(document->format->begin_results(document, &(mesh_results){.directions = true}, NULL),
                         FFD_OK);
        document->format->write(document, 0, MESH_POSITIONS, 1, 1, moved, &changed);
        overwrite(bytes, saved_texts[i].after);
        if (save_bytes(document, &saved, &error) != FFD_E_IO)
            fail_msg("case %zu was saved", i);
        assert_string_equal(error.message, "was changed while it was read");
        document->format->close(document);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_faces_are_refused),
        cmocka_unit_test(other_corners_have_no_normals),
        cmocka_unit_test(a_count_is_no_larger_than_the_file),
        cmocka_unit_test(another_text_is_not_saved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
