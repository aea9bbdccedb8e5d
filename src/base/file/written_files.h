/* written_files.h - the files that a run has written so far. Two names can lead to one file (links, "./"),
   and names are derived from others (a .gltf's buffers): only the files themselves show it. A lookup takes
   the same time however many were written. */
#ifndef FFD_BASE_FILE_WRITTEN_FILES_H
#define FFD_BASE_FILE_WRITTEN_FILES_H

#include "base/file/input.h"
#include "base/memory/intern.h"

/* Zeroed: none. */
typedef struct written_files {
    intern_table known; /* which file each is, on which device */
    char **paths;       /* by its number there */
    size_t count, capacity;
} written_files;

/* Whether path leads to one of them, under whatever name it was written. */
bool ffd_written_holds(const written_files *written, const char *path);
/* Adds the file with this stamp, which is at path or is about to be. Errors: FFD_E_MEMORY. */
ffd_status ffd_written_add(written_files *written, const file_stamp *stamp, const char *path,
                           ffd_error *error);
/* Frees the record; it is empty then. */
void ffd_written_free(written_files *written);

#endif
