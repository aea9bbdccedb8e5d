/* folder.h - making folders, and removing those that were made for nothing. All paths are UTF-8. */
#ifndef FFD_BASE_FILE_FOLDER_H
#define FFD_BASE_FILE_FOLDER_H

#include "base/fail.h"
#include <stddef.h>

/* Makes a folder and those above it, where they do not exist. *made: the length of the first path that was
   made (0: none), also after a failure. */
ffd_status ffd_folder_make(const char *path, size_t *made, ffd_error *error);
/* Removes what ffd_folder_make made, where it is empty; shortens path. */
void ffd_folder_unmake(char *path, size_t made);
/* The absolute path of a file or folder, without links; NULL where there is none (or no memory). Free with
   ffd_free. */
char *ffd_path_resolve(const char *path);

#endif
