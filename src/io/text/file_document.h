/* file_document.h - the common part of OBJ, OFF, PLY and STL documents: one file, and one part in the
   lattice's space. The struct of each format begins with it. */
#ifndef FFD_IO_TEXT_FILE_DOCUMENT_H
#define FFD_IO_TEXT_FILE_DOCUMENT_H

#include "mesh/mesh.h"

typedef struct file_document {
    mesh_document base;
    mesh_part part;
    file_input input;
    char *name; /* for messages */
    char *path; /* names in the file are relative to it; NULL: a stream, which has no folder */
    /* 3 numbers per vector, contiguous. */
    double *positions;
    double *directions;     /* normals; NULL: none, or not held */
    double *new_positions;  /* results; NULL before begin_results */
    double *new_directions; /* NULL: normals stay */
    uint8_t *used;          /* lent to part.used; or NULL */
} file_document;

/* Allocates a document of size bytes, zeroed except for its input and its name. The caller owns the input
   until opening has succeeded. Returns NULL after a failure. Errors: FFD_E_MEMORY. */
void *ffd_file_document_make(size_t size, const file_input *input, const ffd_source *source,
                             ffd_error *error);
/* Notes a Ctrl-Z that ends a text of text_size bytes (ffd_text_size), or refuses it, as the flaws say. */
ffd_status ffd_file_document_note_mark(file_document *document, size_t text_size, ffd_error *error);
/* Ends opening: sets the document's part, whose counts must be set, and its memory budget. Returns the
   document for mesh_open_function. */
mesh_document *ffd_file_document_ready(file_document *document, bool text, const ffd_source *source);
/* Frees a document that could not be opened, with its vectors but not its input. */
void ffd_file_document_free(file_document *document);

/* Makes the values of an empty model: the part's vertices and normals, with their results if any, and this
   many texture coordinates, all 0. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_file_document_model(const file_document *document, size_t texcoords, mesh_model *model,
                                   ffd_error *error);

/* Fails with FFD_E_IO: a second reading has found something else than the first. The file is mapped (mmap),
   and another program has written to it. */
ffd_status ffd_file_document_changed(const file_document *document, ffd_error *error);

/* Fills in the positions of vertices in faces; others stay unset. */
void ffd_file_document_fill_positions(const file_document *document, mesh_faces *faces);

/* Functions of the mesh_format, for formats whose vectors are in these four arrays. */
mesh_close_function ffd_file_document_close;
mesh_read_function ffd_file_document_read;
mesh_begin_results_function ffd_file_document_begin_results;
mesh_write_function ffd_file_document_write;

#endif
