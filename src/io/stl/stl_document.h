/* stl_document.h - an STL file, ascii or binary, as a mesh document: one part, in the lattice's space.
   Declares stl_document.c, stl_results.c, stl_normal.c.

   Each corner of each facet is a vertex, in the order of the file. A facet's normal is not a vertex normal:
   saving computes it anew from the corners. */
#ifndef FFD_IO_STL_STL_DOCUMENT_H
#define FFD_IO_STL_STL_DOCUMENT_H

#include "io/stl/stl_text.h"
#include "io/text/file_document.h"

/* A binary file: a header, the number of facets, and for each facet its normal, three corners and two bytes.
   In bytes: */
#define STL_HEADER 80
#define STL_START 84
#define STL_FACET 50
#define STL_NORMAL 12 /* a facet's normal */
#define STL_ATTRIBUTE 48

/* The maximum number of facets: their corners have 32-bit numbers. */
#define STL_FACETS_MAX ((UINT32_MAX - 1) / 3)

typedef struct stl_document {
    /* positions: only of an ascii file; new_positions: rounded to what the file can hold. */
    file_document file;
    bool binary;
    size_t facets;
    bool renew_normals;
} stl_document;

static inline const stl_document *ffd_stl_of(const mesh_document *document)
{
    return (const stl_document *)document;
}

/* Returns the bytes of a facet of a binary file. */
static inline const unsigned char *ffd_stl_facet(const stl_document *document, size_t facet)
{
    return document->file.input.data + STL_START + STL_FACET * facet;
}

/* Reads vertices, which are the corners of facets. */
void ffd_stl_read_corners(const stl_document *document, size_t first, size_t count, double *xyz);

/* Loads three floats of a binary file. */
void ffd_stl_load(const unsigned char *bytes, double xyz[3]);
/* Stores count numbers as floats of a binary file. */
void ffd_stl_store(unsigned char *bytes, const double *values, size_t count);

/* Computes the right-handed unit normal of a facet from its 9 coordinates. Returns false if the facet's area
   is not larger than rounding can make it. */
bool ffd_stl_normal(const double corners[9], double normal[3]);

/* Functions of the mesh_format. */
mesh_open_function ffd_stl_open;
mesh_read_function ffd_stl_read;
mesh_begin_results_function ffd_stl_begin_results;
mesh_write_function ffd_stl_write;
mesh_save_function ffd_stl_save;
mesh_faces_function ffd_stl_faces;
mesh_mixed_faces_function ffd_stl_mixed_faces;
mesh_model_function ffd_stl_model;
mesh_describe_function ffd_stl_describe;
mesh_compare_function ffd_stl_compare;

#endif
