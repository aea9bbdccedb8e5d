/* hash_cache.h - hashes of the files that jobs have in common with those before them: while a file stays as
   it is, it is not read again. */
#ifndef FFD_BATCH_HASH_CACHE_H
#define FFD_BATCH_HASH_CACHE_H

#include "base/file/input.h"
#include "base/file/path_list.h"
#include "base/memory/hash.h"
#include <ffd/job.h>

/* Files that are remembered: those looked at last. */
enum { CACHED_FILES = 32 };

typedef struct cached_file {
    char *path; /* NULL: none */
    file_stamp stamp;
    hash128 hash;
} cached_file;

/* An empty cache is all zeros. */
typedef struct hash_cache {
    cached_file files[CACHED_FILES];
    size_t next; /* to be replaced */
    /* The mesh looked at last, and what it was read from, itself first. */
    char *mesh;
    ffd_format format;
    file_stamp stamp;
    path_list mesh_files, mesh_images;
} hash_cache;

/* Hashes the file's bytes. Errors: those of reading. */
ffd_status ffd_cache_hash(hash_cache *cache, const char *path, hash128 *hash, ffd_error *error);
/* Adds the files that a mesh is read from. Only formats that can refer to files are opened for that. Errors:
   those of reading. */
ffd_status ffd_cache_list(hash_cache *cache, const ffd_source *source, path_list *files, ffd_error *error);
/* Adds the images beside it that it shows, there or not. */
ffd_status ffd_cache_images(hash_cache *cache, const ffd_source *source, path_list *images, ffd_error *error);
/* Leaves an empty cache. */
void ffd_cache_free(hash_cache *cache);

#endif
