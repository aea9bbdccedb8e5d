/* update.h - files that are changed where they stand, as a journal is, and not written anew as a whole. */
#ifndef FFD_BASE_FILE_UPDATE_H
#define FFD_BASE_FILE_UPDATE_H

#include "base/fail.h"
#include "base/file/cleanup.h"
#include <stdbool.h>
#include <stdio.h>

/* Opens a file for reading and writing, and makes it where there is none. Links to a file are followed.
   Errors: FFD_E_IO, also for what is no file (a pipe is not waited for) and for a link that leads to none. */
ffd_status ffd_update_open(const char *path, FILE **file, ffd_error *error);
/* Empties the file. */
bool ffd_update_clear(FILE *file);

/* A new file that is to take the place of an old one, under a temporary name until then. */
typedef struct file_successor {
    char *target, *temporary;
    cleanup_entry *noted;
    FILE *file; /* for reading and writing */
} file_successor;

/* Makes it, with the permission bits of the file at path. Returns false if that is not possible, or another
   run is doing the same. */
bool ffd_successor_begin(file_successor *successor, const char *path);
/* Gives the file its name, and hands it over, open as it is. Returns false if that is not possible. */
bool ffd_successor_commit(file_successor *successor, FILE **file);
/* Removes it, unless it was handed over. */
void ffd_successor_end(file_successor *successor);

#endif
