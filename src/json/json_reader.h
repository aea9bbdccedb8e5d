/* json_reader.h - reading parsed JSON with errors that say where (a JSON pointer) and what (the value). */
#ifndef FFD_JSON_JSON_READER_H
#define FFD_JSON_JSON_READER_H

#include "base/fail.h"
#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* Where the reader is. The schema's own depth bounds the pointer; a longer one is cut. */
typedef struct json_place {
    const char *file;
    ffd_error *error;
    char pointer[256];
    size_t length;
} json_place;

/* Goes into a member or an element; returns the place to go back to with ffd_place_leave. */
size_t ffd_place_enter(json_place *place, const char *key);
size_t ffd_place_enter_index(json_place *place, size_t index);
void ffd_place_leave(json_place *place, size_t before);

/* FFD_E_INVALID at the place. */
ffd_status ffd_place_fail(const json_place *place, const char *format, ...) FFD_PRINTF(2, 3);

/* What a value is, in words with its article: "an object", "the number 3.5", "the text "abc"". */
typedef struct json_words {
    char text[96];
} json_words;

json_words ffd_json_describe(const json_t *value);

/* Each reads value, which stands at place, or fails there. */
ffd_status ffd_json_read_object(json_place *place, const json_t *value, const char *const *known,
                                size_t count);
ffd_status ffd_json_read_array(json_place *place, const json_t *value, size_t count, const char *what);
ffd_status ffd_json_read_double(json_place *place, const json_t *value, double *number);
ffd_status ffd_json_read_integer(json_place *place, const json_t *value, double *number);
ffd_status ffd_json_read_doubles(json_place *place, const json_t *value, size_t count, double *numbers);
/* One of the words: its index; other values fail with the nearest word. */
ffd_status ffd_json_read_word(json_place *place, const json_t *value, const char *const *words, size_t count,
                              size_t *index);

/* A member of object by key, which a missing one is a failure for. */
ffd_status ffd_json_require(json_place *place, const json_t *object, const char *key, const json_t **member);
/* The same for a member that is a number, or an array of count numbers. */
ffd_status ffd_json_member_double(json_place *place, const json_t *object, const char *key, double *number);
ffd_status ffd_json_member_doubles(json_place *place, const json_t *object, const char *key, size_t count,
                                   double *numbers);

#endif
