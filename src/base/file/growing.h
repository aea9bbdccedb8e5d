/* growing.h - a file that has its own name while it is being written: others can read what is written so far,
   and that remains if the program is killed. All paths are UTF-8. */
#ifndef FFD_BASE_FILE_GROWING_H
#define FFD_BASE_FILE_GROWING_H

#include "base/fail.h"
#include "base/file/written_files.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct growing_file growing_file;

/* Returns whether path can be such a file: a regular file or a new name, not a stream, pipe or device. */
bool ffd_growing_can(const char *path);
/* Creates the file with its first bytes, or replaces an existing one by it, atomically. It is locked against
   other runs. written: the files of this run (output.h), or NULL. Errors: FFD_E_IO, FFD_E_EXISTS (the file is
   among written), FFD_E_MEMORY. */
ffd_status ffd_growing_create(const char *path, const void *bytes, size_t size, written_files *written,
                              growing_file **file, ffd_error *error);
/* Writes bytes at an offset that is not beyond the end of the file; the file may grow. After a failure
   (FFD_E_IO) the file ends at that offset. */
ffd_status ffd_growing_write(growing_file *file, uint64_t at, const void *bytes, size_t size,
                             ffd_error *error);
/* Reads bytes of the file. Errors: FFD_E_IO. */
ffd_status ffd_growing_read(const growing_file *file, uint64_t at, void *bytes, size_t size,
                            ffd_error *error);
/* Closes the file and keeps it. file and *file may be NULL. */
void ffd_growing_close(growing_file **file);

#endif
