/* principal.h - the principal axes of a set of points. */
#ifndef FFD_BASE_VECTOR_PRINCIPAL_H
#define FFD_BASE_VECTOR_PRINCIPAL_H

#include <stddef.h>

/* Unit vectors, as rows, by falling variance of the points along them; points that are not finite do not
   count. The largest component of the first two is positive (the first of equals), the third makes them
   right-handed. center and length are the points' position and size, for numbers that do not overflow. */
void ffd_principal_axes(const double *xyz, size_t count, const double center[3], double length,
                        double axes[9]);

#endif
