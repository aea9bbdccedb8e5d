/* glb_values.h - the numbers of a vertex as a new glTF file holds them. */
#ifndef FFD_IO_WRITE_GLB_VALUES_H
#define FFD_IO_WRITE_GLB_VALUES_H

#include "mesh/model.h"
#include <stdbool.h>
#include <stdint.h>

/* A texture coordinate. */
void ffd_glb_texcoord(const mesh_model *model, uint32_t number, float values[2]);
/* A unit vector; false if the model's normal has no direction. */
bool ffd_glb_normal(const mesh_model *model, uint32_t number, float values[3]);
/* The position of a vertex, from where its node stands. */
void ffd_glb_position(const mesh_model *model, const double origin[3], uint32_t number, float values[3]);
/* What a morph target adds to it. */
void ffd_glb_position_offset(const mesh_model *model, size_t morph, uint32_t number, float values[3]);
/* What it adds to the normal. */
void ffd_glb_normal_offset(const mesh_model *model, size_t morph, uint32_t number, float values[3]);

#endif
