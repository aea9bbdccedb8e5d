/* uri.h - references of a glTF file to others (RFC 3986). */
#ifndef FFD_IO_GLTF_FILE_URI_H
#define FFD_IO_GLTF_FILE_URI_H

#include <stdbool.h>
#include <stddef.h>

/* Whether the URI starts with "data:", in upper or lower case. */
bool ffd_uri_is_data(const char *uri);
/* Whether the URI starts with a scheme ("http:", "file:"; a single letter too: "c:") or with '/' or
   '\\', so that it does not name a file beside the model. */
bool ffd_uri_is_absolute(const char *uri);

/* Decodes %XX in size characters at text, in place; returns the new size. A '%' without two hex digits
   stays. */
size_t ffd_uri_decode(char *text, size_t size);

/* Returns a new string in which all but letters, digits and -._~/ is written as %XX; NULL if memory runs
   out. */
char *ffd_uri_encode(const char *path);

/* Returns a new path with "." and ".." resolved ("a/../b" -> "b"); leading ".." of a relative path
   stay. NULL if memory runs out. */
char *ffd_path_normalize(const char *path);

/* Whether a normalized relative path leads out of its folder. */
bool ffd_path_leads_out(const char *path);

/* Returns a new path that leads from the folder `from` to `to`, both absolute and normalized. NULL if
   memory runs out. */
char *ffd_path_relative(const char *from, const char *to);

#endif
