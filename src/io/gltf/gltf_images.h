/* gltf_images.h - the bytes of a file's images. */
#ifndef FFD_IO_GLTF_GLTF_IMAGES_H
#define FFD_IO_GLTF_GLTF_IMAGES_H

#include "io/gltf/document/gltf_document.h"
#include "mesh/resource/material_images.h"

/* Loads an image of a bufferView, a data URI or a file beside the model, unless it is known. Sets *number to
   its place among the images of the materials, to MATERIAL_LOST if it cannot be had. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_load_image(const gltf_document *document, material_images *images, size_t image,
                               uint32_t *number, ffd_error *error);

#endif
