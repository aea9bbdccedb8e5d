/* extraction_band.h - which entries of an extraction matrix (spline/bezier.h) can be other than 0. */
#ifndef FFD_DEFORM_EXTRACTION_BAND_H
#define FFD_DEFORM_EXTRACTION_BAND_H

#include "base/inline.h"
#include <stddef.h>

/* The columns first to last of row r. Function 0 of a span ends at its last knot and function d begins at its
   first, each with d - 1 continuous derivatives or with the end of the domain there, whatever the other
   knots: they have a part in Bezier point 0 and in point d only. Columns 1 to d - 1 are in every row. */
static ALWAYS_INLINE size_t band_first(size_t r)
{
    return r == 0 ? 0 : 1;
}

static ALWAYS_INLINE size_t band_last(size_t r, size_t order)
{
    return r + 1 == order ? order - 1 : order - 2;
}

#endif
