#include "lattice/formats/grid_arrays.h"
#include "base/memory/memory.h"
#include <inttypes.h>
#include <string.h>

static const struct {
    const char *name;
    bool of_points;
    uint64_t components; /* 0: any */
} kinds[GRID_ARRAYS] = {{"points", true, 3},          {"offset", true, 3},       {"weight", true, 1},
                        {"weight_deformed", true, 1}, {"ffd_degree", false, 0},  {"ffd_closed", false, 0},
                        {"ffd_knots_u", false, 0},    {"ffd_knots_v", false, 0}, {"ffd_knots_w", false, 0}};

const char *ffd_grid_array_name(grid_array_kind kind)
{
    return kinds[kind].name;
}

static bool is_named(int kind, text_word name, bool of_points)
{
    return kinds[kind].of_points == of_points && ffd_text_is(name, kinds[kind].name);
}

bool ffd_grid_array_is_known(text_word name, bool of_points)
{
    for (int k = 0; k < GRID_ARRAYS; k++)
        if (is_named(k, name, of_points))
            return true;
    return false;
}

ffd_status ffd_grid_array_take(grid_arrays *arrays, text_word name, bool of_points, uint64_t components,
                               uint64_t tuples, double ***kept, const char *file, const format_wish *wish,
                               ffd_error *error)
{
    *kept = NULL;
    for (int k = 0; k < GRID_ARRAYS; k++) {
        grid_array *const array = &arrays->array[k];
        if (!is_named(k, name, of_points))
            continue;
        if (array->values)
            return ffd_fail_file(error, FFD_E_INVALID, file, "has the array \"%s\" twice", kinds[k].name);
        if (kinds[k].components && components != kinds[k].components)
            return ffd_fail_file(error, FFD_E_INVALID, file,
                                 "has an array \"%s\" of %" PRIu64 " components, not of %" PRIu64,
                                 kinds[k].name, components, kinds[k].components);
        array->count = components * tuples;
        if (array->count > 3 * FFD_MAX_CONTROL_POINTS)
            return ffd_fail_file(error, FFD_E_LIMIT, file, "has more than %zu control points",
                                 FFD_MAX_CONTROL_POINTS);
        arrays->count += array->count;
        if (wish->allowed && arrays->count > wish->memory / sizeof(double))
            return ffd_fail_file(error, FFD_E_LIMIT, file,
                                 "has arrays of %" PRIu64 " numbers, more than %" PRIu64
                                 " MB of memory hold ({input.memory} raises this)",
                                 arrays->count, wish->memory / 1000000);
        array->values = ffd_alloc_whole((size_t)array->count, sizeof *array->values);
        if (!array->values)
            return ffd_fail_memory(error);
        *kept = &array->values;
        return FFD_OK;
    }
    return FFD_OK;
}

void ffd_grid_arrays_free(grid_arrays *arrays)
{
    for (int k = 0; k < GRID_ARRAYS; k++)
        ffd_free(arrays->array[k].values);
    *arrays = (grid_arrays){0};
}

/* Checks that an array has a number for each of `count`, or that it is not there. */
static ffd_status check_count(const grid_arrays *arrays, grid_array_kind kind, uint64_t count,
                              const char *file, ffd_error *error)
{
    const grid_array *const array = &arrays->array[kind];
    return !array->values || array->count == count
               ? FFD_OK
               : ffd_fail_file(error, FFD_E_INVALID, file,
                               "has an array \"%s\" of %" PRIu64 " numbers, not of %" PRIu64,
                               kinds[kind].name, array->count, count);
}

/* Takes three whole numbers from least to most. */
static ffd_status take_three(const grid_arrays *arrays, grid_array_kind kind, int least, int most,
                             int numbers[3], const char *file, ffd_error *error)
{
    const grid_array *const array = &arrays->array[kind];
    TRY(check_count(arrays, kind, 3, file, error));
    for (int a = 0; a < 3; a++) {
        const double number = array->values[a];
        if (!(number >= least && number <= most) || number != (int)number)
            return ffd_fail_file(error, FFD_E_INVALID, file,
                                 "has %g in the array \"%s\", not a whole number from %d to %d", number,
                                 kinds[kind].name, least, most);
        numbers[a] = (int)number;
    }
    return FFD_OK;
}

