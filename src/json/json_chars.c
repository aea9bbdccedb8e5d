#include "json/json_chars.h"
#include "base/bytes.h"
#include <string.h>

static int hex_value(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

/* Reads the four hexadecimal digits after \u. */
static const char *read_hex(const char *c, const char *last, uint32_t *code)
{
    if (last - c < 4)
        return NULL;
    *code = 0;
    for (int i = 0; i < 4; i++) {
        const int digit = hex_value(c[i]);
        if (digit < 0)
            return NULL;
        *code = *code * 16 + (uint32_t)digit;
    }
    return c + 4;
}

static const char *read_unicode_escape(const char *c, const char *last, uint32_t *code)
{
    c = read_hex(c, last, code);
    if (!c || *code < 0xd800 || *code > 0xdfff)
        return c;
    uint32_t low;
    if (*code > 0xdbff || last - c < 2 || c[0] != '\\' || c[1] != 'u')
        return NULL;
    c = read_hex(c + 2, last, &low);
    if (!c || low < 0xdc00 || low > 0xdfff)
        return NULL;
    *code = 0x10000 + ((*code - 0xd800) << 10) + (low - 0xdc00);
    return c;
}

static const char *read_escape(const char *c, const char *last, uint32_t *code)
{
    if (c == last)
        return NULL;
    switch (*c) {
    case '"':
    case '\\':
    case '/':
        *code = (uint32_t)(unsigned char)*c;
        return c + 1;
    case 'b':
        *code = '\b';
        return c + 1;
    case 'f':
        *code = '\f';
        return c + 1;
    case 'n':
        *code = '\n';
        return c + 1;
    case 'r':
        *code = '\r';
        return c + 1;
    case 't':
        *code = '\t';
        return c + 1;
    case 'u':
        return read_unicode_escape(c + 1, last, code);
    default:
        return NULL;
    }
}

const char *ffd_utf8_read(const char *c, const char *last, uint32_t *code)
{
    const unsigned char lead = (unsigned char)*c;
    const int more = lead < 0x80                   ? 0
                     : lead >= 0xc2 && lead < 0xe0 ? 1
                     : lead < 0xf0                 ? 2
                     : lead < 0xf5                 ? 3
                                                   : -1;
    if (more < 0 || (lead >= 0x80 && lead < 0xc2) || last - c <= more)
        return NULL;
    *code = more == 0 ? lead : lead & (0x3fu >> more);
    for (int i = 1; i <= more; i++) {
        const unsigned char next = (unsigned char)c[i];
        if ((next & 0xc0) != 0x80)
            return NULL;
        *code = *code << 6 | (next & 0x3fu);
    }
    const uint32_t least = more == 2 ? 0x800 : more == 3 ? 0x10000 : 0;
    if (*code < least || *code > 0x10ffff || (*code >= 0xd800 && *code <= 0xdfff))
        return NULL;
    return c + more + 1;
}

const char *ffd_json_char(const char *c, const char *last, uint32_t *code)
{
    if (c == last || (unsigned char)*c < 0x20)
        return NULL;
    return *c == '\\' ? read_escape(c + 1, last, code) : ffd_utf8_read(c, last, code);
}

const char *ffd_json_parsed_char(const char *c, const char *last, uint32_t *code)
{
    const char *const next = ffd_json_char(c, last, code);
    if (next)
        return next;
    *code = '?';
    return c + 1;
}

const char *ffd_json_pass_plain(const char *c, const char *last)
{
    for (; last - c >= 8; c += 8) {
        const uint64_t bytes = load_u64((const unsigned char *)c);
        const uint64_t quotes = bytes ^ '"' * BYTES_ONES, escapes = bytes ^ '\\' * BYTES_ONES;
        /* The subtractions set the highest bit of each smaller byte. A borrow can set it wrongly in later
           bytes, but not before the first smaller one. */
        const uint64_t others =
            bytes | ((bytes - ' ' * BYTES_ONES) | (quotes - BYTES_ONES) | (escapes - BYTES_ONES));
        if (others & BYTES_TOPS)
            break;
    }
    return c;
}

size_t ffd_utf8_write(uint32_t code, char bytes[4])
{
    if (code < 0x80) {
        bytes[0] = (char)code;
        return 1;
    }
    const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    static const unsigned char lead[4] = {0, 0xc0, 0xe0, 0xf0};
    for (int i = more; i > 0; i--) {
        bytes[i] = (char)(0x80 | (code & 0x3f));
        code >>= 6;
    }
    bytes[0] = (char)(lead[more] | code);
    return (size_t)more + 1;
}

bool ffd_utf8_is_valid(const char *text, size_t size)
{
    const char *const last = text + size;
    uint32_t code;
    for (const char *c = text; c < last;)
        if (!(c = ffd_utf8_read(c, last, &code)))
            return false;
    return true;
}

size_t ffd_json_decode(const char *c, const char *last, char *text, size_t capacity)
{
    size_t length = 0;
    while (c < last) {
        const char *const plain = ffd_json_pass_plain(c, last);
        const size_t found = (size_t)(plain - c), left = capacity - 1 - length;
        memcpy(text + length, c, found < left ? found : left);
        length += found < left ? found : left;
        if (found > left || plain == last)
            break;
        uint32_t code = 0;
        char bytes[4];
        c = ffd_json_parsed_char(plain, last, &code);
        const size_t size = ffd_utf8_write(code, bytes);
        if (length + size >= capacity)
            break;
        memcpy(text + length, bytes, size);
        length += size;
    }
    text[length] = 0;
    return length;
}
