/* hash_cache.h - hashes of the files that jobs have in common with those before them: while a file stays as
   it is, it is not read again. */
#ifndef FFD_BATCH_HASH_CACHE_H
#define FFD_BATCH_HASH_CACHE_H

#include "base/file/kept_file.h"
#include "base/file/path_list.h"
#include "base/memory/hash.h"
#include <ffd/job.h>

/* Files, and meshes, that are remembered: those looked at last. */
enum { CACHED_FILES = 256 };

typedef struct cached_file {
    char *path; /* NULL: none */
    file_stamp stamp;
    hash128 hash;
    bool is_looked_through; /* what follows is known: */
    path_list meshes;       /* that it names for its box, if it is a lattice */
} cached_file;

/* A mesh and, of formats that can refer to files, what it was read from, itself first. */
typedef struct cached_mesh {
    char *path; /* NULL: none */
    ffd_format format;
    file_stamp stamp;
    path_list files, images; /* images, material libraries */
} cached_mesh;

/* What the last look at a mesh has shown. */
typedef struct cached_look {
    char *path; /* NULL: none */
    file_stamp stamp;
    ffd_format from, to;
    size_t beside;
    path_list copied;
} cached_look;

/* An empty cache is all zeros. */
typedef struct hash_cache {
    cached_file files[CACHED_FILES];
    cached_mesh meshes[CACHED_FILES];
    cached_look look;
    size_t next, next_mesh; /* to be replaced */
    kept_file kept;         /* the first small file that was read for the job under way: its mesh */
} hash_cache;

/* Hashes the file's bytes; without a cache (NULL) it reads them in any case. Errors: those of reading. */
ffd_status ffd_cache_hash(hash_cache *cache, const char *path, hash128 *hash, ffd_error *error);
/* Adds the files that a mesh is read from. Only formats that can refer to files are opened for that. Errors:
   those of reading. */
ffd_status ffd_cache_list(hash_cache *cache, const ffd_source *source, path_list *files, ffd_error *error);
/* Adds the images and material libraries beside it that it refers to, whether they exist or not. */
ffd_status ffd_cache_images(hash_cache *cache, const ffd_source *source, path_list *images, ffd_error *error);
/* Looks at the bytes of a mesh that is saved in its own format, as `to`: how many files are written beside
   the output, and adds the paths of those that may be copied with it. Errors: those of reading. */
ffd_status ffd_cache_look(hash_cache *cache, const ffd_source *source, ffd_format to, size_t *beside,
                          path_list *copied, ffd_error *error);
/* Adds the meshes that the box of a lattice file names to go round; none where it cannot be read. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_cache_box_meshes(hash_cache *cache, const char *path, path_list *meshes, ffd_error *error);
/* Leaves an empty cache. */
void ffd_cache_free(hash_cache *cache);

#endif
