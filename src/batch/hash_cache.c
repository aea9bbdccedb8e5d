#include "batch/hash_cache.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/formats.h"
#include "job/input/source.h"
#include "lattice/file/box_meshes.h"
#include <string.h>

void ffd_hash_cache_begin_job(hash_cache *cache)
{
    for (size_t i = 0; i < cache->stamps.count; i++)
        ffd_free(cache->stamps.paths[i]);
    cache->stamps.count = 0;
}

/* Takes the stamp of a file, once in a job. Returns false if it cannot be taken. A file that changes
   meanwhile keeps the stamp from before, with which the next job finds it changed. */
static bool take_stamp(hash_cache *cache, const char *path, file_stamp *stamp)
{
    job_stamps *const known = &cache->stamps;
    for (size_t i = 0; i < known->count; i++)
        if (strcmp(known->paths[i], path) == 0) {
            *stamp = known->stamps[i];
            return true;
        }
    if (!ffd_file_stamp(path, stamp))
        return false;
    char *const copy = known->count < JOB_STAMPS ? ffd_text_copy(path) : NULL;
    if (copy) {
        known->paths[known->count] = copy;
        known->stamps[known->count++] = *stamp;
    }
    return true;
}

static cached_file *find(hash_cache *cache, const char *path, const file_stamp *stamp)
{
    for (size_t i = 0; i < CACHED_FILES; i++) {
        cached_file *const file = &cache->files[i];
        if (file->path && ffd_stamp_equal(&file->stamp, stamp) && strcmp(file->path, path) == 0)
            return file;
    }
    return NULL;
}

static void forget_file(cached_file *file)
{
    ffd_free(file->path);
    ffd_paths_free(&file->meshes);
    *file = (cached_file){0};
}

static void remember(hash_cache *cache, const char *path, const file_stamp *stamp, const hash128 *hash)
{
    if (find(cache, path, stamp))
        return;
    cached_file *const file = &cache->files[cache->next];
    forget_file(file);
    *file = (cached_file){.path = ffd_text_copy(path), .stamp = *stamp, .hash = *hash};
    cache->next = (cache->next + 1) % CACHED_FILES;
}

ffd_status ffd_hash_cache_hash(hash_cache *cache, const char *path, hash128 *hash, ffd_error *error)
{
    /* Stamp before reading: if the file changes meanwhile, the entry is outdated. */
    file_stamp stamp;
    const bool is_file = cache && take_stamp(cache, path, &stamp);
    const cached_file *const known = is_file ? find(cache, path, &stamp) : NULL;
    if (known) {
        *hash = known->hash;
        return FFD_OK;
    }
    file_input input;
    TRY(ffd_file_load(path, &input, error));
    *hash = ffd_hash(input.data, input.size);
    if (!is_file) {
        ffd_file_unload(&input);
        return FFD_OK;
    }
    remember(cache, path, &stamp, hash);
    ffd_kept_put(&cache->kept, path, &stamp, &input);
    return FFD_OK;
}

static ffd_status copy_list(const path_list *from, path_list *to, ffd_error *error)
{
    for (size_t i = 0; i < from->count; i++)
        TRY(ffd_paths_add(to, from->paths[i], error));
    return FFD_OK;
}

static void forget_mesh(cached_mesh *mesh)
{
    ffd_free(mesh->path);
    ffd_paths_free(&mesh->files);
    ffd_paths_free(&mesh->images);
    *mesh = (cached_mesh){0};
}

/* stamp: current stamp of the source's file. */
static const cached_mesh *find_mesh(const hash_cache *cache, const ffd_source *source, ffd_format format,
                                    const file_stamp *stamp)
{
    for (size_t i = 0; i < CACHED_FILES; i++) {
        const cached_mesh *const mesh = &cache->meshes[i];
        if (mesh->path && ffd_stamp_equal(&mesh->stamp, stamp) && mesh->format == format &&
            strcmp(mesh->path, source->path) == 0)
            return mesh;
    }
    return NULL;
}

static ffd_status list_by_document(cached_mesh *mesh, const ffd_source *source, ffd_error *error)
{
    mesh_document *document = NULL;
    TRY(ffd_source_open(source, 1, &document, error));
    ffd_status status;
    TRY_END(ffd_source_files(source, document, &mesh->files, error));
    if (document->format->sidecars)
        TRY_END(document->format->sidecars->list_images(document, &mesh->images, error));
end:
    ffd_source_close(&document);
    return status;
}

