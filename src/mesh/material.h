/* material.h - materials, as far as pages and pictures show them: base colours, opacity, emission, and their
   textures. */
#ifndef FFD_MESH_MATERIAL_H
#define FFD_MESH_MATERIAL_H

#include "mesh/memory_budget.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Values of an image index: no image; an image that could not be loaded. */
#define MATERIAL_NONE UINT32_MAX
#define MATERIAL_LOST (UINT32_MAX - 1)

/* The content of a PNG, JPEG or WebP file. */
typedef struct mesh_image {
    char *name; /* for messages */
    unsigned char *bytes;
    size_t size;
} mesh_image;

typedef enum texture_wrap { TEXTURE_REPEAT, TEXTURE_MIRROR, TEXTURE_CLAMP } texture_wrap;

/* How a material uses an image. */
typedef struct mesh_texture {
    uint32_t image;       /* index of the image, or a value above */
    texture_wrap wrap[2]; /* along u and v */
    /* The coordinates are scale times those of the model plus offset, v upwards (-s and -o of the maps of
       OBJ). Those of a glTF model have their set and KHR_texture_transform applied. */
    double scale[2], offset[2];
} mesh_texture;

typedef enum material_alpha {
    MATERIAL_OPAQUE, /* alpha does not count */
    MATERIAL_MASK,   /* drawn only where alpha is at least alpha_cutoff */
    MATERIAL_BLEND,  /* lets through what is behind it */
} material_alpha;

typedef struct mesh_material {
    char *name;      /* "": none */
    double color[4]; /* base colour and alpha, 0 to 1, linear */
    material_alpha alpha;
    double alpha_cutoff;
    double emission[3]; /* linear, 0 or more: it may be beyond 1 */
    mesh_texture base;  /* multiplies color, alpha included */
    mesh_texture glow;  /* multiplies emission */
    /* Takes the place of base's alpha: by its own alpha, or by its luminance if it is opaque everywhere. At
       the coordinates of base. */
    mesh_texture opacity;
    bool is_double_sided, is_unlit;
} mesh_material;

/* All zeros: empty. */
typedef struct mesh_materials {
    mesh_material *list; /* count */
    size_t count, capacity;
    mesh_image *images; /* image_count */
    size_t image_count, image_capacity;
} mesh_materials;

/* Returns a component of a colour, or an opacity, from a file; values outside of 0 to 1 count as 1. */
static inline double material_share(double number)
{
    return number >= 0 && number <= 1 ? number : 1;
}

/* A texture without an image. */
mesh_texture ffd_texture_none(void);

/* Adds a default material: white, opaque, one-sided, dark, without textures. Takes ownership of the name,
   also after a failure; NULL means that memory ran out for the name. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_materials_add(mesh_materials *materials, char *name, memory_budget *budget, ffd_error *error);

/* Frees the materials and empties the list. */
void ffd_materials_free(mesh_materials *materials);

#endif
