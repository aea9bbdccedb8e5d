/* gltf_contents.h - whether the bytes of buffers can be the numbers that the file tells of: buffers that are
   files of another kind, positions beside the min and max of their accessors, weights of skins. */
#ifndef FFD_IO_GLTF_READ_GLTF_CONTENTS_H
#define FFD_IO_GLTF_READ_GLTF_CONTENTS_H

#include "io/gltf/read/gltf_document.h"

/* Refuses a buffer that is a file of another kind, such as a Git LFS pointer or an HTML page. What a
   bufferView without accessors holds at its start, such as an image, is allowed. Needs no index of the file
   to be right. Errors: FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_gltf_check_contents(const gltf_document *document, ffd_error *error);

/* Refuses positions, and offsets of positions, that are beyond min and max by so many orders that the bytes
   cannot be those of the mesh, and notes others outside of min and max as a flaw. Numbers that are not finite
   do not count. Errors: FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_gltf_check_stated(gltf_document *document, ffd_error *error);

/* Reads min and max of an accessor. Returns false if they are not three finite numbers each. */
bool ffd_gltf_stated(const gltf_document *document, size_t accessor, double min[3], double max[3]);

/* Sums of float weights differ from 1 by less than this. */
#define WEIGHT_SUM_ROUNDING 1e-6

/* Notes as flaws the weights of vertices that a skin moves which are negative, not finite or do not sum to 1
   (glTF 2.0, 3.7.3.3). Call it after ffd_gltf_prepare_skins has succeeded. Errors: FFD_E_INVALID (strict),
   FFD_E_MEMORY. */
ffd_status ffd_gltf_judge_weights(gltf_document *document, ffd_error *error);

#endif
