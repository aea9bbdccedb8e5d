/* ply_save.h - the parts of saving a PLY file. Declares ply_face_normals.c, ply_fixed_rows.c, ply_rows.c,
   ply_stale.c. */
#ifndef FFD_IO_PLY_PLY_SAVE_H
#define FFD_IO_PLY_PLY_SAVE_H

#include "io/ply/ply_document.h"
#include "io/text/splice.h"

/* Writes the rows of the faces, with new normals (face_normals) where a corner has moved. */
void ffd_ply_write_face_normals(const ply_document *document, file_splice *splice);
/* Warns of normals and tangents that stay as they are, although the shape has changed. */
void ffd_ply_warn_stale(const ply_document *document, const mesh_log *log);

/* Writes the rows of the vertices, for rows of fixed size (has_fixed_rows). Returns the number of splats
   whose harmonics stay because their types cannot hold the results. */
size_t ffd_ply_write_fixed(const ply_document *document, file_splice *splice);
/* The same for other rows, walking from value to value. */
size_t ffd_ply_write_walked(const ply_document *document, file_splice *splice);

#endif
