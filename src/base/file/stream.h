/* stream.h - reading a file or pipe as its bytes come. */
#ifndef FFD_BASE_FILE_STREAM_H
#define FFD_BASE_FILE_STREAM_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct byte_stream byte_stream;

/* path "-": standard input. name is that in messages, and is lent. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_stream_open(const char *path, const char *name, byte_stream **stream, ffd_error *error);
/* Whether reading a byte will not wait. */
bool ffd_stream_is_ready(const byte_stream *stream);
/* Waits until that is so. */
void ffd_stream_wait(const byte_stream *stream);
/* The next byte, or -1 at the end and after a failure, which *status then reports (FFD_E_IO). Waits. */
int ffd_stream_byte(byte_stream *stream, ffd_status *status, ffd_error *error);
/* Bytes of the whole, 0 where that is not known, and of what was read. */
uint64_t ffd_stream_size(const byte_stream *stream);
/* Bytes read so far. */
uint64_t ffd_stream_position(const byte_stream *stream);
/* NULL and pointers to NULL are allowed. */
void ffd_stream_close(byte_stream **stream);

#endif
