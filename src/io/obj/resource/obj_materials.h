/* obj_materials.h - the materials of the libraries that an OBJ file names. */
#ifndef FFD_IO_OBJ_RESOURCE_OBJ_MATERIALS_H
#define FFD_IO_OBJ_RESOURCE_OBJ_MATERIALS_H

#include "mesh/mesh.h"

/* mesh_format's list_materials. The document begins with a file_document. Of several definitions of a name
   the first one counts, in the order of the libraries in the mesh. */
mesh_list_materials_function ffd_obj_list_materials;

#endif
