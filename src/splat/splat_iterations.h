/* splat_iterations.h - the two iterations for splats, scalar, and their constants, which the kernels use too.
   Used in src/splat only. */
#ifndef FFD_SPLAT_SPLAT_ITERATIONS_H
#define FFD_SPLAT_SPLAT_ITERATIONS_H

/* Limits of Newton's iteration, which converges quadratically in the end; scaling makes the first steps
   fast. */
#define NEWTON_STEPS 30
#define NEWTON_NEAR 1e-2    /* after a squared change below this, no more scaling */
#define NEWTON_ENOUGH 1e-18 /* after a squared change below this, the next change is below rounding */

/* Columns whose cosine is below this count as perpendicular. It is far below the precision of a float, and
   above the rounding of F, so that a rotation keeps the axes of splats with equal scales. */
#define RIGHT 1e-12
#define SWEEPS 20

/* Replaces an invertible matrix by the orthogonal factor of its polar decomposition (src/maths.md 9.6). */
void ffd_splat_orthogonalise(double x[9]);

/* Makes the columns of a matrix, stored one after the other, perpendicular (src/maths.md 9.6). */
void ffd_splat_part_columns(double columns[9]);

#endif
