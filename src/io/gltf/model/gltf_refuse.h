/* gltf_refuse.h - refuses valid files that need something unsupported, such as extensions that are required,
   or that hold geometry in forms of their own. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_REFUSE_H
#define FFD_IO_GLTF_MODEL_GLTF_REFUSE_H

#include "io/gltf/read/gltf_document.h"

/* Sets document->refused_extension: the first required extension that may place vertices or hold encoded
   geometry. Extensions that the caller allows (source) pass. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_find_required(gltf_document *document, const ffd_source *source, ffd_error *error);

/* Marks positions, normals and offsets of morph targets that are not in the file's accessors as not readable:
   the accessor has no bytes, and its min and max are not 0, or (positions) an extension of the primitive
   holds geometry. */
void ffd_gltf_find_held(gltf_document *document);

/* Warns of each extension of the file that holds geometry: what it holds is not deformed. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_warn_of_held(const gltf_document *document, const mesh_log *log, ffd_error *error);

/* Refuses what would make positions wrong or unreadable. Errors: FFD_E_UNSUPPORTED, FFD_E_INVALID,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_refuse_read(const gltf_document *document, ffd_error *error);

/* Refuses attributes that cannot be written back: positions, and (directions) normals and tangents. Errors:
   FFD_E_UNSUPPORTED. */
ffd_status ffd_gltf_refuse_store(const gltf_document *document, bool directions, ffd_error *error);

/* Refuses a primitive if this accessor cannot be read. Errors: FFD_E_UNSUPPORTED. */
ffd_status ffd_gltf_refuse_unreadable(const gltf_document *document, const gltf_primitive *primitive,
                                      int accessor, ffd_error *error);

#endif
