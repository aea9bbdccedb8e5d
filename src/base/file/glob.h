/* glob.h - the files that match a pattern. */
#ifndef FFD_BASE_FILE_GLOB_H
#define FFD_BASE_FILE_GLOB_H

#include "base/fail.h"
#include <stddef.h>

typedef struct file_list {
    char **paths; /* count paths, sorted by bytes */
    size_t count;
} file_list;

/* Finds the files that match pattern (*, ?, [a-z]; a leading dot must be matched explicitly). No match is not
   a failure. After a request to end the program (interrupt.h) nothing is found. Errors: FFD_E_IO,
   FFD_E_MEMORY. */
ffd_status ffd_glob(const char *pattern, file_list *list, ffd_error *error);
/* Frees the paths and empties the list. */
void ffd_glob_free(file_list *list);

#endif
