/* mirror.h - the mirror plane through the middle of the rest points, and the control points that are mirror
   images at rest. */
#ifndef FFD_LATTICE_MIRROR_H
#define FFD_LATTICE_MIRROR_H

#include "lattice/lattice.h"
#include <stdint.h>

/* A k-d tree of points in one array. */
typedef struct mirror_tree {
    const double *points;
    uint32_t *order;      /* indices of points; the point in the middle of a range splits it */
    unsigned char *split; /* at the index of the middle in order: the coordinate along which its range is
                             split */
    size_t count;
} mirror_tree;

/* A plane perpendicular to a coordinate axis, through the middle of the bounds of the rest points. */
typedef struct mirror_plane {
    int axis;
    double twice;     /* the coordinate of the plane, doubled */
    double tolerance; /* positions whose distance is at most this are equal */
} mirror_plane;

/* Returns the plane perpendicular to a coordinate axis. */
mirror_plane ffd_mirror_plane(const ffd_lattice *lattice, int axis);

/* Computes the mirror image of a position. */
static inline void ffd_mirror_point(const mirror_plane *plane, const double p[3], double image[3])
{
    for (int c = 0; c < 3; c++)
        image[c] = c == plane->axis ? plane->twice - p[c] : p[c];
}

/* Replaces a selection (one byte for each point) by the points whose rest positions are the mirror images of
   the selected ones. all: the tree of all points, built if it is empty, for reuse. *missing is the index of a
   selected point without an image, or the number of points if there is none. Errors: FFD_E_MEMORY. */
ffd_status ffd_mirror_select(const ffd_lattice *lattice, const mirror_plane *plane, mirror_tree *all,
                             unsigned char *selected, size_t *missing, ffd_error *error);
/* Frees the tree and empties it. */
void ffd_mirror_tree_free(mirror_tree *tree);

#endif
