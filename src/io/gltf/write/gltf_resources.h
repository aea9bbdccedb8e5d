/* gltf_resources.h - copies or refers to the images of a file. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_RESOURCES_H
#define FFD_IO_GLTF_WRITE_GLTF_RESOURCES_H

#include "io/gltf/write/gltf_saver.h"

/* Copies the images beside the output, or edits their URIs. A file that is not an image, is hidden, or is
   reached through a link is not copied, with a warning. Refuses an image with the name of a file of the model
   itself. Begins and writes files of saver->output; call it after ffd_gltf_name_buffers. Errors:
   FFD_E_EXISTS, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_gltf_bring_images(gltf_saver *saver, ffd_error *error);

/* mesh_format's list_images. */
mesh_list_files_function ffd_gltf_list_images;
/* mesh_format's list_linked. */
mesh_list_files_function ffd_gltf_list_linked;
/* mesh_format's find_resources. */
mesh_find_resources_function ffd_gltf_find_resources;
/* mesh_format's find_named. */
mesh_find_named_function ffd_gltf_find_named;

#endif
