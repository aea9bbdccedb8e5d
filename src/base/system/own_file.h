/* own_file.h - where the file lies that this code was loaded from: the program, or a shared library; and what
   lies near it. */
#ifndef FFD_BASE_SYSTEM_OWN_FILE_H
#define FFD_BASE_SYSTEM_OWN_FILE_H

#include <stdbool.h>
#include <stddef.h>

#define LONGEST_PATH 4096

/* Finds the absolute path of the program or library that holds an address. Its folder is right even if the
   file itself was deleted or replaced since. Works without /proc. Returns false if the path is unknown or too
   long. */
bool ffd_find_own_file(const void *inside, char path[LONGEST_PATH]);

/* Finds the path of a file in the first of `count` folders that has a trusted one: of the administrator, the
   user, or the owner of the file that this code was loaded from. folders: absolute, or relative to the folder
   of that file; the array must lie in it too. Returns false if there is none: path is then that of a file
   which is not trusted or, if there is no file, the path in the last folder. *is_known: whether there is a
   folder of our own to look in. */
bool ffd_find_near(const char *const *folders, size_t count, const char *file, char path[LONGEST_PATH],
                   bool *is_known);

#endif
