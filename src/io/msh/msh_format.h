/* msh_format.h - meshes of Gmsh, for the table of formats. */
#ifndef FFD_IO_MSH_MSH_FORMAT_H
#define FFD_IO_MSH_MSH_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_msh_format;

#endif
