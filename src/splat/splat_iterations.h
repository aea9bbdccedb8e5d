/* splat_iterations.h - the two iterations of splats, for one matrix, and what they have in common with the
   kernels. Used within splat only. */
#ifndef FFD_SPLAT_SPLAT_ITERATIONS_H
#define FFD_SPLAT_SPLAT_ITERATIONS_H

/* Steps of Newton's iteration; it doubles the digits at the end, and scaling brings it near at once. */
#define NEWTON_STEPS 30
#define NEWTON_NEAR 1e-2    /* the square of a change after which scaling would disturb */
#define NEWTON_ENOUGH 1e-18 /* the square of a change after which the next one is below rounding */

/* Columns whose angle is nearer to a right one than this are left: it is far below a float's step, and above
   the rounding of F, so that a turn keeps the axes of splats with equal sizes. */
#define RIGHT 1e-12
#define SWEEPS 20

/* Replaces x, which has an inverse, with the orthogonal factor of its polar decomposition (src/maths.md 9.6).
 */
void ffd_splat_orthogonalise(double x[9]);

/* Makes the columns of a matrix, one after the other, perpendicular (src/maths.md 9.6). */
void ffd_splat_part_columns(double columns[9]);

#endif
