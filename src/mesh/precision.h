/* precision.h - when the rounding of coordinates changes a shape: to float32 in conversions, to float32 or
   float64 of results in the file's own format. */
#ifndef FFD_MESH_PRECISION_H
#define FFD_MESH_PRECISION_H

#include "mesh/bounds.h"
#include <float.h>
#include <math.h>
#include <stdbool.h>

/* The acceptable rounding error relative to the largest side of the model: half a step of 16-bit
   quantization, which is commonly good enough. */
#define SHAPE_TOLERANCE 0x1p-17
/* The same relative to the largest side of one of several objects, where smaller objects of a large model lie
   anywhere in it: half a step of 12 bits. */
#define PART_TOLERANCE 0x1p-13

/* Extends the bounds by a point. Coordinates that are not finite are ignored. */
static inline void ffd_bounds_widen_finite(ffd_bounds *box, const double point[3])
{
    for (int a = 0; a < 3; a++)
        if (isfinite(point[a])) {
            box->min[a] = lesser_of(box->min[a], point[a]);
            box->max[a] = larger_of(box->max[a], point[a]);
        }
}

/* Returns the largest side; 0 of empty bounds. */
static inline double ffd_bounds_side(const ffd_bounds *box)
{
    double side = 0;
    for (int a = 0; a < 3; a++)
        side = larger_of(side, box->max[a] - box->min[a]);
    return side;
}

/* Returns the distance from a finite x >= 0 to the next double away from 0. */
static inline double ffd_double_step(double x)
{
    return next_above(x) - x;
}

/* Returns the largest error of a point's coordinates as float32. Those that are beyond its range are refused
   elsewhere. */
static inline double ffd_float_error(const double point[3])
{
    double error = 0;
    for (int a = 0; a < 3; a++)
        if (fabs(point[a]) <= (double)FLT_MAX)
            error = larger_of(error, fabs(point[a] - (double)(float)point[a]));
    return error;
}

#endif
