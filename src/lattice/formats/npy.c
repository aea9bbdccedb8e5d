/* npy.c - NumPy arrays of the control points. */
#include "io/npy/npy.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "lattice/formats/readers.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Control points are gathered and written in groups of this many. */
#define GROUP 512

static ffd_status find_size(const npy_array *array, const char *name, const format_wish *wish, size_t size[3],
                            ffd_error *error)
{
    const bool is_given = wish->size[0] > 0;
    if (array->dimensions == 4 && array->shape[3] == 3) {
        if (is_given && !wish->size_is_known)
            return ffd_fail_file(error, FFD_E_ARGUMENT, name, "tells its size itself: {size} is not for it");
        for (int a = 0; a < 3; a++)
            size[a] = (size_t)array->shape[a];
        return FFD_OK;
    }
    if (array->dimensions != 2 || array->shape[1] != 3)
        return ffd_fail_file(error, FFD_E_INVALID, name, "has the shape %s, not (n, 3) or (n_u, n_v, n_w, 3)",
                             array->text);
    if (!is_given)
        return ffd_fail_file(error, FFD_E_ARGUMENT, name,
                             "has %zu points in a row: give the control points along u, v and w ({size})",
                             (size_t)array->shape[0]);
    size_t left = (size_t)array->shape[0];
    bool divides = true;
    for (int a = 0; a < 3; a++) {
        size[a] = wish->size[a];
        divides = divides && left % size[a] == 0;
        left = divides ? left / size[a] : left;
    }
    if ((!divides || left != 1) && wish->size_is_known)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "has %zu points, but the lattice has %zu x %zu x %zu control points",
                             (size_t)array->shape[0], size[0], size[1], size[2]);
    if (!divides || left != 1)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "has %zu points, but {size} %zu,%zu,%zu needs another number",
                             (size_t)array->shape[0], size[0], size[1], size[2]);
    return FFD_OK;
}

/* Puts points whose last direction is the fastest in the order of a lattice. */
static ffd_status transpose(double **values, const size_t n[3], ffd_error *error)
{
    double *const points = ffd_alloc(n[0] * n[1] * n[2], 3 * sizeof *points);
    const double *from = *values;
    if (!points)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < n[0]; i++)
        for (size_t j = 0; j < n[1]; j++)
            for (size_t k = 0; k < n[2]; k++, from += 3)
                memcpy(points + 3 * (i + n[0] * (j + n[1] * k)), from, 3 * sizeof *points);
    ffd_free(*values);
    *values = points;
    return FFD_OK;
}

/* An order cannot be found of numbers that are not finite. */
static ffd_status check_finite(const double *values, const size_t n[3], const char *name, ffd_error *error)
{
    for (size_t i = 0; i < 3 * n[0] * n[1] * n[2]; i++)
        if (!isfinite(values[i]))
            return ffd_fail_file(error, FFD_E_INVALID, name, "point %zu: %c is %g, not a finite number",
                                 i / 3, "xyz"[i % 3], values[i]);
    return FFD_OK;
}

ffd_status ffd_lattice_read_npy(const file_input *file, const char *name, const format_wish *wish,
                                lattice_spec **spec, ffd_error *error)
{
    npy_array array = {0};
    size_t size[3];
    ffd_status status;
    *spec = NULL;
    TRY_END(ffd_npy_read_array(file, name, 3 * FFD_MAX_CONTROL_POINTS, &array, error));
    TRY_END(find_size(&array, name, wish, size, error));
    TRY_END(ffd_format_check_size(size, name, wish, error));
    if (array.dimensions == 4)
        TRY_END(transpose(&array.values, size, error));
    if (wish->finds_order) {
        TRY_END(check_finite(array.values, size, name, error));
        TRY_END(ffd_points_order(&array.values, 1, size, array.dimensions == 2, name, wish, error));
    }
    TRY_END(ffd_format_begin_of(size, name, wish, &array.values, spec, error));
end:
    ffd_free(array.values);
    return status;
}

ffd_status ffd_lattice_write_npy(const ffd_lattice *lattice, file_output *output, ffd_error *error)
{
    char shape[80], header[NPY_HEADER_CAPACITY];
    unsigned char group[3 * GROUP][8];
    const size_t *const n = lattice->size;
    size_t filled = 0;
    snprintf(shape, sizeof shape, "(%zu, %zu, %zu, 3)", n[0], n[1], n[2]);
    TRY(ffd_output_write(output, header, ffd_npy_header_of("<f8", shape, header), error));
    for (size_t at = 0; at < lattice->count; at++) {
        const size_t i = at / (n[1] * n[2]), j = at / n[2] % n[1], k = at % n[2];
        for (size_t c = 0; c < 3; c++)
            store_double(group[filled++], lattice->rest[3 * (i + n[0] * (j + n[1] * k)) + c]);
        if (filled == 3 * GROUP || at + 1 == lattice->count) {
            TRY(ffd_output_write(output, group, filled * sizeof *group, error));
            filled = 0;
        }
    }
    return FFD_OK;
}
