/* uri.h - references of a glTF file to others (RFC 3986). */
#ifndef FFD_IO_GLTF_FILE_URI_H
#define FFD_IO_GLTF_FILE_URI_H

#include <stdbool.h>
#include <stddef.h>

/* "data:" in any case. */
bool ffd_uri_is_data(const char *uri);
/* Starts with a scheme ("http:", "file:"; a single letter too: "c:") or with '/' or '\\': leads to no file
   beside the model. */
bool ffd_uri_is_absolute(const char *uri);

/* Replaces %XX in size characters at text; returns the new size. A '%' without two hex digits stays. */
size_t ffd_uri_decode(char *text, size_t size);

/* A new string in which all but letters, digits and -._~/ is written %XX; NULL: no memory. */
char *ffd_uri_encode(const char *path);

/* The path with "." and ".." worked in ("a/../b" -> "b"); leading ".." of a relative path stay. NULL: no
 * memory. */
char *ffd_path_normalize(const char *path);

/* Whether a normalized relative path leads out of its folder. */
bool ffd_path_leads_out(const char *path);

/* The path that leads from the folder `from` to `to`, both absolute and normalized. NULL: no memory. */
char *ffd_path_relative(const char *from, const char *to);

#endif
