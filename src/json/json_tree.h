/* json_tree.h - the tree of a parsed JSON text (json_parse.h). It stores the position of each value in the
   text, so that single values can be replaced while all other bytes are kept. */
#ifndef FFD_JSON_JSON_TREE_H
#define FFD_JSON_JSON_TREE_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define JSON_TREE_DEPTH 256
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

/* A value. Values are stored in the order of the text, so a container is followed by its members. Offsets are
   in bytes from the start of the text. */
typedef struct json_value {
    uint32_t begin, end;         /* the value, including quotes or brackets */
    uint32_t key_begin, key_end; /* its key, including quotes; equal if it has no key */
    uint32_t next;               /* index of the first value after this one and its descendants */
    uint32_t parent;             /* index of the container; JSON_NONE: this is the root */
    uint32_t count;              /* number of members of a container */
    uint8_t kind;                /* json_kind */
} json_value;

typedef struct json_tree {
    const char *text; /* borrowed; needs no final 0 */
    size_t size;
    json_value *values; /* values[0] is the root */
    size_t count, capacity;
    const char *whole; /* where lines are counted from: the text, or that of the file that it is a part of */
    size_t line;       /* the number of the first line there; 0: the file has no lines */
} json_tree;

/* Frees the tree and empties it. */
void ffd_json_tree_free(json_tree *tree);

/* Returns the member of an object; JSON_NONE if it is missing, or if object is JSON_NONE or not an object. */
uint32_t ffd_json_tree_member(const json_tree *tree, uint32_t object, const char *key);
/* Returns element i of an array; JSON_NONE as above. Takes time in proportion to i: in a loop, use
   ffd_json_tree_after. */
uint32_t ffd_json_tree_element(const json_tree *tree, uint32_t array, size_t i);

/* Returns the first member or element of a container; JSON_NONE if there is none. */
uint32_t ffd_json_tree_first(const json_tree *tree, uint32_t container);
/* Returns the member or element after `value`; JSON_NONE at the end. */
uint32_t ffd_json_tree_after(const json_tree *tree, uint32_t value);

/* Returns the number of members or elements of a container; 0 if value is JSON_NONE. */
static inline size_t ffd_json_tree_count(const json_tree *tree, uint32_t value)
{
    return value == JSON_NONE ? 0 : tree->values[value].count;
}

/* Reads a number. Returns false if the value is not a number. An overflow gives an infinity. */
bool ffd_json_tree_number(const json_tree *tree, uint32_t value, double *number);
/* Returns the decoded string in UTF-8 with a final 0; free it with ffd_free. *size is its length, which tells
   whether it contains a 0. size may be NULL: U+0000 is then replaced by its symbol, U+2400, so that the text
   neither ends there nor equals one without it. Returns NULL if memory runs out. */
char *ffd_json_tree_string(const json_tree *tree, uint32_t value, size_t *size);
/* The same for the key of a value, with that symbol. */
char *ffd_json_tree_key(const json_tree *tree, uint32_t value);
/* Returns the text of a value as it stands, with a final 0; free it with ffd_free. NULL if memory runs out.
 */
char *ffd_json_tree_text(const json_tree *tree, uint32_t value);
/* Returns whether the key of a value equals text. */
bool ffd_json_tree_key_is(const json_tree *tree, uint32_t value, const char *text);
/* Returns whether a string value equals text. */
bool ffd_json_tree_string_is(const json_tree *tree, uint32_t value, const char *text);

/* A member of an object. */
typedef struct json_member {
    const json_tree *tree;
    uint32_t value;
} json_member;

/* Fills members, with room for the object's count, with its members sorted by key. */
void ffd_json_tree_sort(const json_tree *tree, uint32_t object, json_member *members);
/* Sorts members, also of different trees, by key. */
void ffd_json_tree_sort_keys(json_member *members, size_t count);

/* Compares two keys by their decoded characters, as strcmp does. */
int ffd_json_tree_compare_keys(const json_tree *a, uint32_t x, const json_tree *b, uint32_t y);
/* Returns whether two strings have the same decoded characters. */
bool ffd_json_tree_equal_strings(const json_tree *a, uint32_t x, const json_tree *b, uint32_t y);

/* Writes the JSON pointer (RFC 6901) of a value, "" for the root, truncated to capacity. */
void ffd_json_tree_pointer(const json_tree *tree, uint32_t value, char *text, size_t capacity);

/* Returns the line of a value, from 1; 0 if the file has no lines. Takes time in proportion to what stands
   before it: in a loop, use ffd_json_tree_line_from. */
size_t ffd_json_tree_line(const json_tree *tree, uint32_t value);

/* Where lines are counted on from. All zeros: the start. */
typedef struct json_line_mark {
    const char *at;
    size_t line;
} json_line_mark;

/* The same, counted from the mark, which moves to the value. A value before the mark is counted anew. */
size_t ffd_json_tree_line_from(const json_tree *tree, uint32_t value, json_line_mark *mark);

/* Fills error with a message at a value, and returns status. */
ffd_status ffd_json_tree_fail(const json_tree *tree, uint32_t value, const char *name, ffd_status status,
                              ffd_error *error, const char *format, ...) FFD_PRINTF(6, 7);

#endif
