/* own_files.h - the files that a run writes beside those of its jobs: no two of them are one file, and none
   is a file that the run reads. */
#ifndef FFD_BATCH_OWN_FILES_H
#define FFD_BATCH_OWN_FILES_H

#include "batch/batch_desc.h"

/* Checks that, before any file is made. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY. */
ffd_status ffd_batch_check_own_files(const batch_desc *desc, ffd_error *error);

#endif
