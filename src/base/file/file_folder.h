/* file_folder.h - where the names in a file lead: to the files beside it or, if it is in memory, to what the
   caller's function finds. */
#ifndef FFD_BASE_FILE_FILE_FOLDER_H
#define FFD_BASE_FILE_FILE_FOLDER_H

#include "base/file/input.h"
#include <ffd/job.h>

typedef struct file_folder {
    const char *file;             /* names count from where it is; NULL: it has no folder */
    ffd_resolve_function resolve; /* finds the files beside one in memory; NULL: it is in the file system */
    void *user;
} file_folder;

/* Returns whether there is a file of this name. */
bool ffd_folder_has(const file_folder *folder, const char *name);
/* Loads it. As ffd_file_load_within, which a folder in the file system is left to. */
ffd_status ffd_folder_load(const file_folder *folder, const char *name, const char *named_by, size_t *most,
                           file_input *input, ffd_error *error);
/* Replaces the backslashes in a name from a file by slashes, which programs for Windows mean by them, unless
   there is a file with exactly that name. Returns whether the name has changed. */
bool ffd_folder_turn_slashes(const file_folder *folder, char *name);

#endif
