/* test_row_array.c - an array for the positions of many jobs: of full size from the start, each row complete
   or NaN. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/file/input.h"
#include "base/system/interrupt.h"
#include "batch/row_array.h"
#include <math.h>
#include <signal.h>

enum { HEAD = 128, VERTICES = 5000 };

static row_array array_of(const char *name, uint64_t rows, uint64_t vertices, bool is_double)
{
    return (row_array){in_folder(name), rows, vertices, is_double};
}

static ffd_status create(const row_array *array, bool force, ffd_error *error)
{
    file_output *made = NULL;
    const ffd_status status = ffd_rows_make(array, force, &made, error);
    assert_true(status == FFD_OK || !made);
    return status ? status : ffd_rows_place(array, force, &made, error);
}

/* Returns the numbers of an array, which must be complete. Free with ffd_file_unload. */
static const unsigned char *load(const row_array *array, file_input *input)
{
    assert_int_equal(ffd_file_load(array->path, input, NULL), FFD_OK);
    assert_int_equal(input->size, HEAD + array->rows * array->vertices * 3 * (array->is_double ? 8 : 4));
    return input->data + HEAD;
}

static double number(const row_array *array, const unsigned char *numbers, size_t i)
{
    float single;
    double value;
    if (array->is_double) {
        memcpy(&value, numbers + 8 * i, sizeof value);
        return value;
    }
    memcpy(&single, numbers + 4 * i, sizeof single);
    return single;
}

static double *make_positions(void)
{
    static double positions[3 * VERTICES];
    for (size_t i = 0; i < 3 * VERTICES; i++)
        positions[i] = (double)i / 3;
    return positions;
}

static void check_row(const row_array *array, size_t row, const double *positions)
{
    file_input input;
    const unsigned char *const numbers = load(array, &input);
    for (size_t i = 0; i < 3 * array->vertices; i++) {
        const double found = number(array, numbers, row * 3 * (size_t)array->vertices + i);
        if (!positions)
            assert_true(isnan(found));
        else
            assert_true(found == (array->is_double ? positions[i] : (double)(float)positions[i]));
    }
    ffd_file_unload(&input);
}

/* More numbers than are written at a time, of both types. */
static void rows_are_written_and_cleared(void **state)
{
    const double *const positions = make_positions();
    for (int type = 0; type < 2; type++) {
        const row_array array = array_of(type ? "f8.npy" : "f4.npy", 3, VERTICES, type);
        hash128 before, after;
        assert_int_equal(create(&array, false, NULL), FFD_OK);
        assert_int_equal(ffd_row_hash(&array, 1, &before, NULL), FFD_OK);
        assert_false(ffd_row_is_done(&array, 1));
        assert_int_equal(ffd_row_write(&array, 1, positions, VERTICES, NULL), FFD_OK);
        assert_true(ffd_row_is_done(&array, 1));
        check_row(&array, 0, NULL);
        check_row(&array, 1, positions);
        check_row(&array, 2, NULL);
        assert_int_equal(ffd_row_hash(&array, 1, &after, NULL), FFD_OK);
        assert_false(ffd_hash_equal(&before, &after));
        ffd_row_clear(&array, 1);
        check_row(&array, 1, NULL);
        assert_int_equal(ffd_row_hash(&array, 1, &after, NULL), FFD_OK);
        assert_true(ffd_hash_equal(&before, &after));
    }
    (void)state;
}

static void other_arrays_are_refused(void **state)
{
    const double *const positions = make_positions();
    const row_array array = array_of("this.npy", 2, 4, false);
    const row_array others[] = {array_of("this.npy", 3, 4, false), array_of("this.npy", 2, 3, false),
                                array_of("this.npy", 2, 4, true)};
    bool is_there;
    ffd_error error;
    assert_int_equal(ffd_rows_find(&array, &is_there, NULL), FFD_OK);
    assert_false(is_there);
    assert_false(ffd_row_is_done(&array, 0));
    assert_int_equal(ffd_row_write(&array, 0, positions, 4, NULL),
                     FFD_E_IO); /* and does not create the file */
    assert_false(ffd_file_exists(array.path));
    assert_int_equal(create(&array, false, NULL), FFD_OK);
    assert_int_equal(create(&array, false, NULL), FFD_OK); /* an equal array of another run is accepted */
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        assert_int_equal(ffd_rows_find(&others[i], &is_there, &error), FFD_E_EXISTS);
        assert_non_null(strstr(error.message, "is not an array of"));
        assert_int_equal(create(&others[i], false, NULL), FFD_E_EXISTS);
        assert_int_equal(ffd_row_write(&others[i], 0, positions, (size_t)others[i].vertices, NULL),
                         FFD_E_EXISTS);
    }
    assert_int_equal(create(&others[1], true, NULL), FFD_OK);
    assert_int_equal(ffd_rows_find(&array, &is_there, NULL), FFD_E_EXISTS);
    (void)state;
}

