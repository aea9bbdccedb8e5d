/* border.h - the control nets of the faces of the domain, to detect faces that coincide or collapse. */
#ifndef FFD_LATTICE_BORDER_H
#define FFD_LATTICE_BORDER_H

#include "lattice/lattice.h"

/* The first (end 0) or last (end 1) face of the domain in a direction that is not closed. It is a surface
   with a control point for each pair of control points of the other two directions. */
typedef struct border_face {
    const ffd_lattice *lattice;
    const double *points, *weights; /* of the volume; weights may be NULL */
    int direction, span;
    double value[MAX_ORDER]; /* basis functions of the direction at that end */
} border_face;

/* Fills *face for an end of a direction, which must not be closed. */
void ffd_border_face(const ffd_lattice *lattice, ffd_volume volume, int direction, int end,
                     border_face *face);

/* Computes a control point of the face in homogeneous coordinates: sum h (P - origin) N and sum h N over the
   control points of the direction. index: its indices in the other directions (that of the direction itself
   is ignored). */
void ffd_border_point(const border_face *face, const size_t index[3], const double origin[3],
                      double point[4]);

/* Returns whether the first and the last face of a direction that is not closed are one surface at rest: a
   seam, as of a full turn that is not closed. Points on both faces have one u,v,w, the least, whatever the
   moves are. The faces have the same control points, within 16 eps of their magnitude (weights may differ:
   flat faces still coincide then, with different parameters; curved faces meet where they cross), or are
   parts of one plane that overlap, with the volume on either side. */
bool ffd_lattice_is_seam(const ffd_lattice *lattice, int direction);

/* Returns whether the moves can separate the faces of such a seam; false is certain. True if the deformed
   control points of the faces differ, or if the ratio of their weights is not constant. */
bool ffd_lattice_opens_seam(const ffd_lattice *lattice, int direction);

/* Returns whether the moves separate control points of a face or an edge of the domain that are one point at
   rest, as on a cylinder's axis. */
bool ffd_lattice_opens_axis(const ffd_lattice *lattice);

#endif
