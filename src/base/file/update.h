/* update.h - files that are changed where they stand, as a journal is, and not written anew as a whole. */
#ifndef FFD_BASE_FILE_UPDATE_H
#define FFD_BASE_FILE_UPDATE_H

#include "base/fail.h"
#include "base/file/cleanup.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* An open file. Nothing is buffered: what was written is in the file. */
typedef struct update_file update_file;

/* Opens a file for reading and writing, and makes it where there is none. Links to a file are followed.
   Errors: FFD_E_IO, also for what is no file (a pipe is not waited for) and for a link that leads to none. */
ffd_status ffd_update_open(const char *path, update_file **file, ffd_error *error);
/* The same for a file that has to be there. */
ffd_status ffd_update_open_there(const char *path, update_file **file, ffd_error *error);
/* Reads bytes from an offset on. Returns false, also where the file ends before. */
bool ffd_update_read(const update_file *file, uint64_t at, void *bytes, size_t size);
/* Writes bytes from an offset on, also beyond the end. Returns false if that fails; errno says why. */
bool ffd_update_write(update_file *file, uint64_t at, const void *bytes, size_t size);
/* Gets the size of the file in bytes. */
bool ffd_update_size(const update_file *file, uint64_t *size);
/* Empties the file. */
bool ffd_update_clear(update_file *file);
/* Closes the file. A pointer to NULL is allowed. */
void ffd_update_close(update_file **file);

/* A new file that is to take the place of an old one, under a temporary name until then. */
typedef struct file_successor {
    char *target, *temporary;
    cleanup_entry *noted;
    update_file *file;
} file_successor;

/* Makes it, with the permission bits of the file at path. Returns false if that is not possible, or another
   run is doing the same. */
bool ffd_successor_begin(file_successor *successor, const char *path);
/* Gives the file its name, and hands it over, open as it is. Returns false if that is not possible. */
bool ffd_successor_commit(file_successor *successor, update_file **file);
/* Removes it, unless it was handed over. */
void ffd_successor_end(file_successor *successor);

#endif
