/* memory_files.h - the files of a job in memory: bytes that the caller lends, and files that a resolve
   callback provides. They have paths, which input.h and folder.h accept like others, so readers need not know
   about them. A path is valid as long as its memory_files exist. No file system is involved. */
#ifndef FFD_BASE_FILE_MEMORY_FILES_H
#define FFD_BASE_FILE_MEMORY_FILES_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct memory_files memory_files;

/* Finds the file of a name, which is relative to the file that refers to it. *bytes are borrowed; NULL: no
   such file. */
typedef ffd_status memory_resolve(void *user, const char *name, const void **bytes, size_t *size);

/* Creates an empty object. Errors: FFD_E_MEMORY. */
ffd_status ffd_memory_create(memory_files **files, ffd_error *error);
/* Destroys the object and its paths. files and *files may be NULL. */
void ffd_memory_destroy(memory_files **files);

/* Adds a file; name is for messages. resolve (may be NULL) finds further files of its folder. *path belongs
   to files. Errors: FFD_E_MEMORY. */
ffd_status ffd_memory_lend(memory_files *files, const char *name, const void *bytes, size_t size,
                           memory_resolve *resolve, void *user, const char **path, ffd_error *error);
/* Replaces paths in a text by the names that the caller knows. capacity: of the text's buffer. */
void ffd_memory_show(const memory_files *files, char *text, size_t capacity);
/* Returns status; but if a resolve function has failed, or memory for its result ran out, that failure. */
ffd_status ffd_memory_judge(const memory_files *files, ffd_status status, ffd_error *error);
/* The same for the object that a path belongs to, if any. */
ffd_status ffd_memory_judge_path(const char *path, ffd_status status, ffd_error *error);

/* Returns whether a path is a path in memory. */
bool ffd_memory_has(const char *path);
/* Returns the name under which a file was added; NULL for another path. It belongs to the
   object. */
const char *ffd_memory_name(const char *path);
/* Finds a file; *bytes is NULL if there is none. Errors: those of the resolve function, FFD_E_MEMORY. */
ffd_status ffd_memory_find(const char *path, const void **bytes, size_t *size, ffd_error *error);

#endif
