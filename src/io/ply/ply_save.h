/* ply_save.h - the parts of saving a PLY file. Declares ply_face_normals.c and ply_rows.c. */
#ifndef FFD_IO_PLY_PLY_SAVE_H
#define FFD_IO_PLY_PLY_SAVE_H

#include "io/ply/ply_document.h"
#include "io/text/splice.h"

/* Writes the rows of the faces, with new normals (face_normals) where a corner has moved. */
void ffd_ply_write_face_normals(const ply_document *document, file_splice *splice);

/* Writes the rows of the vertices, for rows of fixed size (has_fixed_rows). Returns the number of splats
   whose harmonics stay because their types cannot hold the results. */
size_t ffd_ply_write_fixed(const ply_document *document, file_splice *splice);
/* The same for other rows, walking from value to value. */
size_t ffd_ply_write_walked(const ply_document *document, file_splice *splice);

#endif
