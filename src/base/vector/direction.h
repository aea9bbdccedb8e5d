/* direction.h - unit vectors from directions that users give. */
#ifndef FFD_BASE_VECTOR_DIRECTION_H
#define FFD_BASE_VECTOR_DIRECTION_H

#include <stdbool.h>

/* Normalises v; a vector of unit length to rounding keeps its bits. Returns false if v is 0. */
bool ffd_direction_unit(double v[3]);
/* Replaces v by its component perpendicular to the unit vector axis, normalised; a vector that is
   perpendicular and of unit length already keeps its bits. Returns false if v is 0 or nearly parallel to
   axis. */
bool ffd_direction_perpendicular(const double axis[3], double v[3]);
/* Sets zero to the coordinate axis with the least component along axis (the first one if equal), made
   perpendicular to axis. */
void ffd_direction_default_zero(const double axis[3], double zero[3]);

#endif
