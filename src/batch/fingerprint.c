#include "batch/fingerprint.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/memory/memory.h"
#include "io/formats.h"
#include "job/input/shown_box.h"
#include "job/input/source.h"

/* The hashes that are combined into a fingerprint. */
typedef struct hash_list {
    hash128 *hashes;
    size_t count, capacity;
} hash_list;

static ffd_status add_hash(hash_list *list, const hash128 *hash, ffd_error *error)
{
    if (!ffd_grow((void **)&list->hashes, &list->capacity, list->count + 1, sizeof *list->hashes))
        return ffd_fail_memory(error);
    list->hashes[list->count++] = *hash;
    return FFD_OK;
}

static ffd_status add_file(hash_list *list, hash_cache *cache, const char *path, ffd_error *error)
{
    hash128 hash;
    TRY(ffd_hash_cache_hash(cache, path, &hash, error));
    return add_hash(list, &hash, error);
}

static ffd_status add_files(hash_list *list, hash_cache *cache, const path_list *files, ffd_error *error)
{
    for (size_t i = 0; i < files->count; i++)
        TRY(add_file(list, cache, files->paths[i], error));
    return FFD_OK;
}

/* A missing or unreadable image has a hash too. */
static ffd_status add_images(hash_list *list, hash_cache *cache, const path_list *images, ffd_error *error)
{
    static const hash128 missing = {{0}};
    for (size_t i = 0; i < images->count; i++)
        if (add_file(list, cache, images->paths[i], NULL))
            TRY(add_hash(list, &missing, error));
    return FFD_OK;
}

static ffd_status finish(hash_list *list, ffd_status status, hash128 *hash)
{
    if (!status)
        *hash = ffd_hash(list->hashes, list->count * sizeof *list->hashes);
    ffd_free(list->hashes);
    return status;
}

/* Whether images and material libraries would be copied with an output in another folder. They are not in
   place, or in a conversion. */
static bool may_copy_images(const ffd_deform_desc *desc)
{
    ffd_format from_format, format = desc->output_format;
    if (desc->in_place || !desc->output || desc->resources == FFD_RESOURCES_REFERENCE ||
        ffd_source_format(&desc->input, &from_format, NULL))
        return false;
    if (format == FFD_FORMAT_AUTO)
        format = ffd_format_from_name(desc->output);
    return ffd_format_table(format) == ffd_format_table(from_format);
}

static bool copies_images(const ffd_deform_desc *desc)
{
    return may_copy_images(desc) && ffd_folders_differ(desc->input.path, desc->output);
}

/* Lists the images and material libraries that are copied with the output. Most meshes have none, and the
   folders are not compared. */
static ffd_status list_copied(hash_cache *cache, const ffd_deform_desc *desc, path_list *images,
                              ffd_error *error)
{
    if (!may_copy_images(desc))
        return FFD_OK;
    TRY(ffd_hash_cache_images(cache, &desc->input, images, error));
    if (images->count > 0 && !ffd_folders_differ(desc->input.path, desc->output))
        ffd_paths_free(images);
    return FFD_OK;
}

bool ffd_fingerprint_has_copies(const ffd_deform_desc *desc, hash_cache *cache)
{
    path_list images = {0};
    const bool may_have = list_copied(cache, desc, &images, NULL) || images.count > 0;
    ffd_paths_free(&images);
    return may_have;
}

/* Adds the input's images. Those that exist become files of the job. */
static ffd_status add_images_of_input(hash_list *list, hash_cache *cache, const ffd_deform_desc *desc,
                                      path_list *files, ffd_error *error)
{
    path_list images = {0};
    ffd_status status;
    TRY_END(list_copied(cache, desc, &images, error));
    TRY_END(add_images(list, cache, &images, error));
    for (size_t i = 0; i < images.count; i++)
        if (ffd_file_exists(images.paths[i]))
            TRY_END(ffd_paths_add(files, images.paths[i], error));
end:
    ffd_paths_free(&images);
    return status;
}

/* Adds the meshes that lattices take their boxes from: those named in lattice files, and the shared box. */
static ffd_status add_boxes(hash_list *list, hash_cache *cache, const ffd_deform_desc *desc, path_list *files,
                            ffd_error *error)
{
    path_list meshes = {0}, read = {0};
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < desc->lattice_count; i++)
        TRY_END(ffd_hash_cache_box_meshes(cache, desc->lattices[i].path, &meshes, error));
    for (size_t i = 0; i < meshes.count; i++) {
        ffd_source source = desc->input;
        source.path = meshes.paths[i];
        source.format = FFD_FORMAT_AUTO;
        TRY_END(ffd_hash_cache_list(cache, &source, &read, error));
    }
    TRY_END(add_files(list, cache, &read, error));
    for (size_t i = 0; i < read.count; i++)
        TRY_END(ffd_paths_add(files, read.paths[i], error));
