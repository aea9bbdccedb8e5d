/* json_edit.h - a list of edits that replace ranges of a JSON text; all other bytes stay. */
#ifndef FFD_JSON_JSON_EDIT_H
#define FFD_JSON_JSON_EDIT_H

#include "base/text/buffer.h"
#include "json/json_tree.h"
#include <stdint.h>

#define EDIT_NO_BUFFER (-1)

typedef struct json_edit {
    uint32_t begin, end;    /* the range that is replaced; if empty, the text is inserted */
    size_t order;           /* number of the call, to keep the order of insertions at one offset */
    size_t text, text_size; /* range of the new text in the pool */
    int buffer;             /* a glTF buffer whose new content, as base64, is the new text; or
                               EDIT_NO_BUFFER */
} json_edit;

typedef struct json_edits {
    json_edit *edits;
    size_t count, capacity;
    byte_buffer pool;
    bool failed; /* memory ran out: some edits are lost */
} json_edits;

/* Replaces a range by a text, which is copied. The ranges of a list must not overlap. Texts at the same
   offset are inserted in the order of the calls. */
void ffd_edits_replace(json_edits *edits, uint32_t begin, uint32_t end, const char *text, size_t size);
/* Replaces a range by formatted text of less than 256 bytes. */
void ffd_edits_format(json_edits *edits, uint32_t begin, uint32_t end, const char *format, ...)
    FFD_PRINTF(4, 5);
/* Replaces a range by the new content of a glTF buffer, as base64. */
void ffd_edits_buffer(json_edits *edits, uint32_t begin, uint32_t end, int buffer);

/* Adds the edits of another list, none of them of a buffer. */
void ffd_edits_join(json_edits *edits, const json_edits *others);

/* Removes members of an object, or elements of an array, with their commas. At most once for each
   container. */
void ffd_edits_remove(json_edits *edits, const json_tree *tree, uint32_t container, const uint32_t *gone,
                      size_t gone_count);

/* Sorts the edits by offset. To be called before they are applied. */
void ffd_edits_sort(json_edits *edits);
/* Appends text[begin, end) to out with the edits in that range applied; none of them may be of a buffer. */
void ffd_edits_apply(const json_edits *edits, const char *text, uint32_t begin, uint32_t end,
                     byte_buffer *out);

/* Returns whether memory ran out. */
bool ffd_edits_failed(const json_edits *edits);
/* Frees the list and empties it. */
void ffd_edits_free(json_edits *edits);

#endif
