/* path_list.h - a growing list of file names. */
#ifndef FFD_BASE_FILE_PATH_LIST_H
#define FFD_BASE_FILE_PATH_LIST_H

#include "base/fail.h"
#include <stddef.h>

/* An empty list is all zeros. */
typedef struct path_list {
    char **paths;
    size_t count, capacity;
} path_list;

/* Adds a copy of path. Errors: FFD_E_MEMORY. */
ffd_status ffd_paths_add(path_list *list, const char *path, ffd_error *error);
/* Frees the paths and empties the list. */
void ffd_paths_free(path_list *list);

#endif
