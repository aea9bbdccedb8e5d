/* difference.h - what the comparisons of all formats share: distances, counts, and the first and the worst
   difference in words. */
#ifndef FFD_MESH_DIFFERENCE_H
#define FFD_MESH_DIFFERENCE_H

#include "base/fail.h"
#include <ffd/job.h>

/* A comparison that has found no differences yet. */
void ffd_difference_begin(ffd_comparison *comparison, double tolerance, double direction_tolerance);

/* Counts a difference, and keeps its words if it is the first one; control characters become '?'. */
void ffd_difference_say(ffd_comparison *comparison, ffd_difference_kind kind, const char *format, ...)
    FFD_PRINTF(3, 4);

/* The same of a difference that keeps the rest of the files from being matched. */
#define ffd_difference_stop(comparison, ...)                                                                 \
    ((comparison)->complete = false, ffd_difference_say(comparison, __VA_ARGS__))

/* Writes where the vector that is compared stands, as "vertex 3 (line 7)". */
typedef void difference_label(const void *context, char *text, size_t capacity);

/* Compares two vectors of up to 4 components: positions, normals or tangents. One difference where a
   component differs by more than the tolerance of their kind. */
void ffd_difference_vector(ffd_comparison *comparison, ffd_difference_kind kind, int components,
                           const double *a, const double *b, difference_label *place, const void *context);

/* |a - b|; 0 also for equal infinities and two NaN, infinity for a NaN and a number. */
double ffd_difference_of(double a, double b);

#endif
