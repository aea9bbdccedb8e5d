#include "picture/texture.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "picture/linear.h"
#include <math.h>

static uint32_t half(uint32_t side)
{
    return side > 1 ? side / 2 : 1;
}

/* Returns the number of pixels of all mipmap levels below the first. */
static uint64_t smaller_pixels(uint32_t width, uint32_t height)
{
    uint64_t sum = 0;
    while (width > 1 || height > 1) {
        width = half(width);
        height = half(height);
        sum += (uint64_t)width * height;
    }
    return sum;
}

uint64_t ffd_texture_size(uint32_t width, uint32_t height)
{
    return 4 * ((uint64_t)width * height + smaller_pixels(width, height));
}

/* Computes the mean of the pixels of a box, weighted by alpha, so that transparent pixels do not contribute
   colour. */
static void average(const linear_tables *tables, const texture_level *from, const uint32_t x[2],
                    const uint32_t y[2], uint8_t to[4])
{
    uint64_t sum[3] = {0}, plain[3] = {0}, alpha = 0, count = 0;
    for (uint32_t j = y[0]; j < y[1]; j++)
        for (uint32_t i = x[0]; i < x[1]; i++, count++) {
            const uint8_t *const pixel = from->pixels + 4 * ((size_t)from->width * j + i);
            for (int c = 0; c < 3; c++) {
                plain[c] += tables->light[pixel[c]];
                sum[c] += (uint64_t)tables->light[pixel[c]] * pixel[3];
            }
            alpha += pixel[3];
        }
    for (int c = 0; c < 3; c++)
        to[c] = linear_to_byte(tables, (uint16_t)(alpha ? sum[c] / alpha : plain[c] / count));
    to[3] = (uint8_t)((alpha + count / 2) / count);
}

/* Whether the four pixels from `at` on, and in the row below, are opaque. If so, computes their mean: the
   same as `average`, in a fifth of its time. */
static inline bool average_opaque(const linear_tables *tables, const uint8_t *at, size_t row, uint8_t to[4])
{
    const uint8_t *const below = at + row;
    if ((at[3] & at[7] & below[3] & below[7]) != 255)
        return false;
    for (int c = 0; c < 3; c++) {
        const uint32_t sum = (uint32_t)tables->light[at[c]] + tables->light[at[c + 4]] +
                             tables->light[below[c]] + tables->light[below[c + 4]];
        to[c] = linear_to_byte(tables, (uint16_t)(sum / 4));
    }
    to[3] = 255;
    return true;
}

/* If a side is odd, the last pixel is the mean of three. */
static void shrink(const linear_tables *tables, const texture_level *from, uint32_t width, uint32_t height,
                   uint8_t *pixels)
{
    const uint32_t wide = from->width > 1 ? 2 : 1, high = from->height > 1 ? 2 : 1;
    const size_t row = (size_t)4 * from->width;
    for (uint32_t y = 0; y < height; y++) {
        const uint32_t down[2] = {high * y, y + 1 == height ? from->height : high * (y + 1)};
        for (uint32_t x = 0; x < width; x++) {
            const uint32_t across[2] = {wide * x, x + 1 == width ? from->width : wide * (x + 1)};
            const bool is_square = across[1] - across[0] == 2 && down[1] - down[0] == 2;
            uint8_t *const to = pixels + 4 * ((size_t)width * y + x);
            if (!is_square ||
                !average_opaque(tables, from->pixels + row * down[0] + (size_t)4 * across[0], row, to))
                average(tables, from, across, down, to);
        }
    }
}

