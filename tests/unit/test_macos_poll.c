/* test_macos_poll.c - what waits for terminals on macOS, here compiled for this system. */
#define _XOPEN_SOURCE 700 /* posix_openpt */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../../src/base/macos/poll.c"
#include <stdlib.h>
#include <unistd.h>

enum { TERMINAL, PIPE, FILES };

/* Two files that can be read, and what writes to them. */
static int inputs[FILES], writers[FILES];

static int open_both(void **state)
{
    int ends[2];
    (void)state;
    writers[TERMINAL] = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (writers[TERMINAL] < 0 || grantpt(writers[TERMINAL]) != 0 || unlockpt(writers[TERMINAL]) != 0 ||
        pipe(ends) != 0)
        return -1;
    inputs[TERMINAL] = open(ptsname(writers[TERMINAL]), O_RDWR | O_NOCTTY | O_CLOEXEC);
    inputs[PIPE] = ends[0];
    writers[PIPE] = ends[1];
    return inputs[TERMINAL] < 0 ? -1 : 0;
}

static int close_both(void **state)
{
    (void)state;
    for (int i = 0; i < FILES; i++) {
        close(inputs[i]);
        close(writers[i]);
    }
    return 0;
}

static int wait_for(struct pollfd set[FILES], int milliseconds)
{
    for (int i = 0; i < FILES; i++)
        set[i] = (struct pollfd){.fd = inputs[i], .events = POLLIN, .revents = POLLNVAL};
    return ffd_macos_poll(set, FILES, milliseconds);
}

static void nothing_is_ready_before_it_is_written(void **state)
{
    struct pollfd set[FILES];
    (void)state;
    for (int milliseconds = 0; milliseconds < 3; milliseconds++) {
        assert_int_equal(wait_for(set, milliseconds), 0);
        assert_int_equal(set[TERMINAL].revents, 0);
        assert_int_equal(set[PIPE].revents, 0);
    }
}

static void each_is_ready_alone_and_both_together(void **state)
{
    struct pollfd set[FILES];
    (void)state;
    for (int ready = 1; ready < 4; ready++) {
        char line[8];
        for (int i = 0; i < FILES; i++)
            if (ready >> i & 1)
                assert_int_equal(write(writers[i], "a\n", 2), 2);
        assert_int_equal(wait_for(set, -1), ready == 3 ? 2 : 1);
        for (int i = 0; i < FILES; i++) {
            assert_int_equal(set[i].revents, ready >> i & 1 ? POLLIN : 0);
            if (ready >> i & 1)
                assert_int_equal(read(inputs[i], line, sizeof line), 2);
        }
    }
}

static void a_writer_that_is_gone_is_seen(void **state)
{
    struct pollfd set[FILES];
    (void)state;
    close(writers[PIPE]);
    assert_int_equal(wait_for(set, -1), 1);
    assert_int_equal(set[PIPE].revents, POLLIN);
    writers[PIPE] = -1;
}

static void without_a_device_it_is_poll(void **state)
{
    (void)state;
    struct pollfd set = {.fd = inputs[PIPE], .events = POLLIN};
    close(writers[PIPE]);
    assert_int_equal(ffd_macos_poll(&set, 1, -1), 1);
    assert_int_equal(set.revents, POLLHUP); /* which select does not tell */
    writers[PIPE] = -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(nothing_is_ready_before_it_is_written, open_both, close_both),
        cmocka_unit_test_setup_teardown(each_is_ready_alone_and_both_together, open_both, close_both),
        cmocka_unit_test_setup_teardown(a_writer_that_is_gone_is_seen, open_both, close_both),
        cmocka_unit_test_setup_teardown(without_a_device_it_is_poll, open_both, close_both),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
