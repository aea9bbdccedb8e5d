/* gltf_weights.h - notes skin weights that are not as the specification wants them. */
#ifndef FFD_IO_GLTF_READ_GLTF_WEIGHTS_H
#define FFD_IO_GLTF_READ_GLTF_WEIGHTS_H

#include "io/gltf/read/gltf_document.h"

/* Sums of float weights differ from 1 by less than this. */
#define WEIGHT_SUM_ROUNDING 1e-6

/* Notes as flaws the weights of vertices that a skin moves which are negative, not finite or do not sum to 1
   (glTF 2.0, 3.7.3.3). Call it after ffd_gltf_prepare_skins has succeeded. Errors: FFD_E_INVALID (strict),
   FFD_E_MEMORY. */
ffd_status ffd_gltf_judge_weights(gltf_document *document, ffd_error *error);

#endif
