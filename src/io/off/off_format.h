/* off_format.h - the format OFF, as the table of formats has it. */
#ifndef FFD_IO_OFF_OFF_FORMAT_H
#define FFD_IO_OFF_OFF_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_off_format;

#endif
