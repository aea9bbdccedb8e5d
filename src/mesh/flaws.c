#include "mesh/flaws.h"
#include "base/spelling.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* All further kinds share the last entry. */
bool ffd_flaw_repeats(mesh_flaws *flaws, const char *format)
{
    for (size_t i = 0; i < flaws->count; i++)
        if (i == FFD_FLAWS - 1 || strcmp(flaws->formats[i], format) == 0) {
            flaws->list[i].count++;
            return true;
        }
    return false;
}

static void add_kind(mesh_flaws *flaws, const char *format, size_t line, const char *pointer,
                     const char *message)
{
    const bool is_last = flaws->count == FFD_FLAWS - 1;
    ffd_flaw *const flaw = &flaws->list[flaws->count];
    flaws->formats[flaws->count++] = format;
    *flaw = (ffd_flaw){.count = 1, .line = line};
    snprintf(flaw->pointer, sizeof flaw->pointer, "%s", pointer);
    snprintf(flaw->message, sizeof flaw->message, "%s%s", is_last ? "there is more of other kinds: " : "",
             message);
}

ffd_status ffd_flaw_note(mesh_flaws *flaws, const char *file, size_t line, const char *pointer,
                         ffd_error *error, const char *format, va_list arguments)
{
    char message[sizeof error->message];
    if (ffd_flaw_repeats(flaws, format))
        return FFD_OK;
    vsnprintf(message, sizeof message, SPELLED(format), arguments);
    if (!flaws->strict) {
        add_kind(flaws, format, *pointer ? 0 : line, pointer, message);
        return FFD_OK;
    }
    return ffd_fail_at(error, FFD_E_INVALID, file, line, pointer, "%s", message);
}

ffd_status ffd_flaw_line(mesh_flaws *flaws, const char *file, size_t line, ffd_error *error,
                         const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const ffd_status status = ffd_flaw_note(flaws, file, line, "", error, format, arguments);
    va_end(arguments);
    return status;
}

void ffd_flaws_warn(const mesh_flaws *flaws, const char *file, const mesh_log *log)
{
    for (size_t i = 0; i < flaws->count; i++) {
        const ffd_flaw *const flaw = &flaws->list[i];
        char place[sizeof flaw->pointer + 2] = "", more[64] = "";
        if (*flaw->pointer)
            snprintf(place, sizeof place, "%s: ", flaw->pointer);
        else if (flaw->line)
            snprintf(place, sizeof place, "line %" PRIu64 ": ", flaw->line);
        if (flaw->count > 1)
            snprintf(more, sizeof more, " (the first of %" PRIu64 " such)", flaw->count);
        ffd_log_line(log, FFD_LOG_WARNING, "%s%s%s%s%s", file ? file : "", file ? ": " : "", place,
                     flaw->message, more);
    }
}
