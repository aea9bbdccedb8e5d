/* spec_values.h - readers of values that occur in several parts of a lattice file. */
#ifndef FFD_LATTICE_FILE_SPEC_VALUES_H
#define FFD_LATTICE_FILE_SPEC_VALUES_H

#include "json/json_reader.h"

/* Keys that any object of the file may have: texts for people, which the program ignores. */
#define SPEC_NOTES "comment", "name"

/* Checks that the value is an object whose keys are all known, and that the values of SPEC_NOTES are texts.
   For a key that other programs use for a known one, the message suggests the latter. */
ffd_status ffd_spec_read_object(json_cursor cursor, const char *const *known, size_t count);
/* Checks that the notes of an object are texts. */
ffd_status ffd_spec_check_notes(json_cursor object);
/* Reads count points, each an array of three numbers, into a new array of 3*count doubles. The caller frees
   it with ffd_free, also after a failure. */
ffd_status ffd_spec_read_points(json_cursor cursor, size_t count, double **points);
/* Reads the path of a file; free it with ffd_free. */
ffd_status ffd_spec_read_path(json_cursor cursor, char **path);
/* Reads the members "min" and "max" of a box: three numbers each. */
ffd_status ffd_spec_read_ends(json_cursor object, double min[3], double max[3]);
/* Reads a member that is a number greater than 0. */
ffd_status ffd_spec_read_positive(json_cursor object, const char *key, double *value);
/* Reads a member that is a direction: three numbers, not all 0, or "x", "y", "z". axis is normalised. */
ffd_status ffd_spec_read_axis(json_cursor object, const char *key, double axis[3]);

#endif
