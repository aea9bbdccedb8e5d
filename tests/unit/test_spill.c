/* test_spill.c - large arrays that move to a file. */
#include "base/file/spill.h"
#include "base/memory/memory.h"
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cmocka.h>

#define STEP (SPILL_FROM / 4 + 12345)

/* Skips the test if the machine has too little space. */
static void need_room(void)
{
    static const char *const folders[] = {"/tmp", "/var/tmp"};
    for (int i = 0; i < 2; i++) {
        struct statvfs info;
        if (statvfs(folders[i], &info) != 0 || info.f_bavail < 8 * SPILL_FROM / info.f_frsize)
            skip();
    }
}

static unsigned char mark_of(size_t step)
{
    return (unsigned char)(17 * step + 1);
}

/* Returns the next free file descriptor. If it is greater than before, a file was left open. */
static int next_descriptor(void)
{
    const int fd = open("/dev/null", O_RDONLY);
    assert_true(fd >= 0);
    close(fd);
    return fd;
}

/* Grows in steps to three times the smallest size of a file. Each step marks its ends. */
static void grow_and_check(bool is_mapped)
{
    spill_array array = {0};
    const size_t steps = 3 * (SPILL_FROM / STEP);
    const int next = next_descriptor();
    for (size_t s = 0; s < steps; s++) {
        assert_true(ffd_spill_grow(&array, (s + 1) * STEP));
        unsigned char *data = array.data;
        data[s * STEP] = data[(s + 1) * STEP - 1] = mark_of(s);
        ffd_spill_release_pages(&array, s * STEP, STEP);
    }
    assert_true(array.size >= steps * STEP);
    assert_true(array.is_mapped == is_mapped);
    for (size_t s = 0; s < steps; s++) {
        const unsigned char *data = array.data;
        assert_int_equal(data[s * STEP], mark_of(s));
        assert_int_equal(data[(s + 1) * STEP - 1], mark_of(s));
    }
    ffd_spill_free(&array);
    assert_null(array.data);
    assert_int_equal(next_descriptor(), next);
}

static void large_arrays_stand_in_a_file(void **state)
{
    (void)state;
    need_room();
    unsetenv("TMPDIR");
    grow_and_check(true);
    setenv("TMPDIR", "/tmp", 1);
    grow_and_check(true);
}

static void without_a_folder_they_stay_in_memory(void **state)
{
    (void)state;
    setenv("TMPDIR", "/nonexistent", 1);
    grow_and_check(false);
    unsetenv("TMPDIR");
}

/* A limit on file sizes simulates a full disk. */
static void a_full_disk_brings_them_back(void **state)
{
    (void)state;
    const struct rlimit limit = {2 * SPILL_FROM, RLIM_INFINITY}, none = {RLIM_INFINITY, RLIM_INFINITY};
    spill_array array = {0};
    need_room();
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    assert_true(ffd_spill_grow(&array, SPILL_FROM));
    assert_true(array.is_mapped);
    memset(array.data, 7, SPILL_FROM);
    assert_true(ffd_spill_grow(&array, SPILL_FROM + SPILL_FROM / 2));
    assert_true(array.is_mapped);
    assert_true(ffd_spill_grow(&array, 3 * SPILL_FROM));
    assert_false(array.is_mapped);
    setrlimit(RLIMIT_FSIZE, &none);
    const unsigned char *data = array.data;
    assert_true(data[0] == 7 && data[SPILL_FROM - 1] == 7);
    ffd_spill_free(&array);
}

static void small_arrays_do_not_need_one(void **state)
{
    (void)state;
    spill_array array = {0};
    assert_true(ffd_spill_grow(&array, 0));
    assert_non_null(array.data);
    assert_true(ffd_spill_grow(&array, 1000));
    *(unsigned char *)array.data = 7;
    ffd_spill_release_pages(&array, 0, 1000);
    assert_true(ffd_spill_grow(&array, 1 << 20));
    assert_int_equal(*(unsigned char *)array.data, 7);
    assert_false(array.is_mapped);
    ffd_spill_free(&array);
}

static void failures_leave_it_as_it_was(void **state)
{
    (void)state;
    spill_array array = {0};
    assert_true(ffd_spill_grow(&array, 100));
    void *data = array.data;
    ffd_alloc_fail_after(0);
    assert_false(ffd_spill_grow(&array, 1000));
    ffd_alloc_fail_after(-1);
    assert_true(array.data == data && array.size == 100);
    ffd_spill_free(&array);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(large_arrays_stand_in_a_file),
        cmocka_unit_test(without_a_folder_they_stay_in_memory),
        cmocka_unit_test(a_full_disk_brings_them_back),
        cmocka_unit_test(small_arrays_do_not_need_one),
        cmocka_unit_test(failures_leave_it_as_it_was),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
