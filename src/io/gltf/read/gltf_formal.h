/* gltf_formal.h - errors against glTF 2.0 on which nothing depends that is read, written or shown. */
#ifndef FFD_IO_GLTF_READ_GLTF_FORMAL_H
#define FFD_IO_GLTF_READ_GLTF_FORMAL_H

#include "io/gltf/read/gltf_document.h"

/* Refuses such errors where the caller is strict, and else does nothing: a warning of each would hide those
   that matter. They are names and formats of attributes, their alignment, bufferViews with two uses, morph
   targets of no attribute, min and max of another length, extensions that are not listed, arrays of glTF's
   own with nothing in them.
   The numbers of attributes are not looked at. Errors: FFD_E_INVALID (strict), FFD_E_MEMORY. */
ffd_status ffd_gltf_refuse_formal(const gltf_document *document, ffd_error *error);

#endif
