/* vertex_transform.h - how the vertices of a part stand in the lattice's space, one by one. */
#ifndef FFD_JOB_PASS_VERTEX_TRANSFORM_H
#define FFD_JOB_PASS_VERTEX_TRANSFORM_H

#include "base/vector/vec.h"
#include "mesh/mesh.h"

/* So many vertices at once. */
#define VERTEX_PLACES ((size_t)4096)
_Static_assert(VERTEX_PLACES % MESH_RANGE_STEP == 0, "writers would meet");

/* x = linear p + offset. */
typedef struct vertex_place {
    const double *linear, *offset, *inverse;
    bool identity, singular; /* singular: there is no inverse */
} vertex_place;

typedef struct vertex_places {
    const mesh_part *part;
    double transforms[12 * VERTEX_PLACES],
        inverses[9 * VERTEX_PLACES]; /* of the vertices of a skinned part */
    bool singular[VERTEX_PLACES];
} vertex_places;

/* Those of a part's vertices [first, first + count), count being VERTEX_PLACES at most. */
void ffd_vertex_places_read(const mesh_document *document, size_t part, size_t first, size_t count,
                            vertex_places *places);
/* That of vertex first + i. Lent by places and the part. */
vertex_place ffd_vertex_place_of(const vertex_places *places, size_t i);

/* Takes a point from the file's space to the lattice's. */
static inline void ffd_vertex_place_point(const vertex_place *place, double p[3])
{
    if (!place->identity)
        ffd_point_place(place->linear, place->offset, p);
}

/* Takes a displacement from the lattice's space to the file's own: linear^{-1} delta; zeros where there is no
   inverse. */
static inline void ffd_displacement_bring_back(const vertex_place *place, double delta[3])
{
    const bool moves = !place->singular && (delta[0] != 0 || delta[1] != 0 || delta[2] != 0);
    for (int a = 0; a < 3 && !moves; a++)
        delta[a] = 0;
    if (moves && !place->identity)
        mat_apply(place->inverse, delta, delta);
}

/* Takes a gradient E from the lattice's space to the file's own: linear^{-1} E linear. 0 where there is no
   inverse. */
void ffd_gradient_bring_back(const vertex_place *place, double gradient[9]);

#endif
