#include "picture/shade.h"
#include "picture/stripes.h"
#include <math.h>
#include <string.h>

/* The material of faces without one; with vertex colours it is white, so that these match the colour
   scale. */
static const picture_material grey = {.color = {0.3, 0.312, 0.335, 1}, .is_double_sided = true};
static const picture_material white = {.color = {1, 1, 1, 1}, .is_double_sided = true};

const picture_material *ffd_shade_material(const picture_mesh *mesh, size_t triangle)
{
    if (!mesh->materials || mesh->materials[triangle] >= mesh->material_count)
        return mesh->colors ? &white : &grey;
    return &mesh->material_list[mesh->materials[triangle]];
}

/* The textures of a material, in the order of shade.texels. */
enum { BASE, OPACITY, GLOW };

static const texture *texture_of(const shade *of, int which)
{
    const picture_material *const m = of->material;
    if (!of->surface->mesh->texcoords)
        return NULL;
    return which == BASE ? m->texture : which == OPACITY ? m->opacity : m->glow;
}

static const float *texcoords_of(const shade *of, int which)
{
    const picture_mesh *const mesh = of->surface->mesh;
    return (which == GLOW && mesh->glow_texcoords ? mesh->glow_texcoords : mesh->texcoords) +
           6 * of->triangle;
}

/* Returns the number of texels for a pixel: the root mean square of its two sides. It is constant in a
   triangle, because the projection is parallel. */
static double texel_size(const shade *of, int which)
{
    const texture *const base = texture_of(of, which);
    const uint32_t *const t = of->surface->triangles + 3 * of->triangle;
    const surface_vertex *const a = &of->surface->vertices[t[0]], *const b = &of->surface->vertices[t[1]],
                                *const c = &of->surface->vertices[t[2]];
    const float *const uv = texcoords_of(of, which);
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
    for (int which = BASE; which <= GLOW; which++)
        if (texture_of(of, which))
            of->texels[which] = texel_size(of, which);
}

/* Samples a texture; white where there is none. */
static void sample(const shade *of, int which, const texture_wrap wrap[2], const double weights[3],
                   double texel[4])
{
    const texture *const from = texture_of(of, which);
    if (!from) {
        texel[0] = texel[1] = texel[2] = texel[3] = 1;
        return;
    }
    const float *const uv = texcoords_of(of, which);
    const double u = weights[0] * uv[0] + weights[1] * uv[2] + weights[2] * uv[4],
                 v = weights[0] * uv[1] + weights[1] * uv[3] + weights[2] * uv[5];
    ffd_texture_sample(from, of->tables, wrap, u, 1 - v, of->texels[which], texel);
}

static void multiply_textures(const shade *of, const double weights[3], double color[4])
{
    double texel[4], opacity[4];
    sample(of, BASE, of->material->wrap, weights, texel);
    if (texture_of(of, OPACITY)) {
        sample(of, OPACITY, of->material->opacity_wrap, weights, opacity);
        texel[3] = opacity[3];
    }
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

/* The colour in the middle of a triangle whose material has a colour and nothing else, with integers: most
   triangles of a large mesh are smaller than a pixel, and use this. */
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
        parts[c] = linear_shoulder(part);
    }
    return linear_pack(parts[0], parts[1], parts[2]);
}

static bool emits(const picture_material *m)
{
    return m->emission[0] > 0 || m->emission[1] > 0 || m->emission[2] > 0;
}

bool ffd_shade_middle(const shade *of, uint64_t *color)
{
    static const double thirds[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    const picture_material *const m = of->material;
    if (texture_of(of, BASE) || m->alpha_cutoff > 0 || m->is_see_through || m->is_unlit || m->stripes ||
        emits(m))
        return ffd_shade_color(of, thirds, color);
    *color = middle_color(of);
    return true;
}

static double light_at(const shade *of, const double weights[3])
{
    const uint32_t *const t = of->surface->triangles + 3 * of->triangle;
    double light = 0;
    for (int k = 0; k < 3; k++)
        light += weights[k] * of->surface->vertices[t[k]].light[of->side];
    return light * (1.0 / LIGHT_ONE);
}

/* Returns the light of a lit colour as a part of LINEAR_ONE. */
static uint32_t lit(double light)
{
    const double most = 100; /* no lamps are that bright; NaN is dark */
    return linear_shoulder(light > 0 ? (uint64_t)((light < most ? light : most) * LINEAR_ONE + 0.5) : 0);
}

static uint64_t pack(const shade *of, double light, const double color[4], const double glow[3])
{
    const picture_material *const m = of->material;
    uint32_t parts[3];
    for (int c = 0; c < 3; c++) {
        const uint32_t seen = m->is_unlit ? linear_from(color[c]) : lit(light * color[c]);
        const uint32_t all = seen + linear_from(glow[c]);
        parts[c] = all < LINEAR_ONE ? all : LINEAR_ONE;
    }
    const uint64_t packed = linear_pack(parts[0], parts[1], parts[2]);
    return m->is_see_through ? packed | (uint64_t)linear_from(color[3]) << 48 : packed;
}

bool ffd_shade_color(const shade *of, const double weights[3], uint64_t *color)
{
    const picture_material *const m = of->material;
    double c[4] = {m->color[0], m->color[1], m->color[2], m->color[3]}, glow[4] = {0, 0, 0, 0};
    multiply_textures(of, weights, c);
    if (of->surface->mesh->colors)
        multiply_vertices(of, of->surface->triangles + 3 * of->triangle, weights, c);
    if (c[3] < m->alpha_cutoff)
        return false;
    if (m->stripes && c[3] < 0.5 && ffd_stripes_second(m->stripes, of->surface->stripe, of->px, of->py))
        for (int i = 0; i < 3; i++)
            c[i] *= STRIPE_DARK;
    if (emits(m))
        sample(of, GLOW, m->glow_wrap, weights, glow);
    for (int i = 0; i < 3; i++)
        glow[i] *= m->emission[i];
    *color = pack(of, light_at(of, weights), c, glow);
    return true;
}