end:
    ffd_paths_free(&meshes);
    ffd_paths_free(&read);
    if (status || !desc->shared_box)
        return status;
    const fit_extent box = ffd_shown_box_extent(&desc->shared_box->box);
    const hash128 sides[] = {ffd_hash_doubles(box.min, 3), ffd_hash_doubles(box.max, 3),
                             ffd_hash_doubles(box.shown_min, 3), ffd_hash_doubles(box.shown_max, 3)};
    const hash128 hash = ffd_hash(sides, sizeof sides);
    return add_hash(list, &hash, error);
}

ffd_status ffd_fingerprint_inputs(const ffd_deform_desc *desc, const hash128 *content, hash_cache *cache,
                                  path_list *files, hash128 *hash, ffd_error *error)
{
    hash_list list = {0};
    path_list others = {0};
    ffd_status status;
    TRY_END(add_hash(&list, content, error));
    TRY_END(ffd_hash_cache_list(cache, &desc->input, files, error));
    TRY_END(add_files(&list, cache, files, error));
    TRY_END(add_images_of_input(&list, cache, desc, files, error));
    for (size_t i = 0; i < desc->lattice_count; i++)
        TRY_END(ffd_paths_add(&others, desc->lattices[i].path, error));
    if (desc->embedding.path)
        TRY_END(ffd_paths_add(&others, desc->embedding.path, error));
    if (desc->weight.source && ffd_weight_file(desc->weight.source))
        TRY_END(ffd_paths_add(&others, ffd_weight_file(desc->weight.source), error));
    TRY_END(add_files(&list, cache, &others, error));
    for (size_t i = 0; i < others.count; i++)
        TRY_END(ffd_paths_add(files, others.paths[i], error));
    TRY_END(add_boxes(&list, cache, desc, files, error));
end:
    ffd_paths_free(&others);
    return finish(&list, status, hash);
}

static ffd_status find_copies(const char *path, const mesh_format *format, path_list *images,
                              ffd_error *error)
{
    file_input bytes;
    ffd_status status = FFD_OK;
    if (!format->resources || ffd_file_load(path, &bytes, NULL))
        return FFD_OK;
    status = format->resources->find_named(path, &bytes, &(mesh_named){.copies = images}, error);
    ffd_file_unload(&bytes);
    return status;
}

/* Lists the files that the output refers to: its buffers, and images and material libraries
   (find_named finds those that were copied), which may be missing. */
static ffd_status list_output(const ffd_source *output, bool has_copies, path_list *files, path_list *images,
                              ffd_error *error)
{
    ffd_format format;
    mesh_document *document;
    TRY(ffd_source_format(output, &format, error));
    const mesh_sidecar_calls *const sidecars = ffd_format_table(format)->sidecars;
    if (!sidecars || !sidecars->count) {
        TRY(ffd_paths_add(files, output->path, error));
        return has_copies ? find_copies(output->path, ffd_format_table(format), images, error) : FFD_OK;
    }
    TRY(ffd_source_open(output, 1, &document, error));
    ffd_status status;
    TRY_END(ffd_source_files(output, document, files, error));
    TRY_END(sidecars->list_images(document, images, error));
end:
    ffd_source_close(&document);
    return status;
}

ffd_status ffd_fingerprint_output(const ffd_deform_desc *desc, hash128 *hash, ffd_error *error)
{
    const ffd_source output = {.path = desc->in_place ? desc->input.path : desc->output,
                               .format = desc->in_place ? desc->input.format : desc->output_format,
                               .memory = desc->input.memory};
    hash_list list = {0};
    path_list files = {0}, images = {0};
    ffd_status status;
    TRY_END(list_output(&output, copies_images(desc), &files, &images, error));
    TRY_END(add_files(&list, NULL, &files, error));
    TRY_END(add_images(&list, NULL, &images, error));
end:
    ffd_paths_free(&files);
    ffd_paths_free(&images);
    return finish(&list, status, hash);
}

hash128 ffd_fingerprint_written(const hash128 *bytes)
{
    return ffd_hash(bytes, sizeof *bytes);
}
