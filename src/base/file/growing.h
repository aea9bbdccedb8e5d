/* growing.h - a file that stands under its own name while it is still being written: what is there already
   can be read, and stays when the program is killed. All paths are UTF-8. */
#ifndef FFD_BASE_FILE_GROWING_H
#define FFD_BASE_FILE_GROWING_H

#include "base/fail.h"
#include "base/file/written_files.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct growing_file growing_file;

/* Whether path can be one: a file, or nothing yet; no stream, pipe or device. */
bool ffd_growing_can(const char *path);
/* Makes the file with its first bytes, in the place of an old one, all at once; it is locked against other
   runs. written: the record of the run (output.h), or NULL. Errors: FFD_E_IO, FFD_E_EXISTS (of the record),
   FFD_E_MEMORY. */
ffd_status ffd_growing_create(const char *path, const void *bytes, size_t size, written_files *written,
                              growing_file **file, ffd_error *error);
/* Writes bytes from an offset on, to which the file reaches, and beyond its end. After a failure (FFD_E_IO)
   the file ends at that offset. */
ffd_status ffd_growing_write(growing_file *file, uint64_t at, const void *bytes, size_t size,
                             ffd_error *error);
/* Reads bytes of the file. Errors: FFD_E_IO. */
ffd_status ffd_growing_read(const growing_file *file, uint64_t at, void *bytes, size_t size,
                            ffd_error *error);
/* Closes the file, which stays. NULL and pointers to NULL are allowed. */
void ffd_growing_close(growing_file **file);

#endif