/* Gives a direction its own knots. */
static ffd_status take_knots(grid_arrays *arrays, int a, bool is_closed, const char *file, lattice_spec *spec,
                             ffd_error *error)
{
    const grid_array_kind kind = (grid_array_kind)(GRID_KNOTS_U + a);
    grid_array *const array = &arrays->array[kind];
    spec->kind[a] = is_closed ? KNOTS_CLOSED : KNOTS_CLAMPED;
    if (!array->values)
        return FFD_OK;
    TRY(check_count(arrays, kind, spec->size[a] + (is_closed ? 1 : (size_t)spec->degree[a] + 1), file,
                    error));
    spec->kind[a] = is_closed ? KNOTS_CLOSED_LIST : KNOTS_LIST;
    spec->list[a] = array->values;
    spec->list_count[a] = (size_t)array->count;
    array->values = NULL;
    return FFD_OK;
}

static ffd_status take_splines(grid_arrays *arrays, const char *file, const format_wish *wish,
                               lattice_spec *spec, ffd_error *error)
{
    int degree[3], closed[3] = {0};
    const bool has_degree = arrays->array[GRID_DEGREE].values;
    if (has_degree && wish->degree[0])
        return ffd_fail_file(error, FFD_E_ARGUMENT, file, "tells its degree itself: {degree} is not for it");
    if (has_degree)
        TRY(take_three(arrays, GRID_DEGREE, 1, FFD_MAX_DEGREE, degree, file, error));
    if (arrays->array[GRID_CLOSED].values)
        TRY(take_three(arrays, GRID_CLOSED, 0, 1, closed, file, error));
    for (int a = 0; a < 3; a++) {
        spec->degree[a] = has_degree ? degree[a] : spec->degree[a];
        TRY(take_knots(arrays, a, closed[a], file, spec, error));
    }
    return FFD_OK;
}

static ffd_status check_weights(const grid_array *array, const char *file, ffd_error *error)
{
    for (uint64_t i = 0; array->values && i < array->count; i++)
        if (!(array->values[i] > 0))
            return ffd_fail_file(error, FFD_E_INVALID, file, "has the weight %g, which is not positive",
                                 array->values[i]);
    return FFD_OK;
}

static double *hand_over(grid_array *array)
{
    double *const values = array->values;
    array->values = NULL;
    return values;
}

ffd_status ffd_grid_arrays_make(grid_arrays *arrays, const size_t size[3], const char *file,
                                const format_wish *wish, lattice_spec **spec, ffd_error *error)
{
    TRY(ffd_format_check_size(size, file, wish, error));
    const uint64_t count = (uint64_t)size[0] * size[1] * size[2];
    if (!arrays->array[GRID_POINTS].values)
        return ffd_fail_file(error, FFD_E_INVALID, file, "has no points");
    TRY(check_count(arrays, GRID_POINTS, 3 * count, file, error));
    TRY(check_count(arrays, GRID_OFFSETS, 3 * count, file, error));
    for (int k = GRID_WEIGHTS; k <= GRID_MOVED_WEIGHTS; k++) {
        TRY(check_count(arrays, (grid_array_kind)k, count, file, error));
        TRY(check_weights(&arrays->array[k], file, error));
    }
    TRY(ffd_format_begin_of(size, file, wish, &arrays->array[GRID_POINTS].values, spec, error));
    TRY(take_splines(arrays, file, wish, *spec, error));
    (*spec)->deformed_offsets = hand_over(&arrays->array[GRID_OFFSETS]);
    (*spec)->weights = hand_over(&arrays->array[GRID_WEIGHTS]);
    (*spec)->deformed_weights = hand_over(&arrays->array[GRID_MOVED_WEIGHTS]);
    return FFD_OK;
}

double ffd_grid_number(const unsigned char *bytes, size_t size, bool is_float, bool is_signed,
                       bool is_big_endian)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++)
        bits |= (uint64_t)bytes[is_big_endian ? size - 1 - i : i] << (8 * i);
    if (is_float && size == 8) {
        double value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    if (is_float) {
        const uint32_t low = (uint32_t)bits;
        float value;
        memcpy(&value, &low, sizeof value);
        return value;
    }
    const uint64_t top = UINT64_C(1) << (8 * size - 1);
    return is_signed && bits & top ? -(double)((~bits & (top - 1)) + 1) : (double)bits;
}

const double *ffd_grid_knots(const knot_vector *knots, size_t *count)
{
    const bool is_closed = ffd_knots_closed(knots);
    *count = knots->points + (is_closed ? 1 : (size_t)knots->degree + 1);
    return knots->t + (is_closed ? knots->degree : 0);
}
