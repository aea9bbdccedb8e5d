/* gltf_weights.h - attributes, colours and skin weights of a glTF as weights. */
#ifndef FFD_IO_GLTF_GLTF_WEIGHTS_H
#define FFD_IO_GLTF_GLTF_WEIGHTS_H

#include "mesh/weights.h"

/* Takes attributes of one number, the channels of COLOR_0, and the share of the joints of a name. */
extern const mesh_weight_calls ffd_gltf_weights;

#endif
