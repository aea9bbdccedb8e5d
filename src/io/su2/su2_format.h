/* su2_format.h - meshes of SU2, for the table of formats. */
#ifndef FFD_IO_SU2_SU2_FORMAT_H
#define FFD_IO_SU2_SU2_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_su2_format;

#endif
