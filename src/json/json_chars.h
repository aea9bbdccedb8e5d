/* json_chars.h - the characters inside a JSON string. */
#ifndef FFD_JSON_JSON_CHARS_H
#define FFD_JSON_JSON_CHARS_H

#include <stddef.h>
#include <stdint.h>

/* Reads one character of a string's inside at c: plain UTF-8 or an escape (a surrogate pair is one
   character). Returns the place behind it; NULL where it is a control character, broken UTF-8 or a broken
   escape. */
const char *ffd_json_char(const char *c, const char *last, uint32_t *code);

/* Goes on behind characters that stand for themselves in a string and in UTF-8, several at a time: perhaps
   not behind all of them. */
const char *ffd_json_pass_plain(const char *c, const char *last);

/* Writes a character as UTF-8; returns its 1 to 4 bytes. */
size_t ffd_utf8_write(uint32_t code, char bytes[4]);

#endif
