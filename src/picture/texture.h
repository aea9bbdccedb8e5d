/* texture.h - an image on a surface, with smaller versions of itself for where it is seen from far. */
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
    const uint8_t *pixels; /* red, green, blue, alpha, sRGB */
} texture_level;

typedef struct texture {
    image image; /* level 0 */
    uint8_t *smaller;
    texture_level levels[TEXTURE_MOST_LEVELS];
    int level_count;
} texture;

/* Bytes that a texture of an image takes in all. */
uint64_t ffd_texture_size(uint32_t width, uint32_t height);
/* Makes a texture of an image, which it then owns. Each level is half of the one before, the mean of its
   pixels in linear light. Errors: FFD_E_MEMORY; the image is the caller's still then. */
ffd_status ffd_texture_make(image *of, texture *result, ffd_error *error);
/* Frees what it holds; leaves an empty one. */
void ffd_texture_free(texture *of);

/* Red, green, blue and alpha, linear, 0 to 1, at (u, v), v downwards. size: how many texels of level 0 a
   pixel of the picture spans. Not finite coordinates are taken for 0. */
void ffd_texture_sample(const texture *of, const linear_tables *tables, const texture_wrap wrap[2], double u,
                        double v, double size, double color[4]);

#endif
