/* obj_results.h - what a deformation changes in an OBJ file. */
#ifndef FFD_IO_OBJ_OBJ_RESULTS_H
#define FFD_IO_OBJ_OBJ_RESULTS_H

#include "io/obj/obj_document.h"

/* Frees the results of normals, if there are any: normals are kept. */
void ffd_obj_free_normals(obj_document *document);
/* Releases the pages of the positions and results of count vertices if they are in a memory-mapped file. */
void ffd_obj_forget_vectors(const obj_document *document, size_t first, size_t count);

#endif
