/* harmonics.h - rotates real spherical harmonics of degrees 1 to 3 (src/maths.md 9.6). */
#ifndef FFD_SPLAT_HARMONICS_H
#define FFD_SPLAT_HARMONICS_H

#include "base/vector/isa.h"
#include "splat/splat.h"

#define HARMONICS_DEGREES 3
#define HARMONICS_MOST 15 /* number of coefficients of degrees 1 to 3 */
#define HARMONICS_CHANNELS 3

/* Returns the number of coefficients of degrees 1 to `degree`. */
static inline int harmonics_count(int degree)
{
    return (degree + 1) * (degree + 1) - 1;
}

/* Evaluates the functions of a degree at a unit direction, m from -degree to degree. The functions are those
   of 3D Gaussian splatting and of KHR_gaussian_splatting, with the Condon-Shortley phase. */
void ffd_harmonics_values(int degree, const double direction[3], double values[7]);

/* The coefficients of a splat for each channel, by degree and m. */
typedef double harmonics_block[HARMONICS_CHANNELS][HARMONICS_MOST];

/* Replaces the coefficients of degrees 1 to `degree` by those of the rotated functions, for count splats. The
   bits are the same for all instruction sets. */
void ffd_harmonics_turn(ffd_isa isa, const splat_turn *turns, int degree, size_t count, harmonics_block *c);

/* The same for the splats that fill all lanes, with their rotation matrices (without reflections). Returns
   the number of processed splats. One function for each SIMD instruction set. */
typedef size_t harmonics_kernel(double (*rotations)[9], int degree, size_t count, harmonics_block *c);

#define DECLARE(ISA, set, lanes) harmonics_kernel ffd_harmonics_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
