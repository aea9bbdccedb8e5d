#include "io/npy/npy.h"
#include <inttypes.h>
#include <stdio.h>
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
