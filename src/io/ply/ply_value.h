/* ply_value.h - the numbers of a PLY file: their types, and how the file stores them. A text_word holds a
   binary number's bytes too. */
#ifndef FFD_IO_PLY_PLY_VALUE_H
#define FFD_IO_PLY_PLY_VALUE_H

#include "base/little_endian.h"
#include "base/text/number.h"
#include "io/text/text_scan.h"
#include <stdbool.h>
#include <stddef.h>

typedef enum ply_encoding { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } ply_encoding;

/* Whole numbers first. */
typedef enum ply_type {
    PLY_CHAR,
    PLY_UCHAR,
    PLY_SHORT,
    PLY_USHORT,
    PLY_INT,
    PLY_UINT,
    PLY_FLOAT,
    PLY_DOUBLE
} ply_type;

/* "float" and "float32" are the same type; the former is its name here. */
bool ffd_ply_type_of(text_word word, ply_type *type);
/* The name of a type in messages. */
const char *ffd_ply_type_name(ply_type type);
/* The bytes of a type's values. */
size_t ffd_ply_type_size(ply_type type);

static inline bool ply_is_whole(ply_type type)
{
    return type < PLY_FLOAT;
}

/* Reads a number as its type holds it (the text of a float means the nearest float). A text of a whole type
   may be any number. Returns false if a text is not a number; binary values always are. */
bool ffd_ply_load(ply_encoding encoding, ply_type type, text_word word, double *value);

/* Reads a binary number; most are floats. */
static inline double ply_load_binary(ply_encoding encoding, ply_type type, const char *at)
{
    double value;
    if (type == PLY_FLOAT && encoding == PLY_LITTLE_ENDIAN)
        return load_float((const unsigned char *)at);
    ffd_ply_load(encoding, type, (text_word){at, at + ffd_ply_type_size(type)}, &value);
    return value;
}

/* A list's count or an index: a whole number that is not negative. */
bool ffd_ply_load_count(ply_encoding encoding, ply_type type, text_word word, size_t *count);

/* value as a float or double holds it. */
static inline double ply_round(ply_type type, double value)
{
    return type == PLY_FLOAT ? (double)(float)value : value;
}

/* Writes a value that ply_round gave: the bytes, or the shortest text that reads back. Returns the size.
 */
size_t ffd_ply_store(ply_encoding encoding, ply_type type, double value, char bytes[FFD_NUMBER_CAPACITY]);

/* Writes a binary one. */
static inline void ply_store_binary(ply_encoding encoding, ply_type type, double value, char *at)
{
    char bytes[FFD_NUMBER_CAPACITY];
    if (type == PLY_FLOAT && encoding == PLY_LITTLE_ENDIAN)
        store_float((unsigned char *)at, (float)value);
    else
        memcpy(at, bytes, ffd_ply_store(encoding, type, value, bytes));
}

#endif
