/* slabs.h - small steps of parameters that bring a residual within a tolerance, coordinate by coordinate: the
   common part of two parallelepipeds, each of three slabs. */
#ifndef FFD_EMBED_FRAME_SLABS_H
#define FFD_EMBED_FRAME_SLABS_H

#include <stdbool.h>

/* All steps d with least_a <= d_a <= most_a for each a. */
typedef struct step_box {
    double least[3], most[3];
} step_box;

/* The steps from t that stay in [0,1]^3. */
static inline step_box steps_in_unit_box(const double t[3])
{
    return (step_box){{-t[0], -t[1], -t[2]}, {1 - t[0], 1 - t[1], 1 - t[2]}};
}

/* Finds a step d of the box with |(F + J d)_a| <= allowed_a for each a; of all such steps one whose largest
   |(F + J d)_a| / allowed_a is nearly the least. Returns false if there are none. */
bool ffd_slabs_find(const step_box *box, const double equation[3], const double jacobian[9],
                    const double allowed[3], double step[3]);

/* Returns whether |r_a + (J d)_a| <= tolerance_a for each a and some d with |d_b| <= grain_b for each b:
   whether the tolerance and a rounding of the parameters explain the residual r (src/maths.md 6.6). */
bool ffd_residual_is_explained(const double residual[3], const double jacobian[9], const double tolerance[3],
                               const double grain[3]);

#endif
