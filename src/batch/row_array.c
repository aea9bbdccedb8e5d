#include "batch/row_array.h"
#include "base/file/input.h"
#include "base/file/update.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/system/clock.h"
#include "base/system/interrupt.h"
#include "io/npy/npy.h"
#include "job/report/replace.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Bytes per read or write: whole vertices of either number type. */
#define PIECE ((size_t)3 * 8 * 4096)

/* Seconds between checks of a file that another run is making. */
#define POLL 0.02

static size_t number_size(const row_array *array)
{
    return array->is_double ? 8 : 4;
}

static size_t vertex_size(const row_array *array)
{
    return 3 * number_size(array);
}

/* No overflow: ffd_rows_check_size was called. */
static uint64_t row_size(const row_array *array)
{
    return array->vertices * vertex_size(array);
}

static size_t make_head(const row_array *array, char head[NPY_HEADER_CAPACITY])
{
    char shape[80];
    snprintf(shape, sizeof shape, "(%" PRIu64 ", %" PRIu64 ", 3)", array->rows, array->vertices);
    return ffd_npy_header_of(array->is_double ? "<f8" : "<f4", shape, head);
}

ffd_status ffd_rows_check_size(const row_array *array, ffd_error *error)
{
    const uint64_t most = INT64_MAX - NPY_HEADER_CAPACITY, vertex = vertex_size(array);
    if (array->vertices <= most / vertex && (row_size(array) == 0 || array->rows <= most / row_size(array)))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_LIMIT, array->path,
                         "%" PRIu64 " rows of %" PRIu64 " vertices are more than a file can have",
                         array->rows, array->vertices);
}

static uint64_t row_begin(const row_array *array, uint64_t row)
{
    char head[NPY_HEADER_CAPACITY];
    return make_head(array, head) + row * row_size(array);
}

/* Opens the file, if it is this array. */
static ffd_status open_array(const row_array *array, update_file **file, ffd_error *error)
{
    char head[NPY_HEADER_CAPACITY], found[NPY_HEADER_CAPACITY];
    const size_t length = make_head(array, head);
    uint64_t size;
    TRY(ffd_update_open_there(array->path, file, error));
    if (ffd_update_size(*file, &size) && size == length + array->rows * row_size(array) &&
        ffd_update_read(*file, 0, found, length) && memcmp(found, head, length) == 0)
        return FFD_OK;
    ffd_update_close(file);
    return ffd_fail_file(error, FFD_E_EXISTS, array->path,
                         "is there, and is not an array of %" PRIu64 " x %" PRIu64 " x 3 %s numbers",
                         array->rows, array->vertices, array->is_double ? "float64" : "float32");
}

ffd_status ffd_rows_find(const row_array *array, bool *is_there, ffd_error *error)
{
    update_file *file;
    *is_there = ffd_file_exists(array->path);
    if (!*is_there)
        return FFD_OK;
    TRY(open_array(array, &file, error));
    ffd_update_close(&file);
    return FFD_OK;
}

/* Fills bytes with NaNs of the array's number type. */
static void fill_nan(const row_array *array, unsigned char *bytes, size_t size)
{
    for (size_t i = 0; i < size; i += number_size(array))
        if (array->is_double)
            store_double(bytes + i, NAN);
        else
            store_float(bytes + i, NAN);
}

static size_t piece_of(uint64_t left)
{
    return left < PIECE ? (size_t)left : PIECE;
}

static ffd_status write_empty(const row_array *array, file_output *output, ffd_error *error)
{
    char head[NPY_HEADER_CAPACITY];
    unsigned char *const nan = ffd_alloc(PIECE, 1);
    if (!nan)
        return ffd_fail_memory(error);
    fill_nan(array, nan, PIECE);
    ffd_status status;
    TRY_END(ffd_output_write(output, head, make_head(array, head), error));
    for (uint64_t left = array->rows * row_size(array); left > 0 && !ffd_interrupt_requested();
         left -= piece_of(left))
        TRY_END(ffd_output_write(output, nan, piece_of(left), error));
end:
    ffd_free(nan);
    return status;
}

/* *busy: another run is writing the file. */
static ffd_status begin(const row_array *array, bool force, file_output **made, bool *busy, ffd_error *error)
{
    *busy = false;
    TRY(ffd_output_create(made, error));
    ffd_status status;
    TRY_END(ffd_output_begin(*made, array->path, force, error));
    TRY_END(write_empty(array, *made, error));
end:
    *busy = status && ffd_output_was_busy(*made);
    if (status || ffd_interrupt_requested())
        ffd_output_destroy(made);
    return status;
}

static bool is_npy(const file_input *old)
{
    static const char magic[] = "\x93NUMPY";
    return old->size >= sizeof magic - 1 && memcmp(old->data, magic, sizeof magic - 1) == 0;
}

ffd_status ffd_rows_check_replaced(const row_array *array, ffd_error *error)
{
    return ffd_replace_check(array->path, is_npy, "NumPy array", error);
}

ffd_status ffd_rows_make(const row_array *array, bool force, file_output **made, ffd_error *error)
{
    bool busy, is_there = false;
    ffd_status status = begin(array, force, made, &busy, error);
    while (busy && !force && !is_there && !ffd_interrupt_requested()) {
        ffd_clock_sleep(POLL);
        status = ffd_rows_find(array, &is_there, error);
        if (!status && !is_there)
            status = begin(array, force, made, &busy, error);
        else
            busy = false;
    }
    if (busy && ffd_interrupt_requested())
        return FFD_OK;
    /* Another run has made it meanwhile. */
    return status == FFD_E_EXISTS && !force ? ffd_rows_find(array, &is_there, error) : status;
}