static void arrays_have_no_name_until_they_are_placed(void **state)
{
    const row_array array = array_of("late.npy", 2, 4, false), other = array_of("late.npy", 3, 4, false);
    file_output *made;
    bool is_there;
    assert_int_equal(ffd_rows_make(&array, false, &made, NULL), FFD_OK);
    assert_false(ffd_file_exists(array.path));
    ffd_output_destroy(&made);
    assert_int_equal(create(&array, false, NULL), FFD_OK);
    assert_int_equal(ffd_rows_make(&other, true, &made, NULL), FFD_OK);
    assert_int_equal(ffd_rows_find(&array, &is_there, NULL), FFD_OK); /* still the old file */
    assert_int_equal(ffd_rows_place(&other, true, &made, NULL), FFD_OK);
    assert_null(made);
    assert_int_equal(ffd_rows_find(&other, &is_there, NULL), FFD_OK);
    assert_int_equal(ffd_rows_place(&other, true, &made, NULL), FFD_OK); /* nothing to do */
    (void)state;
}

static void what_is_no_row_is_refused(void **state)
{
    double positions[] = {1, 2, 3, 4, -1e39, 6};
    const row_array array = array_of("single.npy", 1, 2, false), wide = array_of("wide.npy", 1, 2, true);
    ffd_error error;
    assert_int_equal(create(&array, false, NULL), FFD_OK);
    assert_int_equal(create(&wide, false, NULL), FFD_OK);
    assert_int_equal(ffd_row_write(&array, 0, positions, 1, &error), FFD_E_INVALID);
    assert_non_null(strstr(error.message, "has 1 vertices"));
    assert_int_equal(ffd_row_write(&array, 0, positions, 2, &error), FFD_E_INVALID);
    assert_non_null(strstr(error.message, "vertex 1 is too large"));
    assert_false(ffd_row_is_done(&array, 0));
    assert_int_equal(ffd_row_write(&wide, 0, positions, 2, NULL), FFD_OK);
    positions[4] = -INFINITY; /* infinite in the mesh already */
    assert_int_equal(ffd_row_write(&array, 0, positions, 2, NULL), FFD_OK);
    assert_true(ffd_row_is_done(&array, 0));
    (void)state;
}

static void sizes_are_counted_in_64_bits(void **state)
{
    const row_array sizes[] = {{"x", UINT64_C(1) << 40, UINT64_C(1) << 40, false},
                               {"x", 1, UINT64_MAX / 12, true},
                               {"x", UINT64_MAX, 1, false},
                               {"x", 1, UINT64_MAX / 3 + 2, false}};
    const row_array small[] = {
        {"x", UINT64_MAX, 0, false}, {"x", 0, UINT64_C(1) << 50, true}, {"x", 50000, 1800, false}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        assert_int_equal(ffd_rows_check_size(&sizes[i], NULL), FFD_E_LIMIT);
    for (size_t i = 0; i < sizeof small / sizeof *small; i++)
        assert_int_equal(ffd_rows_check_size(&small[i], NULL), FFD_OK);
    (void)state;
}

static void rows_of_no_vertices_are_never_done(void **state)
{
    const row_array array = array_of("none.npy", 2, 0, false);
    hash128 hash;
    assert_int_equal(create(&array, false, NULL), FFD_OK);
    assert_int_equal(ffd_row_write(&array, 1, NULL, 0, NULL), FFD_OK);
    assert_int_equal(ffd_row_hash(&array, 1, &hash, NULL), FFD_OK);
    assert_false(ffd_row_is_done(&array, 1));
    ffd_row_clear(&array, 1);
    (void)state;
}

/* Must be the last test: the interrupt stays set. */
static void nothing_is_made_after_an_interrupt(void **state)
{
    const row_array array = array_of("wait.npy", 2, 4, false);
    file_output *other, *made;
    assert_int_equal(ffd_rows_make(&array, false, &other, NULL), FFD_OK);
    assert_int_equal(ffd_rows_make(&array, true, &made, NULL),
                     FFD_E_IO); /* a file that would be replaced is not another run's */
    ffd_interrupt_watch();
    raise(SIGINT);
    assert_int_equal(ffd_rows_make(&array, false, &made, NULL), FFD_OK); /* does not wait for the other run */
    assert_null(made);
    ffd_output_destroy(&other);
    assert_int_equal(ffd_rows_make(&array, false, &made, NULL), FFD_OK);
    assert_null(made);
    assert_false(ffd_file_exists(array.path));
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_written_and_cleared),
        cmocka_unit_test(other_arrays_are_refused),
        cmocka_unit_test(what_is_no_row_is_refused),
        cmocka_unit_test(sizes_are_counted_in_64_bits),
        cmocka_unit_test(rows_of_no_vertices_are_never_done),
        cmocka_unit_test(arrays_have_no_name_until_they_are_placed),
        cmocka_unit_test(nothing_is_made_after_an_interrupt),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
