/* off_document.h - an OFF file as a mesh document: one part, in the lattice's space. Declares off_document.c
   and off_faces.c.

   The vertices are those of the file, in its order; with NOFF each has its normal. Coordinates are held as
   numbers. Everything else stays in the file's bytes and is read again when needed. */
#ifndef FFD_IO_OFF_OFF_DOCUMENT_H
#define FFD_IO_OFF_OFF_DOCUMENT_H

#include "io/off/off_walk.h"
#include "io/text/file_document.h"

typedef struct off_document {
    file_document file;
    off_header header;
    size_t lines, points; /* numbers of faces with two corners, and with one */
    size_t corners;       /* number of corners of the other faces */
    off_walk faces_begin; /* the state of a walk at the first face */
    const char *behind;   /* the text after the line of the last face, or of the last vertex */
} off_document;

static inline const off_document *ffd_off_of(const mesh_document *document)
{
    return (const off_document *)document;
}

/* Reads and checks the faces after the vertices. */
ffd_status ffd_off_read_faces(off_document *document, off_walk *walk, ffd_error *error);

/* The entries of the format's table. */
mesh_open_function ffd_off_open;
mesh_save_function ffd_off_save;
mesh_mark_used_function ffd_off_mark_used;
mesh_faces_function ffd_off_faces;
mesh_mixed_faces_function ffd_off_mixed_faces;
mesh_model_function ffd_off_model;
mesh_describe_function ffd_off_describe;
mesh_compare_function ffd_off_compare;

#endif
