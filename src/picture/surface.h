/* surface.h - a mesh prepared for drawing: positions of vertices in the picture, and their light.
   ffd_surface_normals is in surface_normals.c. */
#ifndef FFD_PICTURE_SURFACE_H
#define FFD_PICTURE_SURFACE_H

#include "picture/bands.h"
#include "picture/picture_scene.h"

/* Subpixels: coordinates are rounded to 1/SUBPIXELS of a pixel. */
#define SUBPIXELS 256
/* Guard band in pixels from the corner of the picture: triangles beyond it are clipped, so that products of
   coordinates fit in 64 bits. */
#define GUARD 65536
/* Values of x for a vertex beyond the guard band, and for one that is not finite. */
#define VERTEX_FAR INT32_MIN
#define VERTEX_NOWHERE INT32_MAX

/* The value of light 1. */
#define LIGHT_ONE 32768

typedef struct surface_vertex {
    int32_t x, y;      /* in subpixels */
    float z;           /* in pixels, away from the eye */
    uint16_t light[2]; /* on the side of the normal, and on the other side */
} surface_vertex;

typedef struct surface {
    const picture_mesh *mesh;
    projection projection;
    surface_vertex *vertices; /* vertices of the mesh, then the copies at creases */
    size_t vertex_count;
    uint32_t *origins;         /* for each copy, the vertex of the mesh */
    const uint32_t *triangles; /* those of the mesh, or own_triangles */
    uint32_t *own_triangles;
    bool has_see_through; /* a material is see-through */
    int32_t stripe;       /* pixels of a stripe and the one beside it */
} surface;

/* Vertex normals of a mesh: the area-weighted mean of the faces. Faces that meet at more than 60 degrees (a
   crease) do not share a normal. */
typedef struct surface_normals {
    float *normals; /* 3 numbers each, of any length, for the vertices of the mesh and then for the copies */
    size_t split_count;
    uint32_t *origins;   /* split_count entries */
    uint32_t *triangles; /* triangles with the copies; NULL: there are no copies */
} surface_normals;

/* Computes the normals. scale: pixels for a unit of the mesh. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_surface_normals(const picture_mesh *mesh, double scale, const memory_budget *budget,
                               surface_normals *result, ffd_error *error);

/* Prepares a mesh. Errors: FFD_E_MEMORY, FFD_E_LIMIT; there is nothing to free then. */
ffd_status ffd_surface_make(const picture_mesh *mesh, const projection *by, const band_means *means,
                            surface *result, ffd_error *error);
/* Frees the surface and empties it. */
void ffd_surface_free(surface *of);

/* Returns the vertex of the mesh from which a vertex of the surface comes. */
static inline uint32_t surface_origin(const surface *of, uint32_t vertex)
{
    return vertex < of->mesh->vertex_count ? vertex : of->origins[vertex - of->mesh->vertex_count];
}

#endif
