#include "base/text/number_type.h"
#include "base/little_endian.h"

static const struct {
    const char *name;
    unsigned char size;
    bool is_signed;
} types[] = {
    [NUMBER_INT8] = {"int8", 1, true},    [NUMBER_UINT8] = {"uint8", 1, false},
    [NUMBER_INT16] = {"int16", 2, true},  [NUMBER_UINT16] = {"uint16", 2, false},
    [NUMBER_INT32] = {"int32", 4, true},  [NUMBER_UINT32] = {"uint32", 4, false},
    [NUMBER_INT64] = {"int64", 8, true},  [NUMBER_UINT64] = {"uint64", 8, false},
    [NUMBER_FLOAT] = {"float", 4, false}, [NUMBER_DOUBLE] = {"double", 8, false},
};

size_t ffd_type_size(number_type type)
{
    return types[type].size;
}

const char *ffd_type_name(number_type type)
{
    return types[type].name;
}

static uint64_t load_bits(number_type type, bool is_big, const char *bytes)
{
    const unsigned char *const at = (const unsigned char *)bytes;
    const size_t size = types[type].size;
    uint64_t bits = 0;
    if (!is_big && size == 8)
        return load_u64(at);
    if (!is_big && size == 4)
        return load_u32(at);
    for (size_t i = 0; i < size; i++)
        bits |= (uint64_t)at[i] << (8 * (is_big ? size - 1 - i : i));
    return bits;
}

/* Whether these bits are a negative whole number. */
static bool is_negative(number_type type, uint64_t bits)
{
    return types[type].is_signed && bits >> (8 * types[type].size - 1) & 1;
}

double ffd_type_load(number_type type, bool is_big, const char *bytes)
{
    const uint64_t bits = load_bits(type, is_big, bytes);
    const uint32_t low = (uint32_t)bits;
    float narrow;
    double value;
    if (type == NUMBER_FLOAT) {
        memcpy(&narrow, &low, sizeof narrow);
        return narrow;
    }
    if (type == NUMBER_DOUBLE) {
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    if (!is_negative(type, bits))
        return (double)bits;
    return -(double)(types[type].size == 8 ? ~bits + 1 : ((uint64_t)1 << 8 * types[type].size) - bits);
}

bool ffd_type_load_whole(number_type type, bool is_big, const char *bytes, uint64_t *value)
{
    *value = load_bits(type, is_big, bytes);
    return !number_is_real(type) && !is_negative(type, *value);
}

bool ffd_type_read(number_type type, text_word word, double *value)
{
    float narrow;
    if (type != NUMBER_FLOAT)
        return ffd_text_number(word, value);
    if (word.first == word.last || ffd_number_parse_float(word.first, word.last, &narrow) != word.last)
        return false;
    *value = narrow;
    return true;
}

void ffd_type_store(number_type type, bool is_big, double value, char *bytes)
{
    unsigned char low_first[8];
    const size_t size = types[type].size;
    if (type == NUMBER_FLOAT)
        store_float(low_first, (float)value);
    else
        store_double(low_first, value);
    for (size_t i = 0; i < size; i++)
        bytes[i] = (char)low_first[is_big ? size - 1 - i : i];
}

size_t ffd_type_format(number_type type, double value, char text[FFD_NUMBER_CAPACITY])
{
    return type == NUMBER_FLOAT ? ffd_number_format_float((float)value, text)
                                : ffd_number_format(value, text);
}
