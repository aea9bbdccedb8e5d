/* number.h - conversion between numbers and text: correctly rounded in both directions, in any locale.
   Implemented in number_parse.c and number_format.c, with fast paths in decimal.h. */
#ifndef FFD_BASE_TEXT_NUMBER_H
#define FFD_BASE_TEXT_NUMBER_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Enough for every text that the functions below write. */
#define FFD_NUMBER_CAPACITY 40

/* Reads the decimal number at the start of [first, last): optional sign, digits, point, exponent, or inf/nan.
   Returns the end of the number, or NULL if there is none. *value is the nearest double; an overflow gives an
   infinity and an underflow 0, with the sign of the number. */
const char *ffd_number_parse(const char *first, const char *last, double *value);
/* The same for the nearest float, which is not always the float nearest to the nearest double (double
   rounding). */
const char *ffd_number_parse_float(const char *first, const char *last, float *value);

/* Writes the shortest text that reads back as the same double, without a final 0, and returns its length. The
   positional form is used unless the scientific form is shorter ("1", "0.001", "1e+300"). */
size_t ffd_number_format(double value, char text[FFD_NUMBER_CAPACITY]);
/* The same for a float: the shortest text that reads back as the same float. */
size_t ffd_number_format_float(float value, char text[FFD_NUMBER_CAPACITY]);

/* A string with the text of a number, terminated by 0. */
typedef struct number_text {
    char text[FFD_NUMBER_CAPACITY + 1];
} number_text;

/* Returns the shortest text of value, for messages. */
number_text ffd_number_text(double value);
/* Returns the text of value rounded to at most 17 digits, as "%.*g" writes it in the C locale. */
number_text ffd_number_digits(double value, int digits);
/* The same with up to 6 decimals, as "%.*f": of numbers up to 1e30; the text of a larger one is cut off. */
number_text ffd_number_decimals(double value, int decimals);

#ifdef __cplusplus
}
#endif

#endif
