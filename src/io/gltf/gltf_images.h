/* gltf_images.h - loads the images of a glTF file. */
#ifndef FFD_IO_GLTF_GLTF_IMAGES_H
#define FFD_IO_GLTF_GLTF_IMAGES_H

#include "io/gltf/read/gltf_document.h"
#include "mesh/resource/material_images.h"

/* Loads an image from a bufferView, a data URI or a file beside the model, unless it is loaded already. Sets
   *number to its index among the images of the materials, or to MATERIAL_LOST if it cannot be loaded. Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_load_image(const gltf_document *document, material_images *images, size_t image,
                               uint32_t *number, ffd_error *error);

#endif
