#include "batch/manifest/lines.h"
#include "base/system/interrupt.h"
#include "base/text/content.h"
#include "base/text/stand_in.h"
#include <string.h>

ffd_status ffd_lines_open(const char *path, const char *name, line_reader *reader, ffd_error *error)
{
    *reader = (line_reader){0};
    return ffd_stream_open(path, name, &reader->stream, error);
}

static void begin_line(line_reader *reader, bool append)
{
    if (append) {
        ffd_buffer_text(&reader->line, "\n");
    } else {
        reader->line.size = 0;
        reader->too_long = false;
        reader->left_out = 0;
    }
}

/* Removes the line break, and terminates the line by 0. */
static ffd_status end_line(line_reader *reader, ffd_error *error)
{
    if (reader->line.size > 0 && reader->line.data[reader->line.size - 1] == '\r')
        reader->line.size--;
    char *end = ffd_buffer_reserve(&reader->line, 1);
    if (!end)
        return ffd_fail_memory(error);
    *end = 0;
    return FFD_OK;
}

/* Reads bytes up to the end of the line, as far as they have arrived. */
static ffd_status take_bytes(line_reader *reader, line_state *state, ffd_error *error)
{
    const char *bytes;
    size_t size;
    /* A line may be endless, so interrupts must be noticed. */
    while (ffd_stream_is_ready(reader->stream) && !ffd_interrupt_requested()) {
        TRY(ffd_stream_take(reader->stream, &bytes, &size, error));
        if (size == 0)
            return FFD_OK;
        *state = LINE_READ;
        const bool ends = bytes[size - 1] == '\n';
        const size_t length = size - ends;
        const size_t room = reader->line.size < LINE_MOST ? LINE_MOST - reader->line.size : 0;
        const size_t taken = length < room ? length : room;
        ffd_buffer_append(&reader->line, bytes, taken);
        reader->too_long = reader->too_long || taken < length;
        reader->left_out += length - taken;
        if (ends)
            return FFD_OK;
        if (reader->left_out >= LINE_LOST)
            return ffd_fail_line(error, FFD_E_INVALID, ffd_stream_name(reader->stream),
                                 (size_t)reader->count + 1, "the line does not end within %zu bytes",
                                 LINE_LOST);
    }
    *state = LINE_LATER;
    return FFD_OK;
}

ffd_status ffd_lines_next(line_reader *reader, bool append, line_state *state, ffd_error *error)
{
    if (!reader->is_partial)
        begin_line(reader, append);
    *state = reader->is_partial && reader->line.size > 0 ? LINE_READ : LINE_NONE;
    const ffd_status status = take_bytes(reader, state, error);
    reader->is_partial = *state == LINE_LATER;
    if (status || reader->is_partial)
        return status;
    reader->count += *state == LINE_READ;
    return end_line(reader, error);
}

/* Blank lines are skipped. */
static bool is_blank(const byte_buffer *line)
{
    for (size_t i = 0; i < line->size; i++)
        if (line->data[i] == 0 || !strchr(" \t\r", line->data[i]))
            return false;
    return true;
}

/* Skips a byte order mark, which some editors write. */
static void skip_mark(line_reader *reader)
{
    byte_buffer *const line = &reader->line;
    if (line->size < 3 || memcmp(line->data, "\xef\xbb\xbf", 3) != 0)
        return;
    line->size -= 3;
    memmove(line->data, line->data + 3, line->size + 1);
}

static ffd_status check_mark(line_reader *reader, ffd_error *error)
{
    const byte_buffer *const line = &reader->line;
    if (ffd_content_is_utf16(line->data, line->size))
        return ffd_fail_line(error, FFD_E_INVALID, ffd_stream_name(reader->stream), 1,
                             "is text in UTF-16: it must be UTF-8");
    skip_mark(reader);
    return FFD_OK;
}

/* Refuses a text that stands in for another with one error, not one a line. */
static ffd_status check_first(line_reader *reader, ffd_error *error)
{
    const char *const stand_in =
        reader->has_begun ? NULL : ffd_stand_in(reader->line.data, reader->line.size);
    reader->has_begun = true;
    if (!stand_in)
        return FFD_OK;
    return ffd_fail_line(error, FFD_E_INVALID, ffd_stream_name(reader->stream), (size_t)reader->count,
                         "has no jobs: it seems to be %s", stand_in);
}

ffd_status ffd_lines_next_filled(line_reader *reader, line_state *state, ffd_error *error)
{
    do {
        TRY(ffd_lines_next(reader, false, state, error));
        if (*state == LINE_READ && reader->count == 1)
            TRY(check_mark(reader, error));
    } while (*state == LINE_READ && is_blank(&reader->line));
    return *state != LINE_READ ? FFD_OK : check_first(reader, error);
}

void ffd_lines_close(line_reader *reader)
{
    ffd_stream_close(&reader->stream);
    ffd_buffer_free(&reader->line);
    *reader = (line_reader){0};
}
