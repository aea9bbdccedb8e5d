/* vertex_transform.h - the transforms of a part's vertices into the lattice's space. */
#ifndef FFD_JOB_PASS_VERTEX_TRANSFORM_H
#define FFD_JOB_PASS_VERTEX_TRANSFORM_H

#include "base/vector/vec.h"
#include "mesh/mesh.h"

/* The most vertices read at a time. */
#define VERTEX_TRANSFORMS ((size_t)4096)
_Static_assert(VERTEX_TRANSFORMS % MESH_RANGE_STEP == 0, "writers would meet");

/* x = linear p + offset. */
typedef struct vertex_transform {
    const double *linear, *offset, *inverse;
    bool identity, singular; /* singular: no inverse exists */
} vertex_transform;

typedef struct vertex_transforms {
    const mesh_part *part;
    double transforms[12 * VERTEX_TRANSFORMS],
        inverses[9 * VERTEX_TRANSFORMS]; /* of the vertices of a skinned part */
    bool singular[VERTEX_TRANSFORMS];
} vertex_transforms;

/* Reads the transforms of a part's vertices [first, first + count), at most VERTEX_TRANSFORMS. found:
   statistics of their skin weights are added to it; or NULL. */
void ffd_vertex_transforms_read(const mesh_document *document, size_t part, size_t first, size_t count,
                                vertex_transforms *transforms, skin_weights *found);
/* Returns the transform of vertex first + i. It borrows from transforms and the part. */
vertex_transform ffd_vertex_transform_of(const vertex_transforms *transforms, size_t i);

/* Transforms a point from the file's space to the lattice's. */
static inline void ffd_vertex_transform_point(const vertex_transform *transform, double p[3])
{
    if (!transform->identity)
        ffd_point_transform(transform->linear, transform->offset, p);
}

/* Transforms a displacement from the lattice's space to the file's: linear^{-1} delta; zeros if singular. */
static inline void ffd_displacement_to_file(const vertex_transform *transform, double delta[3])
{
    const bool moves = !transform->singular && (delta[0] != 0 || delta[1] != 0 || delta[2] != 0);
    for (int a = 0; a < 3 && !moves; a++)
        delta[a] = 0;
    if (moves && !transform->identity)
        mat_apply(transform->inverse, delta, delta);
}

/* Transforms a gradient E from the lattice's space to the file's: linear^{-1} E linear; zeros if singular. */
void ffd_gradient_to_file(const vertex_transform *transform, double gradient[9]);

/* Corrects a vertex's displacement for the motion of the part's node or skin (the rig follows). y: the
   deformed position. Both are in the lattice's space. */
static inline void ffd_part_carry(const mesh_part *part, const double y[3], double delta[3])
{
    double more[3];
    mat_apply(part->carry, y, more);
    for (int a = 0; a < 3; a++)
        delta[a] += more[a] + part->carry[9 + a];
}

/* Likewise corrects the gradient E of the deformation, in the lattice's space. */
void ffd_part_carry_gradient(const mesh_part *part, double gradient[9]);

#endif
