/* linear.h - linear colours, which can be added and averaged: tables to convert sRGB bytes to 16-bit linear
   light and back. */
#ifndef FFD_PICTURE_LINEAR_H
#define FFD_PICTURE_LINEAR_H

#include "base/inline.h"
#include <stdint.h>

/* The value of light 1. */
#define LINEAR_ONE 65535
/* Bits of light for the conversion back to bytes: enough for half a byte step at the dark end. */
#define LINEAR_BITS 14

typedef struct linear_tables {
    uint16_t light[256];
    double shares[256]; /* light as a part of 1 */
    double alphas[256]; /* bytes as parts of 1 */
    uint8_t bytes[1 << LINEAR_BITS];
} linear_tables;

/* Fills the tables. Each drawing has its own, so threads share no state. */
void ffd_linear_fill(linear_tables *tables);

static ALWAYS_INLINE uint8_t linear_to_byte(const linear_tables *tables, uint16_t light)
{
    return tables->bytes[light >> (16 - LINEAR_BITS)];
}

/* Packs red, green and blue into 48 bits of a number. */
static ALWAYS_INLINE uint64_t linear_pack(uint32_t red, uint32_t green, uint32_t blue)
{
    return (uint64_t)red | (uint64_t)green << 16 | (uint64_t)blue << 32;
}

/* The bits of red, green and blue. */
#define LINEAR_LIGHT UINT64_C(0xffffffffffff)

static ALWAYS_INLINE uint16_t linear_part(uint64_t color, int which)
{
    return (uint16_t)(color >> (16 * which));
}

/* Light up to this is shown as it is. */
#define LINEAR_KNEE (LINEAR_ONE / 5 * 4)

/* Returns light that may be beyond LINEAR_ONE as part of it: above the knee it grows ever more slowly, so
   that a white surface keeps its shape in bright light. */
static ALWAYS_INLINE uint32_t linear_shoulder(uint64_t light)
{
    const uint64_t rest = LINEAR_ONE - LINEAR_KNEE;
    return (uint32_t)(light <= LINEAR_KNEE ? light : LINEAR_ONE - rest * rest / (light - LINEAR_KNEE + rest));
}

/* Converts light from 0 to 1 to 16 bits; clamps other values, and NaN to an end. */
static ALWAYS_INLINE uint32_t linear_from(double light)
{
    return light >= 1 ? LINEAR_ONE : light > 0 ? (uint32_t)(light * LINEAR_ONE + 0.5) : 0;
}

#endif
