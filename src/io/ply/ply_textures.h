/* ply_textures.h - the images that a PLY file names in its header: "comment TextureFile NAME". */
#ifndef FFD_IO_PLY_PLY_TEXTURES_H
#define FFD_IO_PLY_PLY_TEXTURES_H

#include "io/ply/ply_header.h"
#include "mesh/linked_files.h"
#include "mesh/mesh.h"

/* Finds the name in a note of the header. Returns false if the note names no texture. */
bool ffd_ply_texture_name(text_word note, text_word *name);

/* Copies the images of the file at options->input to the same places beside the output, or says which the
   output does not reach (FFD_RESOURCES_REFERENCE). Comes before the output's own file. Errors: FFD_E_EXISTS,
   FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_ply_bring_textures(const ply_header *header, const file_folder *folder,
                                  const mesh_save_options *options, file_output *output, const mesh_log *log,
                                  ffd_error *error);

/* The calls of mesh_resource_calls. */
mesh_find_named_function ffd_ply_find_named;

#endif
