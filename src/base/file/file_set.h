/* file_set.h - replaces several files as a unit: all of them or none, whatever fails and whenever the program
   is killed.

   The head is the last file of the set, which refers to the others (a .gltf). First the existing files are
   set aside, the head before all others: each is renamed to ".NAME.ffd-old" in its folder. Then the new files
   are renamed to their targets, the head after all others. At the end the old files are removed. So at any
   time either all old files or all new files are complete, under their own names or in the same folder. While
   this takes place, a record (file_set_record.h) is next to the head. With it, the next run that writes the
   head completes or undoes what a killed run had begun. */
#ifndef FFD_BASE_FILE_FILE_SET_H
#define FFD_BASE_FILE_FILE_SET_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct set_file {
    const char *target;    /* with symbolic links resolved */
    const char *temporary; /* path of the new file, complete and locked */
    bool replace;          /* replace an existing target */
    bool is_gone;          /* out: the temporary file was renamed or removed */
} set_file;

/* Places the files; a single file is only renamed. After a failure everything is as before, except if
   removing the old files fails: then the new files stay. Errors: FFD_E_EXISTS (a target exists that must not
   be replaced, also if it was created just now), FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_set_place(set_file *files, size_t count, ffd_error *error);

#endif
