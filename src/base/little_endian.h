/* little_endian.h - reads and writes numbers as little-endian bytes on any machine. */
#ifndef FFD_BASE_LITTLE_ENDIAN_H
#define FFD_BASE_LITTLE_ENDIAN_H

#include <stdint.h>
#include <string.h>

/* On a little-endian machine the functions are plain copies, because compilers vectorise loops of copies, but
   not of shifts. */
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
#define LITTLE_ENDIAN_MACHINE 1
#else
#define LITTLE_ENDIAN_MACHINE 0
#endif

static inline void store_u16(unsigned char bytes[2], uint16_t value)
{
    bytes[0] = (unsigned char)value;
    bytes[1] = (unsigned char)(value >> 8);
}

static inline void store_u32(unsigned char bytes[4], uint32_t value)
{
    if (LITTLE_ENDIAN_MACHINE)
        memcpy(bytes, &value, sizeof value);
    else
        for (int i = 0; i < 4; i++)
            bytes[i] = (unsigned char)(value >> (8 * i));
}

static inline void store_u64(unsigned char bytes[8], uint64_t value)
{
    if (LITTLE_ENDIAN_MACHINE)
        memcpy(bytes, &value, sizeof value);
    else
        for (int i = 0; i < 8; i++)
            bytes[i] = (unsigned char)(value >> (8 * i));
}

static inline void store_float(unsigned char bytes[4], float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    store_u32(bytes, bits);
}

static inline void store_double(unsigned char bytes[8], double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    store_u64(bytes, bits);
}

static inline uint32_t load_u32(const unsigned char bytes[4])
{
    uint32_t value = 0;
    if (LITTLE_ENDIAN_MACHINE)
        memcpy(&value, bytes, sizeof value);
    else
        for (int i = 0; i < 4; i++)
            value |= (uint32_t)bytes[i] << (8 * i);
    return value;
}

static inline float load_float(const unsigned char bytes[4])
{
    const uint32_t bits = load_u32(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline uint64_t load_u64(const unsigned char bytes[8])
{
    uint64_t value = 0;
    if (LITTLE_ENDIAN_MACHINE)
        memcpy(&value, bytes, sizeof value);
    else
        for (int i = 0; i < 8; i++)
            value |= (uint64_t)bytes[i] << (8 * i);
    return value;
}

static inline double load_double(const unsigned char bytes[8])
{
    const uint64_t bits = load_u64(bytes);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