/* Loads a file that was stamped before, and stores its hash too, as its bytes are in memory. */
static ffd_status load_and_hash(hash_cache *cache, const char *path, const file_stamp *stamp,
                                file_input *bytes, ffd_error *error)
{
    TRY(ffd_file_load(path, bytes, error));
    const hash128 hash = ffd_hash(bytes->data, bytes->size);
    remember(cache, path, stamp, &hash);
    return FFD_OK;
}

static ffd_status list_by_bytes(hash_cache *cache, cached_mesh *mesh, const ffd_source *source,
                                const mesh_format *table, ffd_error *error)
{
    file_input bytes;
    TRY(load_and_hash(cache, source->path, &mesh->stamp, &bytes, error));
    ffd_status status =
        table->resources->find_named(source->path, &bytes, &(mesh_named){.copies = &mesh->images}, error);
    ffd_kept_put(&cache->kept, source->path, &mesh->stamp, &bytes);
    return status;
}

/* stamp: of the source's file, taken before it is read; NULL: it has none. */
static ffd_status scan_source(hash_cache *cache, cached_mesh *mesh, const ffd_source *source,
                              ffd_format format, const file_stamp *stamp, ffd_error *error)
{
    const mesh_format *const table = ffd_format_table(format);
    mesh->format = format;
    if (stamp)
        mesh->stamp = *stamp;
    if (table->sidecars || !table->resources)
        TRY(list_by_document(mesh, source, error));
    else if (stamp)
        TRY(list_by_bytes(cache, mesh, source, table, error));
    if (stamp)
        mesh->path = ffd_text_copy(source->path);
    return FFD_OK;
}

/* Finds or reads the file lists of a mesh. The result is borrowed until the next call. */
static ffd_status know_mesh(hash_cache *cache, const ffd_source *source, ffd_format format,
                            const cached_mesh **known, ffd_error *error)
{
    file_stamp stamp;
    const bool is_file = take_stamp(cache, source->path, &stamp);
    *known = is_file ? find_mesh(cache, source, format, &stamp) : NULL;
    if (*known)
        return FFD_OK;
    cached_mesh *const mesh = &cache->meshes[cache->next_mesh];
    forget_mesh(mesh);
    *known = mesh;
    const ffd_status status = scan_source(cache, mesh, source, format, is_file ? &stamp : NULL, error);
    cache->next_mesh = (cache->next_mesh + 1) % CACHED_FILES;
    return status;
}

ffd_status ffd_hash_cache_list(hash_cache *cache, const ffd_source *source, path_list *files,
                               ffd_error *error)
{
    ffd_format format;
    const cached_mesh *mesh;
    TRY(ffd_source_format(source, &format, error));
    if (!ffd_format_table(format)->sidecars)
        return ffd_paths_add(files, source->path, error);
    TRY(know_mesh(cache, source, format, &mesh, error));
    return copy_list(&mesh->files, files, error);
}

ffd_status ffd_hash_cache_images(hash_cache *cache, const ffd_source *source, path_list *images,
                                 ffd_error *error)
{
    ffd_format format;
    const cached_mesh *mesh;
    TRY(ffd_source_format(source, &format, error));
    if (!(ffd_format_table(format)->sidecars || ffd_format_table(format)->resources))
        return FFD_OK;
    TRY(know_mesh(cache, source, format, &mesh, error));
    return copy_list(&mesh->images, images, error);
}

static void forget_scan(cached_scan *scan)
{
    ffd_free(scan->path);
    ffd_paths_free(&scan->named);
    ffd_paths_free(&scan->copied);
    *scan = (cached_scan){0};
}

static bool is_last_scan(const cached_scan *scan, const char *path, const file_stamp *stamp, ffd_format from,
                         ffd_format to)
{
    return scan->path && strcmp(scan->path, path) == 0 && ffd_stamp_equal(&scan->stamp, stamp) &&
           scan->from == from && scan->to == to;
}

