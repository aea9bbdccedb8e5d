/* page_mesh.h - what of a scene's mesh a page shows: the triangles, segments and points whose vertices are
   finite, and these vertices. */
#ifndef FFD_VIEW_PAGE_MESH_H
#define FFD_VIEW_PAGE_MESH_H

#include "view/view_scene.h"

typedef struct page_part {
    size_t first_triangle, triangle_count;
} page_part;

/* Indices are of the scene's vertices, until ffd_page_mesh_number. */
typedef struct page_mesh {
    const view_scene *scene;
    uint32_t *triangles; /* 3 each, the parts one after the other */
    uint8_t *flipped;    /* one a triangle, or NULL */
    size_t triangle_count;
    page_part *parts; /* as many as the scene has; one where it has none */
    size_t part_count;
    uint32_t *segments, *points; /* 2 and 1 vertices each */
    size_t segment_count, point_count;
    uint32_t *vertices; /* of the scene: those that are used, ascending */
    size_t vertex_count;
    uint32_t *places;      /* where each vertex of the scene is in vertices, or VIEW_NONE */
    uint64_t not_finite;   /* vertices that are left out, with what they are part of */
    size_t triangles_lost; /* for that reason */
} page_mesh;

/* Takes all that can be drawn. Errors: FFD_E_ARGUMENT (an index or a part beyond its array), FFD_E_LIMIT,
   FFD_E_MEMORY. Free it in every case. */
ffd_status ffd_page_mesh_take(const view_scene *scene, page_mesh *mesh, ffd_error *error);
/* Returns how many vertices the elements use; places has their number in that count, or VIEW_NONE. */
size_t ffd_page_mesh_mark(page_mesh *mesh);
/* Lists the vertices that are used, and gives all indices their numbers. Errors: FFD_E_MEMORY. */
ffd_status ffd_page_mesh_number(page_mesh *mesh, ffd_error *error);
/* Frees what a mesh holds. */
void ffd_page_mesh_free(page_mesh *mesh);

#endif
