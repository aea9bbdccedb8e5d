/* format_names.h - the names of mesh formats, for messages. */
#ifndef FFD_IO_FORMAT_NAMES_H
#define FFD_IO_FORMAT_NAMES_H

#include "base/fail.h"
#include <ffd/job.h>

/* Fails with FFD_E_ARGUMENT because the ending of a path is not that of a mesh format, or because standard
   input is of an unknown one. */
ffd_status ffd_format_refuse_name(const char *path, ffd_error *error);

#endif
