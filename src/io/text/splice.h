/* splice.h - writes a file with some of its bytes replaced, in blocks. */
#ifndef FFD_IO_TEXT_SPLICE_H
#define FFD_IO_TEXT_SPLICE_H

#include "base/file/output.h"
#include "base/text/buffer.h"
#include "base/text/decimal.h"
#include "base/text/text_scan.h"
#include "io/text/file_document.h"

typedef struct file_splice {
    const file_document *document; /* NULL in a part */
    file_output *output;
    ffd_error *error;
    ffd_status status;         /* the first failure; nothing is written after it */
    const char *copied, *last; /* the file is copied up to here; the file's end */
    size_t released;           /* bytes of the file whose mmap pages are released (ffd_file_release_until) */
    byte_buffer *text;         /* in a part: the buffer for its bytes; NULL: they go to output */
} file_splice;

/* Begins the output that options name. ffd_splice_end must follow; it returns any failure. */
void ffd_splice_begin(file_splice *splice, const file_document *document, const mesh_save_options *options,
                      file_output *output, ffd_error *error);
/* Begins a part [first, last) of the file; its bytes are appended to text, so that threads can splice parts
   in parallel. ffd_splice_end must follow. */
void ffd_splice_begin_part(file_splice *splice, const char *first, const char *last, byte_buffer *text,
                           ffd_error *error);
/* Writes a finished part in place of the file's bytes [first, last). text NULL: writes the file's bytes. */
void ffd_splice_part(file_splice *splice, const char *first, const char *last, const byte_buffer *text);
/* Copies the file up to a position, which must not be before the last one. */
void ffd_splice_copy(file_splice *splice, const char *to);
/* Inserts bytes that the file does not have. */
void ffd_splice_bytes(file_splice *splice, const void *bytes, size_t size);
/* Copies the file up to a word, and writes other bytes in its place. A word that is not behind the last one
   ends in FFD_E_IO: another program has changed the file since it was read. */
void ffd_splice_replace(file_splice *splice, text_word word, const void *bytes, size_t size);
/* Replaces words by count numbers, at most 32: those whose bit is set in changes. run: the decimal_run of the
   array with the numbers, or NULL. */
void ffd_splice_numbers(file_splice *splice, const text_word *words, const double *numbers, unsigned changes,
                        size_t count, decimal_run *run);
/* Copies the rest of the file and releases its pages. Returns the first failure, if any. */
ffd_status ffd_splice_end(file_splice *splice);

#endif
