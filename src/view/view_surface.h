/* view_surface.h - the materials and triangles of a scene as a picture takes them. */
#ifndef FFD_VIEW_VIEW_SURFACE_H
#define FFD_VIEW_VIEW_SURFACE_H

#include "mesh/mesh_log.h"
#include "picture/picture.h"
#include "view/view_scene.h"

/* All zeros: none. */
typedef struct view_surface {
    /* The triangles, with those whose faces are flipped last; their corners' texture coordinates and their
       materials likewise (the latter two may be NULL). */
    uint32_t *triangles, *materials;
    float *texcoords;
    size_t plain_count, flipped_count;
    picture_material *list; /* of the scene's materials */
    texture *textures;      /* of its images; empty where one cannot be decoded */
    size_t list_count, texture_count;
} view_surface;

/* Makes the surface. textured: decode the images; the log says which are broken, and their materials are
   grey. Errors: FFD_E_LIMIT (the budget), FFD_E_MEMORY. */
ffd_status ffd_view_surface_make(const view_scene *scene, bool textured, const memory_budget *budget,
                                 const mesh_log *log, view_surface *surface, ffd_error *error);
/* Frees it; leaves an empty one. */
void ffd_view_surface_free(view_surface *surface);

#endif
