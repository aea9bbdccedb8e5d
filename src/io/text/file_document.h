/* file_document.h - what the documents of OBJ, OFF, PLY and STL share: one file, and one part that is in the
   lattice's space. The struct of each format begins with it. */
#ifndef FFD_IO_TEXT_FILE_DOCUMENT_H
#define FFD_IO_TEXT_FILE_DOCUMENT_H

#include "mesh/mesh.h"

typedef struct file_document {
    mesh_document base;
    mesh_part part;
    file_input input;
    char *name; /* for messages */
    char *path; /* what the file names is beside it; NULL: it is a stream, which has no folder */
    /* 3 numbers a vector. */
    double *positions;
    double *directions;     /* normals; NULL: there are none, or they are not held */
    double *new_positions;  /* results; NULL before begin_results */
    double *new_directions; /* NULL: normals are kept */
    uint8_t *used;          /* what part.used lends; or NULL */
} file_document;

/* Makes a document of size bytes, zeroed apart from its input and its name. The input is the caller's until
   opening has succeeded. Returns NULL after a failure. Errors: FFD_E_MEMORY. */
void *ffd_file_document_make(size_t size, const file_input *input, const ffd_source *source,
                             ffd_error *error);
/* Notes a Ctrl-Z that ends a text of text_size bytes (ffd_text_size), or refuses it. */
ffd_status ffd_file_document_note_mark(file_document *document, size_t text_size, ffd_error *error);
/* Ends opening: the document shows its part, whose counts are set, and gets its memory budget. Returns what
   the caller of mesh_open_function gets. */
mesh_document *ffd_file_document_ready(file_document *document, bool text, const ffd_source *source);
/* Frees a document that could not be opened, with its vectors; its input is left alone. */
void ffd_file_document_free(file_document *document);

/* Makes the values of an empty model: the part's vertices and normals, with the results where there are some,
   and this many texture coordinates, all 0. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_file_document_model(const file_document *document, size_t texcoords, mesh_model *model,
                                   ffd_error *error);

/* Fills in the positions of the faces' vertices; of others there are none. */
void ffd_file_document_fill_positions(const file_document *document, mesh_faces *faces);

/* Entries of the formats' tables, for formats whose vectors are in the four arrays. */
mesh_close_function ffd_file_document_close;
mesh_read_function ffd_file_document_read_positions;
mesh_read_function ffd_file_document_read_normals;
mesh_begin_results_function ffd_file_document_begin_results;
mesh_write_function ffd_file_document_write_positions;
mesh_write_function ffd_file_document_write_normals;

#endif
