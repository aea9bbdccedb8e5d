/* ply_weights.h - properties of the vertices of a PLY file as weights. */
#ifndef FFD_IO_PLY_PLY_WEIGHTS_H
#define FFD_IO_PLY_PLY_WEIGHTS_H

#include "io/ply/ply_document.h"
#include "mesh/weights.h"

/* Takes each property of one number, and the colours red, green, blue, alpha. */
extern const mesh_weight_calls ffd_ply_weights;

#endif
