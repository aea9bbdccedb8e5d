/* npy.h - NumPy's array file, version 1.0. */
#ifndef FFD_IO_NPY_NPY_H
#define FFD_IO_NPY_NPY_H

#include "base/file.h"
#include <stdint.h>

/* Writes the header of a C-order array of rows x columns (columns 0: one-dimensional) little-endian values;
   descr is NumPy's ("<f8", "|u1"). The values follow by ffd_output_write. */
ffd_status ffd_npy_begin(file_output *output, const char *descr, size_t rows, size_t columns,
                         ffd_error *error);

#endif
