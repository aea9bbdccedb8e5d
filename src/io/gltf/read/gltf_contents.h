/* gltf_contents.h - whether the bytes of buffers can be the numbers that the file tells of. */
#ifndef FFD_IO_GLTF_READ_GLTF_CONTENTS_H
#define FFD_IO_GLTF_READ_GLTF_CONTENTS_H

#include "io/gltf/read/gltf_document.h"

/* Refuses a buffer that is a file of another kind, such as a Git LFS pointer or an HTML page. What a
   bufferView without accessors holds at its start, such as an image, is allowed. Needs no index of the file
   to be right. Errors: FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_gltf_check_contents(const gltf_document *document, ffd_error *error);

#endif
