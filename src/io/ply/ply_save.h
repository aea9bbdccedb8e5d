/* ply_save.h - what saving a PLY file writes. Declares ply_face_normals.c, ply_fixed_rows.c,
   ply_rows.c. */
#ifndef FFD_IO_PLY_PLY_SAVE_H
#define FFD_IO_PLY_PLY_SAVE_H

#include "io/ply/ply_document.h"
#include "io/text/splice.h"

/* Writes the rows of the faces, whose normals (face_normals) are renewed where a corner has moved. */
void ffd_ply_write_face_normals(const ply_document *document, file_splice *splice);

/* Writes the rows of the vertices, which are of one size (has_fixed_rows). Returns how many splats have
   harmonics that are not numbers, and are not turned. */
size_t ffd_ply_write_fixed(const ply_document *document, file_splice *splice);
/* The same where numbers must be looked for one after the other. */
size_t ffd_ply_write_walked(const ply_document *document, file_splice *splice);

#endif
