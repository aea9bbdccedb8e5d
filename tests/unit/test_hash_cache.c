/* test_hash_cache.c - what jobs of a batch know of files that jobs before them have looked at. */
#define _XOPEN_SOURCE 700 /* mkdtemp */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "batch/hash_cache.h"

/* Puts another file in the place of one, as programs do. */
static void replace(const char *name, const char *text)
{
    put_text("new", text);
    assert_int_equal(rename(in_folder("new"), in_folder(name)), 0);
}

static void a_file_is_read_again_when_it_is_another(void **state)
{
    (void)state;
    hash_cache cache = {0};
    hash128 first, again, other;
    replace("a.obj", "v 0 0 0\n");
    assert_int_equal(ffd_cache_hash(&cache, in_folder("a.obj"), &first, NULL), FFD_OK);
    assert_int_equal(ffd_cache_hash(&cache, in_folder("a.obj"), &again, NULL), FFD_OK);
    assert_true(ffd_hash_equal(&again, &first));
    replace("a.obj", "v 0 0 1\n");
    assert_int_equal(ffd_cache_hash(&cache, in_folder("a.obj"), &other, NULL), FFD_OK);
    assert_false(ffd_hash_equal(&other, &first));
    ffd_cache_free(&cache);
}

static void put_asset(const char *buffer)
{
    char text[300];
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"%s\",\"byteLength\":4}]}", buffer);
    put_text(buffer, "data");
    replace("a.gltf", text);
}

static void check_files(hash_cache *cache, const char *buffer)
{
    path_list files = {0};
    const ffd_source source = {.path = in_folder("a.gltf")};
    assert_int_equal(ffd_cache_list(cache, &source, &files, NULL), FFD_OK);
    assert_int_equal(files.count, 2);
    assert_string_equal(files.paths[0], in_folder("a.gltf"));
    assert_string_equal(files.paths[1], in_folder(buffer));
    ffd_paths_free(&files);
}

static void the_files_of_a_mesh_are_those_of_now(void **state)
{
    (void)state;
    hash_cache cache = {0};
    put_asset("one.bin");
    check_files(&cache, "one.bin");
    check_files(&cache, "one.bin");
    put_asset("two.bin");
    check_files(&cache, "two.bin");
    ffd_cache_free(&cache);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_is_read_again_when_it_is_another),
        cmocka_unit_test(the_files_of_a_mesh_are_those_of_now),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
