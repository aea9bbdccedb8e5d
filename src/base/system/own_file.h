/* own_file.h - where the file lies that this code was loaded from: the program, or a shared library. */
#ifndef FFD_BASE_SYSTEM_OWN_FILE_H
#define FFD_BASE_SYSTEM_OWN_FILE_H

#include <stdbool.h>

#define LONGEST_PATH 4096

/* Finds the absolute path of the program or library that holds an address. Its folder is right even if the
   file itself was deleted or replaced since. Works without /proc. Returns false if the path is unknown or too
   long. */
bool ffd_find_own_file(const void *inside, char path[LONGEST_PATH]);

#endif
