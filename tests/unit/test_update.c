/* test_update.c - files that are updated in place: no other file is opened, waited for or overwritten. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/file_content.h"
#include "../support/test_folder.h"
#include "base/file/update.h"
#include <sys/stat.h>

static void files_are_made_or_opened(void **state)
{
    update_file *file;
    char bytes[4];
    uint64_t size;
    assert_int_equal(ffd_update_open(in_folder("new"), &file, NULL), FFD_OK);
    assert_true(ffd_update_write(file, 0, "some", 4));
    check_content("new", "some"); /* before it is closed */
    ffd_update_close(&file);
    assert_int_equal(symlink("new", in_folder("link")), 0);
    assert_int_equal(ffd_update_open(in_folder("link"), &file, NULL), FFD_OK);
    assert_true(ffd_update_read(file, 1, bytes, 3));
    assert_memory_equal(bytes, "ome", 3);
    assert_true(ffd_update_write(file, 0, "c", 1));
    ffd_update_close(&file);
    check_content("new", "come");
    assert_int_equal(ffd_update_open(in_folder("new"), &file, NULL), FFD_OK);
    assert_true(ffd_update_clear(file));
    assert_true(ffd_update_write(file, 2, "x", 1)); /* beyond the end */
    assert_true(ffd_update_size(file, &size));
    assert_int_equal(size, 3);
    assert_true(ffd_update_read(file, 0, bytes, 3));
    assert_memory_equal(bytes, "\0\0x", 3);
    assert_false(ffd_update_read(file, 1, bytes, 3)); /* the file ends earlier */
    assert_false(ffd_update_read(file, UINT64_MAX - 1, bytes, 3));
    assert_false(ffd_update_write(file, UINT64_MAX - 1, bytes, 3));
    assert_false(ffd_update_write(file, INT64_MAX, bytes, 1));
    ffd_update_close(&file);
    ffd_update_close(&file);
    (void)state;
}

static void what_is_no_file_is_refused_at_once(void **state)
{
    update_file *file;
    ffd_error error;
    assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
    assert_int_equal(symlink("nowhere", in_folder("dangling")), 0);
    const char *const paths[] = {in_folder("pipe"), in_folder("dangling"), folder, "/dev/null",
                                 in_folder("none/new")};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        assert_int_equal(ffd_update_open(paths[i], &file, &error), FFD_E_IO);
        assert_null(file);
        assert_string_equal(error.file, paths[i]);
    }
    assert_false(ffd_file_exists(in_folder("nowhere")));
    (void)state;
}

static void a_successor_takes_the_place_and_the_mode(void **state)
{
    file_successor successor;
    struct stat info;
    update_file *file;
    put_text("old", "old");
    put_text("old.new", "precious");
    put_text("victim", "precious");
    assert_int_equal(chmod(in_folder("old"), 0640), 0);
    assert_int_equal(symlink("victim", in_folder(".old.ffd-tmp")), 0);
    assert_false(ffd_successor_begin(&successor, in_folder("old")));
    assert_int_equal(unlink(in_folder(".old.ffd-tmp")), 0);
    for (int commit = 0; commit < 2; commit++) {
        assert_true(ffd_successor_begin(&successor, in_folder("old")));
        assert_true(ffd_update_write(successor.file, 0, "newer", 5));
        if (commit)
            assert_true(ffd_successor_commit(&successor, &file));
        ffd_successor_end(&successor);
        check_content("old", commit ? "newer" : "old");
        assert_false(ffd_file_exists(in_folder(".old.ffd-tmp")));
    }
    char first;
    assert_true(ffd_update_read(file, 0, &first, 1));
    assert_int_equal(first, 'n');
    ffd_update_close(&file);
    assert_int_equal(stat(in_folder("old"), &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    check_content("old.new", "precious");
    check_content("victim", "precious");
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_made_or_opened),
        cmocka_unit_test(what_is_no_file_is_refused_at_once),
        cmocka_unit_test(a_successor_takes_the_place_and_the_mode),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
