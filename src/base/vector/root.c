#include "base/vector/root.h"
#include "base/arithmetic.h"
#include <math.h>

double ffd_root(double x, int n)
{
    /* Newton's method from above: it stops when rounding ends the descent. */
    int exponent;
    const double fraction = frexp(x, &exponent);
    const int share = (int)floor_of((double)exponent / n + 0.5);
    const double scaled = ldexp(fraction, exponent - n * share);
    double nearest = 1 + (scaled - 1) / n; /* an upper bound of the root (Bernoulli's inequality) */
    for (;;) {
        double power = nearest;
        for (int i = 2; i < n; i++)
            power *= nearest;
        const double next = nearest - (nearest - scaled / power) / n;
        if (!(next < nearest))
            return ldexp(nearest, share);
        nearest = next;
    }
}
