/* srgb.h - colours as files for display have them (sRGB), and as light adds up (linear). Both run from 0 to
   1; larger numbers follow the same curve, and those below 0 the line through it.

   IEC 61966-2-1:1999, 5.2. Computed by + - * / and square roots only: the same bits on every processor. */
#ifndef FFD_MESH_SRGB_H
#define FFD_MESH_SRGB_H

#include <stdint.h>

/* The relative error is below 2^-49. */
double ffd_srgb_to_linear(double srgb);

/* The inverse, as exact. A linear number that is the nearest float or 16-bit integer to that of a byte of
   sRGB gives this byte exactly (as byte/255): so bytes survive the way there and back. */
double ffd_srgb_from_linear(double linear);

/* The linear value of a byte of sRGB as a 16-bit integer: 65535 is 1. No two bytes have the same. */
uint16_t ffd_srgb_byte_to_linear(unsigned byte);

#endif
