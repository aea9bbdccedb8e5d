/* meshopt_library.h - decodes streams with the meshoptimizer library. Implemented in meshopt_library.c or,
   for a program that loads the module, in meshopt_load.c. */
#ifndef FFD_MESH_MESHOPT_MESHOPT_LIBRARY_H
#define FFD_MESH_MESHOPT_MESHOPT_LIBRARY_H

#include "mesh/meshopt/meshopt_view.h"

/* Checks that the library is available. Errors, without a file name: FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
ffd_status ffd_meshopt_library_ready(ffd_error *error);

/* Decodes a stream of version 0, or one of indices of version 1, without its filter. The library must be
   available. Errors: FFD_E_INVALID; the bytes are then undefined. */
ffd_status ffd_meshopt_library_decode(const meshopt_view *view, unsigned char *bytes, ffd_error *error);

#endif
