#include "batch/lines.h"
#include <errno.h>
#include <string.h>

ffd_status ffd_lines_open(const char *path, const char *name, line_reader *reader, ffd_error *error)
{
    *reader = (line_reader){.name = name};
    if (strcmp(path, "-") == 0) {
        reader->file = stdin;
        return FFD_OK;
    }
    errno = 0;
    reader->file = fopen(path, "rb");
    if (!reader->file)
        return ffd_fail_file(error, FFD_E_IO, name, "cannot be read: %s", strerror(errno));
    if (fseek(reader->file, 0, SEEK_END) == 0) {
        const long size = ftell(reader->file);
        reader->size = size > 0 ? (uint64_t)size : 0;
        rewind(reader->file);
    }
    clearerr(reader->file);
    return FFD_OK;
}

ffd_status ffd_lines_next(line_reader *reader, bool append, bool *more, ffd_error *error)
{
    int c;
    if (append) {
        ffd_buffer_text(&reader->line, "\n");
    } else {
        reader->line.size = 0;
        reader->too_long = false;
    }
    *more = false;
    errno = 0;
    while ((c = getc(reader->file)) != EOF) {
        const char byte = (char)c;
        *more = true;
        reader->read++;
        if (byte == '\n')
            break;
        if (reader->line.size < LINE_MOST)
            ffd_buffer_append(&reader->line, &byte, 1);
        else
            reader->too_long = true;
    }
    if (ferror(reader->file))
        return ffd_fail_file(error, FFD_E_IO, reader->name, "cannot be read: %s",
                             errno ? strerror(errno) : "no reason is known");
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
    if (reader->file && reader->file != stdin)
        fclose(reader->file);
    ffd_buffer_free(&reader->line);
    *reader = (line_reader){0};
}
