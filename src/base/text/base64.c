#include "base/text/base64.h"
#include <stdint.h>
#include <string.h>

#define NONE 64

/* The 6 bits that each character encodes; NONE: not a base64 character. */
static const uint8_t values[256] = {
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, 62,   NONE, NONE, NONE, 63,
    52,   53,   54,   55,   56,   57,   58,   59,   60,   61,   NONE, NONE, NONE, NONE, NONE, NONE,
    NONE, 0,    1,    2,    3,    4,    5,    6,    7,    8,    9,    10,   11,   12,   13,   14,
    15,   16,   17,   18,   19,   20,   21,   22,   23,   24,   25,   NONE, NONE, NONE, NONE, NONE,
    NONE, 26,   27,   28,   29,   30,   31,   32,   33,   34,   35,   36,   37,   38,   39,   40,
    41,   42,   43,   44,   45,   46,   47,   48,   49,   50,   51,   NONE, NONE, NONE, NONE, NONE,
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,
    NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE,
};

/* Reads count (up to 4) base64 characters into the highest of 24 bits. Returns false at any other
   character. */
static bool read_digits(const char *text, size_t count, uint32_t *bits)
{
    uint32_t all = 0;
    *bits = 0;
    for (size_t i = 0; i < 4; i++) {
        const uint32_t value = i < count ? values[(unsigned char)text[i]] : 0;
        *bits = *bits << 6 | value;
        all |= value;
    }
    return all < NONE;
}

bool ffd_base64_decode(const char *text, size_t size, unsigned char *bytes, size_t *count)
{
    uint32_t bits;
    for (int i = 0; i < 2 && size > 0 && text[size - 1] == '='; i++)
        size--;
    const size_t rest = size % 4, whole = size - rest;
    if (rest == 1)
        return false;
    *count = whole / 4 * 3 + (rest ? rest - 1 : 0);
    for (size_t i = 0; i < whole; i += 4, bytes += 3) {
        if (!read_digits(text + i, 4, &bits))
            return false;
        bytes[0] = (unsigned char)(bits >> 16);
        bytes[1] = (unsigned char)(bits >> 8);
        bytes[2] = (unsigned char)bits;
    }
    if (!read_digits(text + whole, rest, &bits))
        return false;
    for (size_t i = 0; i + 1 < rest; i++)
        bytes[i] = (unsigned char)(bits >> (16 - 8 * i));
    return true;
}

void ffd_base64_encode(const unsigned char *bytes, size_t count, char *text)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < count; i += 3) {
        const size_t left = count - i;
        const uint32_t bits = (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) |
                              (left > 2 ? bytes[i + 2] : 0);
        *text++ = digits[bits >> 18];
        *text++ = digits[bits >> 12 & 63];
        *text++ = left > 1 ? digits[bits >> 6 & 63] : '=';
        *text++ = left > 2 ? digits[bits & 63] : '=';
    }
}

size_t ffd_base64_take(const char **at, const char *last, unsigned char *bytes, size_t count)
{
    char four[4];
    unsigned char three[6];
    size_t done = 0, filled = 0, made;
    while (done < count && *at < last && **at != '<') {
        const char c = *(*at)++;
        if (c == ' ' || c == '\n' || c == '\r' || c == '\t')
            continue;
        four[filled++] = c;
        if (filled < 4)
            continue;
        filled = 0;
        if (!ffd_base64_decode(four, 4, three, &made) || made == 0)
            return done;
        const size_t taken = made < count - done ? made : count - done;
        memcpy(bytes + done, three, taken);
        done += taken;
    }
    return done;
}
