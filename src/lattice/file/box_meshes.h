/* box_meshes.h - the meshes that a lattice file names for its box. */
#ifndef FFD_LATTICE_FILE_BOX_MESHES_H
#define FFD_LATTICE_FILE_BOX_MESHES_H

#include "base/file/input.h"
#include "base/file/path_list.h"

/* Adds the paths of these meshes; none if the file is not valid, which fails its job. bytes: of the file.
   Errors: FFD_E_MEMORY. */
ffd_status ffd_lattice_box_meshes(const char *path, const file_input *bytes, path_list *meshes,
                                  ffd_error *error);

#endif
