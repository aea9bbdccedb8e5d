/* surface.h - a mesh as it is drawn: where its vertices lie in the picture, and how much light they get.
   surface_normals.c has ffd_surface_normals. */
#ifndef FFD_PICTURE_SURFACE_H
#define FFD_PICTURE_SURFACE_H

#include "picture/bands.h"
#include "picture/picture_scene.h"

/* Parts of a pixel that coordinates are rounded to. */
#define SUBPIXELS 256
/* Farther away from the picture's corner, in pixels, triangles are clipped: products of coordinates within it
   fit in 64 bits. */
#define GUARD 65536
/* x of a vertex that is beyond; of one that is not finite. */
#define VERTEX_FAR INT32_MIN
#define VERTEX_NOWHERE INT32_MAX

/* 1 of light on a vertex. */
#define LIGHT_ONE 32768

typedef struct surface_vertex {
    int32_t x, y;      /* in parts of a pixel */
    float z;           /* in pixels, away from the eye */
    uint16_t light[2]; /* on the side that the normal points to, and on the other */
} surface_vertex;

typedef struct surface {
    const picture_mesh *mesh;
    projection projection;
    surface_vertex *vertices; /* of the mesh, then those that creases split */
    size_t vertex_count;
    uint32_t *origins;         /* of each that was split, the mesh's */
    const uint32_t *triangles; /* the mesh's, or own_triangles */
    uint32_t *own_triangles;
} surface;

/* Normals of a mesh: the mean of its faces by their area. Where faces meet at more than 60 degrees they do
   not share one. */
typedef struct surface_normals {
    float *normals; /* 3 a vertex, of any length; of the mesh, then of those that are split */
    size_t split_count;
    uint32_t *origins;   /* split_count */
    uint32_t *triangles; /* of the mesh, with the split ones; NULL: none are */
} surface_normals;

/* Fills normals, of a mesh that is so many pixels in size for a unit. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_surface_normals(const picture_mesh *mesh, double scale, const memory_budget *budget,
                               surface_normals *result, ffd_error *error);

/* Errors: FFD_E_MEMORY, FFD_E_LIMIT; nothing is left to free then. */
ffd_status ffd_surface_make(const picture_mesh *mesh, const projection *by, const band_means *means,
                            surface *result, ffd_error *error);
/* Frees what it holds; leaves an empty one. */
void ffd_surface_free(surface *of);

/* The mesh's vertex that a vertex of the surface came from. */
static inline uint32_t surface_origin(const surface *of, uint32_t vertex)
{
    return vertex < of->mesh->vertex_count ? vertex : of->origins[vertex - of->mesh->vertex_count];
}

#endif
