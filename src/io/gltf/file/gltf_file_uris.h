/* gltf_file_uris.h - the files that URIs of a model name. */
#ifndef FFD_IO_GLTF_FILE_GLTF_FILE_URIS_H
#define FFD_IO_GLTF_FILE_GLTF_FILE_URIS_H

#include "base/file/path_list.h"
#include "json/json_span.h"

/* Finds the normalized path, relative to the model, of a value that is a URI; NULL with FFD_OK: it does not
   name a file beside the model. mesh: the model's path. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_uri_path(const json_span *tree, uint32_t uri, const char *mesh, char **path,
                             ffd_error *error);
/* The same for the member "uri" of an image or buffer. */
ffd_status ffd_gltf_file_path(const json_span *tree, uint32_t value, const char *mesh, char **path,
                              ffd_error *error);
/* Adds the path of a file beside the mesh, unless `relative` is NULL, and frees `relative`. */
ffd_status ffd_gltf_add_beside(const char *mesh, char *relative, path_list *files, ffd_error *error);

/* Returns the first value from v on that is a URI inside of an extension; JSON_NONE: there is none. */
uint32_t ffd_gltf_next_linked(const json_span *tree, uint32_t v, uint32_t *extension);
/* Adds the files that such values name. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_find_linked(const json_span *tree, const char *mesh, path_list *files, ffd_error *error);
#endif
