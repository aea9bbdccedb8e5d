/* json_reader.h - reads the values of a JSON file. Error messages contain the JSON pointer and the value
   found. */
#ifndef FFD_JSON_JSON_READER_H
#define FFD_JSON_JSON_READER_H

#include "json/json_tree.h"

/* Replacement value of a placeholder. */
typedef struct json_substitute {
    uint32_t value;        /* index in the tree of the file */
    const json_tree *tree; /* its root is the replacement */
} json_substitute;

/* A number that was read from a substitute. */
typedef struct json_trace_entry {
    double *number;    /* where the number was stored */
    uint32_t replaced; /* index in the tree of the file: the value that the substitute replaces */
    uint32_t value;    /* index in the tree of the substitute */
} json_trace_entry;

/* All zeros: empty. Free the entries with ffd_free. */
typedef struct json_trace {
    json_trace_entry *entries;
    size_t count, capacity;
} json_trace;

/* A parsed file. Its strings must not contain U+0000 (JSON_NO_NUL). */
typedef struct json_file {
    const char *name; /* for messages */
    const json_tree *tree;
    const json_substitute *substitutes; /* sorted by ascending value */
    size_t substitute_count;
    json_trace *trace; /* records all numbers that are read from substitutes; may be NULL */
    ffd_error *error;  /* filled by the functions below; may be NULL */
} json_file;

/* A position in the file: one value. */
typedef struct json_cursor {
    const json_file *file;
    const json_tree *tree; /* the file's, or a substitute's */
    uint32_t value;        /* index in this tree; JSON_NONE: no value */
    uint32_t replaced;     /* if tree is a substitute's: the value in the file's tree that it replaces */
} json_cursor;

/* Returns the root of the file. */
json_cursor ffd_cursor_top(const json_file *file);
/* Returns a member of an object; no value if it is missing or the cursor is not at an object. */
json_cursor ffd_cursor_member(json_cursor object, const char *key);
/* Returns the first element or member of a container; no value if there is none. */
json_cursor ffd_cursor_first(json_cursor container);
/* Returns the next element or member; no value at the end. */
json_cursor ffd_cursor_next(json_cursor element);

/* Returns whether the cursor is at a value. */
static inline bool ffd_cursor_exists(json_cursor cursor)
{
    return cursor.value != JSON_NONE;
}

/* Returns whether the cursor is at a value of this kind. */
static inline bool ffd_cursor_is(json_cursor cursor, json_kind kind)
{
    return cursor.value != JSON_NONE && cursor.tree->values[cursor.value].kind == kind;
}

/* Returns the number of elements or members of a container. */
static inline size_t ffd_cursor_count(json_cursor cursor)
{
    return cursor.tree->values[cursor.value].count;
}

/* Returns the line of the value in the file, from 1. */
size_t ffd_cursor_line(json_cursor cursor);
/* The same for one of many values: as ffd_json_tree_line_from. */
size_t ffd_cursor_line_from(json_cursor cursor, json_line_mark *mark);

/* Fills the file's error with a message at the value. Returns FFD_E_INVALID. */
ffd_status ffd_cursor_fail(json_cursor cursor, const char *format, ...) FFD_PRINTF(2, 3);
/* The same with another status. */
ffd_status ffd_cursor_fail_as(json_cursor cursor, ffd_status status, const char *format, ...)
    FFD_PRINTF(3, 4);

/* A description of a value with its article: "an object", "the number 3.5", "the text "abc"". */
typedef struct json_words {
    char text[96];
} json_words;

/* Describes the value; long ones are truncated. */
json_words ffd_json_describe(json_cursor cursor);

/* Each of the following reads the value at the cursor, or fails with its position. */

/* Checks that the value is an object and all its keys are known. */
ffd_status ffd_json_read_object(json_cursor cursor, const char *const *known, size_t count);
/* Checks that the value is an array of count elements. what: name of the elements, for messages. */
ffd_status ffd_json_read_array(json_cursor cursor, size_t count, const char *what);
/* A number. */
ffd_status ffd_json_read_double(json_cursor cursor, double *number);
/* An integer of magnitude up to 2^53, which is exact in a double. */
ffd_status ffd_json_read_integer(json_cursor cursor, double *number);
/* An array of count numbers. */
ffd_status ffd_json_read_doubles(json_cursor cursor, size_t count, double *numbers);
/* One of the words; *index is its index. The message for another value contains the most similar word. */
ffd_status ffd_json_read_word(json_cursor cursor, const char *const *words, size_t count, size_t *index);

/* Finds a required member of an object; fails if it is missing. */
ffd_status ffd_json_require(json_cursor object, const char *key, json_cursor *member);
/* Reads a required member that is a number. */
ffd_status ffd_json_member_double(json_cursor object, const char *key, double *number);
/* Reads a required member that is an array of count numbers. */
ffd_status ffd_json_member_doubles(json_cursor object, const char *key, size_t count, double *numbers);

#endif
