/* users.h - the models of a folder that name other files as parts of themselves. */
#ifndef FFD_IO_USERS_H
#define FFD_IO_USERS_H

#include "base/fail.h"
#include "base/file/path_list.h"

/* Adds the path of each such model and that of each file which it names, in pairs, by scanning the models.
   Those that cannot be read have none. Errors: FFD_E_MEMORY. */
ffd_status ffd_users_list(const char *folder, path_list *pairs, ffd_error *error);

#endif
