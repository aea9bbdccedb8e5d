/* grid_arrays.h - the arrays by which the formats of VTK hold a lattice (vtk.c, vts.c): points and, by their
   names, what else it has. */
#ifndef FFD_LATTICE_FORMATS_GRID_ARRAYS_H
#define FFD_LATTICE_FORMATS_GRID_ARRAYS_H

#include "base/text/text_scan.h"
#include "lattice/formats/format_spec.h"
#include "lattice/lattice.h"

/* Of the points; and of the whole grid. */
typedef enum grid_array_kind {
    GRID_POINTS,
    GRID_OFFSETS,
    GRID_WEIGHTS,
    GRID_MOVED_WEIGHTS,
    GRID_DEGREE,
    GRID_CLOSED,
    GRID_KNOTS_U,
    GRID_KNOTS_V,
    GRID_KNOTS_W,
    GRID_ARRAYS
} grid_array_kind;

typedef struct grid_array {
    double *values; /* count numbers; NULL: not there */
    uint64_t count;
} grid_array;

/* All zeros: none yet. */
typedef struct grid_arrays {
    grid_array array[GRID_ARRAYS];
    uint64_t count; /* numbers of all */
} grid_arrays;

/* The name of an array, as it is written. */
const char *ffd_grid_array_name(grid_array_kind kind);
/* Whether an array is one of those above. */
bool ffd_grid_array_is_known(text_word name, bool of_points);
/* Makes room for an array, if its name is one of those above: *kept leads to it, else it is NULL. The caller
   has checked that the file can hold so many numbers. Errors: FFD_E_INVALID for one that is there twice or
   has other components, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_grid_array_take(grid_arrays *arrays, text_word name, bool of_points, uint64_t components,
                               uint64_t tuples, double ***kept, const char *file, const format_wish *wish,
                               ffd_error *error);
/* Makes the spec of a lattice, which takes the arrays. The caller frees *spec. Errors: those of
 * format_reader. */
ffd_status ffd_grid_arrays_make(grid_arrays *arrays, const size_t size[3], const char *file,
                                const format_wish *wish, lattice_spec **spec, ffd_error *error);
/* Frees the arrays, and empties the list. */
void ffd_grid_arrays_free(grid_arrays *arrays);

/* Returns a number of 1, 2, 4 or 8 bytes. */
double ffd_grid_number(const unsigned char *bytes, size_t size, bool is_float, bool is_signed,
                       bool is_big_endian);
/* Returns the knots of a direction as a file has them: all, or of a closed one the breakpoints. */
const double *ffd_grid_knots(const knot_vector *knots, size_t *count);

#endif
