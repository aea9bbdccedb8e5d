/* json_text.h - writes JSON for people and programs: two spaces of indent, inline arrays, shortest numbers.
 */
#ifndef FFD_JSON_JSON_TEXT_H
#define FFD_JSON_JSON_TEXT_H

#include "base/text/buffer.h"
#include <stdbool.h>
#include <stdint.h>

#define FFD_JSON_DEPTH 32

typedef struct json_count {
    const char *key;
    uint64_t count;
} json_count;

typedef struct json_text {
    byte_buffer *out;
    int depth;
    bool inline_from[FFD_JSON_DEPTH]; /* this level and all below are on one line */
    bool empty[FFD_JSON_DEPTH];
} json_text;

/* Starts a text at the end of out. */
void ffd_json_begin(json_text *json, byte_buffer *out);
/* Each of the following appends a member with this key, or an element or the top (key NULL). */

/* Opens an object, whose members follow. */
void ffd_json_object(json_text *json, const char *key, bool on_one_line);
/* The same for an array. */
void ffd_json_array(json_text *json, const char *key, bool on_one_line);
/* Closes it by '}' or ']'; the top with a line break. */
void ffd_json_end(json_text *json, char bracket);
/* NULL gives null; bytes that are not UTF-8 become the replacement character. */
void ffd_json_string(json_text *json, const char *key, const char *value);
/* A number that is not finite gives null. */
void ffd_json_number(json_text *json, const char *key, double value);
/* A whole number. */
void ffd_json_count(json_text *json, const char *key, uint64_t value);
/* Several members at once. */
void ffd_json_counts(json_text *json, const json_count *members, size_t count);
/* true or false. */
void ffd_json_bool(json_text *json, const char *key, bool value);
/* null. */
void ffd_json_null(json_text *json, const char *key);
/* A value that is JSON already, with its line breaks. */
void ffd_json_raw(json_text *json, const char *key, const char *text, size_t size);
/* Appends a text that these functions have written, all on one line. */
void ffd_json_join_lines(const char *text, size_t size, byte_buffer *out);
/* An array of numbers on one line. */
void ffd_json_vector(json_text *json, const char *key, const double *values, size_t count);

#endif
