/* srgb.h - conversion between sRGB and linear colours. Both range from 0 to 1; larger numbers follow the same
   curve, and negative ones the linear segment.

   IEC 61966-2-1:1999, 5.2. Computed with + - * / and square roots only, so results have the same bits on
   every processor. */
#ifndef FFD_MESH_SRGB_H
#define FFD_MESH_SRGB_H

#include <stdint.h>

/* Converts to linear, with a relative error below 2^-49. */
double ffd_srgb_to_linear(double srgb);

/* Converts to sRGB with the same accuracy. A linear number that is the float or 16-bit integer nearest to
   that of an sRGB byte gives exactly byte/255, so bytes survive a round trip. */
double ffd_srgb_from_linear(double linear);

/* Returns the linear value of an sRGB byte as a 16-bit integer; 65535 is 1. Different bytes have different
   values. */
uint16_t ffd_srgb_byte_to_linear(unsigned byte);

#endif
