/* obj_faces.h - what the faces of an OBJ file name. */
#ifndef FFD_IO_OBJ_OBJ_FACES_H
#define FFD_IO_OBJ_OBJ_FACES_H

#include "io/obj/obj_users.h"

/* Fills in the counts, the pairs and addition from the faces. Refuses indices that are out of range. */
ffd_status ffd_obj_read_faces(obj_document *document, obj_users *users, ffd_error *error);

/* Finds the pair of a face's corner. Returns false where it has no normal, and where the file was changed
   after the pairs were listed. */
bool ffd_obj_find_pair(const obj_document *document, const obj_face_corner *corner, size_t *pair);

#endif
