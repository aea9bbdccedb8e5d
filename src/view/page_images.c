#include "view/page_images.h"
#include "base/memory/memory.h"
#include "picture/image/image.h"
#include "picture/texture.h"
#include <stdio.h>
#include <string.h>

/* Longest sides of copies: halved from the first until all images fit, or the last is reached. */
#define FIRST_SIDE 4096
#define LAST_SIDE 64

static const mesh_image *file_of(const page_images *images, const page_image *of)
{
    return &images->from->images[of->image];
}

/* Returns the type of an image that browsers show; NULL: another. */
static const char *type_of(const mesh_image *file)
{
    static const struct {
        const char *type, *bytes;
        size_t at, size;
    } signatures[] = {{"image/png", "\x89PNG\r\n\x1a\n", 0, 8},
                      {"image/jpeg", "\xff\xd8\xff", 0, 3},
                      {"image/webp", "WEBP", 8, 4}};
    for (size_t i = 0; i < sizeof signatures / sizeof *signatures; i++)
        if (file->size >= signatures[i].at + signatures[i].size &&
            memcmp(file->bytes + signatures[i].at, signatures[i].bytes, signatures[i].size) == 0)
            return signatures[i].type;
    return NULL;
}

static void list_one(page_images *images, uint32_t used, uint8_t *seen)
{
    if (used >= images->from->image_count || seen[used])
        return;
    seen[used] = 1;
    const mesh_image *const file = &images->from->images[used];
    const char *const type = type_of(file);
    if (!type)
        return; /* the readers of materials let no other in */
    images->list[images->count++] = (page_image){.image = used, .type = type};
    images->all_bytes += file->size;
}

static void list_used(const page_mesh *mesh, uint8_t *seen, page_images *images)
{
    const view_scene *const scene = mesh->scene;
    for (size_t p = 0; p < scene->part_count; p++) {
        if (scene->parts[p].material >= images->from->count)
            continue;
        const mesh_material *const material = &images->from->list[scene->parts[p].material];
        list_one(images, material->base.image, seen);
        list_one(images, material->glow.image, seen);
        list_one(images, material->opacity.image, seen);
    }
    images->bytes = images->all_bytes;
}

static ffd_status append(void *context, const void *bytes, size_t size, ffd_error *error)
{
    byte_buffer *const to = context;
    ffd_buffer_append(to, bytes, size);
    return to->failed ? ffd_fail_memory(error) : FFD_OK;
}

static bool is_opaque(const texture_level *level)
{
    const size_t count = (size_t)level->width * level->height;
    for (size_t i = 0; i < count; i++)
        if (level->pixels[4 * i + 3] != 0xff)
            return false;
    return true;
}

/* Writes the first level that is no longer than `side`. */
static ffd_status encode(const texture *of, uint32_t side, byte_buffer *bytes, const char **type,
                         ffd_error *error)
{
    int at = 0;
    while (at + 1 < of->level_count && (of->levels[at].width > side || of->levels[at].height > side))
        at++;
    const texture_level *const level = &of->levels[at];
    const bool opaque = is_opaque(level);
    *type = opaque ? "image/jpeg" : "image/png";
    return opaque ? ffd_jpeg_write(level->pixels, level->width, level->height, append, bytes, error)
                  : ffd_png_write(level->pixels, level->width, level->height, 4, append, bytes, error);
}

/* Makes a copy of an image whose longer side exceeds `side`. One that cannot be decoded or written is left as
   it is. Returns FFD_OK or FFD_E_MEMORY. */
static ffd_status shrink(page_images *images, page_image *shown, uint32_t side, const memory_budget *budget,
                         ffd_error *error)
{
    const mesh_image *const file = file_of(images, shown);
    image decoded = {0};
    texture scaled = {0};
    byte_buffer bytes = {0};
    const char *type = NULL;
    ffd_status status;
    TRY_END(ffd_image_decode(file->bytes, file->size, budget, &decoded, NULL));
    shown->side = decoded.width > decoded.height ? decoded.width : decoded.height;
    if (shown->side <= side)
        goto end;
    TRY_END(budget ? ffd_budget_check(budget, ffd_texture_size(decoded.width, decoded.height), 1, NULL)
                   : FFD_OK);
    TRY_END(ffd_texture_make(&decoded, &scaled, NULL));
    decoded.pixels = NULL;
    TRY_END(encode(&scaled, side, &bytes, &type, NULL));
    const uint64_t before = shown->smaller.size ? shown->smaller.size : file->size;
    if (bytes.size < before) {
        images->smaller_count += shown->smaller.size == 0;
        images->bytes -= before - bytes.size;
        ffd_buffer_free(&shown->smaller);
        shown->smaller = bytes;
        shown->type = type;
        bytes = (byte_buffer){0};
    }
end:
    ffd_buffer_free(&bytes);
    ffd_texture_free(&scaled);
    ffd_free(decoded.pixels);
    return status == FFD_E_MEMORY ? ffd_fail_memory(error) : FFD_OK;
}

static ffd_status shrink_all(page_images *images, const memory_budget *budget, ffd_error *error)
{
    for (uint32_t side = FIRST_SIDE; side >= LAST_SIDE && images->bytes > PAGE_IMAGE_BYTES; side /= 2)
        for (size_t i = 0; i < images->count; i++)
            if (images->list[i].side == 0 || images->list[i].side > side)
                TRY(shrink(images, &images->list[i], side, budget, error));
    return FFD_OK;
}

ffd_status ffd_page_images_take(const page_mesh *mesh, bool full, const memory_budget *budget,
                                page_images *images, ffd_error *error)
{
    *images = (page_images){.from = &mesh->scene->materials};
    if (!mesh->texcoords)
        return FFD_OK;
    images->list = ffd_alloc_zero(images->from->image_count, sizeof *images->list);
    uint8_t *const seen = ffd_alloc_zero(images->from->image_count, 1);
    if (images->list && seen)
        list_used(mesh, seen, images);
    ffd_free(seen);
    if (!images->list || !seen)
        return ffd_fail_memory(error);
    return full ? FFD_OK : shrink_all(images, budget, error);
}

uint32_t ffd_page_image_of(const page_images *images, uint32_t of)
{
    for (size_t i = 0; i < images->count; i++)
        if (images->list[i].image == of)
            return (uint32_t)i;
    return VIEW_NONE;
}

static void fill_bytes(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    memcpy(bytes, (const unsigned char *)of + first, count);
}

void ffd_page_images_write(const page_images *images, page_writer *w)
{
    for (size_t i = 0; i < images->count; i++) {
        const page_image *const shown = &images->list[i];
        const mesh_image *const file = file_of(images, shown);
        char id[40];
        snprintf(id, sizeof id, "data-image-%zu", i);
        if (shown->smaller.size)
            ffd_page_write_block(w, id, shown->smaller.size, 1, fill_bytes, shown->smaller.data);
        else
            ffd_page_write_block(w, id, file->size, 1, fill_bytes, file->bytes);
    }
}

void ffd_page_images_describe(const page_images *images, json_text *json)
{
    ffd_json_array(json, "images", false);
    for (size_t i = 0; i < images->count; i++)
        ffd_json_string(json, NULL, images->list[i].type);
    ffd_json_end(json, ']');
}

void ffd_page_images_free(page_images *images)
{
    for (size_t i = 0; i < images->count; i++)
        ffd_buffer_free(&images->list[i].smaller);
    ffd_free(images->list);
    *images = (page_images){0};
}
