/* uri.h - URI references in a glTF file (RFC 3986). */
#ifndef FFD_IO_GLTF_FILE_URI_H
#define FFD_IO_GLTF_FILE_URI_H

#include <stdbool.h>
#include <stddef.h>

/* Whether the text starts with `word`, ignoring case. word: lower-case letters, digits and signs. */
bool ffd_uri_starts_with(const char *text, const char *word);
/* Whether the URI starts with "data:", ignoring case. */
bool ffd_uri_is_data(const char *uri);
/* Whether the URI starts with a scheme ("http:", "file:", but also a single letter: "c:"), '/' or '\\': it
   then does not name a file beside the model. */
bool ffd_uri_is_absolute(const char *uri);

/* Decodes each %XX of the size characters at text, in place; returns the new size. A '%' without two hex
   digits stays. */
size_t ffd_uri_decode(char *text, size_t size);

/* Returns a new string in which every character but letters, digits and -._~/ is written as %XX; NULL if
   memory runs out. */
char *ffd_uri_encode(const char *path);

#endif
