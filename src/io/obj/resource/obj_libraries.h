/* obj_libraries.h - the material libraries that an OBJ file names (mtllib). */
#ifndef FFD_IO_OBJ_RESOURCE_OBJ_LIBRARIES_H
#define FFD_IO_OBJ_RESOURCE_OBJ_LIBRARIES_H

#include "base/fail.h"
#include "base/file/file_folder.h"
#include "base/memory/intern.h"
#include <stdbool.h>

/* Lists the names of all mtllib statements of a mesh, as they are written. A statement names
   several files; a name may have blanks, and reaches to the ending of a library then. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_obj_list_libraries(const file_input *input, const file_folder *mesh, intern_table *names,
                                  ffd_error *error);
/* Whether a file has a mtllib statement: what is found first answers it. */
bool ffd_obj_names_libraries(const file_input *input);

#endif
