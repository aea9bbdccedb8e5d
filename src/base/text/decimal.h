/* decimal.h - fast paths for numbers as they are common in meshes; number_parse.c and number_format.c handle
   all others. Declares decimal.c and decimal_parse.c. */
#ifndef FFD_BASE_TEXT_DECIMAL_H
#define FFD_BASE_TEXT_DECIMAL_H

#include "base/text/decimal_kernel.h"
#include "base/text/number.h"
#include <float.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ffd_powers_of_ten[0][i] = 10^i, exact as double; [1][i] = -10^i. */
#define POWERS_OF_TEN 20
extern const double ffd_powers_of_ten[2][POWERS_OF_TEN];

/* Sets *value to number / 10^power, or to its negative. 0 <= number < 2^62. Returns false if the quotient
   might not be correctly rounded. An integer up to 2^53 (or a larger one with enough factors of 2) and a
   power of ten up to 10^22 are exact doubles, so the quotient is rounded only once (Clinger, How to Read
   Floating Point Numbers Accurately, 1990). */
static inline bool ffd_decimal_quotient(int64_t number, int power, bool negative, double *value)
{
    const double whole = (double)number;
    if ((FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1) || (int64_t)whole != number)
        return false;
    *value = whole / ffd_powers_of_ten[negative][power];
    return true;
}

/* Reads a number of digits, with or without a decimal point, whose value one division by a power of ten gives
   correctly rounded. Returns the end of the number; NULL if the text is not such a number. */
const char *ffd_decimal_parse(const char *first, const char *last, double *value);

/* Writes the shortest text, as ffd_number_format does. Returns its length, at most 24 (the rest of text is
   undefined); 0 if this path does not handle the number. It handles magnitudes from 2^-120 to 2^52, but
   powers of two only from 2^-21 to 2^49. */
size_t ffd_decimal_format(double value, char text[FFD_NUMBER_CAPACITY]);
/* The same for a float: magnitudes from 2^-126 to 2^23, powers of two from 2^-8 to 2^19. */
size_t ffd_decimal_format_float(float value, char text[FFD_NUMBER_CAPACITY]);

/* Formats the numbers of an array in batches, for callers that need their texts in nearly ascending order.
   The numbers must not change meanwhile. */
typedef struct decimal_run {
    decimal_kernel *kernel;
    const double *first;  /* the first number whose text is available; NULL: none */
    const double *before; /* the number that was requested last; NULL: none */
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
