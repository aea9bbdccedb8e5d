/* difference.h - what the comparisons of all formats share: distances, counts, and the texts of the first and
   the worst difference. */
#ifndef FFD_MESH_DIFFERENCE_H
#define FFD_MESH_DIFFERENCE_H

#include "base/fail.h"
#include <ffd/job.h>

/* Begins a comparison without differences. */
void ffd_difference_begin(ffd_comparison *comparison, double tolerance, double direction_tolerance);

/* Counts a difference, and stores its text if it is the first one; control characters become '?'. */
void ffd_difference_add_text(ffd_comparison *comparison, ffd_difference_kind kind, const char *format, ...)
    FFD_PRINTF(3, 4);

/* The same for a difference after which the rest of the files cannot be matched. */
#define ffd_difference_stop(comparison, ...)                                                                 \
    ((comparison)->complete = false, ffd_difference_add_text(comparison, __VA_ARGS__))

/* A callback that writes the name of the compared vector, such as "vertex 3 (line 7)". */
typedef void difference_label(const void *context, char *text, size_t capacity);

/* Compares two vectors of up to 4 components: positions, normals or tangents. Counts one difference if any
   component differs by more than the tolerance of the kind. */
void ffd_difference_vector(ffd_comparison *comparison, ffd_difference_kind kind, int components,
                           const double *a, const double *b, difference_label *label, const void *context);

/* Returns |a - b|: 0 for equal infinities and for two NaN, infinity for a NaN and a number. */
double ffd_difference_of(double a, double b);

#endif
