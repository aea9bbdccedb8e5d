/* gltf_stated.h - positions beside the min and max that their accessors state. */
#ifndef FFD_IO_GLTF_READ_GLTF_STATED_H
#define FFD_IO_GLTF_READ_GLTF_STATED_H

#include "io/gltf/read/gltf_document.h"

/* Refuses positions, and offsets of positions, that are beyond min and max by so many orders that the bytes
   cannot be those of the mesh, and notes others outside of min and max as a flaw. Numbers that are not finite
   do not count. Errors: FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_gltf_check_stated(gltf_document *document, ffd_error *error);

/* Reads min and max of an accessor. Returns false if they are not three finite numbers each. */
bool ffd_gltf_stated(const gltf_document *document, size_t accessor, double min[3], double max[3]);

#endif
