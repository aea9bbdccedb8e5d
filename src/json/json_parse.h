/* json_parse.h - finds the values of a JSON text. Strict RFC 8259; a key twice in one object is an error. */
#ifndef FFD_JSON_JSON_PARSE_H
#define FFD_JSON_JSON_PARSE_H

#include "json/json_span.h"

/* What else is allowed or refused, by its reader; any of these together. */
enum {
    JSON_ALLOW_MARK = 1, /* a byte order mark before the text is skipped (RFC 8259, 8.1) */
    JSON_NO_NUL = 2,     /* refuses the character U+0000 in keys and strings: they fit C strings */
    JSON_DOUBLES = 4,    /* refuses numbers out of the range of a double */
    JSON_INTEGERS = 8    /* refuses numbers without fraction and exponent that do not fit 64 bits */
};

typedef struct json_input {
    const char *text; /* need not end in 0 */
    size_t size;
    const char *name;  /* of the file, in messages */
    const char *whole; /* the file's text, which `text` is a part of: for lines and columns; NULL: text */
    size_t line;       /* of the file where `whole` begins; 0: the first */
    unsigned rules;
} json_input;

/* Finds the values of a text, which must outlive the tree. Errors: FFD_E_INVALID with line and column,
   FFD_E_LIMIT (4 GiB), FFD_E_MEMORY. On failure *tree is empty. */
ffd_status ffd_json_parse(const json_input *input, json_span *tree, ffd_error *error);

#endif
