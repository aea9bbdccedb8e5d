/* page_mesh.h - the part of a scene's mesh that a page shows: the triangles, segments and points whose
   vertices are all finite, and the vertices they use. */
#ifndef FFD_VIEW_PAGE_MESH_H
#define FFD_VIEW_PAGE_MESH_H

#include "view/view_scene.h"

typedef struct page_part {
    size_t first_triangle, triangle_count;
} page_part;

/* Indices refer to the scene's vertices until ffd_page_mesh_index, then to those of the page. */
typedef struct page_mesh {
    const view_scene *scene;
    uint32_t *triangles;   /* 3 indices each, part by part */
    uint8_t *flipped;      /* one flag a triangle, or NULL */
    uint8_t *continues;    /* as the scene has them; NULL: unknown, also of a mesh that is simplified */
    float *texcoords;      /* texcoord_width a corner, zeros where no texture is shown; NULL: none is */
    size_t texcoord_width; /* 2, or 4 with those of the emission; 0: none */
    size_t triangle_count;
    page_part *parts; /* as many as the scene has; one where it has none */
    size_t part_count;
    uint32_t *segments, *points; /* 2 indices and 1 index each */
    size_t segment_count, point_count;
    uint32_t *vertices; /* the scene's indices of the vertices in use, ascending */
    size_t vertex_count;
    uint32_t *places;      /* of each vertex of the scene: its index in vertices, or VIEW_NONE */
    uint64_t not_finite;   /* vertices left out, with every element that uses one */
    size_t triangles_lost; /* triangles left out for that reason */
} page_mesh;

/* Takes every element that can be drawn. Errors: FFD_E_ARGUMENT (an index or a part is out of range),
   FFD_E_LIMIT, FFD_E_MEMORY. Call ffd_page_mesh_free in every case. */
ffd_status ffd_page_mesh_take(const view_scene *scene, page_mesh *mesh, ffd_error *error);
/* Fills places by the elements' vertices, numbered in ascending order. Returns the number of vertices in
   use. */
size_t ffd_page_mesh_mark(page_mesh *mesh);
/* Fills vertices, and makes all indices refer to it. Errors: FFD_E_MEMORY. */
ffd_status ffd_page_mesh_index(page_mesh *mesh, ffd_error *error);
/* Returns the number of lists, a power of two, by which so many corners are found in steady time. */
size_t ffd_page_corner_lists(size_t corners);
/* Returns the list of the corners with this vertex and these texture coordinates: a vertex may have any
   number of these. */
size_t ffd_page_corner_list(uint32_t vertex, const float *texcoords, size_t width, size_t lists);
/* Frees the arrays of a mesh. */
void ffd_page_mesh_free(page_mesh *mesh);

#endif
