/* obj_linked.h - the files that statements other than mtllib name: call, maplib, shadow_obj, trace_obj. No
   job reads or copies them. */
#ifndef FFD_IO_OBJ_OBJ_LINKED_H
#define FFD_IO_OBJ_OBJ_LINKED_H

#include "io/obj/obj_document.h"
#include "mesh/resource/left_out.h"

/* Whether a keyword is one of these. */
bool ffd_obj_names_file(text_word keyword);
/* Adds the files that an output in folder `to` does not reach. from: the mesh's folder. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_obj_leave_linked(const obj_document *document, const char *from, const char *to,
                                left_out *left, ffd_error *error);
/* mesh_format's list_linked. */
mesh_list_files_function ffd_obj_list_linked;

#endif
