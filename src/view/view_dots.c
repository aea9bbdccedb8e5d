#include "view/view_dots.h"
#include "base/memory/memory.h"
#include "mesh/srgb.h"
#include <string.h>

const uint8_t ffd_view_line_color[3] = {60, 64, 72};

/* Splats with less opacity do not widen the picture. */
#define FAINT 0.05

static bool is_vertices_only(const view_scene *scene)
{
    return !scene->triangle_count && !scene->segment_count && !scene->point_count;
}

bool ffd_view_has_dots(const view_scene *scene)
{
    return scene->segment_count || scene->point_count || is_vertices_only(scene);
}

static uint8_t to_byte(double light)
{
    const double srgb = ffd_srgb_from_linear(light > 0 ? (light < 1 ? light : 1) : 0);
    return (uint8_t)(255 * (srgb < 1 ? srgb : 1) + 0.5);
}

/* Colours a vertex by its own colour and the material of an element that uses it. */
static void color_vertex(const view_scene *scene, uint32_t vertex, uint32_t material, const uint8_t *colors,
                         uint8_t *plain)
{
    const uint8_t *const own = colors ? colors + 4 * (size_t)vertex : NULL;
    uint8_t *const to = plain + 4 * (size_t)vertex;
    if (material >= scene->materials.count) {
        memcpy(to, own ? own : ffd_view_line_color, 3);
        to[3] = own ? own[3] : 255;
        return;
    }
    const mesh_material *const m = &scene->materials.list[material];
    for (int c = 0; c < 3; c++) {
        const double light = own ? ffd_srgb_byte_to_linear(own[c]) / 65535.0 : 1;
        to[c] = to_byte(light * m->color[c] + m->emission[c]);
    }
    to[3] = own ? own[3] : 255;
}

/* Points and lines are not lit. */
static ffd_status color_plain(const view_scene *scene, const uint8_t *colors, view_dots *dots,
                              ffd_error *error)
{
    dots->own = ffd_alloc(scene->vertex_count, 4);
    if (!dots->own)
        return ffd_fail_memory(error);
    for (size_t v = 0; v < scene->vertex_count; v++)
        color_vertex(scene, (uint32_t)v, VIEW_NONE, colors, dots->own);
    for (size_t i = 0; i < 2 * scene->segment_count; i++)
        color_vertex(scene, scene->segments[i], scene->segment_materials[i / 2], colors, dots->own);
    for (size_t i = 0; i < scene->point_count; i++)
        color_vertex(scene, scene->points[i], scene->point_materials[i], colors, dots->own);
    return FFD_OK;
}

static ffd_status list_all(const view_scene *scene, view_dots *dots, ffd_error *error)
{
    dots->all = ffd_alloc(scene->vertex_count, sizeof *dots->all);
    for (size_t i = 0; dots->all && i < scene->vertex_count; i++)
        dots->all[i] = (uint32_t)i;
    return dots->all ? FFD_OK : ffd_fail_memory(error);
}

static ffd_status mix_covariances(const view_scene *scene, double share, view_dots *dots, ffd_error *error)
{
    const float *const before = scene->splats[0], *const after = scene->splats[1];
    dots->covariances = ffd_alloc(scene->vertex_count, 6 * sizeof *dots->covariances);
    for (size_t i = 0; dots->covariances && i < 6 * scene->vertex_count; i++)
        dots->covariances[i] = (float)((1 - share) * before[i] + share * after[i]);
    return dots->covariances ? FFD_OK : ffd_fail_memory(error);
}

/* A colour of the palette that is a mark has no alpha, which is a splat's opacity: folded volume would not be
   seen. */
static ffd_status make_solid(const view_scene *scene, const uint8_t *colors, view_dots *dots,
                             ffd_error *error)
{
    dots->own = ffd_alloc(scene->vertex_count, 4);
    if (!dots->own)
        return ffd_fail_memory(error);
    memcpy(dots->own, colors, 4 * scene->vertex_count);
    for (size_t v = 0; v < scene->vertex_count; v++)
        dots->own[4 * v + 3] = 255;
    return FFD_OK;
}

ffd_status ffd_view_dots_make(const view_scene *scene, double share, const double *positions,
                              const uint8_t *colors, bool is_plain, uint32_t height, view_dots *dots,
                              ffd_error *error)
{
    const bool is_alone = is_vertices_only(scene);
    if (!ffd_view_has_dots(scene))
        return FFD_OK;
    if (is_plain)
        TRY(color_plain(scene, colors, dots, error));
    else if (colors && scene->splats[0])
        TRY(make_solid(scene, colors, dots, error));
    if (is_alone)
        TRY(list_all(scene, dots, error));
    if (scene->splats[0])
        TRY(mix_covariances(scene, share, dots, error));
    dots->points = (picture_points){.positions = positions,
                                    .vertex_count = scene->vertex_count,
                                    .points = is_alone ? dots->all : scene->points,
                                    .count = is_alone ? scene->vertex_count : scene->point_count,
                                    .colors = dots->own ? dots->own : colors,
                                    .radius = 1 + height / 900.0,
                                    .covariances = dots->covariances};
    memcpy(dots->points.color, ffd_view_line_color, sizeof ffd_view_line_color);
    return FFD_OK;
}

void ffd_view_dots_free(view_dots *dots)
{
    ffd_free(dots->all);
    ffd_free(dots->covariances);
    ffd_free(dots->own);
    *dots = (view_dots){.all = NULL};
}

void ffd_view_drop_faint(const view_scene *scene, uint8_t *marks)
{
    for (size_t v = 0; v < scene->vertex_count && scene->splats[0] && scene->colors; v++) {
        const float *const spread = scene->splats[0] + 6 * v;
        const bool is_splat = spread[0] > 0 || spread[3] > 0 || spread[5] > 0;
        if (is_splat && scene->colors[4 * v + 3] < FAINT)
            marks[v] = 0;
    }
}
