/* gltf_conformance.h - what glTF 2.0 calls an error though its meaning is plain. */
#ifndef FFD_IO_GLTF_READ_GLTF_CONFORMANCE_H
#define FFD_IO_GLTF_READ_GLTF_CONFORMANCE_H

#include "io/gltf/read/gltf_document.h"

/* Notes such errors of nodes, accessors, primitives and extensions as flaws, which are warnings, or refused
   where the caller is strict. Indices have been checked. Errors: FFD_E_INVALID (strict). */
ffd_status ffd_gltf_note_errors(gltf_document *d, ffd_error *error);

#endif
