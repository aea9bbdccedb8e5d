/* gltf_mend_weights.h - skin weights that are written decompressed. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_MEND_WEIGHTS_H
#define FFD_IO_GLTF_WRITE_GLTF_MEND_WEIGHTS_H

#include "io/gltf/write/gltf_saver.h"

/* Makes weights that are written decompressed valid (glTF 2.0, 3.7.3.3), since compression has rounded them
   and validators do not look into compressed data: those of a vertex sum to 1 in the numbers of the file, no
   joint has two of them, and the joint of a weight of 0 is 0. Vertices where all of this holds keep their
   bytes. Replaces the bytes of unpackings by copies. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_mend_weights(gltf_saver *saver, ffd_error *error);

#endif
