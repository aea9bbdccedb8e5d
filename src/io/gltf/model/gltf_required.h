/* gltf_required.h - decides whether a file can be deformed without knowing the extensions that it requires,
   or that hold geometry in forms of their own, such as vendors' compressions. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_REQUIRED_H
#define FFD_IO_GLTF_MODEL_GLTF_REQUIRED_H

#include "io/gltf/read/gltf_document.h"

/* Sets document->refused_extension: the first required extension that may place vertices or hold encoded
   geometry. Extensions that the caller allows (source) pass. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_find_required(gltf_document *document, const ffd_source *source, ffd_error *error);

/* Refuses the document if it has such an extension. Errors: FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
ffd_status ffd_gltf_refuse_required(const gltf_document *document, ffd_error *error);

/* Marks positions, normals and offsets of morph targets that are not in the file's accessors as not readable:
   the accessor has no bytes, and its min and max are not 0, or (positions) an extension of the primitive
   holds geometry. */
void ffd_gltf_find_held(gltf_document *document);

/* Refuses a primitive of which an extension holds such numbers. Errors: FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
ffd_status ffd_gltf_refuse_held(const gltf_document *document, size_t mesh, size_t primitive,
                                ffd_error *error);

/* Warns of each extension of the file that holds geometry: what it holds is not deformed. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_warn_of_held(const gltf_document *document, const mesh_log *log, ffd_error *error);

#endif
