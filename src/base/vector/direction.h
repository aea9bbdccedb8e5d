/* direction.h - unit vectors made from what people write. */
#ifndef FFD_BASE_VECTOR_DIRECTION_H
#define FFD_BASE_VECTOR_DIRECTION_H

#include <stdbool.h>

/* Scales v to unit length; a vector that has it (to rounding) keeps its bits. Returns false if v is 0. */
bool ffd_direction_unit(double v[3]);
/* The part of v that is perpendicular to the unit vector axis, of unit length; a vector that is both already
   keeps its bits. Returns false if v is (nearly) along axis, or 0. */
bool ffd_direction_perpendicular(const double axis[3], double v[3]);
/* The coordinate axis that is least along axis (the first of equals), made perpendicular to it. */
void ffd_direction_default_zero(const double axis[3], double zero[3]);

#endif
