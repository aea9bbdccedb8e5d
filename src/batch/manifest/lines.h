/* lines.h - a text file or stream line by line, in the memory of one line. */
#ifndef FFD_BATCH_MANIFEST_LINES_H
#define FFD_BATCH_MANIFEST_LINES_H

#include "base/file/stream.h"
#include "base/text/buffer.h"
#include <stdbool.h>
#include <stdint.h>

/* Longest line, in bytes. */
#define LINE_MOST ((size_t)1 << 20)

typedef struct line_reader {
    byte_stream *stream;
    uint64_t number;  /* of the line read last, from 1 */
    byte_buffer line; /* the line read last, without its line break, with a 0 after it */
    bool is_partial;  /* the rest of it has not come yet */
    bool too_long;    /* only its first LINE_MOST bytes are there */
} line_reader;

/* path "-": standard input. name must outlive the reader. Errors: FFD_E_IO. */
ffd_status ffd_lines_open(const char *path, const char *name, line_reader *reader, ffd_error *error);
typedef enum line_state {
    LINE_NONE, /* there are no more */
    LINE_READ,
    LINE_LATER /* the line is not complete yet: call again with the same append */
} line_state;

/* Reads the next line, as far as it has come. append: to what is there, after a line break. Errors:
   FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_lines_next(line_reader *reader, bool append, line_state *state, ffd_error *error);
/* Closes the file, and frees the line. */
void ffd_lines_close(line_reader *reader);

#endif
