/* test_cleanup.c - a signal that ends a program while it writes leaves no temporary file. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/repetitions.h"
#include "../support/test_folder.h"
#include "base/file/cleanup.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include <dirent.h>
#include <ffd/program.h>
#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>

static const int signals[] = {SIGHUP, SIGINT, SIGPIPE, SIGQUIT, SIGTERM};
enum { SIGNALS = sizeof signals / sizeof *signals };

/* Returns the number of names in the folder other than those of complete files. */
static int leftovers(void)
{
    int count = 0;
    DIR *list = opendir(folder);
    assert_non_null(list);
    for (const struct dirent *entry; (entry = readdir(list));)
        count += entry->d_name[0] == '.' && entry->d_name[1] != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(list);
    return count;
}

static void write_file(const char *path, bool commit)
{
    file_output *output;
    if (ffd_output_create(&output, NULL) || ffd_output_begin(output, path, true, NULL) ||
        ffd_output_write(output, "whole", 5, NULL) || (commit && ffd_output_commit(output, NULL)))
        _exit(9);
    if (commit)
        ffd_output_destroy(&output);
}

/* Runs work in a child that then sends itself a signal. Returns the signal that ended it, or 100 plus its
   exit code. */
static int end_of(void (*work)(void), int number)
{
    const pid_t child = fork();
    int status;
    assert_true(child >= 0);
    if (child == 0) {
        signal(number, SIG_DFL);
        work();
        raise(number);
        _exit(8);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 100 + WEXITSTATUS(status);
}

static file_output *unfinished; /* of a child that is killed */

static void begin_two_files(void)
{
    if (ffd_output_create(&unfinished, NULL) || ffd_output_folder(unfinished, in_folder("new/deep"), NULL) ||
        ffd_output_begin(unfinished, in_folder("new/deep/a"), false, NULL) ||
        ffd_output_begin(unfinished, in_folder("old"), true, NULL) ||
        ffd_output_write(unfinished, "new", 3, NULL))
        _exit(9);
}

static void begin_two_files_in_a_folder(void)
{
    ffd_cleanup_on_signals();
    begin_two_files();
}

static void begin_two_files_as_a_worker(void)
{
    ffd_cleanup_on_crashes();
    begin_two_files();
}

static void a_signal_leaves_no_temporary_file(void **state)
{
    put_text("old", "old");
    for (int i = 0; i < SIGNALS; i++) {
        assert_int_equal(end_of(begin_two_files_in_a_folder, signals[i]), signals[i]);
        assert_int_equal(leftovers(), 0);
        assert_false(ffd_file_exists(in_folder("new")));
    }
    file_input input;
    assert_int_equal(ffd_file_load(in_folder("old"), &input, NULL), FFD_OK);
    assert_memory_equal(input.data, "old", 3);
    ffd_file_unload(&input);
    (void)state;
}

/* A worker of a batch, which may crash or be stopped by its batch. */
static void a_crashed_worker_leaves_no_temporary_file(void **state)
{
    static const int crashes[] = {SIGABRT, SIGALRM, SIGBUS, SIGFPE, SIGILL, SIGSEGV};
    for (size_t i = 0; i < sizeof crashes / sizeof *crashes; i++) {
        assert_int_equal(end_of(begin_two_files_as_a_worker, crashes[i]), crashes[i]);
        assert_int_equal(leftovers(), 0);
        assert_false(ffd_file_exists(in_folder("new")));
    }
    (void)state;
}

static void ignore_hangup(void)
{
    signal(SIGHUP, SIG_IGN);
    ffd_cleanup_on_signals();
}

static void do_nothing(void) {}

/* A signal that was ignored stays ignored, and without a call nothing is changed. */
static void ignored_signals_stay_ignored(void **state)
{
    assert_int_equal(end_of(ignore_hangup, SIGHUP), 108);
    assert_int_equal(end_of(do_nothing, SIGTERM), SIGTERM);
    (void)state;
}

/* A forked child does not remove its parent's files. */
static void a_child_leaves_the_files_of_its_parent(void **state)
{
    file_output *output;
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    assert_int_equal(ffd_output_begin(output, in_folder("mine"), false, NULL), FFD_OK);
    assert_int_equal(end_of(begin_two_files_in_a_folder, SIGTERM), SIGTERM);
    assert_int_equal(leftovers(), 1);
    assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
    ffd_output_destroy(&output);
    assert_true(ffd_file_exists(in_folder("mine")));
    (void)state;
}

static void *write_on_and_on(void *name)
{
    for (;;)
        write_file(name, true);
    return NULL;
}

static void run_writers(void)
{
    static char names[3][200];
    pthread_t thread;
    for (int i = 0; i < 3; i++) {
        snprintf(names[i], sizeof names[i], "%s/busy-%d", folder, i);
        if (pthread_create(&thread, NULL, write_on_and_on, names[i]) != 0)
            _exit(9);
    }
}

/* Whatever its threads are doing: every name in the folder is that of a complete file. */
static void threads_at_work_leave_only_complete_files(void **state)
{
    for (int n = 0; n < 60; n += stride(10)) {
        int ready[2], status;
        assert_int_equal(pipe(ready), 0);
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            signal(signals[n % SIGNALS], SIG_DFL);
            ffd_cleanup_on_signals();
            write_file(in_folder("busy-0"), true);
            run_writers();
            if (write(ready[1], "r", 1) == 1)
                pause();
            _exit(8);
        }
        close(ready[1]);
        char letter;
        assert_int_equal(read(ready[0], &letter, 1), 1);
        close(ready[0]);
        nanosleep(&(struct timespec){.tv_nsec = n * 50000}, NULL);
        kill(child, signals[n % SIGNALS]);
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFSIGNALED(status));
        assert_int_equal(leftovers(), 0);
        for (int i = 0; i < 3; i++) {
            char name[16];
            file_input input;
            snprintf(name, sizeof name, "busy-%d", i);
            if (ffd_file_load(in_folder(name), &input, NULL))
                continue;
            assert_int_equal(input.size, 5);
            ffd_file_unload(&input);
        }
    }
    assert_true(ffd_file_exists(in_folder("busy-0")));
    (void)state;
}

