/* weighting.h - the displacement of a vertex times its weight (src/maths.md 9.7). */
#ifndef FFD_DEFORM_WEIGHTING_H
#define FFD_DEFORM_WEIGHTING_H

#include "base/inline.h"
#include <stdbool.h>
#include <stddef.h>

/* Whether a weight changes the displacement or its gradient. slope: g; NULL: 0. */
static ALWAYS_INLINE bool weight_acts(double weight, const double *slope)
{
    return weight != 1 || (slope && (slope[0] != 0 || slope[1] != 0 || slope[2] != 0));
}

/* Replaces E by w E + d g^T. The questions are outside of the loops, which compilers then make vectors of. */
static ALWAYS_INLINE void weigh_gradient(double weight, const double *slope, const double delta[3],
                                         double gradient[9])
{
    double turned[9] = {0};
    for (size_t r = 0; r < 3 && slope; r++)
        for (size_t c = 0; c < 3; c++)
            turned[3 * r + c] = delta[r] * slope[c];
    if (weight == 0)
        for (size_t i = 0; i < 9; i++)
            gradient[i] = 0 + turned[i];
    else
        for (size_t i = 0; i < 9; i++)
            gradient[i] = weight * gradient[i] + turned[i];
}

/* Replaces the displacement d by w d, and its gradient E by w E + d g^T; gradient may be NULL. Nothing
   changes where w = 1 and g = 0, and a weight of 0 gives zeros. */
static ALWAYS_INLINE void weigh_displacement(double weight, const double *slope, double delta[3],
                                             double *gradient)
{
    if (!weight_acts(weight, slope))
        return;
    if (gradient)
        weigh_gradient(weight, slope, delta, gradient);
    for (size_t r = 0; r < 3; r++)
        delta[r] = weight == 0 ? 0 : weight * delta[r];
}

#endif
