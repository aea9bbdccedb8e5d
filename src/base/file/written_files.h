/* written_files.h - the set of files that a run has written so far, by identity. Names do not suffice,
   because several names can lead to one file (links, "./"), and some are derived from others (the buffers of
   a .gltf). A lookup takes constant time. */
#ifndef FFD_BASE_FILE_WRITTEN_FILES_H
#define FFD_BASE_FILE_WRITTEN_FILES_H

#include "base/file/input.h"
#include "base/memory/intern.h"

/* All zeros: empty. */
typedef struct written_files {
    intern_table known; /* identities: device and inode */
    char **paths;       /* indexed by the numbers in `known` */
    size_t count, capacity;
} written_files;

/* Returns whether path leads to one of the files, under whatever name it was written. */
bool ffd_written_holds(const written_files *written, const char *path);
/* Adds the file with this stamp, which is at path or will be renamed to it. Errors: FFD_E_MEMORY. */
ffd_status ffd_written_add(written_files *written, const file_stamp *stamp, const char *path,
                           ffd_error *error);
/* Frees the set and empties it. */
void ffd_written_free(written_files *written);

#endif