static void write_a_set(int count)
{
    file_output *output;
    char name[32];
    if (ffd_output_create(&output, NULL))
        _exit(9);
    for (int i = 0; i < count; i++) {
        snprintf(name, sizeof name, "set-%d", i);
        if (ffd_output_begin(output, in_folder(name), false, NULL))
            _exit(9);
    }
    if (ffd_output_commit(output, NULL))
        _exit(9);
}

static void wait_for(const char *name)
{
    for (int i = 0; i < 100000 && !ffd_file_exists(in_folder(name)); i++)
        nanosleep(&(struct timespec){.tv_nsec = 20000}, NULL);
}

/* A signal during the renames of a set is deferred until all its files are in place. */
static void a_signal_never_tears_a_set(void **state)
{
    enum { FILES = 500 };
    int status;
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        signal(SIGTERM, SIG_DFL);
        ffd_cleanup_on_signals();
        write_a_set(FILES);
        pause();
        _exit(8);
    }
    wait_for("set-0");
    kill(child, SIGTERM);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status));
    assert_int_equal(leftovers(), 0);
    for (int i = 0; i < FILES; i++) {
        char name[32];
        snprintf(name, sizeof name, "set-%d", i);
        assert_true(ffd_file_exists(in_folder(name)));
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_signal_leaves_no_temporary_file),
        cmocka_unit_test(a_crashed_worker_leaves_no_temporary_file),
        cmocka_unit_test(ignored_signals_stay_ignored),
        cmocka_unit_test(a_child_leaves_the_files_of_its_parent),
        cmocka_unit_test(threads_at_work_leave_only_complete_files),
        cmocka_unit_test(a_signal_never_tears_a_set),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
