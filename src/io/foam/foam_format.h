/* foam_format.h - meshes of OpenFOAM, for the table of formats. */
#ifndef FFD_IO_FOAM_FOAM_FORMAT_H
#define FFD_IO_FOAM_FOAM_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_foam_format;

#endif
