/* decimal.h - fast ways for the numbers that meshes hold, with the results of <charconv>, whose ways they are
   used beside (number.cpp). */
#ifndef FFD_BASE_DECIMAL_H
#define FFD_BASE_DECIMAL_H

#include "base/decimal_kernel.h"
#include "base/number.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads digits with a point in them or not, of a value that one division by a power of ten gives exactly
   rounded. Returns the place behind it; NULL where something else stands there. */
const char *ffd_decimal_parse(const char *first, const char *last, double *value);

/* Writes the shortest text as std::to_chars does. Returns its length, 24 at most (what stands behind it in
   text is undefined); 0 where the number is none of those that this way is for: 2^-32 to 2^52 in size, and no
   power of two. */
size_t ffd_decimal_format(double value, char text[FFD_NUMBER_CAPACITY]);

/* Numbers of an array whose texts are wanted nearly one after the other: those of many are made at once. The
 * numbers must not change meanwhile. */
typedef struct decimal_run {
    decimal_kernel *kernel;
    const double *first;  /* the texts of this number and of those behind it are there; NULL: of none */
    const double *before; /* the number that was wanted last; NULL: none */
    const double *end;    /* of the array */
    decimal_batch batch;
} decimal_run;

void ffd_decimal_run_begin(decimal_run *run, const double *end);

/* ffd_number_format for a number of the run's array. */
size_t ffd_decimal_run_format(decimal_run *run, const double *value, char text[FFD_NUMBER_CAPACITY]);

#ifdef __cplusplus
}
#endif

#endif
