/* stl_document.h - an STL file, ascii or binary, as a mesh document: one part, in the lattice's space.
   Declares stl_document.c, stl_results.c, stl_normal.c.

   Each corner of each facet is a vertex, in the order of the file. A facet's normal is not the normal of a
   vertex: saving computes it anew from the corners. */
#ifndef FFD_IO_STL_STL_DOCUMENT_H
#define FFD_IO_STL_STL_DOCUMENT_H

#include "io/stl/stl_text.h"
#include "io/text/file_document.h"

/* Binary files: a header, the number of facets, and for each its normal, three corners and two bytes. */
#define STL_HEADER 80
#define STL_START 84
#define STL_FACET 50
#define STL_NORMAL 12 /* bytes */
#define STL_ATTRIBUTE 48

/* Facets that a file may have: the numbers of their corners are 32 bits. */
#define STL_FACETS_MAX ((UINT32_MAX - 1) / 3)

typedef struct stl_document {
    file_document file; /* positions: of an ascii file only; new_positions: as the file can hold them */
    bool binary;
    size_t facets;
    bool renew_normals;
} stl_document;

static inline const stl_document *ffd_stl_of(const mesh_document *document)
{
    return (const stl_document *)document;
}

/* The bytes of a facet of a binary file. */
static inline const unsigned char *ffd_stl_facet(const stl_document *document, size_t facet)
{
    return document->file.input.data + STL_START + STL_FACET * facet;
}

/* Three floats of a binary file. */
void ffd_stl_load(const unsigned char *bytes, double xyz[3]);
/* Stores count numbers as floats of a binary file. */
void ffd_stl_store(unsigned char *bytes, const double *values, size_t count);

/* The right-hand normal of a facet with 9 coordinates, of length 1. Returns false if they have no area beyond
   what their rounding can make. */
bool ffd_stl_normal(const double corners[9], double normal[3]);

/* The entries of the format's table. */
mesh_open_function ffd_stl_open;
mesh_read_function ffd_stl_read_positions;
mesh_begin_results_function ffd_stl_begin_results;
mesh_write_function ffd_stl_write_positions;
mesh_save_function ffd_stl_save;
mesh_faces_function ffd_stl_faces;
mesh_mixed_faces_function ffd_stl_mixed_faces;
mesh_model_function ffd_stl_model;
mesh_describe_function ffd_stl_describe;
mesh_compare_function ffd_stl_compare;

#endif
