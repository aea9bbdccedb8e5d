/* json_edit.h - replacements of spans of a JSON text; everything between them stays as it is. */
#ifndef FFD_JSON_JSON_EDIT_H
#define FFD_JSON_JSON_EDIT_H

#include "base/text/buffer.h"
#include "json/json_span.h"
#include <stdint.h>

#define EDIT_NO_BUFFER (-1)

typedef struct json_edit {
    uint32_t begin, end;    /* replaced; equal: inserted */
    size_t order;           /* of the call */
    size_t text, text_size; /* the new text, in the list's pool */
    int buffer;             /* instead of text: the base64 of this buffer's new content; or EDIT_NO_BUFFER */
} json_edit;

typedef struct json_edits {
    json_edit *edits;
    size_t count, capacity;
    byte_buffer pool;
    bool failed; /* memory ran out: some edits are lost */
} json_edits;

/* The spans of one list must not overlap; at one offset, texts are inserted in the order of the calls. */
void ffd_edits_replace(json_edits *edits, uint32_t begin, uint32_t end, const char *text, size_t size);
/* Replaces a span by formatted text, of less than 256 bytes. */
void ffd_edits_format(json_edits *edits, uint32_t begin, uint32_t end, const char *format, ...)
    FFD_PRINTF(4, 5);
/* Replaces a span by the base64 of a buffer's new content. */
void ffd_edits_buffer(json_edits *edits, uint32_t begin, uint32_t end, int buffer);

/* Takes members of an object (or elements of an array) out, with the commas that go; once a container. */
void ffd_edits_remove(json_edits *edits, const json_span *tree, uint32_t container, const uint32_t *gone,
                      size_t gone_count);

/* Must come before what follows. */
void ffd_edits_sort(json_edits *edits);
/* Appends text[begin, end) with the edits that lie in it (none may be of a buffer). */
void ffd_edits_apply(const json_edits *edits, const char *text, uint32_t begin, uint32_t end,
                     byte_buffer *out);

/* Whether memory ran out. */
bool ffd_edits_failed(const json_edits *edits);
/* Leaves an empty list. */
void ffd_edits_free(json_edits *edits);

#endif
