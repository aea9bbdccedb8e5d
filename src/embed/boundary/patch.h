/* patch.h - a rectangle of a face of the domain as a Bezier surface: its bounds, the nearest point of it.
   Main header of patches: declares patch.c, patch_bounds.c, patch_project.c, patch_cell.c. */
#ifndef FFD_EMBED_BOUNDARY_PATCH_H
#define FFD_EMBED_BOUNDARY_PATCH_H

#include "embed/frame/box_tree.h"
#include "spline/knots.h"

#define PATCH_COMPONENTS 4 /* h x (3) and h */

/* S(t) = A(t) / W(t) over t in [0,1]^2. What follows `points` is computed by ffd_patch_measure; "along the
   axes" means multiplied by the rows of axis. */
typedef struct face_patch {
    int order[2];
    bool rational;           /* else all h are 1 */
    int face;                /* the boundary's number of the face */
    size_t cell[2];          /* the cell of the face, in non-empty spans */
    double lo[2], hi[2];     /* the part of the cell, whose own is [0,1] */
    struct face_patch *next; /* of a list of patches to be freed */

    double centre[3], axis[9],
        half[3];      /* an oriented box that holds the patch; rows of axis are unit vectors */
    bounds first[2];  /* of S_s and S_t along the axes */
    bounds second[3]; /* of S_ss, S_st, S_tt along the axes */

    double points[]; /* PATCH_COMPONENTS a control point, s fastest */
} face_patch;

/* A patch without contents; NULL if memory runs out. To be freed with ffd_free. */
face_patch *ffd_patch_create(const int order[2], bool rational);

/* The halves of whole across direction f; they have whole's orders. */
void ffd_patch_split(const face_patch *whole, int f, face_patch *lower, face_patch *upper);
/* The same, measured. */
void ffd_patch_halve(const face_patch *whole, int f, face_patch *lower, face_patch *upper);

/* Computes what follows `points` from them. */
void ffd_patch_measure(face_patch *patch);
/* Bounds along x,y,z. */
bounds ffd_patch_hull(const face_patch *patch);
/* Bounds, along the axes, of S(t) - x. */
bounds ffd_patch_residual(const face_patch *patch, const double x[3]);
/* Whether |S(t) - x| has only one local minimum in [0,1]^2, whatever the x with S(t) - x within these bounds
   throughout. Sufficient, not necessary. */
bool ffd_patch_has_one_minimum(const face_patch *patch, const bounds *residual);
/* The direction whose halving makes the derivatives vary least. */
int ffd_patch_direction(const face_patch *patch);

/* The patch at one t, relative to a point x. */
typedef struct patch_sample {
    double point[3];
    double residual[3];  /* S - x */
    double first[2][3];  /* S_s, S_t */
    double second[3][3]; /* S_ss, S_st, S_tt */
} patch_sample;

/* S, its residual and its derivatives at t. */
void ffd_patch_evaluate(const face_patch *patch, const double x[3], const double t[2], patch_sample *sample);

/* Goes from t to a local minimum of |S - x| in [0,1]^2, which is the only one where the patch has one;
 *sample becomes that at t. */
void ffd_patch_project(const face_patch *patch, const double x[3], double t[2], patch_sample *sample);

/* A box with sides along x,y,z. */
typedef struct patch_cell {
    double centre[3], half[3]; /* half its sides, > 0 */
} patch_cell;

/* What the control points of a patch tell of a cell. */
typedef enum patch_view {
    PATCH_MISSES, /* a plane is between the patch and the cell */
    PATCH_MEETS,  /* they have a point in common, or are nearer than a millionth of the cell */
    PATCH_UNKNOWN /* neither is shown; *longer is the direction to halve */
} patch_view;

/* Whether a patch, which need not be measured, meets a cell. */
patch_view ffd_patch_view_cell(const face_patch *patch, const patch_cell *cell, int *longer);

/* The gradient and the second derivatives (ss, st, tt) of |S - x|^2 / 2. */
void ffd_patch_gradient(const patch_sample *sample, double gradient[2], double hessian[3]);

#endif
