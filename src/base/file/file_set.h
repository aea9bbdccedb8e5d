/* file_set.h - several files that come to stand under their names together: all of them or none, whatever
   fails and whenever the program is killed.

   What stands there is set aside first (renamed to ".NAME.ffd-old" beside it), the head before all others.
   Then the new files are renamed, the head after all others; then what was set aside goes. The head is the
   last file of the set, which refers to the others (a .gltf). So at each moment the old files or the new ones
   are whole, under their own names or beside them. A record (file_set_record.h) stands beside the head as
   long as this takes: by it the next run that writes the head finishes, or undoes, what a killed one had
   begun. */
#ifndef FFD_BASE_FILE_FILE_SET_H
#define FFD_BASE_FILE_FILE_SET_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct set_file {
    const char *target;    /* links resolved */
    const char *temporary; /* the new file, complete and locked */
    bool replace;          /* what stands under the target's name */
    bool is_gone;          /* out: the temporary file has another name by now, or none */
} set_file;

/* Places the files; one alone is just renamed. A failure leaves all as it was, but for one in the removal of
   what was set aside, which leaves the new files. Errors: FFD_E_EXISTS (a target that must not be replaced is
   there, even since a moment ago), FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_set_place(set_file *files, size_t count, ffd_error *error);

#endif
