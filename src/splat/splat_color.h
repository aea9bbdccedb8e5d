/* splat_color.h - what a splat shows from everywhere: its colour of degree 0, and its opacity. */
#ifndef FFD_SPLAT_SPLAT_COLOR_H
#define FFD_SPLAT_SPLAT_COLOR_H

#include "base/vector/exponential.h"

/* Returns a component of the colour, 0 to 1, from the coefficient of the harmonic of degree 0, which is 1 /
   (2 sqrt(pi)) everywhere. A coefficient that is not a number gives grey. */
static inline double splat_color(double coefficient)
{
    const double color = 0.5 + 0.28209479177387814 * coefficient;
    return color > 0 ? (color < 1 ? color : 1) : color <= 0 ? 0 : 0.5;
}

/* Returns the opacity, 0 to 1, from its logit, as 3DGS stores it. A number that is none gives 1. */
static inline double splat_opacity(double logit)
{
    if (!(logit < 40))
        return 1;
    return logit > -40 ? 1 / (1 + ffd_exp(-logit)) : 0;
}

#endif
