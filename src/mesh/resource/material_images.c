#include "mesh/resource/material_images.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "mesh/resource/image_tiles.h"
#include "mesh/resource/resource_copy.h"
#include <string.h>

static bool begins_with(const unsigned char *bytes, size_t size, const char *mark, size_t mark_size)
{
    return size >= mark_size && memcmp(bytes, mark, mark_size) == 0;
}

static bool is_shown(const unsigned char *bytes, size_t size)
{
    return begins_with(bytes, size, "\x89PNG\r\n\x1a\n", 8) || begins_with(bytes, size, "\xff\xd8\xff", 3) ||
           (size >= 12 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBP", 4) == 0);
}

ffd_status ffd_images_find(material_images *images, const char *name, bool *is_known, uint32_t *image,
                           ffd_error *error)
{
    const size_t known = images->known.count;
    uint32_t index;
    *image = MATERIAL_LOST;
    if (!ffd_intern(&images->known, name, strlen(name), &index) ||
        !ffd_grow((void **)&images->indices, &images->capacity, images->known.count, sizeof *images->indices))
        return ffd_fail_memory(error);
    *is_known = index < known;
    if (*is_known)
        *image = images->indices[index];
    else
        images->indices[index] = MATERIAL_LOST;
    return FFD_OK;
}

/* Takes the memory of an image from the budget. */
static ffd_status take(const material_images *images, const char *name, uint64_t size, ffd_error *error)
{
    char shown[81];
    ffd_error problem = {0};
    const uint64_t all = size + strlen(name) + 1 + sizeof *images->materials->images; /* both are in memory at
                                                                                         the same time */
    const ffd_status status = ffd_budget_take(images->budget, 1, all, &problem);
    if (!status)
        return FFD_OK;
    ffd_name_shown(name, shown, sizeof shown);
    return ffd_fail_file(error, status, ffd_file_display_name(images->mesh.file), "the image \"%s\" %s",
                         shown, problem.message);
}

ffd_status ffd_images_add(material_images *images, const char *name, const unsigned char *bytes, size_t size,
                          uint32_t *image, ffd_error *error)
{
    mesh_materials *const m = images->materials;
    *image = MATERIAL_LOST;
    if (!is_shown(bytes, size)) {
        ffd_left_add(&images->left, name, "is neither PNG, JPEG nor WebP");
        return FFD_OK;
    }
    TRY(take(images, name, size, error));
    const bool grown =
        ffd_grow((void **)&m->images, &m->image_capacity, m->image_count + 1, sizeof *m->images);
    const mesh_image made = {ffd_text_copy(name), ffd_alloc(size, 1), size};
    if (!grown || !made.name || !made.bytes) {
        ffd_free(made.name);
        ffd_free(made.bytes);
        return ffd_fail_memory(error);
    }
    memcpy(made.bytes, bytes, size);
    *image = images->indices[images->known.count - 1] = (uint32_t)m->image_count;
    m->images[m->image_count++] = made;
    return FFD_OK;
}

ffd_status ffd_images_load(material_images *images, const char *path, uint32_t *image, ffd_error *error)
{
    const mesh_resource resource = {.path = (char *)path, .kind = &ffd_resource_image};
    file_input bytes = {0};
    const char *left;
    ffd_error refused;
    bool is_known = false;
    TRY(ffd_images_find(images, path, &is_known, image, error));
    if (is_known)
        return FFD_OK;
    if (!images->has_folder) {
        ffd_left_add(&images->left, path, "is a file, and standard input has no folder");
        return FFD_OK;
    }
    if (ffd_image_has_tiles(path)) {
        ffd_left_add(&images->left, path, "has tiles");
        return FFD_OK;
    }
    TRY(ffd_resource_load(&images->mesh, &resource, &bytes, &left, &refused, error));
    if (left || refused.status) {
        ffd_left_add_unloaded(&images->left, path, left);
        return FFD_OK;
    }
    ffd_status status = ffd_images_add(images, path, bytes.data, bytes.size, image, error);
    ffd_file_unload(&bytes);
    return status;
}

void ffd_images_end(material_images *images, const mesh_log *log)
{
    ffd_left_out_log(&images->left, "image of a material cannot be shown",
                     "images of materials cannot be shown", log);
    ffd_intern_free(&images->known);
    ffd_free(images->indices);
}
