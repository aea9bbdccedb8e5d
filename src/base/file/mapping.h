/* mapping.h - the mapped input files, and what happens if one of them is truncated while it is read.

   Reading a mapped page that the file no longer has raises SIGBUS, in any thread and in any library. If the
   program has called ffd_guard_inputs, a handler maps pages of zeros there, so that the read continues, and
   records the loss. A job checks for losses before it writes and at its end, and fails. There is no longjmp,
   and no thread is ended. Without the handler, and if a file is truncated within its last page, a comparison
   of sizes finds the loss. */
#ifndef FFD_BASE_FILE_MAPPING_H
#define FFD_BASE_FILE_MAPPING_H

#include "base/fail.h"
#include <stddef.h>
#include <stdint.h>

typedef struct file_mapping file_mapping;

/* Records a mapped file; path is for messages. identity: device and inode; NULL if the path does not lead to
   the file again (standard input). Returns NULL if memory runs out. Thread-safe, as all functions here. */
file_mapping *ffd_mapping_note(const void *begin, size_t size, const char *path, const uint64_t identity[2]);
/* Removes the record. To be called before unmapping. */
void ffd_mapping_forget(file_mapping *mapping);
/* Notes that the page of an address can no longer be read. Returns how many bytes of its input there are from
   that address on; 0: the address is not in a mapped input. For a signal handler. */
size_t ffd_mapping_cut(uintptr_t address);
/* Returns how many mapped inputs of this process were truncated so far. */
unsigned ffd_mapping_losses(void);
/* Returns status; but FFD_E_IO with the name of the input if there are more losses than `before`, because
   what was read since then was not the content of the file. */
ffd_status ffd_mapping_judge(unsigned before, ffd_status status, ffd_error *error);

#endif
