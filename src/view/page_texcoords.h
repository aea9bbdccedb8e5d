/* page_texcoords.h - the texture coordinates of a page's mesh. A wedge is a vertex with the coordinates that
   it has in some of its triangles: at a seam of a texture a vertex has several. */
#ifndef FFD_VIEW_PAGE_TEXCOORDS_H
#define FFD_VIEW_PAGE_TEXCOORDS_H

#include "view/page_mesh.h"
#include "view/page_writer.h"
#include "json/json_text.h"

/* All zeros: the page shows no textures. */
typedef struct page_texcoords {
    uint32_t *corners;  /* wedge of each corner of the triangles */
    uint32_t *vertices; /* vertex of each wedge */
    float *values;      /* of each wedge, as many as a corner of the mesh has, v upwards */
    size_t count;
    size_t corner_count;
    size_t width;
    double low[4], step[4]; /* u = low + step q, q from 0 to 65535 */
} page_texcoords;

/* Collects the wedges of an indexed mesh (ffd_page_mesh_index); none if it has no texture coordinates.
   Errors: FFD_E_MEMORY. Call ffd_page_texcoords_free in every case. */
ffd_status ffd_page_texcoords_make(const page_mesh *mesh, page_texcoords *texcoords, ffd_error *error);
/* Writes the blocks of the wedges. */
void ffd_page_texcoords_write(const page_texcoords *texcoords, page_writer *w);
/* Adds the members that describe the blocks. */
void ffd_page_texcoords_describe(const page_texcoords *texcoords, json_text *json);
/* Frees the arrays. */
void ffd_page_texcoords_free(page_texcoords *texcoords);

#endif
