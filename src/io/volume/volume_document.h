/* volume_document.h - what the documents of all volume formats share: one part in the lattice's space, whose
   points and normals stand in the file as runs of numbers, with cells, groups and further values. The struct
   of each format begins with it, or is it.

   Declares volume_document.c, volume_results.c, volume_faces.c, volume_describe.c, volume_compare.c,
   volume_lend.c, volume_select.c, volume_weights.c. */
#ifndef FFD_IO_VOLUME_VOLUME_DOCUMENT_H
#define FFD_IO_VOLUME_VOLUME_DOCUMENT_H

#include "base/memory/intern.h"
#include "io/text/file_document.h"
#include "io/volume/number_run.h"
#include "io/volume/volume_cells.h"
#include "mesh/selector.h"
#include "mesh/weights.h"
#include <float.h>
#include <stdatomic.h>

/* The most vertices: corners are 32-bit numbers. */
#define VOLUME_VERTICES_MAX (UINT32_MAX - 1)

/* A piece of the points or of the normals, in the order of the file. */
typedef struct volume_piece {
    number_run run;
    mesh_stream stream;
    size_t vertex; /* the first one */
} volume_piece;

/* Bytes of the file that may change: of points, normals, and what depends on them. */
typedef struct volume_span {
    const char *first, *last;
} volume_span;

/* An array of values of all vertices, or of the cells. */
typedef struct volume_array {
    text_word name;
    number_run run; /* count: 0 if it is not read */
    bool of_cells;
} volume_array;

/* Vertices with a name, which is that of its number in group_names. */
typedef struct volume_group {
    uint32_t *vertices; /* count, owned; some may be named several times */
    size_t count, capacity;
} volume_group;

/* The outer faces of the cells, where the file lists them. All zeros: none. */
typedef struct volume_outer {
    size_t *ends; /* count, owned: where the corners of each face end */
    uint32_t *corners;
    size_t count;
} volume_outer;

typedef struct volume_document {
    file_document file;
    const char *encoding; /* "ascii", "binary", .. */
    const char *content;  /* the kind of mesh, as the file names it; NULL: the format has one */
    char content_text[32];
    volume_piece *pieces;
    size_t piece_count, piece_capacity;
    volume_span *spans; /* in the order of the file, once it is open */
    size_t span_count, span_capacity;
    volume_cells cells;
    bool has_outer; /* the outer faces are these; false: those of the cells that no two of them share */
    volume_outer outer;
    size_t listed_faces; /* that the file lists and that are no cells */
    bool lacks_cells;    /* cells are in further files, which are not there */
    volume_array *arrays;
    size_t array_count, array_capacity;
    volume_group *groups;
    intern_table group_names;
    size_t group_count, group_capacity;
    uint64_t grouped;         /* vertices of all groups */
    const char *lacks_groups; /* why some are not known, for the message that refuses a name; NULL */
    number_type point_type, normal_type;
    size_t dimensions; /* numbers of a point: 2 or 3 */
    /* In two dimensions: displacements out of the plane that are left out. */
    atomic_size_t flattened;
    double flat_limit; /* up to this they are rounding */
    bool turns;        /* normals are written */
    uint8_t *selected; /* lent to part.selected; or NULL */
    const char *kept,
        *kept_as; /* what of the file stays and no longer fits, for a warning: "FFD box"; NULL */
} volume_document;

static inline const volume_document *ffd_volume_of(const mesh_document *document)
{
    return (const volume_document *)document;
}

/* Allocates a document of size bytes, as ffd_file_document_make. */
volume_document *ffd_volume_make(size_t size, const file_input *input, const ffd_source *source,
                                 ffd_error *error);
/* Frees a document that could not be opened, but not its input. */
void ffd_volume_free(volume_document *document);
/* Ends opening: the positions are read, and the cells, groups and arrays are there. */
mesh_document *ffd_volume_ready(volume_document *document, bool text, const ffd_source *source);

/* Sets the number of vertices, and allocates their positions. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_volume_make_points(volume_document *document, uint64_t count, size_t line, ffd_error *error);
/* Adds a piece of the points or the normals, and reads its numbers. Sets *last to where it ends and *line to
   the line there. Errors: FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_volume_add_piece(volume_document *document, mesh_stream stream, size_t vertex,
                                const number_run *run, const char **last, size_t *line, ffd_error *error);
/* Notes bytes that may change; those of pieces are noted. Errors: FFD_E_MEMORY. */
ffd_status ffd_volume_add_span(volume_document *document, const char *first, const char *last,
                               ffd_error *error);
/* Adds an array. Errors: FFD_E_MEMORY. */
ffd_status ffd_volume_add_array(volume_document *document, text_word name, const number_run *run,
                                bool of_cells, ffd_error *error);
/* Finds the group of a name, or adds it. Errors: FFD_E_MEMORY. */
ffd_status ffd_volume_group(volume_document *document, const char *name, size_t size, size_t *group,
                            ffd_error *error);
/* Adds a vertex to a group. Errors: FFD_E_LIMIT for more than the budget has, FFD_E_MEMORY. */
ffd_status ffd_volume_group_add(volume_document *document, size_t group, uint32_t vertex, ffd_error *error);
/* Names the file and a line in an error of volume_cells.h. Returns the status. */
ffd_status ffd_volume_at_line(const volume_document *document, size_t line, ffd_status status,
                              ffd_error *error);

/* The entries of the tables of all volume formats. */
mesh_close_function ffd_volume_close;
mesh_begin_results_function ffd_volume_begin_results;
mesh_write_function ffd_volume_write;
mesh_save_function ffd_volume_save;
mesh_faces_function ffd_volume_faces, ffd_volume_sides;
mesh_mixed_faces_function ffd_volume_mixed_faces;
mesh_mark_used_function ffd_volume_mark_used;
mesh_model_function ffd_volume_model;
mesh_describe_function ffd_volume_describe;
mesh_compare_function ffd_volume_compare;
extern const mesh_selector_calls ffd_volume_selectors;
extern const mesh_weight_calls ffd_volume_weights;
extern const mesh_cell_calls ffd_volume_cell_calls;

/* What the tables of all volume formats have alike. */
#define VOLUME_CALLS                                                                                         \
    .largest_coordinate = DBL_MAX, .keeps_format = true, .describe = ffd_volume_describe,                    \
    .compare = ffd_volume_compare, .read = ffd_file_document_read, .faces = ffd_volume_faces,                \
    .mixed_faces = ffd_volume_mixed_faces, .model = ffd_volume_model,                                        \
    .begin_results = ffd_volume_begin_results, .write = ffd_volume_write, .mark_used = ffd_volume_mark_used, \
    .cells = &ffd_volume_cell_calls

/* Warns of what stays as it is although points have moved: arrays of vectors, and what `kept` names. */
void ffd_volume_warn_kept(const volume_document *document, const mesh_log *log);

#endif
