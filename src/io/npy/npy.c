#include "io/npy/npy.h"
#include "base/memory/memory.h"
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The header is padded so that the values start at a multiple of this (NumPy format 1.0). */
#define ALIGNMENT 64

size_t ffd_npy_header(const char *descr, uint64_t rows, size_t columns, char header[NPY_HEADER_CAPACITY])
{
    char shape[64];
    if (columns)
        snprintf(shape, sizeof shape, "(%" PRIu64 ", %zu)", rows, columns);
    else
        snprintf(shape, sizeof shape, "(%" PRIu64 ",)", rows);
    return ffd_npy_header_of(descr, shape, header);
}

size_t ffd_npy_header_of(const char *descr, const char *shape, char header[NPY_HEADER_CAPACITY])
{
    const size_t prefix = 10; /* magic string, version, length of the text */
    int length = snprintf(header + prefix, NPY_HEADER_CAPACITY - prefix,
                          "{'descr': '%s', 'fortran_order': False, 'shape': %s, }", descr, shape);
    size_t size = prefix + (size_t)length;
    while ((size + 1) % ALIGNMENT != 0)
        header[size++] = ' ';
    header[size++] = '\n';
    memcpy(header, "\x93NUMPY\x01\x00", 8);
    header[8] = (char)((size - prefix) & 0xff);
    header[9] = (char)((size - prefix) >> 8);
    return size;
}

ffd_status ffd_npy_begin(file_output *output, const char *descr, size_t rows, size_t columns,
                         ffd_error *error)
{
    char header[NPY_HEADER_CAPACITY];
    return ffd_output_write(output, header, ffd_npy_header(descr, rows, columns, header), error);
}

bool ffd_npy_starts(const unsigned char *data, size_t size, const char *descr, size_t rows, size_t columns,
                    size_t *values)
{
    char header[NPY_HEADER_CAPACITY];
    *values = ffd_npy_header(descr, rows, columns, header);
    return size >= *values && memcmp(data, header, *values) == 0;
}

/* What the header of an array says. */
typedef struct npy_header {
    char descr[8];
    char shape[200];
    uint64_t sizes[NPY_DIMENSIONS];
    size_t dimensions;
    bool is_fortran;
    uint64_t count;
    size_t values; /* offset of the first value */
} npy_header;

/* Returns the text after 'KEY': in the header; NULL if there is no such key. */
static const char *find_value(const char *text, const char *key)
{
    char quoted[32];
    snprintf(quoted, sizeof quoted, "'%s':", key);
    const char *const at = strstr(text, quoted);
    return at ? at + strlen(quoted) + strspn(at + strlen(quoted), " ") : NULL;
}

/* Reads a shape like "(3, 4)": the product of its numbers. */
static bool read_shape(const char *text, npy_header *header)
{
    header->count = 1;
    for (const char *c = text + 1; *c && *c != ')';) {
        char *end;
        const uint64_t size = strtoull(c, &end, 10);
        if (end == c || *c == '-' || (size > 0 && header->count > UINT64_MAX / size))
            return false;
        header->count *= size;
        if (header->dimensions < NPY_DIMENSIONS)
            header->sizes[header->dimensions] = size;
        header->dimensions++;
        c = end + strspn(end, ", L");
    }
    const size_t length = strcspn(text, ")");
    snprintf(header->shape, sizeof header->shape, "%.*s)", (int)(length < 150 ? length : 150), text);
    return true;
}

/* Reads the header. Returns false if the file is not an array file, or one of an unknown version. */
static bool read_header(const file_input *file, npy_header *header)
{
    char text[1024];
    const unsigned char *const data = file->data;
    if (file->size < 12 || memcmp(data, "\x93NUMPY", 6) != 0 || data[6] < 1 || data[6] > 3)
        return false;
    const size_t prefix = data[6] == 1 ? 10 : 12;
    const size_t length =
        data[8] | (size_t)data[9] << 8 | (data[6] == 1 ? 0 : (size_t)data[10] << 16 | (size_t)data[11] << 24);
    if (length > file->size - prefix || length >= sizeof text)
        return false;
    memcpy(text, data + prefix, length);
    text[length] = 0;
    header->values = prefix + length;
    const char *const descr = find_value(text, "descr"), *const order = find_value(text, "fortran_order");
    const char *const shape = find_value(text, "shape");
    if (!descr || *descr != '\'' || !order || !shape || *shape != '(')
        return false;
    header->is_fortran = strncmp(order, "True", 4) == 0;
    if (!header->is_fortran && strncmp(order, "False", 5) != 0)
        return false;
    snprintf(header->descr, sizeof header->descr, "%.*s", (int)strcspn(descr + 1, "'"), descr + 1);
    return read_shape(shape, header);
}

