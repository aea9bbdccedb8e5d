/* spec_values.h - values that occur in several parts of a lattice file. */
#ifndef FFD_LATTICE_SPEC_VALUES_H
#define FFD_LATTICE_SPEC_VALUES_H

#include "json/json_reader.h"

/* Reads count points, each an array of three numbers, into a new block of 3*count (free with ffd_free, after
   a failure too). */
ffd_status ffd_spec_read_points(json_cursor cursor, size_t count, double **points);
/* Reads a member that is a direction: three numbers, not all 0, or "x", "y", "z". axis gets unit length. */
ffd_status ffd_spec_read_axis(json_cursor object, const char *key, double axis[3]);

#endif
