/* material.h - materials, as far as pictures show them: base colours and their textures. */
#ifndef FFD_MESH_MATERIAL_H
#define FFD_MESH_MATERIAL_H

#include "mesh/memory_budget.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Values of an image index: no image; an image that could not be loaded. */
#define MATERIAL_NONE UINT32_MAX
#define MATERIAL_LOST (UINT32_MAX - 1)

/* The content of a PNG or JPEG file. */
typedef struct mesh_image {
    char *name; /* for messages */
    unsigned char *bytes;
    size_t size;
} mesh_image;

typedef enum texture_wrap { TEXTURE_REPEAT, TEXTURE_MIRROR, TEXTURE_CLAMP } texture_wrap;

typedef struct mesh_material {
    char *name;           /* "": none */
    double color[4];      /* base colour and alpha, 0 to 1, linear */
    double alpha_cutoff;  /* drawn only where alpha is at least this; 0: everywhere */
    uint32_t image;       /* index of the base colour texture, or a value above */
    texture_wrap wrap[2]; /* along u and v */
    bool is_double_sided;
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

/* Adds a default material: white, opaque, one-sided. Takes ownership of the name, also after a failure; NULL
   means that memory ran out for the name. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_materials_add(mesh_materials *materials, char *name, memory_budget *budget, ffd_error *error);

/* Frees the materials and empties the list. */
void ffd_materials_free(mesh_materials *materials);

#endif
