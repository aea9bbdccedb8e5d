/* A mesh file that is overwritten while it is in use: the faces are read twice, and the second time they
   differ. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/mesh_bytes.h"
#include "io/formats.h"
#include "mesh/mesh.h"
#include <string.h>

#define SIZE 200
#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Two texts of equal length: when the document is opened, and when its faces are read. */
typedef struct changed_text {
    ffd_format format;
    const char *before, *after;
} changed_text;

#define OBJ_START "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\n"
#define OFF_START "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
static const changed_text texts[] = {
    {FFD_FORMAT_OBJ, OBJ_START "f 1//1 2 3\nf 2 3 4\n", OBJ_START "f 1 2 3 4 1 2 3 4 \n"},  /* more corners */
    {FFD_FORMAT_OBJ, OBJ_START "f 1//1 2 3\nf 2 3 4\n", OBJ_START "f 1 2 3\n#         \n"}, /* fewer faces */
    {FFD_FORMAT_OBJ, OBJ_START "f 1//1 2 3\nf 2 3 4\n", OBJ_START "f 1 2 3\nf 1 2\nf 1\n"}, /* more faces */
    {FFD_FORMAT_OBJ, OBJ_START "f 1//1 2 3\nf 2 3 4\n",
     OBJ_START "f 1 2 3\nf 2 3 99 \n"}, /* no such vertex */
    {FFD_FORMAT_OFF, OFF_START "3 0 1 2\n3 1 2 3\n", OFF_START "3 0 1 2\n9 8 8 8\n"},
    {FFD_FORMAT_OFF, OFF_START "3 0 1 2\n3 1 2 3\n", OFF_START "3 0 1 2\n2 1 2 3\n"},
    {FFD_FORMAT_OFF, OFF_START "3 0 1 2\n3 1 2 3\n", OFF_START "3 0 1 2\n3 1 2 7\n"},
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
        assert_int_equal(document->format->faces(document, &faces, &error), FFD_E_IO);
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
        assert_int_equal(document->format->faces(document, &faces, NULL), FFD_OK);
        assert_int_equal(document->format->corner_normals(document, &faces, normals, NULL), FFD_OK);
        overwrite(bytes, after[i]);
        assert_int_equal(document->format->corner_normals(document, &faces, normals, NULL), FFD_E_IO);
        ffd_mesh_faces_free(&faces);
        document->format->close(document);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_faces_are_refused),
        cmocka_unit_test(other_corners_have_no_normals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
