/* folder.h - creates folders, and removes those that are not needed after all; resolves paths (folder.c has
   ffd_paths_meet and ffd_check_output_folder of ffd/program.h too). All paths are UTF-8. */
#ifndef FFD_BASE_FILE_FOLDER_H
#define FFD_BASE_FILE_FOLDER_H

#include "base/fail.h"
#include "base/file/path_list.h"
#include <ffd/program.h>
#include <stdbool.h>
#include <stddef.h>

/* Creates a folder and its parents if they do not exist. *made: the length of the first path that was
   created, 0 if none; also set after a failure. */
ffd_status ffd_folder_make(const char *path, size_t *made, ffd_error *error);
/* Returns whether a path leads to a folder. */
bool ffd_folder_is_there(const char *path);
/* Makes the checks of ffd_folder_make without making anything. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_folder_check(const char *path, ffd_error *error);
/* Removes the folders that ffd_folder_make created, as far as they are empty. Shortens path. */
void ffd_folder_unmake(char *path, size_t made);
/* Adds the names of the entries of a folder, sorted by bytes; none if it cannot be opened. Errors:
   FFD_E_MEMORY, FFD_E_IO (it cannot be read to its end). */
ffd_status ffd_folder_list(const char *path, path_list *names, ffd_error *error);
/* Adds the files in a folder and in those below it, as paths relative to it with '/', sorted by bytes. Links
   to files count, links to folders are not followed. Errors: FFD_E_IO (it, or one below it, is not a folder
   that can be read), FFD_E_MEMORY. */
ffd_status ffd_folder_walk(const char *path, path_list *files, ffd_error *error);
/* Returns the absolute path of a file or folder, with symbolic links resolved; NULL if it does not exist or
   memory runs out. Free with ffd_free. */
char *ffd_path_resolve(const char *path);
/* Returns the path that a symbolic link leads to, whether or not a file is there; a copy of the path itself
   if it is not a link, or links lead round in a circle; NULL if memory runs out. Free with ffd_free. */
char *ffd_path_follow(const char *path);
/* Returns whether two files are in different folders, which need not exist. Returns false if memory runs
   out. */
bool ffd_folders_differ(const char *file, const char *other);

#endif
