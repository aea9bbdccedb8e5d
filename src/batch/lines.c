#include "batch/lines.h"
#include <string.h>

ffd_status ffd_lines_open(const char *path, const char *name, line_reader *reader, ffd_error *error)
{
    *reader = (line_reader){0};
    return ffd_stream_open(path, name, &reader->stream, error);
}

ffd_status ffd_lines_next(line_reader *reader, bool append, bool *more, ffd_error *error)
{
    int c;
    ffd_status status;
    if (append) {
        ffd_buffer_text(&reader->line, "\n");
    } else {
        reader->line.size = 0;
        reader->too_long = false;
    }
    *more = false;
    while ((c = ffd_stream_byte(reader->stream, &status, error)) >= 0) {
        const char byte = (char)c;
        *more = true;
        if (byte == '\n')
            break;
        if (reader->line.size < LINE_MOST)
            ffd_buffer_append(&reader->line, &byte, 1);
        else
            reader->too_long = true;
    }
    if (status)
        return status;
    reader->number += *more;
    if (reader->line.size > 0 && reader->line.data[reader->line.size - 1] == '\r')
        reader->line.size--;
    char *end = ffd_buffer_room(&reader->line, 1);
    if (!end)
        return ffd_fail_memory(error);
    *end = 0;
    return FFD_OK;
}

void ffd_lines_close(line_reader *reader)
{
    ffd_stream_close(&reader->stream);
    ffd_buffer_free(&reader->line);
    *reader = (line_reader){0};
}
