/* gltf_required.h - decides whether a file can be deformed without knowing the extensions that it
   requires. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_REQUIRED_H
#define FFD_IO_GLTF_SCENE_GLTF_REQUIRED_H

#include "io/gltf/document/gltf_document.h"

/* Sets document->refused_extension: the first required extension that may place vertices or hold encoded
   geometry. Extensions that the caller allows (source) pass. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_find_required(gltf_document *document, const ffd_source *source, ffd_error *error);

/* Whether an extension of this name holds geometry in a form that is not supported. */
bool ffd_gltf_holds_geometry(const char *extension);

/* Refuses the document if it has such an extension. Errors: FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
ffd_status ffd_gltf_refuse_required(const gltf_document *document, ffd_error *error);

#endif
