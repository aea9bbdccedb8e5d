/* folder.h - makes folders, and removes those that turned out not to be needed; finds where names lead. All
   paths are UTF-8. */
#ifndef FFD_BASE_FILE_FOLDER_H
#define FFD_BASE_FILE_FOLDER_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

/* Makes a folder and those above it, where they do not exist. *made: the length of the first path that was
   made (0: none), also after a failure. */
ffd_status ffd_folder_make(const char *path, size_t *made, ffd_error *error);
/* Removes what ffd_folder_make made, where it is empty; shortens path. */
void ffd_folder_unmake(char *path, size_t made);
/* The absolute path of a file or folder, without links; NULL if there is none or memory runs
   out. Free with ffd_free. */
char *ffd_path_resolve(const char *path);
/* Whether both paths lead to one file, which need not exist yet. False too where memory runs out. */
bool ffd_paths_meet(const char *a, const char *b);
/* Whether two files lie in different folders, which need not exist. False too where memory runs out. */
bool ffd_folders_differ(const char *file, const char *other);
/* Turns the backslashes of a name that a file gives into slashes, as programs for Windows mean them, unless
   there are none, or there is a file of that very name in the folder. Sets *turned to whether it did. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_path_turn_slashes(char *name, const char *folder, bool *turned, ffd_error *error);

#endif
