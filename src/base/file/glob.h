/* glob.h - the files that match a pattern. */
#ifndef FFD_BASE_FILE_GLOB_H
#define FFD_BASE_FILE_GLOB_H

#include "base/file/path_list.h"

/* Adds the files that match a pattern (pattern.h), which stands for itself where it has no wildcards, sorted
   by bytes. No match is not a failure. After a request to end the program (interrupt.h) nothing is found.
   Errors: FFD_E_IO (a folder cannot be read), FFD_E_MEMORY. */
ffd_status ffd_glob(const char *pattern, path_list *found, ffd_error *error);

#endif
