/* glb_values.h - the numbers of a vertex as a new glTF file stores them. */
#ifndef FFD_IO_WRITE_GLB_VALUES_H
#define FFD_IO_WRITE_GLB_VALUES_H

#include "mesh/model.h"
#include <stdbool.h>
#include <stdint.h>

/* Computes a texture coordinate. */
void ffd_glb_texcoord(const mesh_model *model, uint32_t index, float values[2]);
/* Computes a unit normal; returns false if the model's normal has no direction. */
bool ffd_glb_normal(const mesh_model *model, uint32_t index, float values[3]);
/* Computes the position of a vertex, relative to its node's translation. */
void ffd_glb_position(const mesh_model *model, const double origin[3], uint32_t index, float values[3]);
/* Computes the offset of a position in a morph target. */
void ffd_glb_position_offset(const mesh_model *model, size_t morph, uint32_t index, float values[3]);
/* Computes the offset of a normal in a morph target. */
void ffd_glb_normal_offset(const mesh_model *model, size_t morph, uint32_t index, float values[3]);

#endif
