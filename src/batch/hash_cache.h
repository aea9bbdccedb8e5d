/* hash_cache.h - cached hashes of files: a file is read again only if it has changed. */
#ifndef FFD_BATCH_HASH_CACHE_H
#define FFD_BATCH_HASH_CACHE_H

#include "base/file/kept_file.h"
#include "base/file/path_list.h"
#include "base/memory/hash.h"
#include <ffd/job.h>

/* Entries for files, and for meshes; the oldest are replaced. */
enum { CACHED_FILES = 256 };

typedef struct cached_file {
    char *path; /* NULL: empty entry */
    file_stamp stamp;
    hash128 hash;
    bool is_scanned_through; /* meshes is valid: */
    path_list meshes;        /* named by a lattice file for its box */
} cached_file;

/* A mesh with the files that it was read from (itself first), if its format can refer to files. */
typedef struct cached_mesh {
    char *path; /* NULL: empty entry */
    ffd_format format;
    file_stamp stamp;
    path_list files, images; /* images: with material libraries */
} cached_mesh;

/* The result of the last ffd_hash_cache_scan. */
typedef struct cached_scan {
    char *path; /* NULL: none */
    file_stamp stamp;
    ffd_format from, to;
    size_t sidecars;
    path_list named, copied;
} cached_scan;

/* The stamps of the job's first files. Each is taken once, before anything of its file is read. */
enum { JOB_STAMPS = 4 };

typedef struct job_stamps {
    char *paths[JOB_STAMPS];
    file_stamp stamps[JOB_STAMPS];
    size_t count;
} job_stamps;

/* All zeros: empty. */
typedef struct hash_cache {
    cached_file files[CACHED_FILES];
    cached_mesh meshes[CACHED_FILES];
    cached_scan scan;
    job_stamps stamps;
    size_t next, next_mesh; /* entries to replace next */
    kept_file kept;         /* bytes of the current job's mesh, if it is small */
} hash_cache;

/* Begins a job: asks for the stamps of files anew. */
void ffd_hash_cache_begin_job(hash_cache *cache);
/* Hashes a file's bytes. cache NULL: always read the file. Errors: those of reading. */
ffd_status ffd_hash_cache_hash(hash_cache *cache, const char *path, hash128 *hash, ffd_error *error);
/* Adds the files that a mesh is read from. Opens the mesh only if its format can refer to files. Errors:
   those of reading. */
ffd_status ffd_hash_cache_list(hash_cache *cache, const ffd_source *source, path_list *files,
                               ffd_error *error);
/* Adds the images and material libraries that a mesh refers to, existing or not. Errors: those of reading. */
ffd_status ffd_hash_cache_images(hash_cache *cache, const ffd_source *source, path_list *images,
                                 ffd_error *error);
/* Finds the files that a mesh names, which are added to `named`, and to `copied` those that may be copied
   with it; and what saving it in its own format, as `to`, writes beside it: *sidecars is the number of other
   files. Errors: those of reading. */
ffd_status ffd_hash_cache_scan(hash_cache *cache, const ffd_source *source, ffd_format to, size_t *sidecars,
                               path_list *named, path_list *copied, ffd_error *error);
/* Adds the files that a mesh names; none if it cannot be read. Errors: FFD_E_MEMORY. */
ffd_status ffd_hash_cache_list_named(const ffd_source *source, path_list *named, ffd_error *error);
/* Adds the meshes that a lattice file names for its box; none if it cannot be read. Errors: FFD_E_MEMORY. */
ffd_status ffd_hash_cache_box_meshes(hash_cache *cache, const char *path, path_list *meshes,
                                     ffd_error *error);
/* Frees all entries; leaves an empty cache. */
void ffd_hash_cache_free(hash_cache *cache);

#endif
