/* number.h - number text: exact both ways, whatever the locale. Declares number_parse.c and number_format.c;
   what meshes mostly hold is done by decimal.h. */
#ifndef FFD_BASE_TEXT_NUMBER_H
#define FFD_BASE_TEXT_NUMBER_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Capacity that is enough for every number written below. */
#define FFD_NUMBER_CAPACITY 40

/* Reads the decimal number at the start of [first, last): optional sign, digits, point, exponent, or inf/nan.
   Returns the end of the number, or NULL if there is none. The nearest double is stored; too large numbers
   give an infinity, too small ones 0, with their sign. */
const char *ffd_number_parse(const char *first, const char *last, double *value);
/* The nearest float, which is not always that of the nearest double. */
const char *ffd_number_parse_float(const char *first, const char *last, float *value);

/* Writes the shortest text that reads back as the same number (no final 0). Returns its length. A whole
   number is written without exponent or point where that is no longer ("1", "0.001", "1e+300"). */
size_t ffd_number_format(double value, char text[FFD_NUMBER_CAPACITY]);
/* The same for a float: the shortest text that reads back as the same float. */
size_t ffd_number_format_float(float value, char text[FFD_NUMBER_CAPACITY]);

/* The shortest text of a number as a string, for messages. */
typedef struct number_text {
    char text[FFD_NUMBER_CAPACITY + 1];
} number_text;

/* The text of value, ended by 0. */
number_text ffd_number_text(double value);

#ifdef __cplusplus
}
#endif

#endif
