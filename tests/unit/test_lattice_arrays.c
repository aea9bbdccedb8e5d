/* test_lattice_arrays.c - lattices from arrays, copies, and control points set by the caller: each equals the
   lattice of a file with the same numbers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_text.h"
#include "base/memory/memory.h"
#include <float.h>
#include <math.h>

/* Checks that two lattices agree in everything that evaluation uses. */
static void assert_same(const ffd_lattice *a, const ffd_lattice *b)
{
    assert_int_equal(a->count, b->count);
    for (int i = 0; i < 3; i++) {
        const double *x, *y;
        const size_t count = ffd_lattice_get_knots(a, i, &x);
        assert_int_equal(count, ffd_lattice_get_knots(b, i, &y));
        assert_memory_equal(x, y, count * sizeof *x);
        assert_int_equal(a->size[i], b->size[i]);
    }
    assert_int_equal(a->form, b->form);
    assert_memory_equal(a->rest, b->rest, 3 * a->count * sizeof(double));
    assert_memory_equal(a->deformed, b->deformed, 3 * a->count * sizeof(double));
    assert_memory_equal(a->difference, b->difference, 3 * a->count * sizeof(double));
    assert_memory_equal(a->moved, b->moved, a->count);
    assert_int_equal(!a->rest_weights, !b->rest_weights);
    if (a->rest_weights) {
        assert_memory_equal(a->rest_weights, b->rest_weights, a->count * sizeof(double));
        assert_memory_equal(a->deformed_weights, b->deformed_weights, a->count * sizeof(double));
    }
    assert_true(a->diagonal == b->diagonal && a->weights_moved == b->weights_moved);
}

static ffd_lattice *from_arrays(const ffd_lattice_arrays *arrays)
{
    ffd_lattice *lattice;
    ffd_error error = {0};
    if (ffd_lattice_from_arrays(arrays, &lattice, &error))
        fail_msg("%s", error.message);
    return lattice;
}

static void a_box_from_arrays_is_that_of_a_file(void **state)
{
    static const double knots[] = {0, 0, 0, 1, 2, 3, 3, 3};
    ffd_lattice_arrays arrays;
    ffd_lattice_arrays_init(&arrays, sizeof arrays);
    memcpy(arrays.size, (const size_t[]){4, 5, 3}, sizeof arrays.size);
    memcpy(arrays.degree, (const int[]){3, 2, 1}, sizeof arrays.degree);
    memcpy(arrays.box_min, (const double[]){-1, 0, 2}, sizeof arrays.box_min);
    memcpy(arrays.box_max, (const double[]){1, 3, 4}, sizeof arrays.box_max);
    memcpy(arrays.axes, (const double[]){0, 1, 0, 1, 0, 0, 0, 0, 1}, sizeof arrays.axes);
    arrays.knots[0] = FFD_KNOTS_OPEN;
    arrays.knot_values[1] = knots;
    arrays.knot_count[1] = 8;
    ffd_lattice *lattice = from_arrays(&arrays);
    ffd_lattice *file =
        make("\"size\":[4,5,3],\"degree\":[3,2,1],\"knots\":[\"open\",[0,0,0,1,2,3,3,3],\"clamped\"],"
             "\"rest\":{\"box\":{\"min\":[-1,0,2],\"max\":[1,3,4],"
             "\"axes\":[[0,1,0],[1,0,0],[0,0,1]]}}",
             "");
    assert_same(lattice, file);
    ffd_lattice_destroy(&lattice);
    ffd_lattice_destroy(&file);
    (void)state;
}

