/* json_chars.h - UTF-8, and the characters inside a JSON string. */
#ifndef FFD_JSON_JSON_CHARS_H
#define FFD_JSON_JSON_CHARS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads the UTF-8 character at c (c < last). Returns the position after it; NULL if it is not valid. */
const char *ffd_utf8_read(const char *c, const char *last, uint32_t *code);
/* Returns whether a text is valid UTF-8. */
bool ffd_utf8_is_valid(const char *text, size_t size);
/* Writes a character as UTF-8. Returns the number of bytes, 1 to 4. */
size_t ffd_utf8_write(uint32_t code, char bytes[4]);

/* Reads one character of the content of a JSON string at c: plain UTF-8 or an escape (a surrogate pair is one
   character). Returns the position after it; NULL for a control character, invalid UTF-8 or an invalid
   escape. */
const char *ffd_json_char(const char *c, const char *last, uint32_t *code);
/* The same (c < last) in a string that was valid when it was parsed. Never returns NULL: if another program
   has changed the text since (mmap), an invalid byte counts as a question mark. */
const char *ffd_json_parsed_char(const char *c, const char *last, uint32_t *code);

/* Skips ASCII characters that need no escape, several at a time. May stop before the last of them. */
const char *ffd_json_pass_plain(const char *c, const char *last);

/* Decodes the content of a valid JSON string to UTF-8 with a final 0, truncated to capacity at a character
   boundary. Returns the length written. */
size_t ffd_json_decode(const char *c, const char *last, char *text, size_t capacity);

#endif
