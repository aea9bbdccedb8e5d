#include "view/view_surface.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include <stdio.h>
#include <string.h>

/* Linear base colours. grey: of a material whose texture is lost. paper: of a white material without texture,
   a little darker than white so that shading shows its shape. */
static const double grey[3] = {0.47, 0.49, 0.52}, paper[3] = {0.72, 0.72, 0.73};
#define WHITE 0.9

/* Bytes per triangle, and of its texture coordinates. */
#define TRIANGLE_BYTES (4 * sizeof(uint32_t))
#define TEXCOORD_BYTES (6 * sizeof(float))

/* All textures are in memory at the same time. */
static ffd_status decode(const mesh_image *from, memory_budget *budget, texture *to, ffd_error *error)
{
    image decoded = {0};
    ffd_status status;
    TRY_END(ffd_image_decode(from->bytes, from->size, budget, &decoded, error));
    TRY_END(ffd_budget_take(budget, ffd_texture_size(decoded.width, decoded.height), 1, error));
    TRY_END(ffd_texture_make(&decoded, to, error));
end:
    if (status)
        ffd_free(decoded.pixels);
    return status;
}

/* An image that cannot be decoded is logged, and its material is drawn grey; running out of memory is an
   error. */
static ffd_status decode_all(const mesh_materials *from, memory_budget *budget, const mesh_log *log,
                             view_surface *s, ffd_error *error)
{
    char first[300] = "";
    size_t lost = 0;
    s->texture_count = from->image_count;
    s->textures = ffd_alloc_zero(from->image_count, sizeof *s->textures);
    if (!s->textures)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < from->image_count; i++) {
        ffd_error own;
        const ffd_status status = decode(&from->images[i], budget, &s->textures[i], &own);
        if (status == FFD_E_MEMORY)
            return ffd_fail_memory(error);
        if (status && lost++ == 0)
            snprintf(first, sizeof first, "%.100s: %.180s", from->images[i].name, own.message);
    }
    if (lost)
        ffd_log_line(log, FFD_LOG_WARNING, "grey in the picture: %zu %s, as %s", lost,
                     ffd_plural(lost, "image", "images"), first);
    return FFD_OK;
}

static void fill_material(const view_surface *s, const mesh_material *from, picture_material *to)
{
    const texture *const of = from->base.image < s->texture_count ? &s->textures[from->base.image] : NULL;
    const bool is_lost = from->base.image == MATERIAL_LOST || (of && of->level_count == 0);
    *to = (picture_material){.wrap = {from->base.wrap[0], from->base.wrap[1]},
                             .alpha_cutoff = from->alpha_cutoff,
                             .is_double_sided = from->is_double_sided};
    memcpy(to->color, from->color, sizeof to->color);
    const double *const c = to->color;
    if (!of && c[0] > WHITE && c[1] > WHITE && c[2] > WHITE)
        memcpy(to->color, paper, sizeof paper);
    if (!is_lost)
        to->texture = of;
    else {
        memcpy(to->color, grey, sizeof grey);
        to->alpha_cutoff = 0; /* it applied to the texture */
    }
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
    return FFD_OK;
}

static void put_triangle(const view_scene *scene, size_t t, uint32_t material, size_t to, view_surface *s)
{
    memcpy(s->triangles + 3 * to, scene->triangles + 3 * t, 3 * sizeof *s->triangles);
    if (s->texcoords)
        memcpy(s->texcoords + 6 * to, scene->texcoords + 6 * t, 6 * sizeof *s->texcoords);
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
                                 uint64_t reserve, const mesh_log *log, view_surface *s, ffd_error *error)
{
    const size_t count = scene->triangle_count;
    const bool has_texcoords = textured && scene->texcoords;
    *s = (view_surface){0};
    TRY(ffd_budget_take(budget, count, TRIANGLE_BYTES + (has_texcoords ? TEXCOORD_BYTES : 0), error));
    count_triangles(scene, s);
    s->triangles = ffd_alloc(count, 3 * sizeof *s->triangles);
    s->materials = ffd_alloc(count, sizeof *s->materials);
    s->texcoords = has_texcoords ? ffd_alloc(count, 6 * sizeof *s->texcoords) : NULL;
    if (!s->triangles || !s->materials || (has_texcoords && !s->texcoords))
        return ffd_fail_memory(error);
    fill_triangles(scene, s);
    if (textured) {
        memory_budget rest = *budget;
        rest.taken += reserve; /* more than there is: then no texture fits */
        TRY(decode_all(&scene->materials, &rest, log, s, error));
        budget->taken = rest.taken - reserve;
    }
    return fill_materials(scene, s, error);
}

void ffd_view_surface_free(view_surface *s)
{
    for (size_t i = 0; s->textures && i < s->texture_count; i++)
        ffd_texture_free(&s->textures[i]);
    ffd_free(s->textures);
    ffd_free(s->list);
    ffd_free(s->triangles);
    ffd_free(s->materials);
    ffd_free(s->texcoords);
    *s = (view_surface){0};
}
