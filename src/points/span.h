/* span.h - reads and writes points of the caller's arrays. */
#ifndef FFD_POINTS_SPAN_H
#define FFD_POINTS_SPAN_H

#include "base/fail.h"
#include <ffd/points.h>

/* Checks that a span is an array of count points, and replaces strides of 0 by the actual ones. what: its
   name in messages. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_span_check(ffd_span *span, size_t count, const char *what, ffd_error *error);
/* Reads count points beginning with `first` as doubles, 3 each. The span must be checked. */
void ffd_span_read(const ffd_span *span, size_t first, size_t count, double *xyz);
/* Writes points, rounded to the type of the span. */
void ffd_span_write(const ffd_span *span, size_t first, size_t count, const double *xyz);
/* Returns where the numbers of the points from `first` on are, if they are doubles without gaps; else NULL.
 */
double *ffd_span_doubles(const ffd_span *span, size_t first);
/* The same for floats. */
float *ffd_span_floats(const ffd_span *span, size_t first);
/* Copies the bytes of a point between spans of the same type. */
void ffd_span_copy(const ffd_span *from, const ffd_span *to, size_t point);

#endif
