/* off_document.h - an OFF file as a mesh document: one part that stands in the lattice's space.

   Every vertex of the file is one, in its order; that of NOFF has its normal. Coordinates are held as
   numbers; all else stays in the file's bytes, which are walked through again where it is needed. */
#ifndef FFD_IO_OFF_OFF_DOCUMENT_H
#define FFD_IO_OFF_OFF_DOCUMENT_H

#include "io/off/off_walk.h"
#include "mesh/mesh.h"

typedef struct off_document {
    mesh_document base;
    mesh_part part;
    file_input input;
    char *name; /* for messages */
    off_header header;
    size_t lines, points;   /* faces of two corners, and of one */
    size_t corners;         /* of the other faces */
    const char *behind;     /* what follows the last face's line, or the last vertex' */
    double *positions;      /* 3 a vertex */
    double *directions;     /* 3 a vertex; NULL without normals */
    double *new_positions;  /* NULL before ffd_off_begin_results */
    double *new_directions; /* NULL: normals are kept */
} off_document;

static inline const off_document *ffd_off_of(const mesh_document *document)
{
    return (const off_document *)document;
}

/* Reads vertices and faces behind the header, or refuses them. */
ffd_status ffd_off_read_vertices(off_document *document, off_walk *walk, ffd_error *error);
ffd_status ffd_off_read_faces(off_document *document, off_walk *walk, ffd_error *error);

/* The entries of the format's table. */
ffd_status ffd_off_open(file_input *input, const ffd_source *source, mesh_document **document,
                        ffd_error *error);
void ffd_off_close(mesh_document *document);
void ffd_off_read_positions(const mesh_document *document, size_t part, size_t first, size_t count,
                            double *xyz);
void ffd_off_read_normals(const mesh_document *document, size_t part, size_t first, size_t count,
                          double *xyz);
ffd_status ffd_off_begin_results(mesh_document *document, bool normals, bool tangents, ffd_error *error);
void ffd_off_write_positions(mesh_document *document, size_t part, size_t first, size_t count,
                             const double *xyz, const uint8_t *changed);
void ffd_off_write_normals(mesh_document *document, size_t part, size_t first, size_t count,
                           const double *xyz, const uint8_t *changed);
ffd_status ffd_off_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error);
ffd_status ffd_off_faces(const mesh_document *document, mesh_faces *faces, ffd_error *error);
ffd_status ffd_off_model(const mesh_document *document, mesh_model *model, ffd_error *error);
ffd_status ffd_off_describe(const mesh_document *document, json_text *json, ffd_error *error);
ffd_status ffd_off_compare(const mesh_document *a, const mesh_document *b, double tolerance,
                           ffd_comparison *comparison, ffd_error *error);

#endif