ffd_status ffd_rows_place(const row_array *array, bool force, file_output **made, ffd_error *error)
{
    bool is_there;
    const ffd_status status = *made ? ffd_output_commit(*made, error) : FFD_OK;
    ffd_output_destroy(made);
    return status == FFD_E_EXISTS && !force ? ffd_rows_find(array, &is_there, error) : status;
}

bool ffd_row_is_done(const row_array *array, uint64_t row)
{
    update_file *file;
    unsigned char number[8];
    if (!array->vertices || open_array(array, &file, NULL))
        return false;
    const bool is_read = ffd_update_read(file, row_begin(array, row), number, number_size(array));
    ffd_update_close(&file);
    return is_read && !(array->is_double ? isnan(load_double(number)) : isnan(load_float(number)));
}

static ffd_status fail_writing(const row_array *array, ffd_error *error)
{
    return ffd_fail_errno(error, array->path, "cannot be written");
}

/* Sets the first vertex of a row to NaN, so that the rest does not count as positions. */
static bool unmark(const row_array *array, uint64_t row, update_file *file)
{
    unsigned char nan[24];
    fill_nan(array, nan, vertex_size(array));
    return array->vertices == 0 || ffd_update_write(file, row_begin(array, row), nan, vertex_size(array));
}

ffd_status ffd_row_check(const row_array *array, const double *positions, size_t count, ffd_error *error)
{
    if (count != array->vertices)
        return ffd_fail(error, FFD_E_INVALID,
                        "has %zu vertices, but a row of %s is of %" PRIu64 ", as many as the first mesh has",
                        count, array->path, array->vertices);
    for (size_t i = 0; i < 3 * count && !array->is_double; i++)
        if (isinf((float)positions[i]) && isfinite(positions[i]))
            return ffd_fail(error, FFD_E_INVALID,
                            "the deformed position of vertex %zu is too large for the float32 numbers of %s "
                            "({dtype=f8})",
                            i / 3, array->path);
    return FFD_OK;
}

/* Converts numbers to the array's number type. */
static void store_numbers(const row_array *array, const double *numbers, size_t count, unsigned char *bytes)
{
    for (size_t i = 0; i < count; i++)
        if (array->is_double)
            store_double(bytes + 8 * i, numbers[i]);
        else
            store_float(bytes + 4 * i, (float)numbers[i]);
}

/* Writes the vertices from `first` on. */
static ffd_status write_vertices(const row_array *array, uint64_t row, update_file *file,
                                 const double *positions, size_t first, size_t count, unsigned char *piece,
                                 ffd_error *error)
{
    const size_t step = PIECE / vertex_size(array);
    for (size_t i = first, n; i < count; i += n) {
        n = count - i < step ? count - i : step;
        store_numbers(array, positions + 3 * i, 3 * n, piece);
        if (!ffd_update_write(file, row_begin(array, row) + i * vertex_size(array), piece,
                              n * vertex_size(array)))
            return fail_writing(array, error);
    }
    return FFD_OK;
}

static ffd_status write_row(const row_array *array, uint64_t row, update_file *file, const double *positions,
                            ffd_error *error)
{
    const size_t count = (size_t)array->vertices;
    unsigned char *const piece = ffd_alloc(PIECE, 1);
    if (!piece)
        return ffd_fail_memory(error);
    ffd_status status;
    TRY_END(unmark(array, row, file) ? FFD_OK : fail_writing(array, error));
    if (count > 1)
        TRY_END(write_vertices(array, row, file, positions, 1, count, piece, error));
    if (count > 0)
        TRY_END(write_vertices(array, row, file, positions, 0, 1, piece, error));
end:
    ffd_free(piece);
    return status;
}

ffd_status ffd_row_write(const row_array *array, uint64_t row, const double *positions, size_t count,
                         ffd_error *error)
{
    update_file *file;
    TRY(ffd_row_check(array, positions, count, error));
    TRY(open_array(array, &file, error));
    ffd_status status = write_row(array, row, file, positions, error);
    ffd_update_close(&file);
    return status;
}

void ffd_row_clear(const row_array *array, uint64_t row)
{
    update_file *file;
    if (open_array(array, &file, NULL))
        return;
    unsigned char *const nan = ffd_alloc(PIECE, 1);
    bool written = unmark(array, row, file) && nan;
    if (nan)
        fill_nan(array, nan, PIECE);
    for (uint64_t left = row_size(array), at = row_begin(array, row); left > 0 && written;) {
        const size_t size = piece_of(left);
        written = ffd_update_write(file, at, nan, size);
        at += size;
        left -= size;
    }
    ffd_free(nan);
    ffd_update_close(&file);
}

static bool hash_bytes(const row_array *array, uint64_t row, const update_file *file, unsigned char *piece,
                       hash_stream *stream)
{
    bool is_read = true;
    for (uint64_t left = row_size(array), at = row_begin(array, row); left > 0 && is_read;) {
        const size_t size = piece_of(left);
        is_read = ffd_update_read(file, at, piece, size);
        if (is_read)
            ffd_hash_stream_add(stream, piece, size);
        at += size;
        left -= size;
    }
    return is_read;
}

ffd_status ffd_row_hash(const row_array *array, uint64_t row, hash128 *hash, ffd_error *error)
{
    update_file *file;
    TRY(open_array(array, &file, error));
    unsigned char *const piece = ffd_alloc(PIECE, 1);
    hash_stream *const stream = ffd_hash_stream_create();
    ffd_status status = FFD_OK;
    if (!piece || !stream)
        status = ffd_fail_memory(error);
    else if (!hash_bytes(array, row, file, piece, stream))
        status = ffd_fail_errno(error, array->path, "cannot be read");
    else
        *hash = ffd_hash_stream_value(stream);
    ffd_free(stream);
    ffd_free(piece);
    ffd_update_close(&file);
    return status;
}
