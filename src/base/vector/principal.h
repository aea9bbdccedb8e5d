/* principal.h - the principal axes of a set of points. */
#ifndef FFD_BASE_VECTOR_PRINCIPAL_H
#define FFD_BASE_VECTOR_PRINCIPAL_H

#include <stddef.h>

/* Finds the principal axes of count points: unit vectors in rows, in the order of descending variance. Points
   that are not finite are ignored. The largest component of each of the first two axes is positive (the first
   one if equal); the third makes the system right-handed. center and length: rough position and size of the
   points, to scale the numbers so that they do not overflow. */
void ffd_principal_axes(const double *xyz, size_t count, const double center[3], double length,
                        double axes[9]);

#endif
