/* test_room.c - how much memory a document may take. */
#include "mesh/memory_budget.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#define MB ((uint64_t)1000000)

static void check_left(const mesh_room *room, uint64_t left)
{
    ffd_error error;
    assert_true(ffd_room_left(room) == left);
    assert_int_equal(ffd_room_check(room, left, 1, &error), FFD_OK);
    if (left == UINT64_MAX)
        return;
    assert_int_equal(ffd_room_check(room, left + 1, 1, &error), FFD_E_LIMIT);
    assert_int_equal(ffd_room_check(room, 1, left + 1, &error), FFD_E_LIMIT);
}

static void files_widen_it(void **state)
{
    (void)state;
    mesh_room room = ffd_room_make(0);
    const uint64_t first = ffd_room_left(&room);
    assert_true(ffd_room_most(&room) == 100 * MB);
    assert_in_range(first, 80 * MB, 95 * MB); /* the program itself takes some */
    check_left(&room, first);
    ffd_room_add_file(&room, 3 * MB, 1);
    assert_true(ffd_room_most(&room) == 160 * MB);
    check_left(&room, first + 57 * MB);
    ffd_room_add_file(&room, MB, 20);
    check_left(&room, first + 57 * MB);
}

static void more_can_be_asked_for(void **state)
{
    (void)state;
    mesh_room less = ffd_room_make(50 * MB), more = ffd_room_make(1000 * MB);
    assert_true(ffd_room_most(&less) == 100 * MB);
    assert_true(ffd_room_most(&more) == 1000 * MB);
    ffd_room_add_file(&more, 10 * MB, 1);
    assert_true(ffd_room_most(&more) == 1000 * MB);
    ffd_room_add_file(&more, 100 * MB, 1);
    assert_true(ffd_room_most(&more) == 2300 * MB);
}

static void what_is_taken_is_gone(void **state)
{
    (void)state;
    mesh_room room = ffd_room_make(0);
    ffd_error error;
    const uint64_t first = ffd_room_left(&room);
    assert_int_equal(ffd_room_take(&room, MB, 12, &error), FFD_OK);
    check_left(&room, first - 12 * MB);
    assert_int_equal(ffd_room_take(&room, first, 1, &error), FFD_E_LIMIT);
    assert_string_equal(error.message, "needs more than the 100 MB of memory allowed (--memory raises this)");
    check_left(&room, first - 12 * MB);
    assert_int_equal(ffd_room_take(&room, first - 12 * MB, 1, &error), FFD_OK);
    check_left(&room, 0);
    assert_int_equal(ffd_room_take(&room, UINT64_MAX, 0, &error), FFD_OK);
}

/* Sizes are a file's to state. */
static void no_size_wraps_round(void **state)
{
    (void)state;
    mesh_room room = ffd_room_make(0), huge = ffd_room_make(UINT64_MAX);
    ffd_error error;
    assert_int_equal(ffd_room_check(&room, UINT64_MAX, UINT64_MAX, &error), FFD_E_LIMIT);
    assert_int_equal(ffd_room_check(&room, (uint64_t)1 << 32, (uint64_t)1 << 32, &error), FFD_E_LIMIT);
    ffd_room_add_file(&room, UINT64_MAX / 2, 1);
    assert_true(ffd_room_most(&room) == UINT64_MAX);
    ffd_room_add_file(&room, UINT64_MAX / 2, 3);
    assert_true(ffd_room_left(&room) == 0);
    assert_int_equal(ffd_room_take(&huge, UINT64_MAX, 1, &error), FFD_E_LIMIT);
    assert_int_equal(ffd_room_take(&huge, ffd_room_left(&huge), 1, &error), FFD_OK);
    assert_true(ffd_room_left(&huge) == 0);
}

static void text_is_kept_as_numbers(void **state)
{
    (void)state;
    const mesh_room none = ffd_room_make(0), room = ffd_room_of_file(10 * MB, true, 0),
                    floats = ffd_room_of_file(10 * MB, false, 0);
    assert_true(ffd_room_most(&room) == 300 * MB);
    assert_in_range(ffd_room_left(&room), ffd_room_left(&none) + 50 * MB, ffd_room_left(&none) + 190 * MB);
    assert_true(ffd_room_left(&floats) > ffd_room_left(&room));
}

static void threads_share_what_is_left(void **state)
{
    (void)state;
    mesh_room room = ffd_room_make(0);
    const uint64_t left = ffd_room_left(&room);
    assert_int_equal(ffd_room_threads(&room, 64, left / 64), 64);
    assert_int_equal(ffd_room_threads(&room, 64, left / 10), 10);
    assert_int_equal(ffd_room_threads(&room, 3, left / 10), 3);
    assert_int_equal(ffd_room_threads(&room, 0, 1), 1);
    assert_int_equal(ffd_room_take(&room, left, 1, NULL), FFD_OK);
    assert_int_equal(ffd_room_threads(&room, 64, 1), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_widen_it),          cmocka_unit_test(more_can_be_asked_for),
        cmocka_unit_test(what_is_taken_is_gone),   cmocka_unit_test(no_size_wraps_round),
        cmocka_unit_test(text_is_kept_as_numbers), cmocka_unit_test(threads_share_what_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
