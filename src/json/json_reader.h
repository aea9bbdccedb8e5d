/* json_reader.h - reads the values of a JSON file. Errors say where (a JSON pointer) and what was found. */
#ifndef FFD_JSON_JSON_READER_H
#define FFD_JSON_JSON_READER_H

#include "json/json_span.h"

/* A value that is read instead of one of the file's. */
typedef struct json_substitute {
    uint32_t value;        /* in the file's tree */
    const json_span *tree; /* its top is read instead */
} json_substitute;

/* A number that was read from within a substitute. */
typedef struct json_trace_entry {
    double *number;    /* where it went */
    uint32_t replaced; /* in the file's tree: what the substitute is read instead of */
    uint32_t value;    /* in the substitute's tree */
} json_trace_entry;

/* All zeros: empty. Its entries are freed with ffd_free. */
typedef struct json_trace {
    json_trace_entry *entries;
    size_t count, capacity;
} json_trace;

/* A parsed file. Its strings must not hold the character U+0000 (JSON_NO_NUL). */
typedef struct json_file {
    const char *name; /* in messages */
    const json_span *tree;
    const json_substitute *substitutes; /* by ascending value */
    size_t substitute_count;
    json_trace *trace; /* gets all numbers that are read from substitutes; or NULL */
    ffd_error *error;  /* of the functions below; may be NULL */
} json_file;

/* One value of the file. */
typedef struct json_cursor {
    const json_file *file;
    const json_span *tree; /* the file's, or a substitute's */
    uint32_t value;        /* in this tree; JSON_NONE: there is no value */
    uint32_t replaced;     /* in the file's tree: the value that a substitute is read instead of */
} json_cursor;

/* The value at the top. */
json_cursor ffd_cursor_top(const json_file *file);
/* The member of an object; no value where it is missing or the cursor is not at an object. */
json_cursor ffd_cursor_member(json_cursor object, const char *key);
/* The first element or member of a container; no value where there is none. */
json_cursor ffd_cursor_first(json_cursor container);
/* The element or member after this; no value at the end. */
json_cursor ffd_cursor_next(json_cursor element);

/* Whether there is a value. */
static inline bool ffd_cursor_exists(json_cursor cursor)
{
    return cursor.value != JSON_NONE;
}

/* Whether there is a value of this kind. */
static inline bool ffd_cursor_is(json_cursor cursor, json_kind kind)
{
    return cursor.value != JSON_NONE && cursor.tree->values[cursor.value].kind == kind;
}

/* The elements or members of a container. */
static inline size_t ffd_cursor_count(json_cursor cursor)
{
    return cursor.tree->values[cursor.value].count;
}

/* A failure at the value: FFD_E_INVALID, or another status. Returns it. */
ffd_status ffd_cursor_fail(json_cursor cursor, const char *format, ...) FFD_PRINTF(2, 3);
/* The same with another status. */
ffd_status ffd_cursor_fail_as(json_cursor cursor, ffd_status status, const char *format, ...)
    FFD_PRINTF(3, 4);

/* What a value is, in words with an article: "an object", "the number 3.5", "the text "abc"". */
typedef struct json_words {
    char text[96];
} json_words;

/* Describes the value, cut where it is long. */
json_words ffd_json_describe(json_cursor cursor);

/* Each reads the value at the cursor, or fails there. */

/* An object whose keys are all known. */
ffd_status ffd_json_read_object(json_cursor cursor, const char *const *known, size_t count);
/* An array of count elements; what: they are called in messages. */
ffd_status ffd_json_read_array(json_cursor cursor, size_t count, const char *what);
/* A number. */
ffd_status ffd_json_read_double(json_cursor cursor, double *number);
/* A whole number, exact: at most 2^53. */
ffd_status ffd_json_read_integer(json_cursor cursor, double *number);
/* An array of count numbers. */
ffd_status ffd_json_read_doubles(json_cursor cursor, size_t count, double *numbers);
/* One of the words: its index; other values fail with the nearest word. */
ffd_status ffd_json_read_word(json_cursor cursor, const char *const *words, size_t count, size_t *index);

/* The member of an object; fails where it is missing. */
ffd_status ffd_json_require(json_cursor object, const char *key, json_cursor *member);
/* The same, and reads it as a number. */
ffd_status ffd_json_member_double(json_cursor object, const char *key, double *number);
/* The same for an array of count numbers. */
ffd_status ffd_json_member_doubles(json_cursor object, const char *key, size_t count, double *numbers);

#endif