static double number_at(const unsigned char *from, size_t size, bool swapped)
{
    unsigned char bytes[8];
    double wide;
    float narrow;
    for (size_t i = 0; i < size; i++)
        bytes[i] = from[swapped ? size - 1 - i : i];
    if (size == sizeof wide) {
        memcpy(&wide, bytes, sizeof wide);
        return wide;
    }
    memcpy(&narrow, bytes, sizeof narrow);
    return narrow;
}

static bool is_little_endian(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

/* Returns the bytes of a number; 0 for a type that is none of floating point. */
static size_t number_size(const npy_header *header)
{
    const char *const type = header->descr + 1;
    return !header->descr[0] || !strchr("<>=|", header->descr[0]) ? 0
           : strcmp(type, "f8") == 0                              ? 8
           : strcmp(type, "f4") == 0                              ? 4
                                                                  : 0;
}

static ffd_status refuse_type(const char *path, const npy_header *header, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_INVALID, path, "has numbers of type %s, not float32 or float64",
                         header->descr);
}

/* Copies count numbers in the order of the file, which has so many. */
static void copy_values(const file_input *file, const npy_header *header, size_t count, double *values)
{
    const size_t size = number_size(header);
    const unsigned char *const from = file->data + header->values;
    const bool little = header->descr[0] == '<' || (header->descr[0] != '>' && is_little_endian());
    const bool swapped = little != is_little_endian();
    if (!swapped && size == sizeof *values)
        memcpy(values, from, count * sizeof *values);
    for (size_t i = 0; i < count && !swapped && size == sizeof(float); i++) {
        float narrow;
        memcpy(&narrow, from + i * sizeof narrow, sizeof narrow);
        values[i] = narrow;
    }
    for (size_t i = 0; i < count && swapped; i++)
        values[i] = number_at(from + i * size, size, true);
}

/* Reads count numbers, which the file has. */
static ffd_status take_values(const file_input *file, const npy_header *header, size_t count, double **values,
                              ffd_error *error)
{
    *values = ffd_alloc(count, sizeof **values);
    if (!*values)
        return ffd_fail_memory(error);
    copy_values(file, header, count, *values);
    return FFD_OK;
}

static ffd_status read_values(const char *path, const file_input *file, size_t count, double **values,
                              ffd_error *error)
{
    npy_header header = {.descr = ""};
    if (!read_header(file, &header) || header.is_fortran)
        return ffd_fail_file(error, FFD_E_INVALID, path, "is not a NumPy array file (.npy) in C order");
    const size_t size = number_size(&header);
    if (size == 0)
        return refuse_type(path, &header, error);
    if (header.count != count)
        return ffd_fail_file(error, FFD_E_INVALID, path, "has the shape %s, and %zu numbers are needed",
                             header.shape, count);
    if ((file->size - header.values) / size < count)
        return ffd_fail_file(error, FFD_E_INVALID, path, "ends early: %zu numbers are needed", count);
    return take_values(file, &header, count, values, error);
}

/* Puts numbers whose first index is the fastest in C order. */
static ffd_status transpose(npy_array *array, size_t count, ffd_error *error)
{
    double *const values = ffd_alloc(count, sizeof *values);
    size_t index[NPY_DIMENSIONS] = {0};
    if (!values)
        return ffd_fail_memory(error);
    for (size_t from = 0; from < count; from++) {
        size_t to = 0, d = 0;
        for (size_t k = 0; k < array->dimensions; k++)
            to = to * (size_t)array->shape[k] + index[k];
        values[to] = array->values[from];
        while (d < array->dimensions && ++index[d] == array->shape[d])
            index[d++] = 0;
    }
    ffd_free(array->values);
    array->values = values;
    return FFD_OK;
}

