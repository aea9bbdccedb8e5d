/* test_mapping.c - input files that are truncated while they are read, and unrelated signals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/file/input.h"
#include <fcntl.h>
#include <ffd/program.h>
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>

enum { LARGE = 1 << 20, CUT = 1000, THREADS = 4 };

static void put_large(const char *name)
{
    char *const bytes = malloc(LARGE);
    assert_non_null(bytes);
    memset(bytes, 'x', LARGE);
    put(name, bytes, LARGE);
    free(bytes);
}

static void *read_all(void *argument)
{
    const file_input *const input = argument;
    size_t zeros = 0;
    for (size_t i = 0; i < input->size; i++)
        zeros += input->data[i] == 0;
    return zeros == LARGE - CUT ? argument : NULL;
}

/* Runs work in a child. Returns its exit code; 100 and more: the signal that ended it. */
static int end_of(int (*work)(void))
{
    int status;
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        signal(SIGBUS, SIG_DFL); /* a sanitizer installs its own */
        _exit(work());
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFSIGNALED(status) ? 100 + WTERMSIG(status) : WEXITSTATUS(status);
}

static bool is_removed; /* then the size cannot tell */

static int read_a_cut_file(void)
{
    file_input input;
    ffd_error error;
    pthread_t threads[THREADS];
    bool fine = true;
    ffd_guard_inputs();
    const unsigned before = ffd_mapping_losses();
    if (ffd_file_load(in_folder("cut"), &input, NULL) || truncate(in_folder("cut"), CUT) != 0)
        return 1;
    if (is_removed)
        unlink(in_folder("cut"));
    for (int i = 0; i < THREADS; i++)
        fine = pthread_create(&threads[i], NULL, read_all, &input) == 0 && fine;
    for (int i = 0; i < THREADS; i++) {
        void *result = NULL;
        fine = pthread_join(threads[i], &result) == 0 && result && fine;
    }
    if (!fine)
        return 2;
    ffd_file_unload(&input);
    if (ffd_mapping_judge(before, FFD_E_INVALID, &error) != FFD_E_IO ||
        strcmp(error.file, in_folder("cut")) != 0 ||
        strcmp(error.message, "became shorter while it was read") != 0)
        return 3;
    /* A loss counts for everyone who began before it, and for nobody else. */
    const unsigned after = ffd_mapping_losses();
    return ffd_mapping_judge(after, FFD_E_INVALID, NULL) == FFD_E_INVALID ? 0 : 4;
}

static void a_file_that_becomes_shorter_fails_its_job(void **state)
{
    for (int i = 0; i < 2; i++) {
        is_removed = i == 1;
        put_large("cut");
        assert_int_equal(end_of(read_a_cut_file), 0);
    }
    (void)state;
}

/* A truncation within the last page raises no signal, and the page may not be touched at all. */
static void the_size_tells_without_a_signal(void **state)
{
    ffd_error error;
    for (int i = 0; i < 2; i++) {
        file_input input;
        put_large("short");
        const unsigned before = ffd_mapping_losses();
        assert_int_equal(ffd_file_load(in_folder("short"), &input, NULL), FFD_OK);
        assert_int_equal(ffd_mapping_judge(before, FFD_OK, &error), FFD_OK);
        assert_int_equal(truncate(in_folder("short"), i ? CUT : LARGE - 1), 0);
        if (i)
            ffd_file_unload(&input);
        assert_int_equal(ffd_mapping_judge(before, FFD_OK, &error), FFD_E_IO);
        ffd_file_unload(&input);
    }
    (void)state;
}

/* The old file is intact, whatever has its name by now. */
static void a_file_that_was_replaced_is_no_loss(void **state)
{
    file_input input;
    const unsigned before = ffd_mapping_losses();
    put_large("replaced");
    assert_int_equal(ffd_file_load(in_folder("replaced"), &input, NULL), FFD_OK);
    put_text("other", "short");
    assert_int_equal(rename(in_folder("other"), in_folder("replaced")), 0);
    assert_int_equal(ffd_mapping_judge(before, FFD_OK, NULL), FFD_OK);
    assert_int_equal(unlink(in_folder("replaced")), 0);
    ffd_file_unload(&input);
    assert_int_equal(ffd_mapping_judge(before, FFD_OK, NULL), FFD_OK);
    (void)state;
}

static void many_files_at_once(void **state)
{
    enum { MANY = 200 };
    static file_input inputs[MANY];
    put_large("one of many");
    for (int turn = 0; turn < 2; turn++) {
        for (int i = 0; i < MANY; i++)
            assert_int_equal(ffd_file_load(in_folder("one of many"), &inputs[i], NULL), FFD_OK);
        for (int i = 0; i < MANY; i++)
            ffd_file_unload(&inputs[i]);
    }
    (void)state;
}

/* A mapping that does not belong to an input, of a file that is gone. */
static volatile char *foreign(void)
{
    put_large("foreign");
    const int fd = open(in_folder("foreign"), O_RDONLY);
    char *const bytes = mmap(NULL, LARGE, PROT_READ, MAP_PRIVATE, fd, 0);
    close(fd);
    return bytes == MAP_FAILED || truncate(in_folder("foreign"), 0) != 0 ? NULL : bytes;
}

static void leave(int number)
{
    _exit(number == SIGBUS ? 40 : 41);
}

static void leave_with_place(int number, siginfo_t *info, void *context)
{
    (void)context;
    _exit(number == SIGBUS && info->si_addr ? 50 : 51);
}

static int touch_under_handler(void)
{
    signal(SIGBUS, leave);
    ffd_guard_inputs();
    ffd_guard_inputs(); /* a second call is harmless */
    const volatile char *const bytes = foreign();
    return bytes ? bytes[5000] : 1;
}

static int touch_under_handler_with_place(void)
{
    struct sigaction action = {.sa_sigaction = leave_with_place, .sa_flags = SA_SIGINFO};
    sigaction(SIGBUS, &action, NULL);
    ffd_guard_inputs();
    const volatile char *const bytes = foreign();
    return bytes ? bytes[5000] : 1;
}

static int touch(void)
{
    ffd_guard_inputs();
    const volatile char *const bytes = foreign();
    return bytes ? bytes[5000] : 1;
}

static int send_it(void)
{
    ffd_guard_inputs();
    raise(SIGBUS);
    return 2;
}

static void other_signals_are_passed_on(void **state)
{
    assert_int_equal(end_of(touch_under_handler), 40);
    assert_int_equal(end_of(touch_under_handler_with_place), 50);
    assert_int_equal(end_of(touch), 100 + SIGBUS);
    assert_int_equal(end_of(send_it), 100 + SIGBUS);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_that_becomes_shorter_fails_its_job),
        cmocka_unit_test(the_size_tells_without_a_signal),
        cmocka_unit_test(a_file_that_was_replaced_is_no_loss),
        cmocka_unit_test(many_files_at_once),
        cmocka_unit_test(other_signals_are_passed_on),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
