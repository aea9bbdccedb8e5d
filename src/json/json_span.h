/* json_span.h - the tree of a parsed JSON text (json_parse.h): where in the text each value is, so that
   single values can be replaced and all other bytes kept. */
#ifndef FFD_JSON_JSON_SPAN_H
#define FFD_JSON_JSON_SPAN_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define JSON_SPAN_DEPTH 256
#define JSON_NONE UINT32_MAX

typedef enum json_kind {
    JSON_NULL,
    JSON_FALSE,
    JSON_TRUE,
    JSON_NUMBER,
    JSON_STRING,
    JSON_ARRAY,
    JSON_OBJECT
} json_kind;

/* Values are in the order of the text; the members of a container follow it. Offsets are into the text. */
typedef struct json_value {
    uint32_t begin, end;         /* the value with its quotes or brackets */
    uint32_t key_begin, key_end; /* its key with the quotes; equal where it has none */
    uint32_t next;               /* number of the first value after this one and all that it holds */
    uint32_t parent;             /* JSON_NONE: the top */
    uint32_t count;              /* members of a container */
    uint8_t kind;                /* json_kind */
} json_value;

typedef struct json_span {
    const char *text; /* not owned; need not end in 0 */
    size_t size;
    json_value *values; /* values[0] is the top */
    size_t count, capacity;
} json_span;

/* Leaves an empty tree. */
void ffd_json_span_free(json_span *tree);

/* The member of an object; JSON_NONE where there is none, or where object is JSON_NONE or no object. */
uint32_t ffd_json_span_member(const json_span *tree, uint32_t object, const char *key);
/* Element i of an array, counted from the first one; JSON_NONE as above. In a loop,
   use ffd_json_span_after. */
uint32_t ffd_json_span_element(const json_span *tree, uint32_t array, size_t i);

/* The first member or element of a container; JSON_NONE where there is none. */
uint32_t ffd_json_span_first(const json_span *tree, uint32_t container);
/* The member or element after `value`; JSON_NONE at the end. */
uint32_t ffd_json_span_after(const json_span *tree, uint32_t value);

/* The number of a value; false if it is not a number. Too large ones give an infinity. */
bool ffd_json_span_number(const json_span *tree, uint32_t value, double *number);
/* The characters of a string, UTF-8, ended by 0 (size, which may be NULL, shows a 0 inside). Free with
   ffd_free. NULL: no memory. */
char *ffd_json_span_string(const json_span *tree, uint32_t value, size_t *size);
/* The same of its key. */
char *ffd_json_span_key(const json_span *tree, uint32_t value);
/* Whether the key of value is text. */
bool ffd_json_span_key_is(const json_span *tree, uint32_t value, const char *text);
/* Whether the string value is text. */
bool ffd_json_span_string_is(const json_span *tree, uint32_t value, const char *text);

/* A member of an object. */
typedef struct json_member {
    const json_span *tree;
    uint32_t value;
} json_member;

/* Lists the members of an object (as many as its count) in the order of their keys. */
void ffd_json_span_sort(const json_span *tree, uint32_t object, json_member *members);
/* Sorts members, perhaps of several trees, by their keys. */
void ffd_json_span_sort_keys(json_member *members, size_t count);

/* Compares two keys by their characters as memcmp would (shorter first). */
int ffd_json_span_compare_keys(const json_span *a, uint32_t x, const json_span *b, uint32_t y);
/* Whether two strings have the same characters. */
bool ffd_json_span_equal_strings(const json_span *a, uint32_t x, const json_span *b, uint32_t y);

/* The JSON pointer (RFC 6901) of a value; "" for the top. Cut to capacity. */
void ffd_json_span_pointer(const json_span *tree, uint32_t value, char *text, size_t capacity);

/* A failure at a value. */
ffd_status ffd_json_span_fail(const json_span *tree, uint32_t value, const char *name, ffd_status status,
                              ffd_error *error, const char *format, ...) FFD_PRINTF(6, 7);

#endif
