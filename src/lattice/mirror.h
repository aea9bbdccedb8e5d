/* mirror.h - mirror planes, and the control points that are mirror images at rest. */
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

/* The plane normal . p = offset. Perpendicular to a coordinate axis, images are exact: the other coordinates
   keep their bits. */
typedef struct mirror_plane {
    int axis;     /* the coordinate axis of the normal; -1: another direction */
    double twice; /* the coordinate of the plane along this axis, doubled */
    double normal[3], offset;
    double tolerance; /* positions whose distance is at most this are equal */
} mirror_plane;

/* Returns the plane perpendicular to a coordinate axis, through the middle of the bounds of the rest points.
 */
mirror_plane ffd_mirror_middle(const ffd_lattice *lattice, int axis);
/* Returns the plane of a unit normal. */
mirror_plane ffd_mirror_plane(const ffd_lattice *lattice, const double normal[3], double offset);

/* Computes the mirror image of a position; image may be p. */
void ffd_mirror_point(const mirror_plane *plane, const double p[3], double image[3]);
/* The same for a vector. */
void ffd_mirror_vector(const mirror_plane *plane, const double v[3], double image[3]);
/* Computes where p goes if its mirror image goes from `from` to `to`; moved may be `to`. What does not change
   keeps its bits. */
void ffd_mirror_back(const mirror_plane *plane, const double p[3], const double from[3], const double to[3],
                     double moved[3]);

typedef struct mirror_text {
    char text[120];
} mirror_text;
/* Returns the equation of a plane: "x = 1.5" or "0.6 x - 0.8 z = 2". */
mirror_text ffd_mirror_describe(const mirror_plane *plane);

/* Replaces a selection (one byte for each point) by the points whose rest positions are the mirror images of
   the selected ones. all: the tree of all points, built if it is empty, for reuse. *missing is the index of a
   selected point without an image, or the number of points if there is none. Errors: FFD_E_MEMORY. */
ffd_status ffd_mirror_select(const ffd_lattice *lattice, const mirror_plane *plane, mirror_tree *all,
                             unsigned char *selected, size_t *missing, ffd_error *error);
/* Frees the tree and empties it. */
void ffd_mirror_tree_free(mirror_tree *tree);

#endif