ffd_status ffd_texture_make(image *of, texture *result, ffd_error *error)
{
    const uint64_t count = smaller_pixels(of->width, of->height);
    *result = (texture){.level_count = 1, .levels = {{of->width, of->height, of->pixels}}};
    result->smaller = ffd_alloc((size_t)count, 4);
    if (!result->smaller)
        return ffd_fail_memory(error);
    linear_tables tables;
    ffd_linear_fill(&tables);
    uint8_t *next = result->smaller;
    for (;;) {
        const texture_level *const last = &result->levels[result->level_count - 1];
        if (last->width == 1 && last->height == 1)
            break;
        texture_level *const level = &result->levels[result->level_count++];
        *level = (texture_level){half(last->width), half(last->height), next};
        shrink(&tables, last, level->width, level->height, next);
        next += (size_t)4 * level->width * level->height;
    }
    result->image = *of;
    *of = (image){0, 0, NULL};
    return FFD_OK;
}

void ffd_texture_free(texture *of)
{
    ffd_free(of->smaller);
    ffd_free(of->image.pixels);
    *of = (texture){.level_count = 0};
}

/* Returns the equivalent coordinate in 0 to 1. */
static double fold(texture_wrap wrap, double x)
{
    if (!isfinite(x))
        return 0;
    if (wrap == TEXTURE_CLAMP)
        return x < 0 ? 0 : x > 1 ? 1 : x;
    if (wrap == TEXTURE_MIRROR) {
        x -= 2 * floor_of(x / 2);
        return x > 1 ? 2 - x : x;
    }
    return x - floor_of(x);
}

/* Finds the two texels next to a coordinate from 0 to 1. Returns the weight of the second. */
static inline double neighbours(texture_wrap wrap, double x, uint32_t side, uint32_t texels[2])
{
    const double at = x * side - 0.5;
    const int64_t first = at < 0 ? -1 : (int64_t)at, last = (int64_t)side - 1;
    const bool repeats = wrap == TEXTURE_REPEAT;
    texels[0] = (uint32_t)(first < 0 ? (repeats ? last : 0) : first > last ? last : first);
    texels[1] = (uint32_t)(first + 1 > last ? (repeats ? 0 : last) : first + 1);
    return at - (double)first;
}

static inline void add_texel(const linear_tables *tables, const uint8_t *pixel, double weight,
                             double color[4])
{
    for (int c = 0; c < 3; c++)
        color[c] += weight * tables->shares[pixel[c]];
    color[3] += weight * tables->alphas[pixel[3]];
}

/* Adds a level's share of a texture at (u, v) from 0 to 1. */
static void sample_level(const linear_tables *tables, const texture_level *level, const texture_wrap wrap[2],
                         double u, double v, double share, double color[4])
{
    uint32_t x[2], y[2];
    const double right = neighbours(wrap[0], u, level->width, x),
                 below = neighbours(wrap[1], v, level->height, y);
    const double upper = share * (1 - below), lower = share * below;
    const uint8_t *const top = level->pixels + (size_t)4 * level->width * y[0], *const bottom =
                                                                                    level->pixels +
                                                                                    (size_t)4 * level->width *
                                                                                        y[1];
    add_texel(tables, top + (size_t)4 * x[0], upper * (1 - right), color);
    add_texel(tables, top + (size_t)4 * x[1], upper * right, color);
    add_texel(tables, bottom + (size_t)4 * x[0], lower * (1 - right), color);
    add_texel(tables, bottom + (size_t)4 * x[1], lower * right, color);
}

void ffd_texture_sample(const texture *of, const linear_tables *tables, const texture_wrap wrap[2], double u,
                        double v, double size, double color[4])
{
    const double across = fold(wrap[0], u), down = fold(wrap[1], v);
    int level = 0;
    double step = 1;
    while (level + 1 < of->level_count && size >= 2 * step) {
        level++;
        step *= 2;
    }
    /* Interpolates linearly between levels by size instead of its logarithm, which would not be
       reproducible. */
    double share = size / step - 1;
    share = level + 1 < of->level_count && share > 0 ? (share < 1 ? share : 1) : 0;
    color[0] = color[1] = color[2] = color[3] = 0;
    sample_level(tables, &of->levels[level], wrap, across, down, 1 - share, color);
    if (share > 0)
        sample_level(tables, &of->levels[level + 1], wrap, across, down, share, color);
}
