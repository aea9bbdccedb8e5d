/* buffer_binary.h - appends little-endian binary numbers to a growing buffer. */
#ifndef FFD_BASE_TEXT_BUFFER_BINARY_H
#define FFD_BASE_TEXT_BUFFER_BINARY_H

#include "base/little_endian.h"
#include "base/text/buffer.h"

/* Appends a 32-bit number. */
static inline void ffd_buffer_u32(byte_buffer *buffer, uint32_t value)
{
    unsigned char bytes[4];
    store_u32(bytes, value);
    ffd_buffer_append(buffer, bytes, sizeof bytes);
}

/* Appends a number as a float32. */
static inline void ffd_buffer_float(byte_buffer *buffer, double value)
{
    unsigned char bytes[4];
    store_float(bytes, (float)value);
    ffd_buffer_append(buffer, bytes, sizeof bytes);
}

#endif
