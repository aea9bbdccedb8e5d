/* test_file_set.c - files that are replaced together: whichever call fails, or is the last one before the
   program is killed, either the old files or the new ones are complete. */
#define _GNU_SOURCE /* renameat2 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include <errno.h>
#include <fcntl.h>
#include <ffd/job.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>

/* Replace the C library's functions that rename and remove files. */
enum { NEVER = -1 };
static long calls_left = NEVER; /* calls before the one that fails or ends the program */
static bool fails_on, ends, has_no_flags;
enum { KILLED = 77 };

static bool fault_is_due(void)
{
    if (calls_left < 0 || calls_left-- > 0)
        return false;
    if (ends)
        _exit(KILLED);
    calls_left = fails_on ? 0 : NEVER;
    errno = EIO;
    return true;
}

int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags)
{
    if (has_no_flags) {
        errno = EINVAL;
        return -1;
    }
    return fault_is_due() ? -1 : (int)syscall(SYS_renameat2, from_folder, from, to_folder, to, flags);
}

int rename(const char *from, const char *to)
{
    return fault_is_due() ? -1 : (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}

int link(const char *from, const char *to)
{
    return fault_is_due() ? -1 : (int)syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0);
}

int unlink(const char *path)
{
    return fault_is_due() ? -1 : (int)syscall(SYS_unlinkat, AT_FDCWD, path, 0);
}

/* What another run does to a record between this run's making and locking it. */
static enum { LEAVES, LOCKS, REMOVES } other_run;

int flock(int fd, int operation)
{
    char path[64], name[512];
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    const ssize_t length = readlink(path, name, sizeof name - 1);
    name[length < 0 ? 0 : length] = 0;
    if (other_run == LEAVES || !strstr(name, ".ffd-set"))
        return (int)syscall(SYS_flock, fd, operation);
    const bool locks = other_run == LOCKS;
    other_run = LEAVES;
    assert_int_equal(syscall(SYS_unlinkat, AT_FDCWD, name, 0), 0);
    errno = EWOULDBLOCK;
    return locks ? -1 : (int)syscall(SYS_flock, fd, operation);
}

/* Three files: the first is new, the others replace old ones; the last one is the main file. */
static const char *const names[] = {"s-1.bin", "s.bin", "s.gltf"};
enum { FILES = 3, FIRST_OLD = 1 };

static bool holds(const char *name, const char *text)
{
    file_input input;
    if (ffd_file_load(in_folder(name), &input, NULL))
        return false;
    const bool same = input.size == strlen(text) && memcmp(input.data, text, input.size) == 0;
    ffd_file_unload(&input);
    return same;
}

/* Whether a file with this text exists, under its name or set aside. */
static bool stands(const char *name, const char *text)
{
    char aside[64];
    snprintf(aside, sizeof aside, ".%s.ffd-old", name);
    return holds(name, text) || holds(aside, text);
}

static bool old_is_whole(void)
{
    bool whole = true;
    for (int i = FIRST_OLD; i < FILES; i++)
        whole = whole && stands(names[i], "old");
    return whole;
}

static bool new_is_whole(void)
{
    bool whole = true;
    for (int i = 0; i < FILES; i++)
        whole = whole && holds(names[i], "newer");
    return whole;
}

/* Whether the old files are in place, and there is nothing else. */
static bool is_as_before(void)
{
    bool same = !ffd_file_exists(in_folder(names[0]));
    for (int i = FIRST_OLD; i < FILES; i++)
        same = same && holds(names[i], "old");
    return same;
}

static bool has_leftovers(void)
{
    static const char *const endings[] = {"tmp", "old", "set"};
    for (int i = 0; i < FILES; i++)
        for (int k = 0; k < 3; k++) {
            char name[64];
            struct stat info;
            snprintf(name, sizeof name, ".%s.ffd-%s", names[i], endings[k]);
            if (lstat(in_folder(name), &info) == 0)
                return true;
        }
    return false;
}

static void lay_out(void)
{
    char command[160];
    snprintf(command, sizeof command, "rm -rf '%s'/s* '%s'/.s*", folder, folder);
    assert_int_equal(system(command), 0);
    for (int i = FIRST_OLD; i < FILES; i++)
        put_text(names[i], "old");
}

static ffd_status write_set(ffd_error *error)
{
    file_output *output;
    ffd_status status = ffd_output_create(&output, error);
    if (!status)
        status = ffd_restore_output(in_folder(names[FILES - 1]), error);
    for (int i = 0; i < FILES && !status; i++) {
        status = ffd_output_begin(output, in_folder(names[i]), true, error);
        if (!status)
            status = ffd_output_write(output, "newer", 5, error);
    }
    if (!status)
        status = ffd_output_commit(output, error);
    ffd_output_destroy(&output);
    return status;
}

/* Checks that the next run restores order. */
static void check_next_run(void)
{
    ffd_error error;
    calls_left = NEVER;
    if (write_set(&error))
        fail_msg("%s: %s", error.file, error.message);
    assert_true(new_is_whole());
    assert_false(has_leftovers());
}

