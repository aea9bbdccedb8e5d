/* memory_files.h - files of a job that are in memory: bytes that its caller lends, others that a callback
   finds, and what is to be written, which goes to a callback as a whole. They have paths like others, by
   which input.h, folder.h and output.h find them: readers and writers need not know. A path leads there only
   while its memory_files exist. No system has a part in any of this. */
#ifndef FFD_BASE_FILE_MEMORY_FILES_H
#define FFD_BASE_FILE_MEMORY_FILES_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct memory_files memory_files;

/* Finds the file of a name, which is relative to the file that names it: *bytes are lent; NULL: there is
   none. */
typedef ffd_status memory_resolve(void *user, const char *name, const void **bytes, size_t *size);
/* Takes a file that was written; the bytes are lent during the call. */
typedef ffd_status memory_sink(void *user, const char *name, const void *bytes, size_t size);

/* Errors: FFD_E_MEMORY. */
ffd_status ffd_memory_create(memory_files **files, ffd_error *error);
/* NULL and pointers to NULL are allowed. */
void ffd_memory_destroy(memory_files **files);

/* Adds a file of this name, as messages have it. resolve (NULL: none) finds what is in its folder besides.
 *path is lent by files. Errors: FFD_E_ARGUMENT for a name that ends in a folder's, FFD_E_MEMORY. */
ffd_status ffd_memory_lend(memory_files *files, const char *name, const void *bytes, size_t size,
                           memory_resolve *resolve, void *user, const char **path, ffd_error *error);
/* Adds a folder for an output of this name and what is written beside it. Errors: likewise. */
ffd_status ffd_memory_take(memory_files *files, const char *name, memory_sink *sink, void *user,
                           const char **path, ffd_error *error);

/* Puts the names that the caller knows in the place of paths within a text of a buffer of this size. */
void ffd_memory_show(const memory_files *files, char *text, size_t capacity);
/* The status; or, whatever it is, that with which a resolve function, or the memory for what it has found,
   has failed. */
ffd_status ffd_memory_judge(const memory_files *files, ffd_status status, ffd_error *error);
/* The same for the files that a path leads to, if it leads to any. */
ffd_status ffd_memory_judge_path(const char *path, ffd_status status, ffd_error *error);

/* Whether a path leads there. */
bool ffd_memory_has(const char *path);
/* The name that a file or output was added under; NULL if path is another one. Lent by its files. */
const char *ffd_memory_name(const char *path);
/* Finds a file. *bytes: NULL: there is none. Errors: those of the resolve function, FFD_E_MEMORY. */
ffd_status ffd_memory_find(const char *path, const void **bytes, size_t *size, ffd_error *error);
/* Begins an output: *name is what its sink will get (free with ffd_free). Errors: FFD_E_IO for a path of
   inputs, FFD_E_MEMORY. */
ffd_status ffd_memory_begin(const char *path, char **name, ffd_error *error);
/* Hands the whole output of this path and name to its sink; needs no memory. Errors: those of the sink. */
ffd_status ffd_memory_give(const char *path, const char *name, const void *bytes, size_t size,
                           ffd_error *error);

#endif
