/* format_names.h - the names of mesh formats and of their files. */
#ifndef FFD_IO_FORMAT_NAMES_H
#define FFD_IO_FORMAT_NAMES_H

#include "base/fail.h"
#include <ffd/job.h>

/* Fails with FFD_E_ARGUMENT because the ending of a path is not that of a mesh format, or because standard
   input is of an unknown one. */
ffd_status ffd_format_refuse_name(const char *path, ffd_error *error);

/* A mesh of OpenFOAM has no ending: its file has this name, or that of its compressed form. */
#define FOAM_NAME "points"
#define FOAM_PACKED FOAM_NAME ".gz"

/* Checks that an output of this format may have this name: "points" where it is one of OpenFOAM. Errors:
   FFD_E_ARGUMENT, FFD_E_UNSUPPORTED. */
ffd_status ffd_format_check_output(ffd_format format, const char *path, ffd_error *error);
/* Returns a path with the ending of another format, or with the name that its files have; freed with
   ffd_free. ending: "glb", ".glb" or "foam". NULL if memory runs out. */
char *ffd_format_rename(const char *path, const char *ending);

#endif
