/* obj_resources.h - the material libraries of an OBJ file and their maps, which go with an output in another
   folder; and their materials (obj_materials.c). */
#ifndef FFD_IO_OBJ_RESOURCE_OBJ_RESOURCES_H
#define FFD_IO_OBJ_RESOURCE_OBJ_RESOURCES_H

#include "mesh/linked_files.h"

/* Copies the libraries and maps of the file at options->input, whose bytes are `input`, to the same places
   beside the output, or says which libraries the output does not reach (FFD_RESOURCES_REFERENCE). What cannot
   be copied is named in a warning; so is what other statements name (names_files: there are such), and all
   that a mesh from standard input names. Refuses an output that has the name of one of them. Begins and
   writes files of `output`, so that it comes before the output's own file. Errors: FFD_E_EXISTS, FFD_E_IO,
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_obj_bring_resources(const file_input *input, const file_folder *folder, bool names_files,
                                   const mesh_save_options *options, file_output *output, const mesh_log *log,
                                   ffd_error *error);

/* mesh_resource_calls' find_named. Only files in the folder of the mesh or below. */
mesh_find_named_function ffd_obj_find_named;

/* mesh_format's list_materials. The document begins with a file_document. Of several definitions of a name
   the first one counts, in the order of the libraries in the mesh. */
mesh_list_materials_function ffd_obj_list_materials;

#endif
