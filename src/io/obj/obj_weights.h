/* obj_weights.h - the colours of the vertices of an OBJ file as weights. */
#ifndef FFD_IO_OBJ_OBJ_WEIGHTS_H
#define FFD_IO_OBJ_OBJ_WEIGHTS_H

#include "io/obj/obj_document.h"
#include "mesh/weights.h"

/* Takes the channels of `v x y z r g b [a]`. */
extern const mesh_weight_calls ffd_obj_weights;

#endif
