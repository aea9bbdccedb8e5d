#include "base/fail.h"
#include "base/posix.h"
#include "base/spelling.h"
#include <errno.h>
#include <ffd/program.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void copy_text(char *to, size_t capacity, const char *from)
{
    size_t length = strlen(from);
    if (length >= capacity)
        length = capacity - 1;
    memcpy(to, from, length);
    to[length] = 0;
}

static void fill(ffd_error *error, ffd_status status, const char *file, size_t line, const char *pointer,
                 const char *format, va_list arguments)
{
    /* The arguments may point into the record itself (a message that quotes an earlier one). */
    char message[sizeof error->message];
    vsnprintf(message, sizeof message, SPELLED(format), arguments);
    char file_copy[sizeof error->file], pointer_copy[sizeof error->pointer];
    copy_text(file_copy, sizeof file_copy, file);
    copy_text(pointer_copy, sizeof pointer_copy, pointer);
    ffd_make_one_line(message, strlen(message));
    ffd_make_one_line(file_copy, strlen(file_copy));
    ffd_make_one_line(pointer_copy, strlen(pointer_copy));
    error->status = status;
    error->line = line;
    copy_text(error->file, sizeof error->file, file_copy);
    copy_text(error->pointer, sizeof error->pointer, pointer_copy);
    copy_text(error->message, sizeof error->message, message);
}

ffd_status ffd_fail(ffd_error *error, ffd_status status, const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        fill(error, status, "", 0, "", format, arguments);
        va_end(arguments);
    }
    return status;
}

ffd_status ffd_fail_file(ffd_error *error, ffd_status status, const char *file, const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        fill(error, status, file, 0, "", format, arguments);
        va_end(arguments);
    }
    return status;
}

ffd_status ffd_fail_errno(ffd_error *error, const char *file, const char *what)
{
    const int reason = errno;
    return ffd_fail_file(error, reason == ENOMEM ? FFD_E_MEMORY : FFD_E_IO, file, "%s: %s", what,
                         strerror(reason));
}

ffd_status ffd_fail_line(ffd_error *error, ffd_status status, const char *file, size_t line,
                         const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        fill(error, status, file, line, "", format, arguments);
        va_end(arguments);
    }
    return status;
}

ffd_status ffd_fail_at(ffd_error *error, ffd_status status, const char *file, size_t line,
                       const char *pointer, const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        fill(error, status, file, line, pointer, format, arguments);
        va_end(arguments);
    }
    return status;
}

ffd_status ffd_fail_as(ffd_status status, const ffd_error *own, ffd_error *error)
{
    if (status && error)
        *error = *own;
    return status;
}

ffd_status ffd_fail_memory(ffd_error *error)
{
    return ffd_fail(error, FFD_E_MEMORY, "out of memory");
}

void ffd_fail_name_file(ffd_error *error, const char *file)
{
    if (!error || error->file[0])
        return;
    copy_text(error->file, sizeof error->file, file);
    ffd_make_one_line(error->file, strlen(error->file));
}

size_t ffd_error_format(const ffd_error *error, char *text, size_t capacity)
{
    int length;
    if (!error->file[0] && !error->pointer[0])
        length = snprintf(text, capacity, "%s", error->message);
    else if (error->line > 0 && error->pointer[0])
        length = snprintf(text, capacity, "%s:%zu: %s: %s", error->file, error->line, error->pointer,
                          error->message);
    else if (error->line > 0)
        length = snprintf(text, capacity, "%s:%zu: %s", error->file, error->line, error->message);
    else if (error->pointer[0])
        length = snprintf(text, capacity, "%s:%s: %s", error->file, error->pointer, error->message);
    else
        length = snprintf(text, capacity, "%s: %s", error->file, error->message);
    return length < 0 ? 0 : (size_t)length;
}

int ffd_status_exit_code(ffd_status status)
{
    switch (status) {
    case FFD_OK:
        return 0;
    case FFD_E_GATE:
    case FFD_E_UNMET:
    case FFD_E_CANCELLED:
        return 1;
    case FFD_E_ARGUMENT:
        return 2;
    case FFD_E_IO:
    case FFD_E_EXISTS:
        return 3;
    case FFD_E_INVALID:
        return 4;
    case FFD_E_EMBEDDING:
        return 5;
    case FFD_E_UNSUPPORTED:
        return 6;
    case FFD_E_MEMORY:
    case FFD_E_LIMIT:
        return 7;
    }
    return 7;
}

ffd_status ffd_status_known(ffd_status status)
{
    switch (status) {
    case FFD_OK:
    case FFD_E_GATE:
    case FFD_E_UNMET:
    case FFD_E_ARGUMENT:
    case FFD_E_IO:
    case FFD_E_EXISTS:
    case FFD_E_INVALID:
    case FFD_E_EMBEDDING:
    case FFD_E_UNSUPPORTED:
    case FFD_E_MEMORY:
    case FFD_E_LIMIT:
    case FFD_E_CANCELLED:
        return status;
    }
    return FFD_E_IO;
}
