/* material_images.h - loads the images of materials, each once. An image that cannot be loaded is left out
   and logged. */
#ifndef FFD_MESH_RESOURCE_MATERIAL_IMAGES_H
#define FFD_MESH_RESOURCE_MATERIAL_IMAGES_H

#include "base/file/file_folder.h"
#include "base/memory/intern.h"
#include "mesh/material.h"
#include "mesh/resource/left_out.h"

/* Set the first four members, and all others to 0. */
typedef struct material_images {
    mesh_materials *materials; /* receives the images */
    memory_budget *budget;
    file_folder mesh; /* where the names in the mesh file lead; its file is for messages too */
    bool has_folder;  /* false: the mesh comes from standard input */
    left_out left;
    intern_table known; /* names of images that were requested */
    uint32_t *indices;  /* index of the image of each name, or MATERIAL_LOST */
    size_t capacity;
} material_images;

/* Looks up an image by name. If the name is known, *image is its index, or MATERIAL_LOST. Otherwise *image is
   MATERIAL_LOST, and the next image that is added gets this name. Errors: FFD_E_MEMORY. */
ffd_status ffd_images_find(material_images *images, const char *name, bool *is_known, uint32_t *image,
                           ffd_error *error);
/* Adds a copy of bytes, if they are PNG, JPEG or WebP, with the name that ffd_images_find did not find last.
 *image becomes its index, or MATERIAL_LOST. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_images_add(material_images *images, const char *name, const unsigned char *bytes, size_t size,
                          uint32_t *image, ffd_error *error);
/* Loads a file unless it is known. path: relative to the mesh's folder, normalized. Sets *image to its index,
   or to MATERIAL_LOST if it cannot be loaded. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_images_load(material_images *images, const char *path, uint32_t *image, ffd_error *error);
/* Logs what was left out, and frees everything except the materials. */
void ffd_images_end(material_images *images, const mesh_log *log);

#endif
