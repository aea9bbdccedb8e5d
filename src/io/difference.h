/* difference.h - what the comparisons of all formats share: distances, and the first difference in words. */
#ifndef FFD_IO_DIFFERENCE_H
#define FFD_IO_DIFFERENCE_H

#include "base/fail.h"
#include <ffd/job.h>

/* Keeps the first difference; control characters become '?'. */
void ffd_difference_say(ffd_comparison *comparison, const char *format, ...) FFD_PRINTF(2, 3);

/* |a - b|; 0 also for equal infinities and two NaN, infinity for a NaN and a number. */
double ffd_difference_of(double a, double b);

/* Notes the distance of two coordinates; false, with words that begin with place, where it is more than the
   tolerance. axis: 0 to 2. */
bool ffd_difference_coordinate(ffd_comparison *comparison, const char *place, int axis, double a, double b,
                               double tolerance);

#endif
