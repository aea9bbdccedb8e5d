/* border.h - the control nets of the domain's faces: where two faces are one surface, or one collapses. */
#ifndef FFD_LATTICE_BORDER_H
#define FFD_LATTICE_BORDER_H

#include "lattice/lattice.h"

/* A face of the domain of a direction that is not closed: its first (end 0) or last (end 1). As a surface it
   has one control point for each pair of control points of the other two directions. */
typedef struct border_face {
    const ffd_lattice *lattice;
    const double *points, *weights; /* the volume's; weights may be NULL */
    int direction, span;
    double value[MAX_ORDER]; /* the direction's basis functions at that end */
} border_face;

/* Fills *face for one end of a direction, which must not be closed. */
void ffd_border_face(const ffd_lattice *lattice, ffd_volume volume, int direction, int end,
                     border_face *face);

/* sum h (P - origin) N and sum h N over the direction's control points: the face's control point whose
   indices of the other directions are those of index (the direction's own does not matter). */
void ffd_border_point(const border_face *face, const size_t index[3], const double origin[3],
                      double point[4]);

/* Whether the first and the last face of a direction that is not closed have the same control points at rest,
   within 16 eps of their size: a full turn that is not closed. What lies on both has one u,v,w, the least,
   whatever the moves. Weights may differ: flat faces are then still one, with other parameters along them;
   others meet where they cross. */
bool ffd_lattice_is_seam(const ffd_lattice *lattice, int direction);

/* Whether the moves may take the faces of such a direction apart: false is certain. True where a moved
   control point of one is not that of the other, or where weights are not in one ratio. */
bool ffd_lattice_opens_seam(const ffd_lattice *lattice, int direction);

#endif
