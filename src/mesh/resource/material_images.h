/* material_images.h - loads the images of materials, each once. One that cannot be had is left out, and said.
 */
#ifndef FFD_MESH_RESOURCE_MATERIAL_IMAGES_H
#define FFD_MESH_RESOURCE_MATERIAL_IMAGES_H

#include "base/memory/intern.h"
#include "mesh/material.h"
#include "mesh/resource/left_out.h"

/* Begin with the first four members set, all else 0. */
typedef struct material_images {
    mesh_materials *materials; /* gets the images */
    memory_budget *budget;
    const char *mesh;   /* the path of its file, for messages too */
    const char *folder; /* of that; NULL: it has none */
    left_out left;
    intern_table known; /* names under which images were looked for */
    uint32_t *numbers;  /* of the image of each, or MATERIAL_LOST */
    size_t capacity;
} material_images;

/* Whether an image was looked for under this name; *image is then its number, or MATERIAL_LOST. Else the name
   is noted, and *image MATERIAL_LOST; what is added next has it. Errors: FFD_E_MEMORY. */
ffd_status ffd_images_find(material_images *images, const char *name, bool *is_known, uint32_t *image,
                           ffd_error *error);
/* Adds a copy of bytes, if they are PNG or JPEG, as the image of the name that ffd_images_find noted last.
 *Sets image, to MATERIAL_LOST if they are not. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_images_add(material_images *images, const char *name, const unsigned char *bytes, size_t size,
                          uint32_t *image, ffd_error *error);
/* Loads a file at a path relative to the mesh's folder, normalized, unless it is known. Sets *image, to
   MATERIAL_LOST if it cannot be had. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_images_load(material_images *images, const char *path, uint32_t *image, ffd_error *error);
/* Says what was left out, and frees all but the materials. */
void ffd_images_end(material_images *images, const mesh_log *log);

#endif
