/* test_hash_cache.c - what jobs of a batch reuse of files that earlier jobs have read. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "batch/hash_cache.h"

/* Replaces a file by renaming another one onto it. */
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
    assert_int_equal(ffd_hash_cache_hash(&cache, in_folder("a.obj"), &first, NULL), FFD_OK);
    assert_int_equal(ffd_hash_cache_hash(&cache, in_folder("a.obj"), &again, NULL), FFD_OK);
    assert_true(ffd_hash_equal(&again, &first));
    replace("a.obj", "v 0 0 1\n");
    assert_int_equal(ffd_hash_cache_hash(&cache, in_folder("a.obj"), &again, NULL), FFD_OK);
    assert_true(ffd_hash_equal(&again, &first)); /* within a job a file is what it was */
    ffd_hash_cache_begin_job(&cache);
    assert_int_equal(ffd_hash_cache_hash(&cache, in_folder("a.obj"), &other, NULL), FFD_OK);
    assert_false(ffd_hash_equal(&other, &first));
    ffd_hash_cache_free(&cache);
}

/* A mesh with a buffer file. */
static void put_asset(const char *name, const char *buffer)
{
    char text[300];
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"%s\",\"byteLength\":4}]}", buffer);
    put_text(buffer, "data");
    replace(name, text);
}

static void check_files(hash_cache *cache, const char *name, const char *buffer)
{
    path_list files = {0};
    const ffd_source source = {.path = in_folder(name)};
    assert_int_equal(ffd_hash_cache_list(cache, &source, &files, NULL), FFD_OK);
    assert_int_equal(files.count, 2);
    assert_string_equal(files.paths[0], in_folder(name));
    assert_string_equal(files.paths[1], in_folder(buffer));
    ffd_paths_free(&files);
}

static void the_files_of_a_mesh_are_those_of_now(void **state)
{
    (void)state;
    hash_cache cache = {0};
    put_asset("a.gltf", "one.bin");
    check_files(&cache, "a.gltf", "one.bin");
    check_files(&cache, "a.gltf", "one.bin");
    put_asset("a.gltf", "two.bin");
    ffd_hash_cache_begin_job(&cache);
    check_files(&cache, "a.gltf", "two.bin");
    ffd_hash_cache_free(&cache);
}

/* Alternating, like the jobs' meshes and those of a lattice's box. */
static void meshes_by_turns_are_read_once(void **state)
{
    (void)state;
    hash_cache cache = {0};
    put_asset("a.gltf", "a.bin");
    put_asset("b.gltf", "b.bin");
    for (int turn = 0; turn < 3; turn++) {
        check_files(&cache, "a.gltf", "a.bin");
        check_files(&cache, "b.gltf", "b.bin");
    }
    assert_int_equal(cache.next_mesh, 2);
    ffd_hash_cache_free(&cache);
}

static bool take(hash_cache *cache, const char *name, file_input *input)
{
    file_stamp stamp;
    assert_true(ffd_file_stamp(in_folder(name), &stamp));
    return ffd_kept_take(&cache->kept, in_folder(name), &stamp, input);
}

/* A worker hands the bytes to the job, which need not read the file again. */
static void the_bytes_of_a_mesh_are_kept_while_it_stays(void **state)
{
    (void)state;
    hash128 hash;
    file_input input;
    const char *const text = "v 0 0 0\n";
    replace("k.obj", text);
    put_text("l.json", "{}");
    put_text("same.obj", text);
    for (int change = 0; change < 2; change++) {
        hash_cache cache = {0};
        path_list images = {0};
        const ffd_source source = {.path = in_folder("k.obj")};
        assert_int_equal(ffd_hash_cache_images(&cache, &source, &images, NULL), FFD_OK);
        assert_int_equal(ffd_hash_cache_hash(&cache, in_folder("l.json"), &hash, NULL), FFD_OK);
        assert_non_null(cache.kept.path);
        assert_false(take(&cache, "l.json", &input)); /* a job's first file is its mesh */
        assert_false(take(&cache, "same.obj", &input));
        if (change)
            replace("k.obj", "v 0 0 1 1\n");
        assert_int_equal(take(&cache, "k.obj", &input), !change);
        if (!change) {
            assert_int_equal(input.size, strlen(text));
            assert_memory_equal(input.data, text, input.size);
            ffd_file_unload(&input);
            assert_false(take(&cache, "k.obj", &input));
        }
        ffd_paths_free(&images);
        ffd_hash_cache_free(&cache);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_is_read_again_when_it_is_another),
        cmocka_unit_test(the_files_of_a_mesh_are_those_of_now),
        cmocka_unit_test(meshes_by_turns_are_read_once),
        cmocka_unit_test(the_bytes_of_a_mesh_are_kept_while_it_stays),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
