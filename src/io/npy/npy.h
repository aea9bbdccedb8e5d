/* npy.h - NumPy's array file, version 1.0. */
#ifndef FFD_IO_NPY_NPY_H
#define FFD_IO_NPY_NPY_H

#include "base/file/output.h"

/* Capacity that is enough for every header below. */
#define NPY_HEADER_CAPACITY 256

/* Makes the header of a C-order array of rows x columns values (columns 0: one-dimensional); descr is NumPy's
   ("<f8", "|u1"). Returns its length, a multiple of 64. */
size_t ffd_npy_header(const char *descr, size_t rows, size_t columns, char header[NPY_HEADER_CAPACITY]);

/* The same for an array of any shape, as NumPy writes it: "()", "(2, 3, 4)". */
size_t ffd_npy_header_of(const char *descr, const char *shape, char header[NPY_HEADER_CAPACITY]);

/* Writes that header. The values follow by ffd_output_write. */
ffd_status ffd_npy_begin(file_output *output, const char *descr, size_t rows, size_t columns,
                         ffd_error *error);

/* Whether data starts with the header that ffd_npy_header makes for this array, to the byte; *values is then
   the offset of the first value. Headers with the same meaning but other text are not recognized. */
bool ffd_npy_starts(const unsigned char *data, size_t size, const char *descr, size_t rows, size_t columns,
                    size_t *values);

#endif
