/* test_obj_resources.c - libraries named in an OBJ, maps named in a library, and copying them with failing
   memory. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/repetitions.h"
#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "io/obj/resource/mtl_file.h"
#include "io/obj/resource/obj_libraries.h"
#include "io/obj/resource/obj_resources.h"
#include <sys/stat.h>

/* Checks names joined by '|'. */
static void check_names(const intern_table *names, const char *expected)
{
    char text[400] = "";
    for (uint32_t i = 0; i < names->count; i++) {
        strcat(text, i ? "|" : "");
        strcat(text, ffd_intern_key(names, i));
    }
    assert_string_equal(text, expected);
}

static void statements_that_name_libraries(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"mtllib a.mtl", "a.mtl"},
        {"v 0 0 0\r\n \t mtllib\ta.mtl \t\r\nmtllib b.mtl\rmtllib c.mtl", "a.mtl|b.mtl|c.mtl"},
        {"\xef\xbb\xbfmtllib a.mtl\n", "a.mtl"},
        {"mtllib a.mtl b.mtl  c d.MTL e", "a.mtl|b.mtl|c d.MTL|e"},
        {"mtllib a.mtl\\\nb.mtl \\\r\n c.mat\nd.mtl", "a.mtl|b.mtl|c.mat"},
        {"#mtllib a.mtl\nxmtllib b.mtl\ng mtllib c.mtl\nmtllibs d.mtl\nMTLLIB e.mtl\nmtllib\nmtllib ", ""},
        {"g a\\\nmtllib b.mtl\n", ""},
        {"# a\\\nmtllib b.mtl\n", "b.mtl"},
        {"mtllib a.mtl\nmtllib a.mtl\n", "a.mtl"},
        {"mmtllib\nmmtllib a.mtl\nmtllib b.mtl", "b.mtl"},
        {"mtllib a.mtl\n\x1a\n", "a.mtl"},
        {"", ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const file_input input = {.data = (const unsigned char *)cases[i][0], .size = strlen(cases[i][0])};
        intern_table names = {0};
        assert_int_equal(ffd_obj_list_libraries(&input, &(file_folder){.file = "m.obj"}, &names, NULL),
                         FFD_OK);
        check_names(&names, cases[i][1]);
        ffd_intern_free(&names);
    }
}

/* A file larger than the window of the search, with statements across window borders. */
static void statements_anywhere_in_a_large_file(void **state)
{
    (void)state;
    const size_t piece = (size_t)1 << 21, size = 2 * piece + 100;
    char *const text = ffd_alloc(size, 1);
    for (size_t shift = 0; shift < 24; shift += (size_t)stride(5)) {
        const file_input input = {.data = (const unsigned char *)text, .size = size};
        intern_table names = {0};
        memset(text, 'm', size);
        memcpy(text + piece - shift, "\nmtllib a.mtl\n", 14);
        memcpy(text + 2 * piece - shift, "\nmtllib b.mtl\n", 14);
        assert_int_equal(ffd_obj_list_libraries(&input, &(file_folder){.file = "m.obj"}, &names, NULL),
                         FFD_OK);
        check_names(&names, "a.mtl|b.mtl");
        ffd_intern_free(&names);
    }
    ffd_free(text);
}

static void maps_of_a_library(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"newmtl a\nmap_Kd a.png", "a.png"},
        {"map_Kd a b.png\t\r\nMAP_KS\tc.png\rbump d.png\ndisp e.png\ndecal f.png\nrefl g.png\nnorm h.png",
         "a b.png|c.png|d.png|e.png|f.png|g.png|h.png"},
        {"map_Kd -s 1 1 1 -o 0 0 0 a b.png", "a b.png"},
        {"map_Kd -s 1 a.png\nmap_Kd -o 1 2 b.png\nmap_Kd -t 1 2 3 4 c.png\nmap_Kd -o d.png",
         "a.png|b.png|4 c.png|d.png"},
        {"bump -bm 1 x.png\nrefl -type cube_top y.png\nmap_d -mm 0 1 -clamp on -imfchan m -texres 8 z.png",
         "x.png|y.png|z.png"},
        {"map_Kd -blendu off -blendv on -boost 2 -cc on -colorspace sRGB a.png", "a.png"},
        {"map_Kd -unknown a.png", "-unknown a.png"},
        {"map_aat on\nmap_\nmap_Kd\nmap_Kd -s 1 1 1\nbump -bm\n#map_Kd a.png\nKd map_Kd a.png\nbumps b.png",
         ""},
        {"map_Kd #1.png\nmap_Kd #1.png", "#1.png"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        intern_table names = {0};
        assert_int_equal(
            ffd_mtl_list_maps((const unsigned char *)cases[i][0], strlen(cases[i][0]), "m.mtl", &names, NULL),
            FFD_OK);
        check_names(&names, cases[i][1]);
        ffd_intern_free(&names);
    }
}

