/* ply_format.h - the format PLY, ascii and binary, for the table of formats. */
#ifndef FFD_IO_PLY_PLY_FORMAT_H
#define FFD_IO_PLY_PLY_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_ply_format;

#endif