/* Parses a file of a format that may refer to other files. */
static ffd_status scan_bytes(hash_cache *cache, const char *path, const file_stamp *stamp, ffd_format from,
                             ffd_format to, ffd_error *error)
{
    cached_scan *const scan = &cache->scan;
    const mesh_format *const table = ffd_format_table(from);
    file_input bytes;
    forget_scan(scan);
    TRY(load_and_hash(cache, path, stamp, &bytes, error));
    ffd_status status = FFD_OK;
    if (table->sidecars && table->sidecars->count)
        scan->sidecars = table->sidecars->count(&bytes, from, to);
    /* A GLB that is made of a .gltf holds its images. */
    const bool copies = from != FFD_FORMAT_GLTF || to != FFD_FORMAT_GLB;
    const mesh_named found = {.files = &scan->named, .copies = copies ? &scan->copied : NULL};
    if (table->resources)
        status = table->resources->find_named(path, &bytes, &found, error);
    ffd_kept_put(&cache->kept, path, stamp, &bytes);
    scan->path = status ? NULL : ffd_text_copy(path);
    scan->stamp = *stamp;
    scan->from = from;
    scan->to = to;
    return status;
}

ffd_status ffd_hash_cache_scan(hash_cache *cache, const ffd_source *source, ffd_format to, size_t *sidecars,
                               path_list *named, path_list *copied, ffd_error *error)
{
    ffd_format from;
    file_stamp stamp;
    *sidecars = 0;
    TRY(ffd_source_format(source, &from, error));
    if (!ffd_format_table(from)->sidecars) {
        TRY(ffd_hash_cache_images(cache, source, copied, error));
        return copy_list(copied, named, error);
    }
    if (!take_stamp(cache, source->path, &stamp))
        return FFD_OK;
    if (!is_last_scan(&cache->scan, source->path, &stamp, from, to))
        TRY(scan_bytes(cache, source->path, &stamp, from, to, error));
    *sidecars = cache->scan.sidecars;
    TRY(copy_list(&cache->scan.named, named, error));
    return copy_list(&cache->scan.copied, copied, error);
}

ffd_status ffd_hash_cache_list_named(const ffd_source *source, path_list *named, ffd_error *error)
{
    ffd_format format;
    file_input bytes;
    if (ffd_source_format(source, &format, NULL) || !ffd_format_table(format)->sidecars ||
        ffd_file_load(source->path, &bytes, NULL))
        return FFD_OK;
    const ffd_status status = ffd_format_table(format)->resources->find_named(
        source->path, &bytes, &(mesh_named){.files = named}, error);
    ffd_file_unload(&bytes);
    return status;
}

/* Loads a lattice file, remembers its hash, and scans it. */
static ffd_status scan_lattice(hash_cache *cache, const char *path, path_list *meshes, ffd_error *error)
{
    file_stamp stamp;
    file_input bytes;
    if (!take_stamp(cache, path, &stamp) || load_and_hash(cache, path, &stamp, &bytes, NULL))
        return FFD_OK;
    const ffd_status status = ffd_lattice_box_meshes(path, &bytes, meshes, error);
    ffd_file_unload(&bytes);
    TRY(status);
    cached_file *const file = find(cache, path, &stamp);
    if (!file || file->is_scanned_through)
        return FFD_OK;
    TRY(copy_list(meshes, &file->meshes, error));
    file->is_scanned_through = true;
    return FFD_OK;
}

ffd_status ffd_hash_cache_box_meshes(hash_cache *cache, const char *path, path_list *meshes, ffd_error *error)
{
    file_stamp stamp;
    path_list found = {0};
    const cached_file *const file = take_stamp(cache, path, &stamp) ? find(cache, path, &stamp) : NULL;
    if (file && file->is_scanned_through)
        return copy_list(&file->meshes, meshes, error);
    ffd_status status;
    TRY_END(scan_lattice(cache, path, &found, error));
    TRY_END(copy_list(&found, meshes, error));
end:
    ffd_paths_free(&found);
    return status;
}

void ffd_hash_cache_free(hash_cache *cache)
{
    for (size_t i = 0; i < CACHED_FILES; i++)
        forget_file(&cache->files[i]);
    for (size_t i = 0; i < CACHED_FILES; i++)
        forget_mesh(&cache->meshes[i]);
    forget_scan(&cache->scan);
    ffd_hash_cache_begin_job(cache);
    ffd_kept_free(&cache->kept);
    *cache = (hash_cache){0};
}
