/* buffer.h - a growing buffer of bytes. It remembers a failed allocation, so callers need to check for one
   only at the end. */
#ifndef FFD_BASE_TEXT_BUFFER_H
#define FFD_BASE_TEXT_BUFFER_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct byte_buffer {
    char *data; /* size bytes; not terminated by 0 before ffd_buffer_finish */
    size_t size, capacity;
    bool failed; /* memory ran out; what was appended since then is lost */
} byte_buffer;

/* Returns a pointer to room for size more bytes. The caller writes there, and adds the number of written
   bytes to the buffer's size. NULL if memory ran out. */
char *ffd_buffer_reserve(byte_buffer *buffer, size_t size);
/* Appends size bytes. */
void ffd_buffer_append(byte_buffer *buffer, const void *bytes, size_t size);
/* Appends a string without its final 0. */
void ffd_buffer_text(byte_buffer *buffer, const char *text);
/* Appends formatted text, as printf. */
void ffd_buffer_format(byte_buffer *buffer, const char *format, ...) FFD_PRINTF(2, 3);
/* Appends the shortest text that reads back as the same double (number.h). */
void ffd_buffer_number(byte_buffer *buffer, double value);
/* Appends a final 0, which size does not count, and returns the block, which the caller frees with ffd_free.
   NULL if memory ran out. The buffer is empty afterwards. */
char *ffd_buffer_finish(byte_buffer *buffer);
/* Frees the bytes and empties the buffer. */
void ffd_buffer_free(byte_buffer *buffer);

#endif
