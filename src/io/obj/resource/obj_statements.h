/* obj_statements.h - the statements of one keyword in an OBJ file, which are few in a large file. */
#ifndef FFD_IO_OBJ_RESOURCE_OBJ_STATEMENTS_H
#define FFD_IO_OBJ_RESOURCE_OBJ_STATEMENTS_H

#include "base/fail.h"
#include "base/file/input.h"
#include "base/memory/intern.h"
#include <stdbool.h>

/* Lists the arguments of all statements of a keyword, each text once, continued lines joined: some programs
   repeat a statement for every object. Those with a NUL character are left out. path is for messages. Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_obj_list_statements(const file_input *input, const char *path, const char *keyword,
                                   intern_table *statements, ffd_error *error);
/* Whether there is one: what is found first answers it. */
bool ffd_obj_has_statement(const file_input *input, const char *keyword);

#endif