static void points_and_weights_from_arrays_are_those_of_a_file(void **state)
{
    const double corners[] = {1, 0, 0, 2, 0, 0, 0, 1, 0, 0, 2, 0, -1, 0, 0, -2, 0, 0, 0, -1, 0, 0, -2, 0,
                              1, 0, 1, 2, 0, 1, 0, 1, 1, 0, 2, 1, -1, 0, 1, -2, 0, 1, 0, -1, 1, 0, -2, 1};
    const double weights[] = {1, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0.5};
    ffd_lattice_arrays arrays;
    ffd_lattice_arrays_init(&arrays, sizeof arrays);
    memcpy(arrays.size, (const size_t[]){2, 4, 2}, sizeof arrays.size);
    arrays.degree[1] = 2;
    arrays.knots[1] = FFD_KNOTS_CLOSED;
    arrays.rest = corners;
    arrays.rest_weights = weights;
    ffd_lattice *lattice = from_arrays(&arrays);
    ffd_lattice *file = make("\"size\":[2,4,2],\"degree\":[1,2,1],\"knots\":[\"clamped\",\"closed\","
                             "\"clamped\"],\"rest\":{\"points\":[[1,0,"
                             "0],[2,0,0],[0,1,0],[0,2,0],[-1,0,0],[-2,0,0],[0,-1,0],[0,-2,0],[1,0,1],[2,0,1],"
                             "[0,1,1],[0,2,1],[-1,0,1],[-2,0,"
                             "1],[0,-1,1],[0,-2,1]]},\"weights\":[1,2,1,1,1,1,1,1,1,1,1,1,1,1,1,0.5]",
                             "");
    assert_same(lattice, file);
    ffd_lattice_destroy(&lattice);
    ffd_lattice_destroy(&file);
    (void)state;
}

static void refuse(const ffd_lattice_arrays *arrays, ffd_status status, const char *words)
{
    ffd_lattice *lattice;
    ffd_error error = {0};
    assert_int_equal(ffd_lattice_from_arrays(arrays, &lattice, &error), status);
    assert_null(lattice);
    if (!strstr(error.message, words))
        fail_msg("%s: not %s", error.message, words);
}

static void arrays_that_are_no_lattice_are_refused(void **state)
{
    const double rest[24] = {0}, falling[] = {0, 1, 0.5, 2}, infinite[] = {0, 0, (double)INFINITY, 1};
    const double weights[8] = {1, 1, 1, 1, 1, 1, 1, 0};
    ffd_lattice_arrays good, bad;
    ffd_lattice_arrays_init(&good, sizeof good);
    for (int a = 0; a < 3; a++) {
        good.size[a] = 2;
        good.box_max[a] = 1;
    }
    bad = good;
    bad.size[1] = 1;
    refuse(&bad, FFD_E_ARGUMENT, "size 1 along v");
    bad = good;
    bad.size[0] = bad.size[1] = SIZE_MAX / 2;
    refuse(&bad, FFD_E_LIMIT, "control points");
    bad = good;
    bad.degree[2] = 2;
    refuse(&bad, FFD_E_ARGUMENT, "degree 2 along w");
    bad = good;
    bad.knots[0] = FFD_KNOTS_CLOSED;
    refuse(&bad, FFD_E_ARGUMENT, "closed");
    bad = good;
    bad.knot_values[0] = falling;
    bad.knot_count[0] = 3;
    refuse(&bad, FFD_E_ARGUMENT, "needs 4 knots, not 3");
    bad.knot_count[0] = 4;
    refuse(&bad, FFD_E_INVALID, "");
    bad.knot_values[0] = infinite;
    refuse(&bad, FFD_E_INVALID, "not finite");
    bad = good;
    bad.rest_weights = weights;
    refuse(&bad, FFD_E_INVALID, "control point 7");
    bad = good;
    bad.box_max[1] = (double)NAN;
    refuse(&bad, FFD_E_INVALID, "direction v");
    bad = good;
    bad.axes[0] = 2;
    refuse(&bad, FFD_E_INVALID, "axes");
    bad = good;
    bad.rest = rest;
    bad.struct_size = 0;
    refuse(&bad, FFD_E_ARGUMENT, "ffd_lattice_arrays_init");
    (void)state;
}

#define REST "\"size\":[3,3,2],\"rest\":{\"box\":{\"min\":[0.1,0.2,0.3],\"max\":[1,2,3]}}"

static void set_points_are_those_of_a_file(void **state)
{
    const size_t index[] = {17, 0, 17};
    const double xyz[] = {9, 9, 9, 0.25, 0.5, 0.75, 1, 2, 3.5};
    ffd_lattice *set = make(REST, "{\"twist\":{\"axis\":\"x\",\"degrees\":3}}"), *file;
    const double *const points = ffd_lattice_get_points(set, FFD_VOLUME_DEFORMED);
    assert_int_equal(ffd_lattice_set_points(set, index, 3, xyz, NULL), FFD_OK);
    assert_true(points[51] == 1 && points[52] == 2 && points[53] == 3.5 && points[0] == 0.25);
    char *text;
    size_t size;
    assert_int_equal(ffd_lattice_text(set, &text, &size, NULL), FFD_OK);
    assert_int_equal(strlen(text), size);
    assert_int_equal(ffd_lattice_parse(text, size, "t", &file, NULL), FFD_OK);
    /* Offsets are stored exactly; the points are rounded sums. */
    assert_memory_equal(set->difference, file->difference, 54 * sizeof(double));
    assert_memory_equal(set->moved, file->moved, 18);
    for (int i = 0; i < 54; i++)
        assert_true(fabs(set->deformed[i] - file->deformed[i]) <= 4 * DBL_EPSILON);
    ffd_free(text);
    ffd_lattice_destroy(&set);
    ffd_lattice_destroy(&file);
    (void)state;
}

