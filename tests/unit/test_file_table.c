/* test_file_table.c - numbers for many files, and the identity of the file at a path. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "batch/manifest/file_table.h"
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

static hash128 file_of(uint64_t number)
{
    return ffd_hash(&number, sizeof number);
}

/* Many merges, and some numbers are changed. */
static void numbers_are_found(void **state)
{
    const uint64_t count = 100000;
    file_table table = {0};
    uint64_t number;
    hash128 file = file_of(0);
    assert_false(ffd_files_find(&table, &file, &number));
    for (uint64_t i = 0; i < count; i++) {
        file = file_of(i);
        assert_false(ffd_files_find(&table, &file, &number));
        assert_int_equal(ffd_files_put(&table, &file, i * 1000003 % ((UINT64_C(1) << 40) - 1), NULL), FFD_OK);
        if (i % 7)
            continue;
        file = file_of(i / 2);
        assert_int_equal(ffd_files_put(&table, &file, i / 2, NULL), FFD_OK);
    }
    for (uint64_t i = 0; i < count; i++) {
        file = file_of(i);
        assert_true(ffd_files_find(&table, &file, &number));
        const bool is_changed = 2 * i % 7 == 0 || (2 * i + 1) % 7 == 0;
        if (!is_changed || 2 * i >= count)
            assert_int_equal(number, i * 1000003 % ((UINT64_C(1) << 40) - 1));
        else
            assert_int_equal(number, i);
    }
    assert_int_equal(table.count + table.used, count);
    /* 16 bytes each, plus a sixteenth, plus a constant. */
    assert_true((table.count + table.slots) * sizeof(file_entry) <= count * 17 + 2048 * sizeof(file_entry));
    ffd_files_free(&table);
    (void)state;
}

static void a_lack_of_memory_loses_nothing(void **state)
{
    file_table table = {0};
    uint64_t number, put = 0;
    for (uint64_t i = 0; i < 3000; i++) {
        const hash128 file = file_of(i);
        ffd_alloc_fail_after(i % 3 ? (long)(i % 2) : -1);
        const ffd_status status = ffd_files_put(&table, &file, i, NULL);
        ffd_alloc_fail_after(-1);
        assert_int_equal(ffd_files_find(&table, &file, &number), status == FFD_OK);
        put += status == FFD_OK;
    }
    assert_int_equal(table.count + table.used, put);
    assert_true(put > 1000);
    ffd_files_free(&table);
    (void)state;
}

static bool same(const char *a, const char *b)
{
    char first[PATH_MAX];
    snprintf(first, sizeof first, "%s", in_folder(a));
    const hash128 x = ffd_file_identity(first), y = ffd_file_identity(in_folder(b));
    return ffd_hash_equal(&x, &y);
}

static void names_of_one_file(void **state)
{
    char target[PATH_MAX];
    assert_int_equal(mkdir(in_folder("sub"), 0777), 0);
    snprintf(target, sizeof target, "%s", in_folder("sub"));
    assert_int_equal(symlink(target, in_folder("link")), 0);
    for (int there = 0; there < 2; there++) {
        assert_true(same("o", "./o") && same("o", "sub/../o") && same("sub/o", "link/o"));
        assert_false(same("o", "sub/o") || same("o", "p") || same("o", "O"));
        put_text("o", "x");
        put_text("sub/o", "y");
    }
    snprintf(target, sizeof target, "%s", in_folder("o"));
    assert_int_equal(symlink(target, in_folder("other")), 0);
    assert_true(same("other", "o"));
    assert_false(same("none/o", "o"));
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_found),
        cmocka_unit_test(a_lack_of_memory_loses_nothing),
        cmocka_unit_test(names_of_one_file),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
