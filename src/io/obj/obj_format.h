/* obj_format.h - the format Wavefront OBJ, as the table of formats has it. */
#ifndef FFD_IO_OBJ_OBJ_FORMAT_H
#define FFD_IO_OBJ_OBJ_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_obj_format;

#endif