static bool is_library(const char *bytes, size_t size)
{
    return ffd_mtl_has_content((const unsigned char *)bytes, size);
}

static void what_a_library_is(void **state)
{
    (void)state;
    static const char *const libraries[] = {"newmtl a", "# a\n\n\tnewmtl b\nanything", "",
                                            "# only a comment\n", "\xef\xbb\xbfNewMtl a"};
    static const char *const others[] = {"-----BEGIN KEY-----\nnewmtl a", "Kd 1 0 0\nnewmtl a", "newmtls a",
                                         "[section]", "v 0 0 0"};
    for (size_t i = 0; i < sizeof libraries / sizeof *libraries; i++)
        assert_true(is_library(libraries[i], strlen(libraries[i])));
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        assert_false(is_library(others[i], strlen(others[i])));
    assert_false(is_library("newmtl a\n\0", 10));
    assert_true(ffd_mtl_has_name("a/b.MTL") && ffd_mtl_has_name("x.mat"));
    assert_false(ffd_mtl_has_name(".mtl") || ffd_mtl_has_name("id_rsa") || ffd_mtl_has_name("a.mtl/b"));
}

static const char mesh[] = "mtllib m.mtl none.mtl\nv 0 0 0\n";

/* Copies the resources of the mesh, and commits them with the output. */
static ffd_status bring(void)
{
    const file_input input = {.data = (const unsigned char *)mesh, .size = sizeof mesh - 1};
    path_list copied = {0};
    const mesh_save_options options = {
        .path = in_folder("out/m.obj"), .input = in_folder("m.obj"), .copied = &copied};
    file_output *output = NULL;
    ffd_error error = {0};
    ffd_status status = ffd_output_create(&output, &error);
    if (!status)
        status = ffd_obj_bring_resources(&input, &(file_folder){.file = options.input}, true, &options,
                                         output, NULL, &error);
    if (!status)
        status = ffd_output_begin(output, options.path, false, &error);
    if (!status)
        status = ffd_output_commit(output, &error);
    assert_true(status != FFD_OK || copied.count == 2);
    ffd_output_destroy(&output);
    ffd_paths_free(&copied);
    return status;
}

static void memory_may_run_out_anywhere(void **state)
{
    (void)state;
    assert_int_equal(mkdir(in_folder("out"), 0777), 0);
    put_text("m.obj", mesh);
    put_text("m.mtl", "newmtl a\nmap_Kd sub\\t.png\n");
    assert_int_equal(mkdir(in_folder("sub"), 0777), 0);
    put("sub/t.png", "\x89PNG\r\n\x1a\n", 8);
    ffd_status status = FFD_E_MEMORY;
    for (long successes = 0; status != FFD_OK; successes++) {
        assert_int_equal(access(in_folder("out/m.mtl"), F_OK), -1);
        assert_int_equal(access(in_folder("out/sub"), F_OK), -1);
        ffd_alloc_fail_after(successes);
        status = bring();
        ffd_alloc_fail_after(-1);
        assert_true(status == FFD_OK || status == FFD_E_MEMORY);
    }
    assert_int_equal(access(in_folder("out/m.mtl"), F_OK), 0);
    assert_int_equal(access(in_folder("out/sub/t.png"), F_OK), 0);
    path_list files = {0};
    file_input bytes;
    assert_int_equal(ffd_file_load(in_folder("m.obj"), &bytes, NULL), FFD_OK);
    assert_int_equal(ffd_obj_find_named(in_folder("m.obj"), &bytes, &(mesh_named){.copies = &files}, NULL),
                     FFD_OK);
    ffd_file_unload(&bytes);
    assert_int_equal(files.count, 3);
    assert_string_equal(files.paths[0], in_folder("m.mtl"));
    assert_string_equal(files.paths[1], in_folder("none.mtl"));
    assert_string_equal(files.paths[2], in_folder("sub/t.png"));
    ffd_paths_free(&files);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statements_that_name_libraries),
        cmocka_unit_test(statements_anywhere_in_a_large_file),
        cmocka_unit_test(maps_of_a_library),
        cmocka_unit_test(what_a_library_is),
        cmocka_unit_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