/* Runs with call `number` being the last. Returns whether the run got that far. */
static bool killed_at(long number)
{
    int status;
    lay_out();
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        ends = true;
        calls_left = number;
        _exit(write_set(NULL) ? 1 : 0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    if (WEXITSTATUS(status) == 0)
        return false;
    assert_int_equal(WEXITSTATUS(status), KILLED);
    assert_true(old_is_whole() || new_is_whole());
    check_next_run();
    return true;
}

static void killed_at_any_call(void **state)
{
    for (int flags = 0; flags < 2; flags++) {
        long number = 0;
        has_no_flags = flags == 1;
        while (killed_at(number))
            number++;
        assert_true(number >= 8);
    }
    has_no_flags = false;
    (void)state;
}

static void a_run_that_comes_between_is_in_no_way(void **state)
{
    ffd_error error;
    for (int does = LOCKS; does <= REMOVES; does++) {
        lay_out();
        other_run = does == LOCKS ? LOCKS : REMOVES;
        if (write_set(&error))
            fail_msg("%s: %s", error.file, error.message);
        assert_int_equal(other_run, LEAVES);
        assert_true(new_is_whole());
        assert_false(has_leftovers());
    }
    (void)state;
}

static bool failed_at(long number)
{
    ffd_error error = {0};
    lay_out();
    calls_left = number;
    const ffd_status status = write_set(&error);
    const bool came_so_far = calls_left < 0 || fails_on;
    calls_left = NEVER;
    if (status &&
        !fails_on) { /* after a single failed call all is as before, or only what was replaced is left over */
        assert_int_equal(status, FFD_E_IO);
        assert_true(is_as_before() ? !has_leftovers() : new_is_whole());
    }
    assert_true(old_is_whole() || new_is_whole());
    assert_true(status || new_is_whole());
    check_next_run();
    return came_so_far && status;
}

static void failed_at_any_call(void **state)
{
    for (int flags = 0; flags < 4; flags++) {
        has_no_flags = flags & 1;
        fails_on = flags & 2;
        long number = 0;
        while (failed_at(number))
            number++;
        assert_true(number >= 8);
    }
    has_no_flags = fails_on = false;
    (void)state;
}

/* A file that could not be restored is named. */
static void a_failure_says_where_the_old_file_is(void **state)
{
    ffd_error error;
    lay_out();
    fails_on = true;
    calls_left = 3; /* the old files are set aside, and one new file is in place */
    assert_int_equal(write_set(&error), FFD_E_IO);
    calls_left = NEVER;
    fails_on = false;
    assert_non_null(strstr(error.message, "stands beside it as .s.gltf.ffd-old"));
    assert_true(old_is_whole());
    check_next_run();
    (void)state;
}

static void a_target_that_must_not_be_replaced_undoes_all(void **state)
{
    file_output *output;
    ffd_error error;
    lay_out();
    assert_int_equal(ffd_output_create(&output, &error), FFD_OK);
    for (int i = 0; i < FILES; i++)
        assert_int_equal(ffd_output_begin(output, in_folder(names[i]), i > 0, &error), FFD_OK);
    put_text(names[0], "somebody's");
    assert_int_equal(ffd_output_commit(output, &error), FFD_E_EXISTS);
    ffd_output_destroy(&output);
    assert_true(holds(names[0], "somebody's"));
    assert_true(old_is_whole());
    assert_false(has_leftovers());
    (void)state;
}

/* A copy of the folder, elsewhere, can be restored too. */
static void a_copied_folder_is_mended(void **state)
{
    char command[200], head[200];
    lay_out();
    const pid_t child = fork();
    if (child == 0) {
        ends = true;
        calls_left = 4;
        _exit(write_set(NULL) ? 1 : 0);
    }
    assert_int_equal(waitpid(child, NULL, 0), child);
    assert_true(has_leftovers());
    snprintf(command, sizeof command, "mkdir '%s'/copy && cp -p '%s'/s* '%s'/.s* '%s'/copy", folder, folder,
             folder, folder);
    assert_int_equal(system(command), 0);
    snprintf(head, sizeof head, "%s", in_folder("copy/s.gltf"));
    assert_int_equal(ffd_restore_output(head, NULL), FFD_OK);
    assert_true(holds("copy/s.gltf", "old"));
    assert_true(holds("copy/s.bin", "old"));
    assert_false(ffd_file_exists(in_folder("copy/s-1.bin")));
    assert_false(ffd_file_exists(in_folder("copy/.s.gltf.ffd-set")));
    assert_false(ffd_file_exists(in_folder("copy/.s.bin.ffd-tmp")));
    check_next_run();
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(killed_at_any_call),
        cmocka_unit_test(failed_at_any_call),
        cmocka_unit_test(a_run_that_comes_between_is_in_no_way),
        cmocka_unit_test(a_failure_says_where_the_old_file_is),
        cmocka_unit_test(a_target_that_must_not_be_replaced_undoes_all),
        cmocka_unit_test(a_copied_folder_is_mended),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
