/* worker_program.h - the program whose processes are workers, for a library: the program `ffd`. */
#ifndef FFD_BASE_SYSTEM_WORKER_PROGRAM_H
#define FFD_BASE_SYSTEM_WORKER_PROGRAM_H

#include "base/fail.h"
#include "base/system/own_file.h"

/* Finds it near the library, as modules are found (module.h), else by PATH. Errors: FFD_E_UNSUPPORTED. */
ffd_status ffd_worker_program_find(char path[LONGEST_PATH], ffd_error *error);

#endif