static void set_offsets_are_used_as_they_are(void **state)
{
    double offsets[54] = {0};
    ffd_lattice *lattice = make(REST, "{\"by\":[1,1,1]}");
    offsets[4] = 1e-30;
    assert_int_equal(ffd_lattice_set_offsets(lattice, NULL, 18, offsets, NULL), FFD_OK);
    assert_memory_equal(ffd_lattice_get_offsets(lattice), offsets, sizeof offsets);
    for (int i = 0; i < 18; i++)
        assert_int_equal(lattice->moved[i] != 0, i == 1);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void set_weights_move_the_volume(void **state)
{
    const size_t index = 4;
    const double weight = 2, none = 0;
    double before[3], after[3];
    const double uvw[3] = {0.5, 0.5, 0.25};
    ffd_lattice *lattice = make(REST, "{\"at\":[1,1,0],\"by\":[0.5,0,0]}");
    ffd_lattice_evaluate(lattice, FFD_VOLUME_DEFORMED, uvw, before, NULL);
    assert_int_equal(ffd_lattice_set_weights(lattice, &index, 1, &weight, NULL), FFD_OK);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_DEFORMED, uvw, after, NULL);
    assert_true(lattice->weights_moved && after[0] > before[0]);
    assert_int_equal(ffd_lattice_set_weights(lattice, &index, 1, &none, NULL), FFD_E_INVALID);
    assert_true(lattice->deformed_weights[4] == 2);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void weights_times_a_factor_move_nothing_and_are_kept(void **state)
{
    double weights[18];
    char *text;
    size_t size;
    ffd_lattice *lattice =
                    make(REST ",\"weights\":[1,2,3,4,5,6,7,8,9,1,2,3,4,5,6,7,8,9]", "{\"by\":[0,0,0]}"),
                *copy;
    for (int i = 0; i < 18; i++)
        weights[i] = 0.3 * (1 + i % 9);
    assert_int_equal(ffd_lattice_set_weights(lattice, NULL, 18, weights, NULL), FFD_OK);
    assert_false(lattice->weights_moved);
    assert_int_equal(ffd_lattice_text(lattice, &text, &size, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_parse(text, size, "t", &copy, NULL), FFD_OK);
    assert_memory_equal(ffd_lattice_get_weights(copy, FFD_VOLUME_DEFORMED), weights, sizeof weights);
    ffd_free(text);
    ffd_lattice_destroy(&copy);
    weights[17] *= 1 + 1e-14;
    assert_int_equal(ffd_lattice_set_weights(lattice, NULL, 18, weights, NULL), FFD_OK);
    assert_true(lattice->weights_moved);
    for (int i = 0; i < 18; i++) /* ratios beneath the range of doubles are no common factor */
        weights[i] = i == 4 ? 1e-323 : 5e-324;
    assert_int_equal(ffd_lattice_set_weights(lattice, NULL, 18, weights, NULL), FFD_OK);
    assert_true(lattice->weights_moved);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void a_failure_changes_nothing(void **state)
{
    const size_t index[] = {3, 3, 5}, beyond = 18;
    const double xyz[] = {1, 1, 1, 2, 2, 2, 0, (double)INFINITY, 0};
    ffd_lattice *lattice = make(REST, "{\"by\":[0.1,0,0]}"), *copy;
    ffd_error error;
    assert_int_equal(ffd_lattice_copy(lattice, &copy, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_set_points(lattice, index, 3, xyz, &error), FFD_E_INVALID);
    assert_same(lattice, copy);
    assert_int_equal(ffd_lattice_set_points(lattice, &beyond, 1, xyz, &error), FFD_E_ARGUMENT);
    assert_int_equal(ffd_lattice_set_offsets(lattice, NULL, 19, xyz, &error), FFD_E_ARGUMENT);
    assert_same(lattice, copy);
    ffd_lattice_destroy(&lattice);
    ffd_lattice_destroy(&copy);
    (void)state;
}

static void weights_that_are_refused_leave_none(void **state)
{
    const double weights[] = {2, 0};
    ffd_lattice *lattice = make(REST, "{\"by\":[0.1,0,0]}"), *copy;
    ffd_error error;
    assert_int_equal(ffd_lattice_copy(lattice, &copy, NULL), FFD_OK);
    assert_null(ffd_lattice_get_weights(lattice, FFD_VOLUME_REST));
    assert_int_equal(ffd_lattice_set_weights(lattice, NULL, 2, weights, &error), FFD_E_INVALID);
    assert_same(lattice, copy);
    assert_int_equal(ffd_lattice_set_weights(lattice, NULL, 1, weights, &error), FFD_OK);
    assert_int_equal(ffd_lattice_set_weights(lattice, NULL, 2, weights, &error), FFD_E_INVALID);
    assert_true(ffd_lattice_get_weights(lattice, FFD_VOLUME_DEFORMED)[0] == 2);
    ffd_lattice_destroy(&lattice);
    ffd_lattice_destroy(&copy);
    (void)state;
}

static void setting_nothing_changes_nothing(void **state)
{
    ffd_lattice *lattice = make(REST, "{\"by\":[0.1,0,0]}"), *copy;
    char *first, *second;
    size_t size;
    assert_int_equal(ffd_lattice_copy(lattice, &copy, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_set_points(lattice, NULL, 0, NULL, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_set_offsets(lattice, NULL, 0, NULL, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_set_weights(lattice, NULL, 0, NULL, NULL), FFD_OK);
    assert_same(lattice, copy);
    assert_int_equal(ffd_lattice_text(lattice, &first, &size, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_text(copy, &second, &size, NULL), FFD_OK);
    assert_string_equal(first, second);
    ffd_free(first);
    ffd_free(second);
    ffd_lattice_destroy(&lattice);
    ffd_lattice_destroy(&copy);
    (void)state;
}

static void values_may_be_lent_by_the_lattice(void **state)
{
    const size_t swapped[] = {1, 0};
    ffd_lattice *lattice = make(REST, "{\"by\":[0.1,0,0]}");
    double before[6];
    memcpy(before, ffd_lattice_get_points(lattice, FFD_VOLUME_DEFORMED), sizeof before);
    assert_int_equal(ffd_lattice_set_points(lattice, swapped, 2,
                                            ffd_lattice_get_points(lattice, FFD_VOLUME_DEFORMED), NULL),
                     FFD_OK);
    assert_memory_equal(lattice->deformed, before + 3, sizeof before / 2);
    assert_memory_equal(lattice->deformed + 3, before, sizeof before / 2);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void a_mesh_that_no_box_names_is_refused(void **state)
{
    ffd_lattice_arrays arrays;
    char *path;
    ffd_error error;
    ffd_lattice_arrays_init(&arrays, sizeof arrays);
    for (int a = 0; a < 3; a++) {
        arrays.size[a] = 2;
        arrays.box_max[a] = 1;
    }
    ffd_lattice *lattice = from_arrays(&arrays);
    assert_int_equal(ffd_lattice_get_mesh(lattice, 0, &path, &error), FFD_E_ARGUMENT);
    assert_null(path);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static void a_copy_is_equal_and_independent(void **state)
{
    const double xyz[] = {5, 5, 5};
    ffd_lattice *lattice = make(
                    "\"size\":[2,4,2],\"degree\":[1,2,1],\"knots\":[[0,0,1,1],\"closed\",\"open\"],"
                    "\"parameters\":{\"A\":{\"default\":1,\"unit\":\"m\"}},\"rest\":{\"points\":[[1,0,0],[2,"
                    "0,0],[0,1,0],[0,2,0],[-1,0,0],[-2,0,0],[0,-1,0],[0,-2,0],[1,0,1],[2,0,1],[0,1,1],[0,2,"
                    "1],[-1,0,1],[-2,0,1],[0,-1,1],[0,-2,1]]},\"deformed\":{\"weights\":[1,1,1,1,1,1,1,1,1,"
                    "1,1,1,1,1,1,3]}",
                    "{\"by\":[{\"$\":\"A\"},0,0]}"),
                *copy;
    char *first, *second;
    size_t size;
    assert_int_equal(ffd_lattice_copy(lattice, &copy, NULL), FFD_OK);
    assert_same(lattice, copy);
    assert_int_equal(ffd_lattice_text(lattice, &first, &size, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_text(copy, &second, &size, NULL), FFD_OK);
    assert_string_equal(first, second);
    assert_int_equal(ffd_lattice_set_points(copy, NULL, 1, xyz, NULL), FFD_OK);
    assert_true(lattice->deformed[0] != 5);
    ffd_lattice_destroy(&lattice);
    assert_true(copy->deformed[0] == 5);
    ffd_free(first);
    ffd_free(second);
    ffd_lattice_destroy(&copy);
    (void)state;
}

/* A box that was fitted to a mesh keeps the control points that were set when it is fitted again. */
static void a_box_that_is_fitted_anew_keeps_what_was_set(void **state)
{
    const double first_min[3] = {0, 0, 0}, first_max[3] = {1, 1, 1}, then_min[3] = {-1, -1, -1},
                 offset[] = {0.5, 0, 0};
    ffd_lattice *lattice = make("\"size\":[2,2,2],\"rest\":{\"box\":\"mesh\"}", "{\"by\":[9,9,9]}");
    assert_int_equal(ffd_lattice_set_offsets(lattice, NULL, 1, offset, NULL), FFD_E_ARGUMENT);
    assert_int_equal(ffd_lattice_fit(lattice, first_min, first_max, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_set_offsets(lattice, NULL, 1, offset, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_fit(lattice, then_min, first_max, NULL), FFD_OK);
    assert_true(lattice->rest[0] == -1 && lattice->deformed[0] == -0.5 && lattice->difference[3] == 9);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

static bool note_parameter(void *user, const ffd_parameter *parameter)
{
    char *const told = user;
    sprintf(told + strlen(told), "%s=%s %g..%g %s %s;", parameter->name,
            parameter->default_value ? parameter->default_value : "-", parameter->min, parameter->max,
            parameter->unit ? parameter->unit : "-", parameter->comment ? parameter->comment : "-");
    return strcmp(parameter->name, "B") != 0;
}

static void parameters_are_listed(void **state)
{
    static const char text[] =
        "{\"format\":\"ffd-lattice\",\"version\":1," REST ",\"parameters\":{\"A\":{\"default\":[1,2],"
        "\"min\":0,\"unit\":\"mm\"},\"B\":{\"comment\":\"two\"},\"C\":{}},"
        "\"moves\":[{\"by\":{\"$\":\"D\"}}]}";
    char told[200] = "";
    assert_int_equal(ffd_lattice_list_parameters(text, strlen(text), "t", note_parameter, told, NULL),
                     FFD_OK);
    assert_string_equal(told, "A=[1,2] 0..inf mm -;B=- -inf..inf - two;");
    (void)state;
}

static void memory_that_ends_leaves_nothing(void **state)
{
    ffd_lattice *lattice = make(REST, "{\"by\":[0.1,0,0]}"), *copy = NULL;
    ffd_status status = FFD_E_MEMORY;
    for (long successes = 0; status; successes++) {
        ffd_alloc_fail_after(successes);
        status = ffd_lattice_copy(lattice, &copy, NULL);
        ffd_alloc_fail_after(-1);
        assert_true(status == FFD_OK || (status == FFD_E_MEMORY && !copy));
    }
    assert_same(lattice, copy);
    ffd_lattice_destroy(&lattice);
    ffd_lattice_destroy(&copy);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_from_arrays_is_that_of_a_file),
        cmocka_unit_test(points_and_weights_from_arrays_are_those_of_a_file),
        cmocka_unit_test(arrays_that_are_no_lattice_are_refused),
        cmocka_unit_test(set_points_are_those_of_a_file),
        cmocka_unit_test(set_offsets_are_used_as_they_are),
        cmocka_unit_test(set_weights_move_the_volume),
        cmocka_unit_test(weights_times_a_factor_move_nothing_and_are_kept),
        cmocka_unit_test(a_failure_changes_nothing),
        cmocka_unit_test(weights_that_are_refused_leave_none),
        cmocka_unit_test(setting_nothing_changes_nothing),
        cmocka_unit_test(values_may_be_lent_by_the_lattice),
        cmocka_unit_test(a_mesh_that_no_box_names_is_refused),
        cmocka_unit_test(a_copy_is_equal_and_independent),
        cmocka_unit_test(a_box_that_is_fitted_anew_keeps_what_was_set),
        cmocka_unit_test(parameters_are_listed),
        cmocka_unit_test(memory_that_ends_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
