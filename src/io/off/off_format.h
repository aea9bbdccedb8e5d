/* off_format.h - the format OFF, for the table of formats. */
#ifndef FFD_IO_OFF_OFF_FORMAT_H
#define FFD_IO_OFF_OFF_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_off_format;

#endif
