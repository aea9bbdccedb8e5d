/* material.h - how the surface of a mesh looks, as far as a picture shows it: base colours and their
   textures. */
#ifndef FFD_MESH_MATERIAL_H
#define FFD_MESH_MATERIAL_H

#include "mesh/memory_budget.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* No image; one that cannot be had. */
#define MATERIAL_NONE UINT32_MAX
#define MATERIAL_LOST (UINT32_MAX - 1)

/* A PNG or JPEG file, not decoded. */
typedef struct mesh_image {
    char *name; /* for messages */
    unsigned char *bytes;
    size_t size;
} mesh_image;

typedef enum texture_wrap { TEXTURE_REPEAT, TEXTURE_MIRROR, TEXTURE_CLAMP } texture_wrap;

typedef struct mesh_material {
    char *name;           /* "": none */
    double color[4];      /* base colour and alpha, 0 to 1, linear */
    double alpha_cutoff;  /* drawn where alpha is not less; 0: everywhere */
    uint32_t image;       /* base colour texture, or one of those above */
    texture_wrap wrap[2]; /* along u and v */
    bool is_double_sided;
} mesh_material;

/* All zeros: none. */
typedef struct mesh_materials {
    mesh_material *list; /* count */
    size_t count, capacity;
    mesh_image *images; /* image_count */
    size_t image_count, image_capacity;
} mesh_materials;

/* What a file has for a colour's number or an opacity; what is not 0 to 1 counts as 1. */
static inline double material_share(double number)
{
    return number >= 0 && number <= 1 ? number : 1;
}

/* Adds a material that says nothing: white, opaque, one-sided. Takes ownership of the name, also after a
   failure; NULL: memory ran out for it. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_materials_add(mesh_materials *materials, char *name, memory_budget *budget, ffd_error *error);

/* Frees them; the list is empty then. */
void ffd_materials_free(mesh_materials *materials);

#endif
