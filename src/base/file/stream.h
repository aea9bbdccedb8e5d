/* stream.h - reads a file or pipe as data arrive. */
#ifndef FFD_BASE_FILE_STREAM_H
#define FFD_BASE_FILE_STREAM_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct byte_stream byte_stream;

/* Opens path as ffd_file_open does (input.h). name is for messages and must outlive the stream. Errors:
   FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_stream_open(const char *path, const char *name, byte_stream **stream, ffd_error *error);
/* Returns whether a byte can be read without blocking. */
bool ffd_stream_is_ready(const byte_stream *stream);
/* Waits until a byte can be read. */
void ffd_stream_wait(const byte_stream *stream);
/* Takes the next bytes that have arrived, up to the end of a line, with its line feed; blocks until there is
   one. *bytes: borrowed until the next call; *size: 0 at the end. Errors: FFD_E_IO. */
ffd_status ffd_stream_take(byte_stream *stream, const char **bytes, size_t *size, ffd_error *error);
/* Returns its descriptor, to wait for bytes. */
int ffd_stream_descriptor(const byte_stream *stream);
/* Returns the name of the stream for messages. */
const char *ffd_stream_name(const byte_stream *stream);
/* Returns the size of the whole stream in bytes; 0 if unknown. */
uint64_t ffd_stream_size(const byte_stream *stream);
/* Returns the number of bytes read so far. */
uint64_t ffd_stream_position(const byte_stream *stream);
/* Closes the stream and sets *stream to NULL. stream and *stream may be NULL. */
void ffd_stream_close(byte_stream **stream);

#endif
