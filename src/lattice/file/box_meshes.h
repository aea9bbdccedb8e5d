/* box_meshes.h - the meshes that a lattice file names for its box. */
#ifndef FFD_LATTICE_FILE_BOX_MESHES_H
#define FFD_LATTICE_FILE_BOX_MESHES_H

#include "base/file/path_list.h"

/* Adds the paths of these meshes; none if the file cannot be read, which fails its job. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_lattice_box_meshes(const char *path, path_list *meshes, ffd_error *error);

#endif
