/* frame.h - what all methods that find u,v,w share: the rest lattice in the search's own parameters, and the
   tolerance. */
#ifndef FFD_EMBED_FRAME_FRAME_H
#define FFD_EMBED_FRAME_FRAME_H

#include "base/vector/isa.h"
#include "base/vector/vec.h"
#include "embed/frame/box_tree.h"
#include "lattice/lattice.h"
#include <ffd/embedding.h>
#include <float.h>
#include <math.h>

typedef enum locator_method { METHOD_AFFINE, METHOD_SEPARABLE, METHOD_GENERAL } locator_method;

/* C(u,v,w) - origin = frame t, t in [0,1]^3 over the domain (src/maths.md 5). */
typedef struct affine_map {
    double frame[9], inverse[9];
} affine_map;

/* A direction of a separable lattice: a strictly monotone spline x(u). */
typedef struct monotone_curve {
    double *points;      /* one for each basis function, relative to the origin */
    double *breakpoints; /* x at the start of each non-empty span and at the end of the domain: span_count + 1
                            values */
    bool falling;
} monotone_curve;

struct ffd_locator {
    const ffd_lattice *lattice;
    ffd_isa isa;
    locator_method method;
    /* The knots of the lattice relative to the start of the domain, times a power of two that scales the
       domain to size 1. Far from 0 a parameter would be too coarse for the tolerance, and derivatives by very
       large or small parameters would overflow or underflow. All searches use these knots; results are
       converted back. */
    knot_vector knots[3];
    double knot_first[3], knot_scale[3]; /* that start, and that power */
    double origin[3];                    /* subtracted from control points and points first */
    double extent[3];                    /* max |P_a - origin_a| over the control points */
    bounds hull;                         /* bounds of the control points, world units */
    struct locator_border *border;       /* for points outside; made on demand */
    affine_map affine;
    monotone_curve curves[3];
    struct cell_search *cells;
};

/* Computes the tolerance of a point in world units: 16 eps (max|P_a| + |p_a|), in the coordinates of the file
   (src/maths.md 6.6). */
static inline void ffd_world_tolerance(const ffd_locator *locator, const double xyz[3], double tolerance[3])
{
    for (int a = 0; a < 3; a++) {
        const double most = larger_of(fabs(locator->hull.lo[a]), fabs(locator->hull.hi[a]));
        tolerance[a] = 16 * DBL_EPSILON * (most + fabs(xyz[a]));
    }
}

/* Computes the residual that a search aims at, for p relative to the origin: 16 eps of magnitudes relative to
   the origin, the accuracy of C. */
static inline void ffd_locator_aim(const ffd_locator *locator, const double p[3], double aim[3])
{
    for (int a = 0; a < 3; a++)
        aim[a] = 16 * DBL_EPSILON * (locator->extent[a] + fabs(p[a]));
}

/* The share of the tolerance at which a root is accepted where there may be a better one. The rest is for the
   rounding of C itself, and of u,v,w in the range of the knots, so that the residual is within the tolerance
   when it is computed exactly. */
#define TOLERANCE_SHARE (15.0 / 16)
/* The same where no root is better: on the border, as near as it comes. */
#define BORDER_SHARE (31.0 / 32)

/* Computes the tolerance of p relative to the origin. */
static inline void ffd_locator_tolerance(const ffd_locator *locator, const double p[3], double tolerance[3])
{
    double xyz[3];
    for (int a = 0; a < 3; a++)
        xyz[a] = p[a] + locator->origin[a];
    ffd_world_tolerance(locator, xyz, tolerance);
}

/* Converts u,v,w of the search to the range of the lattice's knots. */
static inline void ffd_locator_report(const ffd_locator *locator, const double local[3], double uvw[3])
{
    for (int a = 0; a < 3; a++)
        uvw[a] = ffd_knots_wrap(&locator->lattice->knots[a],
                                locator->knot_first[a] + local[a] / locator->knot_scale[a]);
}

/* Returns whether |r_a| <= tol_a for each a. */
static inline bool ffd_within_tolerance(const double residual[3], const double tolerance[3])
{
    for (int a = 0; a < 3; a++)
        if (!(residual[a] <= tolerance[a] && residual[a] >= -tolerance[a]))
            return false;
    return true;
}

#endif
