/* stl_format.h - the format STL, ascii and binary, for the table of formats. */
#ifndef FFD_IO_STL_STL_FORMAT_H
#define FFD_IO_STL_STL_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_stl_format;

#endif
