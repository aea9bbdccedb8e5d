/* test_file_table.c - numbers for many files. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/memory/file_table.h"
#include "base/memory/memory.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_found),
        cmocka_unit_test(a_lack_of_memory_loses_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
