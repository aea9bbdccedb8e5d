/* obj_linked.h - the files that statements other than mtllib name: call, maplib, shadow_obj, trace_obj. No
   job reads or copies them. */
#ifndef FFD_IO_OBJ_RESOURCE_OBJ_LINKED_H
#define FFD_IO_OBJ_RESOURCE_OBJ_LINKED_H

#include "base/file/file_folder.h"
#include "base/file/path_list.h"
#include "base/text/text_scan.h"
#include "mesh/resource/left_out.h"

/* Whether a keyword is one of these. The functions below read the file once for each: call them if it has
   one. */
bool ffd_obj_names_file(text_word keyword);
/* Adds the file that a name in the mesh leads to, unless an output in folder `to` reaches it. why: of
   left_out. Errors: FFD_E_MEMORY. */
ffd_status ffd_obj_leave_name(const file_folder *from, const char *name, const char *to, left_out *left,
                              const char *why, ffd_error *error);
/* Adds the files that an output in folder `to` (NULL: it is not a file) does not reach. name: of the mesh,
   for messages; from: its folder. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_obj_leave_linked(const file_input *input, const char *name, const file_folder *from,
                                const char *to, left_out *left, ffd_error *error);
/* Adds the paths of the files that the mesh at a path names. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_obj_find_linked(const file_input *input, const char *path, path_list *files, ffd_error *error);

#endif
