/* folder_entries.h - reads the entries of an open folder one by one, for folder.c and glob.c. */
#ifndef FFD_BASE_FILE_FOLDER_ENTRIES_H
#define FFD_BASE_FILE_FOLDER_ENTRIES_H

#include "base/fail.h"
#include "base/posix.h"

/* Sets *entry to the next entry of a folder, NULL at its end. path: for messages. Errors: FFD_E_IO (a disk or
   a network fails within the list, which must not pass for its end). */
ffd_status ffd_folder_next(DIR *folder, const char *path, const struct dirent **entry, ffd_error *error);

#endif
