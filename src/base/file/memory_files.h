/* memory_files.h - the files of a job in memory: bytes that the caller lends, files that a resolve callback
   provides, and outputs that are collected for a sink callback. They have paths, which input.h, folder.h and
   output.h accept like others, so readers and writers need not know about them. A path is valid as long as
   its memory_files exist. No file system is involved. */
#ifndef FFD_BASE_FILE_MEMORY_FILES_H
#define FFD_BASE_FILE_MEMORY_FILES_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct memory_files memory_files;

/* Finds the file of a name, which is relative to the file that refers to it. *bytes are borrowed; NULL: no
   such file. */
typedef ffd_status memory_resolve(void *user, const char *name, const void **bytes, size_t *size);
/* Receives a file that was written; bytes are valid during the call. */
typedef ffd_status memory_sink(void *user, const char *name, const void *bytes, size_t size);

/* Creates an empty object. Errors: FFD_E_MEMORY. */
ffd_status ffd_memory_create(memory_files **files, ffd_error *error);
/* Destroys the object and its paths. files and *files may be NULL. */
void ffd_memory_destroy(memory_files **files);

/* Refuses a name whose last component is not that of a file (FFD_E_ARGUMENT). */
ffd_status ffd_memory_check_name(const char *name, ffd_error *error);
/* Adds a file; name is for messages. resolve (may be NULL) finds further files of its folder. *path belongs
   to files. Errors: FFD_E_ARGUMENT (the last component of name is not that of a file), FFD_E_MEMORY. */
ffd_status ffd_memory_lend(memory_files *files, const char *name, const void *bytes, size_t size,
                           memory_resolve *resolve, void *user, const char **path, ffd_error *error);
/* Adds a folder for an output of this name and further files next to it. *path belongs to files. Errors: as
   above. */
ffd_status ffd_memory_take(memory_files *files, const char *name, memory_sink *sink, void *user,
                           const char **path, ffd_error *error);

/* Replaces paths in a text by the names that the caller knows. capacity: of the text's buffer. */
void ffd_memory_show(const memory_files *files, char *text, size_t capacity);
/* Returns status; but if a resolve function has failed, or memory for its result ran out, that failure. */
ffd_status ffd_memory_judge(const memory_files *files, ffd_status status, ffd_error *error);
/* The same for the object that a path belongs to, if any. */
ffd_status ffd_memory_judge_path(const char *path, ffd_status status, ffd_error *error);

/* Returns whether a path is a path in memory. */
bool ffd_memory_has(const char *path);
/* Returns the name under which a file or output was added; NULL for another path. It belongs to the
   object. */
const char *ffd_memory_name(const char *path);
/* Finds a file; *bytes is NULL if there is none. Errors: those of the resolve function, FFD_E_MEMORY. */
ffd_status ffd_memory_find(const char *path, const void **bytes, size_t *size, ffd_error *error);
/* Begins an output. *name is the name for the sink (free with ffd_free). Errors: FFD_E_IO (path is in a
   folder of inputs), FFD_E_MEMORY. */
ffd_status ffd_memory_begin(const char *path, char **name, ffd_error *error);
/* Passes a complete output to its sink. Does not allocate. Errors: those of the sink. */
ffd_status ffd_memory_give(const char *path, const char *name, const void *bytes, size_t size,
                           ffd_error *error);

#endif
