#include "base/text/buffer.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool make_room(byte_buffer *buffer, size_t more)
{
    size_t needed;
    if (!buffer->failed && more <= buffer->capacity - buffer->size)
        return true;
    if (buffer->failed || !ffd_add_size(buffer->size, more, &needed) ||
        !ffd_grow((void **)&buffer->data, &buffer->capacity, needed, 1)) {
        buffer->failed = true;
        return false;
    }
    return true;
}

char *ffd_buffer_reserve(byte_buffer *buffer, size_t size)
{
    return make_room(buffer, size) ? buffer->data + buffer->size : NULL;
}

void ffd_buffer_append(byte_buffer *buffer, const void *bytes, size_t size)
{
    if (size == 0 || !make_room(buffer, size))
        return;
    memcpy(buffer->data + buffer->size, bytes, size);
    buffer->size += size;
}

void ffd_buffer_text(byte_buffer *buffer, const char *text)
{
    ffd_buffer_append(buffer, text, strlen(text));
}

void ffd_buffer_format(byte_buffer *buffer, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0 || !make_room(buffer, (size_t)length + 1))
        return;
    va_start(arguments, format);
    vsnprintf(buffer->data + buffer->size, (size_t)length + 1, format, arguments);
    va_end(arguments);
    buffer->size += (size_t)length;
}

void ffd_buffer_number(byte_buffer *buffer, double value)
{
    char *const room = ffd_buffer_reserve(buffer, FFD_NUMBER_CAPACITY);
    if (room)
        buffer->size += ffd_number_format(value, room);
}

char *ffd_buffer_finish(byte_buffer *buffer)
{
    ffd_buffer_append(buffer, "", 1);
    char *text = buffer->data;
    if (buffer->failed) {
        ffd_free(text);
        text = NULL;
    }
    memset(buffer, 0, sizeof *buffer);
    return text;
}

void ffd_buffer_free(byte_buffer *buffer)
{
    ffd_free(buffer->data);
    memset(buffer, 0, sizeof *buffer);
}
