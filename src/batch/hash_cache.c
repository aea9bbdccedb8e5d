#include "batch/hash_cache.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/formats.h"
#include "job/input/source.h"

static const cached_file *find(const hash_cache *cache, const char *path, const file_stamp *stamp)
{
    for (size_t i = 0; i < CACHED_FILES; i++) {
        const cached_file *const file = &cache->files[i];
        if (file->path && strcmp(file->path, path) == 0 && ffd_stamp_equal(&file->stamp, stamp))
            return file;
    }
    return NULL;
}

static void remember(hash_cache *cache, const char *path, const file_stamp *stamp, const hash128 *hash)
{
    cached_file *const file = &cache->files[cache->next];
    ffd_free(file->path);
    *file = (cached_file){ffd_text_copy(path), *stamp, *hash};
    cache->next = (cache->next + 1) % CACHED_FILES;
}

ffd_status ffd_cache_hash(hash_cache *cache, const char *path, hash128 *hash, ffd_error *error)
{
    /* Looked at before the file is read: what changes it meanwhile makes the stamp an old one. */
    file_stamp stamp;
    const bool is_file = ffd_file_stamp(path, &stamp);
    const cached_file *const known = is_file ? find(cache, path, &stamp) : NULL;
    if (known) {
        *hash = known->hash;
        return FFD_OK;
    }
    file_input input;
    const ffd_status status = ffd_file_load(path, &input, error);
    if (status)
        return status;
    *hash = ffd_hash(input.data, input.size);
    ffd_file_unload(&input);
    if (is_file)
        remember(cache, path, &stamp, hash);
    return FFD_OK;
}

static ffd_status copy_list(const path_list *from, path_list *to, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < from->count && !status; i++)
        status = ffd_paths_add(to, from->paths[i], error);
    return status;
}

static void forget_mesh(hash_cache *cache)
{
    ffd_free(cache->mesh);
    cache->mesh = NULL;
    ffd_paths_free(&cache->mesh_files);
    ffd_paths_free(&cache->mesh_images);
}

static ffd_status list_opened(hash_cache *cache, const ffd_source *source, ffd_format format,
                              ffd_error *error)
{
    mesh_document *document = NULL;
    const bool is_file = ffd_file_stamp(source->path, &cache->stamp);
    ffd_status status = ffd_source_open(source, 1, &document, error);
    if (!status)
        status = ffd_source_files(source, document, &cache->mesh_files, error);
    if (!status && document->format->list_images)
        status = document->format->list_images(document, &cache->mesh_images, error);
    ffd_source_close(&document);
    if (!status && is_file)
        cache->mesh = ffd_text_copy(source->path);
    cache->format = format;
    return status;
}

/* Makes the source's the mesh that is known. */
static ffd_status know_mesh(hash_cache *cache, const ffd_source *source, ffd_format format, ffd_error *error)
{
    file_stamp stamp;
    if (cache->mesh && strcmp(cache->mesh, source->path) == 0 && cache->format == format &&
        ffd_file_stamp(source->path, &stamp) && ffd_stamp_equal(&stamp, &cache->stamp))
        return FFD_OK;
    forget_mesh(cache);
    return list_opened(cache, source, format, error);
}

ffd_status ffd_cache_list(hash_cache *cache, const ffd_source *source, path_list *files, ffd_error *error)
{
    ffd_format format;
    ffd_status status = ffd_source_format(source, &format, error);
    if (status)
        return status;
    if (!ffd_format_table(format)->list_files)
        return ffd_paths_add(files, source->path, error);
    status = know_mesh(cache, source, format, error);
    return status ? status : copy_list(&cache->mesh_files, files, error);
}

ffd_status ffd_cache_images(hash_cache *cache, const ffd_source *source, path_list *images, ffd_error *error)
{
    ffd_format format;
    ffd_status status = ffd_source_format(source, &format, error);
    if (status || !ffd_format_table(format)->list_images)
        return status;
    status = know_mesh(cache, source, format, error);
    return status ? status : copy_list(&cache->mesh_images, images, error);
}

void ffd_cache_free(hash_cache *cache)
{
    for (size_t i = 0; i < CACHED_FILES; i++)
        ffd_free(cache->files[i].path);
    forget_mesh(cache);
    *cache = (hash_cache){0};
}
