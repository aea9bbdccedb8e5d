/* decimal.h - fast paths for the numbers that meshes hold; number_parse.c and number_format.c do the others.
   Declares decimal.c and decimal_parse.c. */
#ifndef FFD_BASE_TEXT_DECIMAL_H
#define FFD_BASE_TEXT_DECIMAL_H

#include "base/text/decimal_kernel.h"
#include "base/text/number.h"
#include <float.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Powers of ten that are doubles, and those below 0. */
#define POWERS_OF_TEN 20
extern const double ffd_powers_of_ten[2][POWERS_OF_TEN];

/* A number, not negative and below 2^62, by a power of ten, or below 0 that much. Returns false if the
   quotient may not be the nearest double. A whole number up to 2^53, or one with enough factors 2, and a
   power of ten up to 10^22 are doubles, so that their quotient is rounded once (Clinger, How to Read Floating
   Point Numbers Accurately, 1990), unless it were longer than a double first. */
static inline bool ffd_decimal_quotient(int64_t number, int power, bool negative, double *value)
{
    const double whole = (double)number;
    if ((FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1) || (int64_t)whole != number)
        return false;
    *value = whole / ffd_powers_of_ten[negative][power];
    return true;
}

/* Reads digits with a point in them or not, of a value that one division by a power of ten gives exactly
   rounded. Returns the end of the number; NULL where the text is not such a number. */
const char *ffd_decimal_parse(const char *first, const char *last, double *value);

/* Writes the shortest text, as ffd_number_format has it. Returns its length, 24 at most (the rest of text is
   undefined); 0 where the number is not one of those that this path is for: 2^-120 to 2^52 in size, of powers
   of two 2^-21 to 2^49. */
size_t ffd_decimal_format(double value, char text[FFD_NUMBER_CAPACITY]);
/* The same for a float: 2^-126 to 2^23 in size, of powers of two 2^-8 to 2^19. */
size_t ffd_decimal_format_float(float value, char text[FFD_NUMBER_CAPACITY]);

/* Numbers of an array whose texts are wanted nearly one after the other: those of many are made at once. The
 * numbers must not change meanwhile. */
typedef struct decimal_run {
    decimal_kernel *kernel;
    const double *first;  /* the texts of this number and of those after it are there; NULL: of none */
    const double *before; /* the number that was wanted last; NULL: none */
    const double *end;    /* of the array */
    decimal_batch batch;
} decimal_run;

/* Starts a run over an array that ends at `end`. */
void ffd_decimal_run_begin(decimal_run *run, const double *end);

/* ffd_number_format for a number of the run's array. */
size_t ffd_decimal_run_format(decimal_run *run, const double *value, char text[FFD_NUMBER_CAPACITY]);

#ifdef __cplusplus
}
#endif

#endif
