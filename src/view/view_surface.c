#include "view/view_surface.h"
#include "base/memory/memory.h"
#include <string.h>

/* The linear base colour of a material whose texture is lost. */
static const double grey[3] = {0.3, 0.312, 0.335};

/* Bytes per triangle, and of its texture coordinates. */
#define TRIANGLE_BYTES (4 * sizeof(uint32_t))
#define TEXCOORD_BYTES (6 * sizeof(float))

/* Returns the texture of an image; NULL if there is none. *is_lost: there is one that cannot be had. */
static const texture *find_texture(const texture *list, size_t count, const mesh_texture *of, bool *is_lost)
{
    if (of->image >= count)
        *is_lost = of->image == MATERIAL_LOST;
    else
        *is_lost = list[of->image].level_count == 0;
    return of->image < count && !*is_lost ? &list[of->image] : NULL;
}

static void fill_material(const view_surface *s, const mesh_material *from, picture_material *to)
{
    bool base_is_lost, glow_is_lost, opacity_is_lost;
    *to = (picture_material){.wrap = {from->base.wrap[0], from->base.wrap[1]},
                             .opacity_wrap = {from->opacity.wrap[0], from->opacity.wrap[1]},
                             .glow_wrap = {from->glow.wrap[0], from->glow.wrap[1]},
                             .alpha_cutoff = from->alpha == MATERIAL_MASK ? from->alpha_cutoff : 0,
                             .is_see_through = from->alpha == MATERIAL_BLEND,
                             .is_unlit = from->is_unlit,
                             .is_double_sided = from->is_double_sided};
    memcpy(to->color, from->color, sizeof to->color);
    const view_textures *const t = &s->textures;
    to->texture = find_texture(t->colors, t->count, &from->base, &base_is_lost);
    to->opacity = find_texture(t->opacities, t->count, &from->opacity, &opacity_is_lost);
    to->glow = find_texture(t->colors, t->count, &from->glow, &glow_is_lost);
    if (!glow_is_lost) /* else all of it would be as bright as its brightest place */
        memcpy(to->emission, from->emission, sizeof to->emission);
    if (!base_is_lost)
        return;
    memcpy(to->color, grey, sizeof grey);
    to->alpha_cutoff = 0; /* it applied to the texture */
}

static ffd_status fill_materials(const view_scene *scene, view_surface *s, ffd_error *error)
{
    const mesh_materials *const from = &scene->materials;
    s->list_count = from->count;
    s->list = ffd_alloc_zero(from->count, sizeof *s->list);
    if (!s->list)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < from->count; i++)
        fill_material(s, &from->list[i], &s->list[i]);
    for (size_t i = 0; i < from->count; i++)
        s->sees_through |= s->list[i].is_see_through;
    return FFD_OK;
}

static void put_triangle(const view_scene *scene, size_t t, uint32_t material, size_t to, view_surface *s)
{
    memcpy(s->triangles + 3 * to, scene->triangles + 3 * t, 3 * sizeof *s->triangles);
    if (s->texcoords)
        memcpy(s->texcoords + 6 * to, scene->texcoords + 6 * t, 6 * sizeof *s->texcoords);
    if (s->glow_texcoords)
        memcpy(s->glow_texcoords + 6 * to, scene->glow_texcoords + 6 * t, 6 * sizeof *s->glow_texcoords);
    s->materials[to] = material;
}

/* Copies the triangles, the flipped ones behind the others. Order is kept within both. */
static void fill_triangles(const view_scene *scene, view_surface *s)
{
    const view_part whole = {.material = VIEW_NONE, .triangle_count = scene->triangle_count};
    const view_part *const parts = scene->part_count ? scene->parts : &whole;
    const size_t part_count = scene->part_count ? scene->part_count : 1;
    size_t plain = 0, flipped = s->plain_count;
    for (size_t p = 0; p < part_count; p++)
        for (size_t t = parts[p].first_triangle; t < parts[p].first_triangle + parts[p].triangle_count; t++) {
            const bool is_flipped = scene->flipped && scene->flipped[t];
            put_triangle(scene, t, parts[p].material, is_flipped ? flipped++ : plain++, s);
        }
}

/* Counts plain and flipped triangles. */
static void count_triangles(const view_scene *scene, view_surface *s)
{
    for (size_t t = 0; t < scene->triangle_count; t++)
        s->flipped_count += scene->flipped && scene->flipped[t];
    s->plain_count = scene->triangle_count - s->flipped_count;
}

ffd_status ffd_view_surface_make(const view_scene *scene, bool textured, memory_budget *budget,
                                 uint64_t reserve, int threads, const mesh_log *log, view_surface *s,
                                 ffd_error *error)
{
    const size_t count = scene->triangle_count;
    const bool has_texcoords = textured && scene->texcoords,
               has_glow = has_texcoords && scene->glow_texcoords;
    *s = (view_surface){0};
    TRY(ffd_budget_take(
        budget, count,
        TRIANGLE_BYTES + (has_texcoords ? TEXCOORD_BYTES : 0) + (has_glow ? TEXCOORD_BYTES : 0), error));
    count_triangles(scene, s);
    s->triangles = ffd_alloc(count, 3 * sizeof *s->triangles);
    s->materials = ffd_alloc(count, sizeof *s->materials);
    s->texcoords = has_texcoords ? ffd_alloc_whole(count, 6 * sizeof *s->texcoords) : NULL;
    s->glow_texcoords = has_glow ? ffd_alloc_whole(count, 6 * sizeof *s->glow_texcoords) : NULL;
    if (!s->triangles || !s->materials || (has_texcoords && !s->texcoords) ||
        (has_glow && !s->glow_texcoords))
        return ffd_fail_memory(error);
    fill_triangles(scene, s);
    if (textured) {
        memory_budget rest = *budget;
        rest.taken += reserve; /* more than there is: then no texture fits */
        TRY(ffd_view_textures_decode(&scene->materials, &rest, threads, log, &s->textures, error));
        budget->taken = rest.taken - reserve;
    }
    return fill_materials(scene, s, error);
}

void ffd_view_surface_free(view_surface *s)
{
    ffd_view_textures_free(&s->textures);
    ffd_free(s->glow_texcoords);
    ffd_free(s->list);
    ffd_free(s->triangles);
    ffd_free(s->materials);
    ffd_free(s->texcoords);
    *s = (view_surface){0};
}
