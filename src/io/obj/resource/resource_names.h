/* resource_names.h - the names that a file gives to material libraries and maps. */
#ifndef FFD_IO_OBJ_RESOURCE_RESOURCE_NAMES_H
#define FFD_IO_OBJ_RESOURCE_RESOURCE_NAMES_H

#include "base/fail.h"
#include "base/memory/intern.h"

/* Names of one file, and their bytes: a file must not be able to ask for any number, and any memory. */
#define OBJ_RESOURCES_MAX 65536
#define OBJ_RESOURCE_BYTES ((size_t)1 << 24)

/* Adds a name. file is for messages. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_obj_add_name(intern_table *names, const char *name, size_t size, const char *file,
                            ffd_error *error);

#endif
