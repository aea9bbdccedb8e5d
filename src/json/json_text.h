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

void ffd_json_begin(json_text *json, byte_buffer *out);
/* key is NULL in an array and at the top. */
void ffd_json_object(json_text *json, const char *key, bool on_one_line);
void ffd_json_array(json_text *json, const char *key, bool on_one_line);
void ffd_json_end(json_text *json, char bracket);                          /* '}' or ']' */
void ffd_json_string(json_text *json, const char *key, const char *value); /* NULL gives null */
void ffd_json_number(json_text *json, const char *key, double value);      /* not finite gives null */
void ffd_json_count(json_text *json, const char *key, uint64_t value);
void ffd_json_counts(json_text *json, const json_count *members, size_t count);
void ffd_json_bool(json_text *json, const char *key, bool value);
void ffd_json_null(json_text *json, const char *key);
/* A value that is JSON already, with its line breaks. */
void ffd_json_raw(json_text *json, const char *key, const char *text, size_t size);
void ffd_json_vector(json_text *json, const char *key, const double *values, size_t count); /* on one line */

#endif
