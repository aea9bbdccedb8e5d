/* obj_paths.h - the names that OBJ files and material libraries give to files: lists of them, and where they
   lead. */
#ifndef FFD_IO_OBJ_RESOURCE_OBJ_PATHS_H
#define FFD_IO_OBJ_RESOURCE_OBJ_PATHS_H

#include "base/file/file_folder.h"
#include "base/memory/intern.h"

/* Finds the path, relative to the mesh's folder and normalized, of a name in the file `base`, which is
   relative to that folder too. NULL with FFD_OK: the name is absolute, or that of a folder. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_obj_find_path(const file_folder *folder, const char *base, const char *name, char **path,
                             ffd_error *error);
/* The same of a map in a library: names count from the library's folder; some programs write them from that
   of the mesh, where they lead if only there is such a file. */
ffd_status ffd_obj_find_map(const file_folder *folder, const char *library, const char *name, char **path,
                            ffd_error *error);

/* Names of one file, and their bytes: a file must not be able to ask for any number, and any memory. */
#define OBJ_RESOURCES_MAX 65536
#define OBJ_RESOURCE_BYTES ((size_t)1 << 24)

/* Adds a name. file is for messages. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_obj_add_name(intern_table *names, const char *name, size_t size, const char *file,
                            ffd_error *error);

#endif
