/* mirror.h - the plane through the rest's middle, and which control points are mirror images at rest. */
#ifndef FFD_LATTICE_MIRROR_H
#define FFD_LATTICE_MIRROR_H

#include "lattice/lattice.h"
#include <stdint.h>

/* Points that a place is looked up in: a k-d tree in one array. */
typedef struct mirror_tree {
    const double *points;
    uint32_t *order;      /* numbers of points; a range is split by the point in its middle */
    unsigned char *split; /* by the middle's place in order: the coordinate that its range is split along */
    size_t count;
} mirror_tree;

/* A plane across one coordinate in the middle of the bounds of the rest points. */
typedef struct mirror_plane {
    int axis;
    double twice;     /* the coordinate of the plane, doubled */
    double tolerance; /* two places that lie no farther apart are one */
} mirror_plane;

/* The plane across coordinate axis. */
mirror_plane ffd_mirror_plane(const ffd_lattice *lattice, int axis);

/* The image of a position. */
static inline void ffd_mirror_point(const mirror_plane *plane, const double p[3], double image[3])
{
    for (int c = 0; c < 3; c++)
        image[c] = c == plane->axis ? plane->twice - p[c] : p[c];
}

/* Replaces a selection (a byte a point) by the points whose rest positions are mirror images of those
   selected. `all` is made where it is empty, and can be used again. *missing is a selected point without an
   image, or the number of points. Errors: FFD_E_MEMORY. */
ffd_status ffd_mirror_select(const ffd_lattice *lattice, const mirror_plane *plane, mirror_tree *all,
                             unsigned char *selected, size_t *missing, ffd_error *error);
/* Leaves an empty tree. */
void ffd_mirror_tree_free(mirror_tree *tree);

#endif
