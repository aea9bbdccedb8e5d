/* gltf_uri.h - URI references in a glTF file (RFC 3986), and the files that they name. */
#ifndef FFD_IO_GLTF_FILE_GLTF_URI_H
#define FFD_IO_GLTF_FILE_GLTF_URI_H

#include "base/file/file_folder.h"
#include "base/file/path_list.h"
#include "json/json_tree.h"
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

/* Finds the normalized path, relative to the model, of a value that is a URI; NULL with FFD_OK: it does not
   name a file beside the model. mesh: the model's folder. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_uri_path(const json_tree *tree, uint32_t uri, const file_folder *mesh, char **path,
                             ffd_error *error);
/* The same for the member "uri" of an image or buffer. */
ffd_status ffd_gltf_file_path(const json_tree *tree, uint32_t value, const file_folder *mesh, char **path,
                              ffd_error *error);
/* Adds the path of a file beside the mesh, unless `relative` is NULL, and frees `relative`. */
ffd_status ffd_gltf_add_sibling(const file_folder *mesh, char *relative, path_list *files, ffd_error *error);

/* Returns the first value from v on that is a URI inside of an extension; JSON_NONE: there is none. */
uint32_t ffd_gltf_next_linked(const json_tree *tree, uint32_t v, uint32_t *extension);
/* Adds the files that such values name. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_find_linked(const json_tree *tree, const file_folder *mesh, path_list *files,
                                ffd_error *error);

#endif
