/* glob.h - the files that a pattern names. */
#ifndef FFD_BASE_FILE_GLOB_H
#define FFD_BASE_FILE_GLOB_H

#include "base/fail.h"
#include <stddef.h>

typedef struct file_list {
    char **paths; /* count, in the order of their bytes */
    size_t count;
} file_list;

/* Finds the files that match pattern (*, ?, [a-z]; names that begin with a dot only where the pattern has
   it). Finding none is not a failure. After a request to end
   the program (interrupt.h) none are found. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_glob(const char *pattern, file_list *list, ffd_error *error);
/* Frees the paths; the list is empty then. */
void ffd_glob_free(file_list *list);

#endif
