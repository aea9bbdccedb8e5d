/* npy_read.h - reads arrays of numbers from NumPy's files, versions 1 to 3. */
#ifndef FFD_IO_NPY_NPY_READ_H
#define FFD_IO_NPY_NPY_READ_H

#include "base/file/input.h"
#include <stddef.h>

/* Reads from a file, or from bytes of that name (ffd_file_take), an array of float32 or float64 in C order as
   doubles. The product of its shape must be `numbers`, whatever its dimensions. The caller frees *values with
   ffd_free. Errors: FFD_E_INVALID for another file, type, order or size, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_npy_read(const char *path, ffd_bytes bytes, size_t numbers, double **values, ffd_error *error);

#endif
