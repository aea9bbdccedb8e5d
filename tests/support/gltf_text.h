/* gltf_text.h - makes the text of a glTF file with an embedded buffer. Includes come after cmocka.h. */
#ifndef FFD_TESTS_GLTF_TEXT_H
#define FFD_TESTS_GLTF_TEXT_H

#include "base/text/base64.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One bufferView covers the buffer. members: the rest of the JSON, from "accessors" on. Free the text with
   free(). */
static inline char *gltf_text(const void *bytes, size_t size, const char *members)
{
    static const char form[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:application/"
        "octet-stream;base64,%s\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu}],%s}";
    char *const base64 = calloc(2, size + 2);
    const size_t capacity = sizeof form + 2 * size + strlen(members) + 60;
    char *const text = malloc(capacity);
    assert_true(base64 && text);
    ffd_base64_encode(bytes, size, base64);
    assert_in_range(snprintf(text, capacity, form, size, base64, size, members), 1, capacity - 1);
    free(base64);
    return text;
}

#endif
