/* obj_vectors.h - reads the coordinates of an OBJ file. */
#ifndef FFD_IO_OBJ_OBJ_VECTORS_H
#define FFD_IO_OBJ_OBJ_VECTORS_H

#include "io/obj/obj_users.h"

/* Cuts the file into blocks, and fills in the blocks, the numbers of elements, their
   coordinates, and addition as if no index counted back. *users (obj_users.h) is to be freed in any case. */
ffd_status ffd_obj_read_vectors(obj_document *document, obj_users *users, ffd_error *error);

/* Reads positions from the file again, 3 numbers each: results may have replaced them. Those of the wanted
   vertices, count ascending numbers; of all where wanted is NULL. */
void ffd_obj_read_again(const obj_document *document, const uint32_t *wanted, size_t count, double *xyz);

#endif
