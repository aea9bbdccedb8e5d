/* view_textures.h - the images of a scene's materials, decoded as textures for a picture. */
#ifndef FFD_VIEW_VIEW_TEXTURES_H
#define FFD_VIEW_VIEW_TEXTURES_H

#include "mesh/material.h"
#include "mesh/memory_budget.h"
#include "mesh/mesh_log.h"
#include "picture/texture.h"

/* One texture for each image; empty where it is not used as such, or cannot be decoded. opacities: with the
   opacity as alpha. All zeros: none. */
typedef struct view_textures {
    texture *colors, *opacities;
    size_t count;
} view_textures;

/* Decodes the images that materials use, and takes the memory of the textures from the budget; one that
   cannot be decoded or does not fit is logged. Where all of them fit at once, several threads decode them.
   Errors: FFD_E_MEMORY. Call ffd_view_textures_free in every case. */
ffd_status ffd_view_textures_decode(const mesh_materials *from, memory_budget *budget, int threads,
                                    const mesh_log *log, view_textures *textures, ffd_error *error);
/* Frees the textures; leaves none. */
void ffd_view_textures_free(view_textures *textures);

#endif
