#include "io/ply/ply_value.h"
#include "base/little_endian.h"
#include <string.h>

/* Doubles represent every whole number up to this one. */
#define WHOLE_MAX 9007199254740992.0

static const struct {
    const char *name, *alias;
    size_t size;
} types[] = {
    [PLY_CHAR] = {"char", "int8", 1},      [PLY_UCHAR] = {"uchar", "uint8", 1},
    [PLY_SHORT] = {"short", "int16", 2},   [PLY_USHORT] = {"ushort", "uint16", 2},
    [PLY_INT] = {"int", "int32", 4},       [PLY_UINT] = {"uint", "uint32", 4},
    [PLY_FLOAT] = {"float", "float32", 4}, [PLY_DOUBLE] = {"double", "float64", 8},
};

bool ffd_ply_type_of(text_word word, ply_type *type)
{
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (ffd_text_is(word, types[i].name) || ffd_text_is(word, types[i].alias)) {
            *type = (ply_type)i;
            return true;
        }
    return false;
}

const char *ffd_ply_type_name(ply_type type)
{
    return types[type].name;
}

size_t ffd_ply_type_size(ply_type type)
{
    return types[type].size;
}

static bool load_text(ply_type type, text_word word, double *value)
{
    float narrow;
    if (type != PLY_FLOAT)
        return ffd_number_parse(word.first, word.last, value) == word.last;
    if (ffd_number_parse_float(word.first, word.last, &narrow) != word.last)
        return false;
    *value = narrow;
    return true;
}

/* Loads the bits of a binary number, the lowest 8 bits from bytes[0] if little-endian. */
static uint64_t load_bits(ply_encoding encoding, text_word word)
{
    uint64_t bits = 0;
    const size_t size = (size_t)(word.last - word.first);
    if (encoding == PLY_LITTLE_ENDIAN && size == sizeof(uint32_t))
        return load_u32((const unsigned char *)word.first);
    for (size_t i = 0; i < size; i++) {
        const unsigned char byte = (unsigned char)word.first[i];
        bits |= (uint64_t)byte << (8 * (encoding == PLY_BIG_ENDIAN ? size - 1 - i : i));
    }
    return bits;
}

/* Whether these bits of an integer type are a negative number. */
static bool is_negative(ply_type type, text_word word, uint64_t bits)
{
    const bool is_signed = type == PLY_CHAR || type == PLY_SHORT || type == PLY_INT;
    return is_signed && word.first < word.last && bits >> (8 * (word.last - word.first) - 1);
}

static double load_whole(ply_type type, text_word word, uint64_t bits)
{
    const uint64_t range = (uint64_t)1 << (8 * (word.last - word.first));
    return is_negative(type, word, bits) ? (double)bits - (double)range : (double)bits;
}

bool ffd_ply_load(ply_encoding encoding, ply_type type, text_word word, double *value)
{
    float narrow;
    if (encoding == PLY_ASCII)
        return load_text(type, word, value);
    const uint64_t bits = load_bits(encoding, word);
    const uint32_t low = (uint32_t)bits;
    if (type == PLY_FLOAT) {
        memcpy(&narrow, &low, sizeof narrow);
        *value = narrow;
    } else if (type == PLY_DOUBLE)
        memcpy(value, &bits, sizeof *value);
    else
        *value = load_whole(type, word, bits);
    return true;
}

bool ffd_ply_load_count(ply_encoding encoding, ply_type type, text_word word, size_t *count)
{
    double value;
    if (encoding != PLY_ASCII && ply_is_whole(type)) {
        const uint64_t bits = load_bits(encoding, word);
        *count = (size_t)bits;
        return !is_negative(type, word, bits);
    }
    if (!ffd_ply_load(encoding, type, word, &value) || !(value >= 0 && value < WHOLE_MAX))
        return false;
    const uint64_t whole = (uint64_t)value;
    *count = (size_t)whole;
    return (double)whole == value && *count == whole;
}

static size_t store_text(ply_type type, double value, char *text)
{
    return type == PLY_FLOAT ? ffd_number_format_float((float)value, text) : ffd_number_format(value, text);
}

size_t ffd_ply_store(ply_encoding encoding, ply_type type, double value, char bytes[FFD_NUMBER_CAPACITY])
{
    unsigned char low_first[8];
    const size_t size = types[type].size;
    if (encoding == PLY_ASCII)
        return store_text(type, value, bytes);
    if (type == PLY_FLOAT)
        store_float(low_first, (float)value);
    else
        store_double(low_first, value);
    for (size_t i = 0; i < size; i++)
        bytes[i] = (char)low_first[encoding == PLY_BIG_ENDIAN ? size - 1 - i : i];
    return size;
}
