/* patch.h - a rectangle of a face of the domain as a Bezier surface, with bounds and its nearest point. Main
   header of patches: declares patch.c, patch_bounds.c, patch_project.c, patch_cell.c. */
#ifndef FFD_EMBED_BOUNDARY_PATCH_H
#define FFD_EMBED_BOUNDARY_PATCH_H

#include "embed/frame/box_tree.h"
#include "spline/knots.h"

#define PATCH_COMPONENTS 4 /* h x (3) and h */

/* A patch S(t) = A(t) / W(t), t in [0,1]^2. ffd_patch_measure computes the oriented box and the bounds from
   points; "along the axes" means multiplied by the rows of axis. */
typedef struct face_patch {
    int order[2];
    bool rational;           /* false: all h are 1 */
    int face;                /* index of the face in the boundary */
    size_t cell[2];          /* cell of the face, as indices of non-empty spans */
    double lo[2], hi[2];     /* the part of the cell, which is [0,1]^2 */
    struct face_patch *next; /* in a list of patches to be freed */

    double centre[3], axis[9],
        half[3];      /* an oriented box that contains the patch; the rows of axis are unit vectors */
    bounds first[2];  /* of S_s and S_t along the axes */
    bounds second[3]; /* of S_ss, S_st, S_tt along the axes */

    double points[]; /* PATCH_COMPONENTS numbers for each control point, s fastest */
} face_patch;

/* Allocates a patch; free it with ffd_free. Returns NULL if memory runs out. */
face_patch *ffd_patch_create(const int order[2], bool rational);

/* Splits a patch in direction f into halves with the same orders. */
void ffd_patch_split(const face_patch *whole, int f, face_patch *lower, face_patch *upper);
/* Splits a patch and measures the halves. */
void ffd_patch_halve(const face_patch *whole, int f, face_patch *lower, face_patch *upper);

/* Computes the oriented box and the bounds. */
void ffd_patch_measure(face_patch *patch);
/* Returns the bounds of the control points along x,y,z. */
bounds ffd_patch_hull(const face_patch *patch);
/* Returns bounds of S(t) - x along the axes. */
bounds ffd_patch_residual(const face_patch *patch, const double x[3]);
/* Returns whether |S(t) - x| has only one local minimum in [0,1]^2 for every x with S(t) - x within these
   bounds. The test is sufficient, not necessary. */
bool ffd_patch_has_one_minimum(const face_patch *patch, const bounds *residual);
/* Returns the direction whose halving reduces the variation of the derivatives most. */
int ffd_patch_direction(const face_patch *patch);

/* A patch at a parameter t, relative to a point x. */
typedef struct patch_sample {
    double point[3];
    double residual[3];  /* S - x */
    double first[2][3];  /* S_s, S_t */
    double second[3][3]; /* S_ss, S_st, S_tt */
} patch_sample;

/* Evaluates the residual S - x and the derivatives at t. */
void ffd_patch_evaluate(const face_patch *patch, const double x[3], const double t[2], patch_sample *sample);

/* Moves t to a local minimum of |S - x| in [0,1]^2, and sets *sample to the sample there. */
void ffd_patch_project(const face_patch *patch, const double x[3], double t[2], patch_sample *sample);

/* An axis-aligned box. */
typedef struct patch_cell {
    double centre[3], half[3]; /* half sides, > 0 */
} patch_cell;

/* What the control points of a patch prove about a cell. */
typedef enum patch_view {
    PATCH_MISSES, /* a plane separates the patch and the cell */
    PATCH_MEETS,  /* they have a point in common, or their distance is less than a millionth of the cell */
    PATCH_UNKNOWN /* undecided; *longer is the direction to halve */
} patch_view;

/* Decides whether a patch, which need not be measured, meets a cell. */
patch_view ffd_patch_view_cell(const face_patch *patch, const patch_cell *cell, int *longer);

/* Computes the gradient and the second derivatives (ss, st, tt) of |S - x|^2 / 2. */
void ffd_patch_gradient(const patch_sample *sample, double gradient[2], double hessian[3]);

#endif
