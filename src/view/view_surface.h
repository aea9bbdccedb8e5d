/* view_surface.h - the materials and triangles of a scene in the form that a picture takes. */
#ifndef FFD_VIEW_VIEW_SURFACE_H
#define FFD_VIEW_VIEW_SURFACE_H

#include "mesh/mesh_log.h"
#include "picture/picture.h"
#include "view/view_scene.h"
#include "view/view_textures.h"

/* All zeros: none. */
typedef struct view_surface {
    /* Flipped triangles come last. materials (1 a triangle) and texcoords (6 a triangle; NULL if not
       textured) are in the same order. */
    uint32_t *triangles, *materials;
    float *texcoords, *glow_texcoords; /* glow_texcoords: as in view_scene */
    size_t plain_count, flipped_count;
    picture_material *list; /* one for each material of the scene */
    view_textures textures;
    bool sees_through; /* a material is see-through */
    size_t list_count;
} view_surface;

/* Makes the surface, and takes its memory from the budget. textured: decode the images, as long as `reserve`
   bytes are left; one that cannot be decoded or does not fit is logged, and its materials are drawn grey.
   Errors: FFD_E_LIMIT (the budget), FFD_E_MEMORY. Call ffd_view_surface_free in every case. */
ffd_status ffd_view_surface_make(const view_scene *scene, bool textured, memory_budget *budget,
                                 uint64_t reserve, int threads, const mesh_log *log, view_surface *surface,
                                 ffd_error *error);
/* Frees the arrays; leaves an empty surface. */
void ffd_view_surface_free(view_surface *surface);

#endif
