/* splice.h - writes a file's bytes with some of them replaced, in blocks. */
#ifndef FFD_IO_SPLICE_H
#define FFD_IO_SPLICE_H

#include "base/file.h"

typedef struct file_splice {
    file_output *output;
    ffd_error *error;
    ffd_status status;  /* the first failure; nothing is written after it */
    const char *copied; /* the file is copied up to here */
    char *block;
    size_t used;
} file_splice;

ffd_status ffd_splice_begin(file_splice *splice, const void *data, file_output *output, ffd_error *error);
/* Copies the file up to a place not before the last one. */
void ffd_splice_copy(file_splice *splice, const char *to);
void ffd_splice_bytes(file_splice *splice, const void *bytes, size_t size);
/* Copies up to `first` and writes bytes instead of what stands in [first, last). */
void ffd_splice_replace(file_splice *splice, const char *first, const char *last, const void *bytes,
                        size_t size);
/* Writes what is held back, frees, and tells whether all went well. To be called after ffd_splice_begin in
   every case. */
ffd_status ffd_splice_end(file_splice *splice);

#endif
