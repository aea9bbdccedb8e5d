/* test_memory_budget.c - the memory limit of a document. */
#include "mesh/memory_budget.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#define MB ((uint64_t)1000000)

static void check_left(const memory_budget *budget, uint64_t left)
{
    ffd_error error;
    assert_true(ffd_budget_left(budget) == left);
    assert_int_equal(ffd_budget_check(budget, left, 1, &error), FFD_OK);
    if (left == UINT64_MAX)
        return;
    assert_int_equal(ffd_budget_check(budget, left + 1, 1, &error), FFD_E_LIMIT);
    assert_int_equal(ffd_budget_check(budget, 1, left + 1, &error), FFD_E_LIMIT);
}

static void files_widen_it(void **state)
{
    (void)state;
    memory_budget budget = ffd_budget_make(0);
    const uint64_t first = ffd_budget_left(&budget);
    assert_true(ffd_budget_most(&budget) == 100 * MB);
    assert_in_range(first, 80 * MB, 95 * MB); /* the program itself takes some memory */
    check_left(&budget, first);
    ffd_budget_add_file(&budget, 3 * MB, 1);
    assert_true(ffd_budget_most(&budget) == 160 * MB);
    check_left(&budget, first + 57 * MB);
    ffd_budget_add_file(&budget, MB, 20);
    check_left(&budget, first + 57 * MB);
}

static void more_can_be_asked_for(void **state)
{
    (void)state;
    memory_budget less = ffd_budget_make(50 * MB), more = ffd_budget_make(1000 * MB);
    assert_true(ffd_budget_most(&less) == 100 * MB);
    assert_true(ffd_budget_most(&more) == 1000 * MB);
    ffd_budget_add_file(&more, 10 * MB, 1);
    assert_true(ffd_budget_most(&more) == 1000 * MB);
    ffd_budget_add_file(&more, 100 * MB, 1);
    assert_true(ffd_budget_most(&more) == 2300 * MB);
}

static void what_is_taken_is_gone(void **state)
{
    (void)state;
    memory_budget budget = ffd_budget_make(0);
    ffd_error error;
    const uint64_t first = ffd_budget_left(&budget);
    assert_int_equal(ffd_budget_take(&budget, MB, 12, &error), FFD_OK);
    check_left(&budget, first - 12 * MB);
    assert_int_equal(ffd_budget_take(&budget, first, 1, &error), FFD_E_LIMIT);
    assert_string_equal(error.message,
                        "needs more than the 100 MB of memory allowed (input.memory raises this)");
    check_left(&budget, first - 12 * MB);
    assert_int_equal(ffd_budget_take(&budget, first - 12 * MB, 1, &error), FFD_OK);
    check_left(&budget, 0);
    assert_int_equal(ffd_budget_take(&budget, UINT64_MAX, 0, &error), FFD_OK);
}

/* A file may claim any size. */
static void no_size_wraps_round(void **state)
{
    (void)state;
    memory_budget budget = ffd_budget_make(0), huge = ffd_budget_make(UINT64_MAX);
    ffd_error error;
    assert_int_equal(ffd_budget_check(&budget, UINT64_MAX, UINT64_MAX, &error), FFD_E_LIMIT);
    assert_int_equal(ffd_budget_check(&budget, (uint64_t)1 << 32, (uint64_t)1 << 32, &error), FFD_E_LIMIT);
    ffd_budget_add_file(&budget, UINT64_MAX / 2, 1);
    assert_true(ffd_budget_most(&budget) == SIZE_MAX);
    ffd_budget_add_file(&budget, UINT64_MAX / 2, 3);
    assert_true(ffd_budget_left(&budget) == 0);
    assert_int_equal(ffd_budget_take(&huge, UINT64_MAX, 1, &error), FFD_E_LIMIT);
    assert_int_equal(ffd_budget_take(&huge, ffd_budget_left(&huge), 1, &error), FFD_OK);
    assert_true(ffd_budget_left(&huge) == 0);
}

static void text_is_kept_as_numbers(void **state)
{
    (void)state;
    const memory_budget none = ffd_budget_make(0), budget = ffd_budget_for_file(10 * MB, true, 0),
                        floats = ffd_budget_for_file(10 * MB, false, 0);
    assert_true(ffd_budget_most(&budget) == 300 * MB);
    assert_in_range(ffd_budget_left(&budget), ffd_budget_left(&none) + 50 * MB,
                    ffd_budget_left(&none) + 190 * MB);
    assert_true(ffd_budget_left(&floats) > ffd_budget_left(&budget));
}

static void threads_share_what_is_left(void **state)
{
    (void)state;
    memory_budget budget = ffd_budget_make(0);
    const uint64_t left = ffd_budget_left(&budget);
    assert_int_equal(ffd_budget_threads(&budget, 64, left / 64), 64);
    assert_int_equal(ffd_budget_threads(&budget, 64, left / 10), 10);
    assert_int_equal(ffd_budget_threads(&budget, 3, left / 10), 3);
    assert_int_equal(ffd_budget_threads(&budget, 0, 1), 1);
    assert_int_equal(ffd_budget_take(&budget, left, 1, NULL), FFD_OK);
    assert_int_equal(ffd_budget_threads(&budget, 64, 1), 1);
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
