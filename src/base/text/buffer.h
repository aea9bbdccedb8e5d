/* buffer.h - bytes that grow. A failed allocation is remembered, so that only the end needs a check. */
#ifndef FFD_BASE_TEXT_BUFFER_H
#define FFD_BASE_TEXT_BUFFER_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct byte_buffer {
    char *data; /* size bytes in use; not ended by 0 unless ffd_buffer_finish was called */
    size_t size, capacity;
    bool failed; /* memory ran out: everything appended since is lost */
} byte_buffer;

/* Returns where the caller can write size more bytes, and then adds what was written to the buffer's size;
   NULL if memory ran out. */
char *ffd_buffer_reserve(byte_buffer *buffer, size_t size);
/* Appends size bytes. */
void ffd_buffer_append(byte_buffer *buffer, const void *bytes, size_t size);
/* Appends a string without its final 0. */
void ffd_buffer_text(byte_buffer *buffer, const char *text);
/* Appends text as printf writes it. */
void ffd_buffer_format(byte_buffer *buffer, const char *format, ...) FFD_PRINTF(2, 3);
/* Appends the shortest text of a number (number.h). */
void ffd_buffer_number(byte_buffer *buffer, double value);
/* Appends a final 0 (not counted in size) and hands the block over (free with ffd_free); NULL if memory ran
   out. The buffer is empty afterwards. */
char *ffd_buffer_finish(byte_buffer *buffer);
/* Frees the bytes; the buffer is empty then. */
void ffd_buffer_free(byte_buffer *buffer);

#endif
