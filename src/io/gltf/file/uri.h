/* uri.h - references of a glTF file to others (RFC 3986). */
#ifndef FFD_IO_GLTF_FILE_URI_H
#define FFD_IO_GLTF_FILE_URI_H

#include <stdbool.h>
#include <stddef.h>

/* Whether the text starts with a word of small letters, digits and signs, in upper or lower case. */
bool ffd_uri_starts_with(const char *text, const char *word);
/* Whether the URI starts with "data:", in upper or lower case. */
bool ffd_uri_is_data(const char *uri);
/* Whether the URI starts with a scheme ("http:", "file:"; a single letter too: "c:") or with '/' or
   '\\', so that it does not name a file beside the model. */
bool ffd_uri_is_absolute(const char *uri);

/* Decodes %XX in size characters at text, in place; returns the new size. A '%' without
   two hex digits stays. */
size_t ffd_uri_decode(char *text, size_t size);

/* Returns a new string in which all but letters, digits and -._~/ is written as %XX;
   NULL if memory runs out. */
char *ffd_uri_encode(const char *path);

#endif
