/* texture.h - a texture: an image with mipmaps. */
#ifndef FFD_PICTURE_TEXTURE_H
#define FFD_PICTURE_TEXTURE_H

#include "base/fail.h"
#include "mesh/material.h"
#include "picture/image/image.h"
#include "picture/linear.h"
#include <stdint.h>

#define TEXTURE_MOST_LEVELS 32

typedef struct texture_level {
    uint32_t width, height;
    const uint8_t *pixels; /* sRGB red, green, blue, alpha */
} texture_level;

typedef struct texture {
    image image; /* level 0 */
    uint8_t *smaller;
    texture_level levels[TEXTURE_MOST_LEVELS];
    int level_count;
} texture;

/* Returns the bytes of a texture with all levels. */
uint64_t ffd_texture_size(uint32_t width, uint32_t height);
/* Makes a texture from an image, and takes ownership of it. Each level has half the size of the one before,
   averaged in linear light. Errors: FFD_E_MEMORY; the caller then still owns the image. */
ffd_status ffd_texture_make(image *of, texture *result, ffd_error *error);
/* Frees the texture and empties it. */
void ffd_texture_free(texture *of);

/* Samples the texture at (u, v), v downwards. color: linear red, green, blue, alpha, 0 to 1. size: texels of
   level 0 for a pixel of the picture. Coordinates that are not finite count as 0. */
void ffd_texture_sample(const texture *of, const linear_tables *tables, const texture_wrap wrap[2], double u,
                        double v, double size, double color[4]);

#endif
