/* vtk_reader.h - reads a VTK file of the legacy format, word by word and array by array. Declares
   vtk_reader.c, vtk_cells.c, vtk_arrays.c. */
#ifndef FFD_IO_VTK_VTK_READER_H
#define FFD_IO_VTK_VTK_READER_H

#include "io/volume/volume_document.h"

/* The type of an array. */
typedef enum vtk_special { VTK_NUMBERS, VTK_BITS, VTK_TEXTS } vtk_special;
typedef struct vtk_type {
    const char *name; /* in lower case */
    number_type type;
    vtk_special special; /* bits and texts are only skipped */
} vtk_type;

/* Whole numbers of the file: of cells. */
typedef struct vtk_wholes {
    bool is_text;
    number_type type;
    text_scan scan; /* in binary only its place */
    uint64_t count; /* that are left */
} vtk_wholes;

typedef enum vtk_dataset { VTK_POLYDATA, VTK_UNSTRUCTURED, VTK_STRUCTURED } vtk_dataset;

/* The attributes that follow belong to these. */
typedef enum vtk_owner { VTK_OF_FILE, VTK_OF_POINTS, VTK_OF_CELLS } vtk_owner;

typedef struct vtk_reader {
    volume_document *d;
    text_scan scan;
    bool is_binary;
    bool has_offsets; /* from version 5 on cells have offsets and a connectivity */
    vtk_dataset dataset;
    uint64_t dimensions[3];
    bool has_dimensions, has_points, has_normals, has_cells, has_kinds;
    vtk_owner owner;
    uint64_t tuples; /* that its attributes have */
    /* Of an unstructured grid, whose types follow behind the cells. */
    uint64_t cell_count;
    vtk_wholes sizes, points, kinds; /* sizes: offsets; without offsets the sizes are among the points */
    ffd_error *error;
} vtk_reader;

/* The line for a message; 0: the file is binary. */
static inline size_t vtk_line(const vtk_reader *r)
{
    return r->is_binary ? 0 : r->scan.line;
}

#define VTK_REFUSE(r, ...)                                                                                   \
    ffd_fail_line((r)->error, FFD_E_INVALID, (r)->d->file.name, vtk_line(r), __VA_ARGS__)

/* Takes the next word, in this line or a later one. */
ffd_status ffd_vtk_word(vtk_reader *r, const char *what, text_word *word);
/* Takes the next word as a number of things, of which none takes less than a bit of the file. */
ffd_status ffd_vtk_count(vtk_reader *r, const char *what, uint64_t *count);
/* Takes the next word as the type of an array. Errors: FFD_E_UNSUPPORTED for one that is not known. */
ffd_status ffd_vtk_type(vtk_reader *r, const vtk_type **type);
/* Returns where binary data begin: behind the line. */
const char *ffd_vtk_binary(const vtk_reader *r);

/* Takes the points, which follow their keyword. */
ffd_status ffd_vtk_points(vtk_reader *r);
/* Takes the cells behind a keyword of them. *taken: whether it is one. */
ffd_status ffd_vtk_cells(vtk_reader *r, text_word keyword, bool *taken);
/* Joins the cells of an unstructured grid with their types, or makes those of a structured grid. */
ffd_status ffd_vtk_end_cells(vtk_reader *r);
/* Takes an array, or several, behind a keyword of an attribute. */
ffd_status ffd_vtk_attribute(vtk_reader *r, text_word keyword);
/* Moves past metadata, to the next empty line. */
void ffd_vtk_metadata(vtk_reader *r);

#endif
