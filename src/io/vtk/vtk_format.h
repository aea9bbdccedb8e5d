/* vtk_format.h - VTK files of the legacy format, for the table of formats. */
#ifndef FFD_IO_VTK_VTK_FORMAT_H
#define FFD_IO_VTK_VTK_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_vtk_format;

#endif
