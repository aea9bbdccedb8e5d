/* ply_value.h - the numbers of a PLY file: their types, and their encoding. A text_word may also hold the
   bytes of a binary number. */
#ifndef FFD_IO_PLY_PLY_VALUE_H
#define FFD_IO_PLY_PLY_VALUE_H

#include "base/little_endian.h"
#include "base/text/number_type.h"
#include "base/text/text_scan.h"
#include <stdbool.h>
#include <stddef.h>

typedef enum ply_encoding { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } ply_encoding;

/* Finds the type of a name. "float" and "float32" are the same type, called float here. */
bool ffd_ply_type_of(text_word word, number_type *type);
/* Returns the name of a type, for messages. */
const char *ffd_ply_type_name(number_type type);

/* Reads a number, rounded to its type: the text of a float means the nearest float. The text of an integer
   type may be any number. Returns false if a text is not a number; binary values always are. */
bool ffd_ply_load(ply_encoding encoding, number_type type, text_word word, double *value);

/* Reads a binary number. The most common type, float, comes first. */
static inline double ply_load_binary(ply_encoding encoding, number_type type, const char *at)
{
    double value;
    if (type == NUMBER_FLOAT && encoding == PLY_LITTLE_ENDIAN)
        return load_float((const unsigned char *)at);
    ffd_ply_load(encoding, type, (text_word){at, at + ffd_type_size(type)}, &value);
    return value;
}

/* Reads a list's count or an index. Returns false if it is not a nonnegative whole number. */
bool ffd_ply_load_count(ply_encoding encoding, number_type type, text_word word, size_t *count);

/* Writes a value that number_round returned: its bytes, or the shortest text that reads back as the same
   number. Returns the size. */
size_t ffd_ply_store(ply_encoding encoding, number_type type, double value, char bytes[FFD_NUMBER_CAPACITY]);

/* Writes a binary number. */
static inline void ply_store_binary(ply_encoding encoding, number_type type, double value, char *at)
{
    char bytes[FFD_NUMBER_CAPACITY];
    if (type == NUMBER_FLOAT && encoding == PLY_LITTLE_ENDIAN)
        store_float((unsigned char *)at, (float)value);
    else
        memcpy(at, bytes, ffd_ply_store(encoding, type, value, bytes));
}

#endif
