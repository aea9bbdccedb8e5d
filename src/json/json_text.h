/* json_text.h - writes JSON, readable for people too: indented by two spaces, with arrays of numbers on one
   line and the shortest number texts. */
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
    bool inline_from[FFD_JSON_DEPTH]; /* this level and all deeper ones are on one line */
    bool empty[FFD_JSON_DEPTH];
} json_text;

/* Starts a text at the end of out. */
void ffd_json_begin(json_text *json, byte_buffer *out);
/* Each of the following appends a member with this key, or with key NULL an element or the root. */

/* Opens an object, whose members follow. */
void ffd_json_object(json_text *json, const char *key, bool on_one_line);
/* The same for an array. */
void ffd_json_array(json_text *json, const char *key, bool on_one_line);
/* Closes an object or array with '}' or ']'; the root also with a line break. */
void ffd_json_end(json_text *json, char bracket);
/* A string; NULL gives null. Invalid UTF-8 becomes the replacement character. */
void ffd_json_string(json_text *json, const char *key, const char *value);
/* A number; null if it is not finite. */
void ffd_json_number(json_text *json, const char *key, double value);
/* An integer. */
void ffd_json_count(json_text *json, const char *key, uint64_t value);
/* Several members with integers. */
void ffd_json_counts(json_text *json, const json_count *members, size_t count);
/* true or false. */
void ffd_json_bool(json_text *json, const char *key, bool value);
/* null. */
void ffd_json_null(json_text *json, const char *key);
/* A text that is JSON already, copied with its line breaks. */
void ffd_json_raw(json_text *json, const char *key, const char *text, size_t size);
/* Appends a text that these functions have written, joined to one line. */
void ffd_json_join_lines(const char *text, size_t size, byte_buffer *out);
/* An array of numbers on one line. */
void ffd_json_vector(json_text *json, const char *key, const double *values, size_t count);

#endif
