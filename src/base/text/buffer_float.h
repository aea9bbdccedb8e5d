/* buffer_float.h - appends binary numbers to a growing buffer. */
#ifndef FFD_BASE_TEXT_BUFFER_FLOAT_H
#define FFD_BASE_TEXT_BUFFER_FLOAT_H

#include "base/little_endian.h"
#include "base/text/buffer.h"

/* Appends a number as a little-endian float32. */
static inline void ffd_buffer_float(byte_buffer *buffer, double value)
{
    unsigned char bytes[4];
    store_float(bytes, (float)value);
    ffd_buffer_append(buffer, bytes, sizeof bytes);
}

#endif
