/* mapping.h - the inputs that are mapped, and what happens when one becomes shorter while it is read.

   A read of a mapped page that the file no longer has raises SIGBUS, in whatever thread and library reads.
   Where the program has asked for it (ffd_guard_inputs), a handler puts pages of zeros there, so that the
   read goes on, and notes it; a job asks at its end, and before it writes, and fails. Nothing is jumped out
   of, and no thread is ended. Without the handler, and where a file ends within its last page, the size
   tells. */
#ifndef FFD_BASE_FILE_MAPPING_H
#define FFD_BASE_FILE_MAPPING_H

#include "base/fail.h"
#include <stdint.h>

typedef struct file_mapping file_mapping;

/* Notes that a file is mapped, path as messages name it. identity: device and number; NULL if the path does
   not lead to it again (standard input). Returns NULL if memory runs out. Thread-safe, as all of these. */
file_mapping *ffd_mapping_note(const void *begin, size_t size, const char *path, const uint64_t identity[2]);
/* Strikes it off, before it is unmapped. */
void ffd_mapping_forget(file_mapping *mapping);
/* How many inputs have become shorter so far, of all that this process has mapped. */
unsigned ffd_mapping_losses(void);
/* The status; or FFD_E_IO with the input's name, whatever the status, if there were more losses than
   `before`: what was read since is not what the file held. */
ffd_status ffd_mapping_judge(unsigned before, ffd_status status, ffd_error *error);

#endif
