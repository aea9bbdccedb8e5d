/* number_type.h - the types of the numbers in files of several formats: in text, or in binary of either byte
   order. */
#ifndef FFD_BASE_TEXT_NUMBER_TYPE_H
#define FFD_BASE_TEXT_NUMBER_TYPE_H

#include "base/text/number.h"
#include "base/text/text_scan.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Integer types first. */
typedef enum number_type {
    NUMBER_INT8,
    NUMBER_UINT8,
    NUMBER_INT16,
    NUMBER_UINT16,
    NUMBER_INT32,
    NUMBER_UINT32,
    NUMBER_INT64,
    NUMBER_UINT64,
    NUMBER_FLOAT,
    NUMBER_DOUBLE
} number_type;

/* Returns the size of a type in bytes. */
size_t ffd_type_size(number_type type);
/* Returns the name of a type, for messages. */
const char *ffd_type_name(number_type type);

static inline bool number_is_real(number_type type)
{
    return type >= NUMBER_FLOAT;
}

/* Reads a number in binary. */
double ffd_type_load(number_type type, bool is_big, const char *bytes);
/* Reads a whole number in binary. Returns false if it is negative, or of a type that is not whole. */
bool ffd_type_load_whole(number_type type, bool is_big, const char *bytes, uint64_t *value);
/* Reads a text, rounded once to its type. Returns false if it is not a number. */
bool ffd_type_read(number_type type, text_word word, double *value);

/* Rounds to a float, or leaves a double. */
static inline double number_round(number_type type, double value)
{
    return type == NUMBER_FLOAT ? (double)(float)value : value;
}

/* Writes a float or double in binary. */
void ffd_type_store(number_type type, bool is_big, double value, char *bytes);
/* Writes the shortest text that reads back as the same number of the type. Returns its length. */
size_t ffd_type_format(number_type type, double value, char text[FFD_NUMBER_CAPACITY]);

#endif
