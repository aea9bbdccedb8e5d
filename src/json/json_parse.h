/* json_parse.h - parses a JSON text into a tree of positions. Strict RFC 8259; duplicate keys in an object
   are an error. */
#ifndef FFD_JSON_JSON_PARSE_H
#define FFD_JSON_JSON_PARSE_H

#include "json/json_tree.h"

/* Additional rules of a reader, combined with |. */
enum {
    JSON_ALLOW_MARK = 1,   /* a byte order mark before the text is skipped (RFC 8259, 8.1) */
    JSON_NO_NUL = 2,       /* refuses U+0000 in keys and strings, so that they are valid C strings */
    JSON_DOUBLES = 4,      /* refuses numbers that overflow a double */
    JSON_INTEGERS = 8,     /* refuses integers (numbers without fraction and exponent) that do not fit in 64
                              bits */
    JSON_HAS_COMMENT = 16, /* a message that JSON has no comments names the member "comment" */
    JSON_NO_LINES = 32     /* the text is a part of a binary file: messages about values have no line */
};

typedef struct json_input {
    const char *text; /* needs no final 0 */
    size_t size;
    const char *name;  /* file name for messages */
    const char *whole; /* the text of the whole file, of which `text` is a part, to count lines and columns;
                          NULL: the same as text */
    size_t line;       /* line number of the beginning of `whole`; 0: line 1 */
    unsigned rules;
} json_input;

/* Parses a text, which must outlive the tree. *tree is empty after a failure. Errors: FFD_E_INVALID with line
   and column, FFD_E_LIMIT (4 GiB), FFD_E_MEMORY. */
ffd_status ffd_json_parse(const json_input *input, json_tree *tree, ffd_error *error);

#endif
