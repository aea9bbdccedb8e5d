/* update.h - files that are modified in place, such as a journal, instead of being rewritten. */
#ifndef FFD_BASE_FILE_UPDATE_H
#define FFD_BASE_FILE_UPDATE_H

#include "base/fail.h"
#include "base/file/cleanup.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* An open file. Writes are not buffered. */
typedef struct update_file update_file;

/* Opens a file for reading and writing, and creates it if it does not exist. Follows symbolic links. Errors:
   FFD_E_IO, also for other than regular files (a pipe does not block the call) and for dangling links. */
ffd_status ffd_update_open(const char *path, update_file **file, ffd_error *error);
/* The same for a file that must exist. */
ffd_status ffd_update_open_there(const char *path, update_file **file, ffd_error *error);
/* Reads bytes at an offset. Returns false on failure, and if the file is too short. */
bool ffd_update_read(const update_file *file, uint64_t at, void *bytes, size_t size);
/* Writes bytes at an offset, which may be beyond the end. Returns false with errno on failure. */
bool ffd_update_write(update_file *file, uint64_t at, const void *bytes, size_t size);
/* Gets the size of the file in bytes. */
bool ffd_update_size(const update_file *file, uint64_t *size);
/* Empties the file. */
bool ffd_update_clear(update_file *file);
/* Closes the file and sets *file to NULL. *file may be NULL. */
void ffd_update_close(update_file **file);

/* A new file with a temporary name that will replace an old file. */
typedef struct file_successor {
    char *target, *temporary;
    cleanup_entry *noted;
    update_file *file;
} file_successor;

/* Creates it, with the permission bits of the file at path. Returns false if that fails or another run is
   doing the same. */
bool ffd_successor_begin(file_successor *successor, const char *path);
/* Renames the file to its final name, and hands it over as an open file. Returns false on failure. */
bool ffd_successor_commit(file_successor *successor, update_file **file);
/* Removes the file unless it was handed over. */
void ffd_successor_end(file_successor *successor);

#endif
