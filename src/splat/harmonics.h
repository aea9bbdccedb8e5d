/* harmonics.h - turning real spherical harmonics of degrees 1 to 3 (src/maths.md 9.5). */
#ifndef FFD_SPLAT_HARMONICS_H
#define FFD_SPLAT_HARMONICS_H

#include "splat/splat.h"

#define HARMONICS_DEGREES 3
#define HARMONICS_MOST 15 /* coefficients of degrees 1 to 3 */
#define HARMONICS_CHANNELS 3

/* The number of coefficients of degrees 1 to this one. */
static inline int harmonics_count(int degree)
{
    return (degree + 1) * (degree + 1) - 1;
}

/* Values of the functions of a degree at a direction of length 1, m from -degree to degree. The functions are
   those of 3D Gaussian splatting and of KHR_gaussian_splatting: with the Condon-Shortley phase. */
void ffd_harmonics_values(int degree, const double direction[3], double values[7]);

/* Replaces the coefficients of degrees 1 to `degree`, by degree and m, with those of the turned function. */
void ffd_harmonics_turn(const splat_turn *turn, int degree,
                        double coefficients[HARMONICS_MOST][HARMONICS_CHANNELS]);

#endif
