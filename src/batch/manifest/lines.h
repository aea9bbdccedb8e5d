/* lines.h - reads a text file or stream line by line, with one line in memory. */
#ifndef FFD_BATCH_MANIFEST_LINES_H
#define FFD_BATCH_MANIFEST_LINES_H

#include "base/file/stream.h"
#include "base/text/buffer.h"
#include <stdbool.h>
#include <stdint.h>

/* The longest line, in bytes. */
#define LINE_MOST ((size_t)1 << 20)
/* The most bytes in which the end of a longer line is looked for. */
#define LINE_LOST ((size_t)1 << 26)

typedef struct line_reader {
    byte_stream *stream;
    uint64_t count;   /* lines read */
    byte_buffer line; /* the last line, without its line break, terminated by 0 */
    bool is_partial;  /* its rest has not arrived yet */
    bool has_begun;   /* a line that is not blank has been read */
    bool too_long;    /* only its first LINE_MOST bytes are stored */
    size_t left_out;  /* number of the others */
} line_reader;

/* Opens a file. path "-": standard input. name: for messages; must outlive the reader. Errors: FFD_E_IO. */
ffd_status ffd_lines_open(const char *path, const char *name, line_reader *reader, ffd_error *error);
typedef enum line_state {
    LINE_NONE, /* end of the text */
    LINE_READ,
    LINE_LATER /* the line is incomplete: call again with the same append */
} line_state;

/* Reads the next line, as far as it has arrived. append: add it to the current one, after a line break.
   Errors: FFD_E_IO, FFD_E_MEMORY, FFD_E_INVALID (the line does not end). */
ffd_status ffd_lines_next(line_reader *reader, bool append, line_state *state, ffd_error *error);
/* Reads the next line that is not blank. A byte order mark, which some editors write, is skipped; that of
   UTF-16 is FFD_E_INVALID. Errors: as above. */
ffd_status ffd_lines_next_filled(line_reader *reader, line_state *state, ffd_error *error);
/* Closes the file and frees the line. */
void ffd_lines_close(line_reader *reader);

#endif
