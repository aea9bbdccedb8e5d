/* npy.h - NumPy's array file: writes version 1.0, reads versions 1 to 3. */
#ifndef FFD_IO_NPY_NPY_H
#define FFD_IO_NPY_NPY_H

#include "base/fail.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include <stddef.h>

/* A capacity for every header below. */
#define NPY_HEADER_CAPACITY 256

/* Makes the header of a C-order array of rows x columns values (columns 0: one-dimensional). descr is NumPy's
   ("<f8", "|u1"). Returns the length of the header, a multiple of 64. */
size_t ffd_npy_header(const char *descr, uint64_t rows, size_t columns, char header[NPY_HEADER_CAPACITY]);

/* The same for an array of any shape, which is written as in NumPy: "()", "(2, 3, 4)". */
size_t ffd_npy_header_of(const char *descr, const char *shape, char header[NPY_HEADER_CAPACITY]);

/* Writes the header. The caller then writes the values with ffd_output_write. */
ffd_status ffd_npy_begin(file_output *output, const char *descr, size_t rows, size_t columns,
                         ffd_error *error);

/* Whether data starts with exactly the bytes of the header that ffd_npy_header makes for this array; *values
   is then the offset of the first value. Headers of the same meaning but with other text are not
   recognized. */
bool ffd_npy_starts(const unsigned char *data, size_t size, const char *descr, size_t rows, size_t columns,
                    size_t *values);

/* Reads from a file, or from bytes of that name (ffd_file_take), an array of float32 or float64 in C order as
   doubles. The product of its shape must be `count`, whatever its dimensions. The caller frees *values with
   ffd_free. Errors: FFD_E_INVALID for another file, type, order or size, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_npy_read(const char *path, ffd_bytes bytes, size_t count, double **values, ffd_error *error);

/* Reads likewise an array of the shape (count) or (count, 1), into values. Errors: FFD_E_INVALID for another
   file, type, shape or size, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_npy_read_column(const char *path, ffd_bytes bytes, size_t count, double *values,
                               ffd_error *error);

#define NPY_DIMENSIONS 4

typedef struct npy_array {
    size_t dimensions; /* those above NPY_DIMENSIONS count, but their sizes are not in shape */
    uint64_t shape[NPY_DIMENSIONS];
    char text[200]; /* the shape as the file has it, shortened */
    double *values; /* in C order; freed by the caller with ffd_free */
} npy_array;

/* Reads an array of float32 or float64 in C or Fortran order. name: for messages. Errors: FFD_E_INVALID, also
   where the file has more bytes than the array; FFD_E_LIMIT for more than `most` numbers; FFD_E_MEMORY. */
ffd_status ffd_npy_read_array(const file_input *file, const char *name, uint64_t most, npy_array *array,
                              ffd_error *error);

/* An array of any type, where it is. */
typedef struct npy_view {
    char kind;   /* 'f', 'i', 'u', 'S' (bytes) or another letter of NumPy */
    size_t size; /* of an element, in bytes */
    bool is_big_endian, is_fortran;
    size_t dimensions; /* as of npy_array */
    uint64_t shape[NPY_DIMENSIONS], count;
    const unsigned char *values; /* count elements, in the file */
} npy_view;

/* Finds an array in a file that must outlive the view. Errors: FFD_E_INVALID, also where the file has more or
   fewer bytes than the array. */
ffd_status ffd_npy_view(const file_input *file, const char *name, npy_view *view, ffd_error *error);

#endif
