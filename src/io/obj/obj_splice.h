/* obj_splice.h - writes a file's bytes with some of them replaced, in blocks. */
#ifndef FFD_IO_OBJ_OBJ_SPLICE_H
#define FFD_IO_OBJ_OBJ_SPLICE_H

#include "base/file.h"
#include "io/obj/obj_scan.h"

typedef struct obj_splice {
    file_output *output;
    ffd_error *error;
    ffd_status status;  /* the first failure; nothing is written after it */
    const char *copied; /* the file is copied up to here */
    char *block;
    size_t used;
} obj_splice;

ffd_status ffd_obj_splice_begin(obj_splice *splice, const void *data, file_output *output, ffd_error *error);
/* Copies the file up to a place not before the last one. */
void ffd_obj_splice_copy(obj_splice *splice, const char *to);
void ffd_obj_splice_text(obj_splice *splice, const char *text, size_t size);
/* Copies up to the word and writes text or a number in its stead. */
void ffd_obj_splice_word(obj_splice *splice, obj_word word, const char *text, size_t size);
void ffd_obj_splice_number(obj_splice *splice, obj_word word, double value);
/* Writes what is held back, frees, and tells whether all went well. */
ffd_status ffd_obj_splice_end(obj_splice *splice);

#endif
