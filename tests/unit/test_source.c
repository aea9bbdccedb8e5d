/* test_source.c - the files that a mesh is read from. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "job/input/source.h"
#include <sys/stat.h>

#define POINTS                                                                                               \
    "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 1, \"type\": \"VEC3\"}]"
#define MESHES "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"mode\": 0}]}]"
#define VIEWS "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 12}]"
#define DATA_URI "data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"

static const char gltf[] =
    "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{\"mesh\": 0}], " POINTS ", " MESHES ", " VIEWS
    ", \"images\": [{\"uri\": \"picture.png\"}], \"buffers\": ["
    "{\"byteLength\": 12, \"uri\": \"a.bin\"}, {\"byteLength\": 12, \"uri\": \"" DATA_URI "\"}, "
    "{\"byteLength\": 12, \"uri\": \"in/b%20c.bin\"}]}";

static void check_files(const ffd_source *source, const char *const *expected, size_t count)
{
    mesh_document *document;
    path_list files = {0};
    assert_int_equal(ffd_source_open(source, 1, &document, NULL), FFD_OK);
    assert_int_equal(ffd_source_files(source, document, &files, NULL), FFD_OK);
    assert_int_equal(files.count, count);
    for (size_t i = 0; i < count; i++)
        assert_string_equal(files.paths[i], expected[i]);
    ffd_paths_free(&files);
    ffd_source_close(&document);
}

static void a_mesh_lists_the_files_it_is_read_from(void **state)
{
    static const unsigned char point[12];
    assert_int_equal(mkdir(in_folder("in"), 0777), 0);
    put("a.bin", point, sizeof point);
    put("in/b c.bin", point, sizeof point);
    put_text("m.gltf", gltf);
    put_text("m.obj", "mtllib m.mtl\nv 0 0 0\n");
    const char *const of_gltf[] = {in_folder("m.gltf"), in_folder("a.bin"), in_folder("in/b c.bin")};
    check_files(&(ffd_source){.path = of_gltf[0]}, of_gltf, 3);
    const char *const of_obj[] = {in_folder("m.obj")};
    check_files(&(ffd_source){.path = of_obj[0]}, of_obj, 1);
    /* In the current folder names stay as short as given. */
    assert_int_equal(chdir(folder), 0);
    static const char *const here[] = {"m.gltf", "a.bin", "in/b c.bin"};
    check_files(&(ffd_source){.path = "m.gltf"}, here, 3);
    (void)state;
}

static void standard_input_lists_no_file(void **state)
{
    put_text("s.obj", "v 0 0 0\n");
    assert_non_null(freopen(in_folder("s.obj"), "r", stdin));
    check_files(&(ffd_source){.path = "-", .format = FFD_FORMAT_OBJ}, NULL, 0);
    check_files(&(ffd_source){.path = "/dev/stdin", .format = FFD_FORMAT_OBJ}, NULL, 0);
    (void)state;
}

static void every_failed_allocation_is_reported(void **state)
{
    mesh_document *document;
    const ffd_source source = {.path = in_folder("m.gltf")};
    assert_int_equal(ffd_source_open(&source, 1, &document, NULL), FFD_OK);
    ffd_status status = FFD_E_MEMORY;
    long n = 0;
    for (; status; n++) {
        path_list files = {0};
        ffd_alloc_fail_after(n);
        status = ffd_source_files(&source, document, &files, NULL);
        ffd_alloc_fail_after(-1);
        assert_true(status == FFD_OK || status == FFD_E_MEMORY);
        ffd_paths_free(&files);
    }
    assert_true(n > 4);
    ffd_source_close(&document);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mesh_lists_the_files_it_is_read_from),
        cmocka_unit_test(standard_input_lists_no_file),
        cmocka_unit_test(every_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
