/* gltf_textures.h - the textures of materials (textureInfo), and the texture coordinates that they use. */
#ifndef FFD_IO_GLTF_READ_GLTF_TEXTURES_H
#define FFD_IO_GLTF_READ_GLTF_TEXTURES_H

#include "io/gltf/read/gltf_document.h"

/* What a texture does with the coordinates of a set: scale, rotate, offset (KHR_texture_transform). */
typedef struct gltf_texture_use {
    size_t set;
    double offset[2], scale[2], radians;
} gltf_texture_use;

/* Values of a texture that glTF does not allow, at most. */
enum { TEXTURE_FAULTS = 7 };

typedef struct gltf_texture_faults {
    uint32_t values[TEXTURE_FAULTS];
    size_t count;
} gltf_texture_faults;

/* Reads a whole number below limit. */
bool ffd_gltf_read_count(const gltf_document *document, uint32_t value, double limit, size_t *count);
/* Returns the first texture of a material after v, one of its values or the material itself; JSON_NONE:
   none. */
uint32_t ffd_gltf_next_texture(const gltf_document *document, uint32_t material, uint32_t v);
/* Reads how a texture (JSON_NONE: none) uses texture coordinates. A value that glTF does not allow is
   ignored, and added to faults, which may be NULL. */
void ffd_gltf_read_texture(const gltf_document *document, uint32_t texture, gltf_texture_use *use,
                           gltf_texture_faults *faults);

#endif
