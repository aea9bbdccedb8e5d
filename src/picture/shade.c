#include "picture/shade.h"
#include <math.h>

/* The material of faces without one; with vertex colours it is white, so that these match the colour
   scale. */
static const picture_material grey = {.color = {0.47, 0.49, 0.52, 1}, .is_double_sided = true};
static const picture_material white = {.color = {1, 1, 1, 1}, .is_double_sided = true};

const picture_material *ffd_shade_material(const picture_mesh *mesh, size_t triangle)
{
    if (!mesh->materials || mesh->materials[triangle] >= mesh->material_count)
        return mesh->colors ? &white : &grey;
    return &mesh->material_list[mesh->materials[triangle]];
}

static bool has_texture(const shade *of)
{
    return of->material->texture && of->surface->mesh->texcoords;
}

/* Returns the number of texels for a pixel: the root mean square of its two sides. It is constant in a
   triangle, because the projection is parallel. */
static double texel_size(const shade *of)
{
    const texture *const base = of->material->texture;
    const uint32_t *const t = of->surface->triangles + 3 * of->triangle;
    const surface_vertex *const a = &of->surface->vertices[t[0]], *const b = &of->surface->vertices[t[1]],
                                *const c = &of->surface->vertices[t[2]];
    const float *const uv = of->surface->mesh->texcoords + 6 * of->triangle;
    const double bx = ((double)b->x - a->x) / SUBPIXELS, by = ((double)b->y - a->y) / SUBPIXELS,
                 cx = ((double)c->x - a->x) / SUBPIXELS, cy = ((double)c->y - a->y) / SUBPIXELS;
    const double area = bx * cy - by * cx, sides[2] = {base->image.width, base->image.height};
    double sum = 0;
    for (int k = 0; k < 2; k++) {
        const double b_step = sides[k] * ((double)uv[2 + k] - uv[k]),
                     c_step = sides[k] * ((double)uv[4 + k] - uv[k]);
        const double across = (b_step * cy - c_step * by) / area, down = (c_step * bx - b_step * cx) / area;
        sum += across * across + down * down;
    }
    return sqrt(sum / 2);
}

void ffd_shade_begin(shade *of)
{
    of->material = ffd_shade_material(of->surface->mesh, of->triangle);
    if (has_texture(of))
        of->texel_size = texel_size(of);
}

static void multiply_texture(const shade *of, const double weights[3], double color[4])
{
    const float *const uv = of->surface->mesh->texcoords + 6 * of->triangle;
    double texel[4];
    const double u = weights[0] * uv[0] + weights[1] * uv[2] + weights[2] * uv[4],
                 v = weights[0] * uv[1] + weights[1] * uv[3] + weights[2] * uv[5];
    ffd_texture_sample(of->material->texture, of->tables, of->material->wrap, u, 1 - v, of->texel_size,
                       texel);
    for (int c = 0; c < 4; c++)
        color[c] *= texel[c];
}

static void multiply_vertices(const shade *of, const uint32_t *triangle, const double weights[3],
                              double color[4])
{
    double sum[4] = {0, 0, 0, 0};
    for (int k = 0; k < 3; k++) {
        const uint8_t *const bytes =
            of->surface->mesh->colors + 4 * (size_t)surface_origin(of->surface, triangle[k]);
        for (int c = 0; c < 3; c++)
            sum[c] += weights[k] * of->tables->light[bytes[c]];
        sum[3] += weights[k] * bytes[3];
    }
    for (int c = 0; c < 3; c++)
        color[c] *= sum[c] * (1.0 / LINEAR_ONE);
    color[3] *= sum[3] * (1.0 / 255);
}

/* The colour in the middle of a triangle without texture and holes, with integers: most triangles of a large
   mesh are smaller than a pixel, and use this. */
static uint64_t middle_color(const shade *of)
{
    const surface *const from = of->surface;
    const uint32_t *const t = from->triangles + 3 * of->triangle;
    uint32_t parts[3];
    uint64_t light = 0;
    const uint8_t *bytes[3] = {NULL};
    for (int k = 0; k < 3; k++) {
        light += from->vertices[t[k]].light[of->side];
        if (from->mesh->colors)
            bytes[k] = from->mesh->colors + 4 * (size_t)surface_origin(from, t[k]);
    }
    for (int c = 0; c < 3; c++) {
        uint64_t part = linear_from(of->material->color[c]) * light / (3 * LIGHT_ONE);
        if (bytes[0]) {
            const uint16_t *const table = of->tables->light;
            const uint64_t sum = (uint64_t)table[bytes[0][c]] + table[bytes[1][c]] + table[bytes[2][c]];
            part = part * sum / (3 * LINEAR_ONE);
        }
        parts[c] = (uint32_t)(part < LINEAR_ONE ? part : LINEAR_ONE);
    }
    return linear_pack(parts[0], parts[1], parts[2]);
}

bool ffd_shade_middle(const shade *of, uint64_t *color)
{
    static const double thirds[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    if (has_texture(of) || of->material->alpha_cutoff > 0)
        return ffd_shade_color(of, thirds, color);
    *color = middle_color(of);
    return true;
}

bool ffd_shade_color(const shade *of, const double weights[3], uint64_t *color)
{
    const uint32_t *const t = of->surface->triangles + 3 * of->triangle;
    double c[4] = {of->material->color[0], of->material->color[1], of->material->color[2],
                   of->material->color[3]};
    double light = 0;
    for (int k = 0; k < 3; k++)
        light += weights[k] * of->surface->vertices[t[k]].light[of->side];
    light *= 1.0 / LIGHT_ONE;
    if (has_texture(of))
        multiply_texture(of, weights, c);
    if (of->surface->mesh->colors)
        multiply_vertices(of, t, weights, c);
    if (c[3] < of->material->alpha_cutoff)
        return false;
    *color = linear_pack(linear_from(light * c[0]), linear_from(light * c[1]), linear_from(light * c[2]));
    return true;
}
