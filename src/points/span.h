/* span.h - reads and writes points of the caller's arrays. */
#ifndef FFD_POINTS_SPAN_H
#define FFD_POINTS_SPAN_H

#include "base/fail.h"
#include <ffd/points.h>

/* Fails for a span that is no array of count points. what: its name in messages. Makes the strides of packed
   ones explicit. */
ffd_status ffd_span_check(ffd_span *span, size_t count, const char *what, ffd_error *error);
/* Reads count points from the first on as doubles, 3 each. The span was checked. */
void ffd_span_read(const ffd_span *span, size_t first, size_t count, double *xyz);
/* Writes them, rounded to the span's type. */
void ffd_span_write(const ffd_span *span, size_t first, size_t count, const double *xyz);
/* Copies a point's bytes between spans of one type. */
void ffd_span_copy(const ffd_span *from, const ffd_span *to, size_t point);

#endif