ffd_status ffd_npy_read_array(const file_input *file, const char *name, uint64_t most, npy_array *array,
                              ffd_error *error)
{
    npy_header header = {.descr = ""};
    *array = (npy_array){0};
    if (!read_header(file, &header))
        return ffd_fail_file(error, FFD_E_INVALID, name, "is not a NumPy array file (.npy)");
    const size_t size = number_size(&header);
    if (size == 0)
        return refuse_type(name, &header, error);
    array->dimensions = header.dimensions;
    memcpy(array->shape, header.sizes, sizeof array->shape);
    snprintf(array->text, sizeof array->text, "%s", header.shape);
    if (header.count > most)
        return ffd_fail_file(error, FFD_E_LIMIT, name, "has the shape %s: more than %" PRIu64 " numbers",
                             header.shape, most);
    const size_t count = (size_t)header.count, bytes = file->size - header.values;
    if (bytes / size < count || bytes > count * size)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "has %zu bytes of numbers, but the shape %s needs %zu", bytes, header.shape,
                             count * size);
    TRY(take_values(file, &header, count, &array->values, error));
    return header.is_fortran && header.dimensions <= NPY_DIMENSIONS ? transpose(array, count, error) : FFD_OK;
}

ffd_status ffd_npy_read(const char *path, ffd_bytes bytes, size_t count, double **values, ffd_error *error)
{
    file_input file;
    *values = NULL;
    TRY(ffd_file_take(path, bytes, &file, error));
    ffd_status status = read_values(path, &file, count, values, error);
    ffd_file_unload(&file);
    return status;
}

ffd_status ffd_npy_view(const file_input *file, const char *name, npy_view *view, ffd_error *error)
{
    npy_header header = {.descr = ""};
    if (!read_header(file, &header) || !header.descr[0] || !header.descr[1])
        return ffd_fail_file(error, FFD_E_INVALID, name, "is not a NumPy array file (.npy)");
    *view = (npy_view){.kind = header.descr[1],
                       .size = strtoull(header.descr + 2, NULL, 10),
                       .is_big_endian = header.descr[0] == '>',
                       .is_fortran = header.is_fortran,
                       .dimensions = header.dimensions,
                       .count = header.count,
                       .values = file->data + header.values};
    memcpy(view->shape, header.sizes, sizeof view->shape);
    const size_t bytes = file->size - header.values;
    if (view->size == 0 || view->count > bytes / view->size || view->count * view->size != bytes)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "has %zu bytes, which are not those of an array %s of %s", bytes, header.shape,
                             header.descr);
    return FFD_OK;
}

/* Reads a column from a loaded file. */
static ffd_status read_column(const char *path, const file_input *file, size_t count, double *values,
                              ffd_error *error)
{
    npy_header header = {.descr = ""};
    if (!read_header(file, &header))
        return ffd_fail_file(error, FFD_E_INVALID, path, "is not a NumPy array file (.npy)");
    const size_t size = number_size(&header), bytes = file->size - header.values;
    if (size == 0)
        return refuse_type(path, &header, error);
    const bool is_column = header.dimensions == 1 || (header.dimensions == 2 && header.sizes[1] == 1);
    if (!is_column || header.sizes[0] != count)
        return ffd_fail_file(error, FFD_E_INVALID, path, "has the shape %s, and (%zu,) or (%zu, 1) is needed",
                             header.shape, count, count);
    if (bytes / size < count || bytes > count * size)
        return ffd_fail_file(error, FFD_E_INVALID, path,
                             "has %zu bytes of numbers, but the shape %s needs %zu", bytes, header.shape,
                             count * size);
    copy_values(file, &header, count, values);
    return FFD_OK;
}

ffd_status ffd_npy_read_column(const char *path, ffd_bytes bytes, size_t count, double *values,
                               ffd_error *error)
{
    file_input file;
    TRY(ffd_file_take(path, bytes, &file, error));
    const ffd_status status = read_column(path, &file, count, values, error);
    ffd_file_unload(&file);
    return status;
}
