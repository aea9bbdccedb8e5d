/* vtkxml_document.h - a VTK file in XML as a mesh document: its pieces, one after the other. Declares
   vtkxml_tags.c, vtkxml_cells.c, vtkxml_save.c, vtkxml_weights.c. */
#ifndef FFD_IO_VTKXML_VTKXML_DOCUMENT_H
#define FFD_IO_VTKXML_VTKXML_DOCUMENT_H

#include "base/text/xml_scan.h"
#include "io/volume/volume_document.h"

typedef enum vtkxml_place { VTKXML_TEXT, VTKXML_BASE64, VTKXML_APPENDED } vtkxml_place;

/* A DataArray. */
typedef struct vtkxml_array {
    bool is_there;
    text_word name;
    bool is_number; /* else of texts or bits, which are not read */
    number_type type;
    size_t width; /* components */
    vtkxml_place place;
    uint64_t offset; /* in what is appended */
    text_word text;  /* between its tags */
    size_t line;
    /* Values of attributes; empty: there are none. */
    text_word offset_text, range_min, range_max;
} vtkxml_array;

/* The lists of cells of polygonal data, in VTK's order. Other grids have one list. */
typedef enum vtkxml_list {
    VTKXML_VERTS,
    VTKXML_LINES,
    VTKXML_POLYS,
    VTKXML_STRIPS,
    VTKXML_LISTS
} vtkxml_list;

/* The arrays of cells. Faces of polyhedra are in one of two forms: each with its points, cell by cell; or in
   a list, of which each cell names some (since VTK 9.4). "Ends" count from the first cell or face. */
typedef enum vtkxml_cell_array {
    VTKXML_CONNECTIVITY,
    VTKXML_ENDS,
    VTKXML_KINDS,
    VTKXML_FACES, /* of a polyhedron: how many; of each face how many points, and these */
    VTKXML_FACES_ENDS,
    VTKXML_LISTED_FACES, /* the points of all faces */
    VTKXML_LISTED_FACES_ENDS,
    VTKXML_CELL_FACES, /* the faces of all polyhedra */
    VTKXML_CELL_FACES_ENDS,
    VTKXML_CELL_ARRAYS
} vtkxml_cell_array;

typedef struct vtkxml_cells {
    uint64_t count;
    vtkxml_array arrays[VTKXML_CELL_ARRAYS];
} vtkxml_cells;

typedef struct vtkxml_piece {
    uint64_t points, size[3]; /* size: of a structured grid */
    size_t vertex;            /* the first one */
    size_t line;
    vtkxml_array points_array, normals;
    vtkxml_cells lists[VTKXML_LISTS];
    uint64_t cells;
} vtkxml_piece;

/* An array of the points of a piece. */
typedef struct vtkxml_values {
    size_t piece;
    vtkxml_array array;
} vtkxml_values;

typedef enum vtkxml_grid { VTKXML_UNSTRUCTURED, VTKXML_POLYDATA, VTKXML_STRUCTURED } vtkxml_grid;

typedef struct vtkxml_document {
    volume_document volume;
    vtkxml_grid grid;
    bool is_big, is_compressed, is_raw;
    size_t word; /* bytes of a number in a header */
    text_word appended;
    vtkxml_piece *pieces;
    size_t piece_count, piece_capacity;
    vtkxml_values *values;
    size_t value_count, value_capacity;
    vtkxml_array *placed; /* all arrays whose data are appended */
    size_t placed_count, placed_capacity;
    bool turns; /* whether all pieces have normals */
} vtkxml_document;

static inline const vtkxml_document *ffd_vtkxml_of(const mesh_document *document)
{
    return (const vtkxml_document *)document;
}

/* Reads the tags. Errors: FFD_E_INVALID, FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
ffd_status ffd_vtkxml_tags(vtkxml_document *document, ffd_error *error);
/* Reads the cells of all pieces. Errors: those of the tags, and FFD_E_LIMIT. */
ffd_status ffd_vtkxml_cells(vtkxml_document *document, ffd_error *error);
mesh_save_function ffd_vtkxml_save;
extern const mesh_weight_calls ffd_vtkxml_weights;

#endif
