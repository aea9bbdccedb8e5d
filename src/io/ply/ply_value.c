#include "io/ply/ply_value.h"

/* Doubles represent every whole number up to this one. */
#define WHOLE_MAX 9007199254740992.0

static const struct {
    const char *name, *alias;
} names[] = {
    [NUMBER_INT8] = {"char", "int8"},      [NUMBER_UINT8] = {"uchar", "uint8"},
    [NUMBER_INT16] = {"short", "int16"},   [NUMBER_UINT16] = {"ushort", "uint16"},
    [NUMBER_INT32] = {"int", "int32"},     [NUMBER_UINT32] = {"uint", "uint32"},
    [NUMBER_FLOAT] = {"float", "float32"}, [NUMBER_DOUBLE] = {"double", "float64"},
};

bool ffd_ply_type_of(text_word word, number_type *type)
{
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (names[i].name && (ffd_text_is(word, names[i].name) || ffd_text_is(word, names[i].alias))) {
            *type = (number_type)i;
            return true;
        }
    return false;
}

const char *ffd_ply_type_name(number_type type)
{
    return names[type].name;
}

bool ffd_ply_load(ply_encoding encoding, number_type type, text_word word, double *value)
{
    if (encoding == PLY_ASCII)
        return ffd_type_read(type, word, value);
    *value = ffd_type_load(type, encoding == PLY_BIG_ENDIAN, word.first);
    return true;
}

bool ffd_ply_load_count(ply_encoding encoding, number_type type, text_word word, size_t *count)
{
    double value;
    uint64_t whole;
    if (encoding != PLY_ASCII && !number_is_real(type)) {
        const bool is_whole = ffd_type_load_whole(type, encoding == PLY_BIG_ENDIAN, word.first, &whole);
        *count = (size_t)whole;
        return is_whole;
    }
    if (!ffd_ply_load(encoding, type, word, &value) || !(value >= 0 && value < WHOLE_MAX))
        return false;
    whole = (uint64_t)value;
    *count = (size_t)whole;
    return (double)whole == value && *count == whole;
}

size_t ffd_ply_store(ply_encoding encoding, number_type type, double value, char bytes[FFD_NUMBER_CAPACITY])
{
    if (encoding == PLY_ASCII)
        return ffd_type_format(type, value, bytes);
    ffd_type_store(type, encoding == PLY_BIG_ENDIAN, value, bytes);
    return ffd_type_size(type);
}
