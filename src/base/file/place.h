/* place.h - identifies the place that a path leads to, whether or not a file is there: the folder, with links
   resolved, and the name in it. A file that is replaced by a rename keeps its place, unlike its inode; so
   does a file that is made, together with its folders. */
#ifndef FFD_BASE_FILE_PLACE_H
#define FFD_BASE_FILE_PLACE_H

#include "base/memory/hash.h"
#include "base/memory/intern.h"

/* Folders that are remembered by their paths. */
enum { PLACE_FOLDERS = 8 };

typedef struct place_folder {
    char *path, *resolved; /* path NULL: empty entry */
} place_folder;

/* Remembers folders, so that most places take one call of the system. All zeros: empty. */
typedef struct file_places {
    place_folder folders[PLACE_FOLDERS];
    size_t next;        /* entry to replace next */
    intern_table known; /* device and inode of each folder so far, */
    char **resolved;    /* and its path: it may be mounted at several */
    size_t capacity;
} file_places;

/* Returns a hash of the place. places: may be NULL. */
hash128 ffd_place_of(file_places *places, const char *path);
/* Returns a hash of the place as seen from the folder `base`, an absolute path without links: the same one
   where base has moved together with the place. places: may be NULL. */
hash128 ffd_place_relative(file_places *places, const char *base, const char *path);
/* Returns the hash of ffd_place_of, and with the same look at the file that of ffd_place_relative: *seen. */
hash128 ffd_place_both(file_places *places, const char *base, const char *path, hash128 *seen);
/* Frees the folders; leaves all zeros. */
void ffd_places_free(file_places *places);

#endif
