/* shape_sample.h - lattices of known shapes: bent, rolled up, twisted, closed on themselves, collapsed,
 * folded.
 */
#ifndef FFD_TESTS_SHAPE_SAMPLE_H
#define FFD_TESTS_SHAPE_SAMPLE_H

#include "volume_sample.h"

typedef enum shape_kind {
    SHAPE_C,
    SHAPE_SPIRAL,       /* rolled up two turns, the turns apart */
    SHAPE_TWIST,        /* a box whose ends are turned by 270 degrees */
    SHAPE_HALF_TORUS,   /* the tube's angle closed, the ring's not */
    SHAPE_TORUS,        /* both closed */
    SHAPE_KINKED,       /* inner knots of the degree's multiplicity */
    SHAPE_OVERLAP,      /* a bar bent past a full turn, det J > 0 (< 0) everywhere */
    SHAPE_FOLD,         /* det J of both signs */
    SHAPE_CYLINDER,     /* from radius 0, the angle closed */
    SHAPE_SECTOR,       /* from radius 0, part of a turn */
    SHAPE_BALL,         /* from radius 0, longitude closed, poles */
    SHAPE_SHELL,        /* a ball from a radius above 0 */
    SHAPE_PYRAMID,      /* a face collapsed to a point */
    SHAPE_PRISM,        /* a face collapsed to an edge */
    SHAPE_QUARTER_TORUS /* rational and exact */
} shape_kind;

/* How a shape's own parameters (across, along, up) lie in the lattice, and where the shape is. */
typedef struct shape {
    shape_kind kind;
    int role[3];                      /* the lattice's direction of each */
    long double turn, radius, across; /* radians; inner radius; what the radius grows by across */
    long double climb;                /* of SHAPE_OVERLAP: so little that two turns are equal in up (1e-9) */
    long double origin[3], frame[9];  /* xyz = origin + frame * local */
} shape;

/* Scale and position of a shape. */
typedef struct shape_setting {
    volume_scale scale;
    bool rotated;
    bool bare; /* in its own coordinates */
} shape_setting;

/* Makes s (its axes, control points and, of the quarter torus, weights) and describes the shape in x. */
void shape_make(shape *x, sample *s, draw *random, shape_kind kind, const shape_setting *setting);

/* The same with the degree of the longest direction given. For SHAPE_C. */
void shape_make_degree(shape *x, sample *s, draw *random, int degree, const shape_setting *setting);

/* Puts u,v,w on a collapsed face; false where the shape has none. */
bool shape_to_collapsed(const shape *x, const sample *s, draw *random, long double uvw[3]);

/* Takes u,v,w to the least one with the same C, by the shape's collapsed faces. Returns whether there are
 * several. */
bool shape_collapse(const shape *x, const sample *s, long double uvw[3]);

/* A full turn (SHAPE_OVERLAP) or torus (SHAPE_TORUS) whose directions are clamped instead of closed, so that
   end faces meet: in the same control points, or in what rounding leaves of them. */
void shape_make_seam(shape *x, sample *s, draw *random, shape_kind kind, const shape_setting *setting,
                     bool same_points);

/* Knots of direction a as a list. */
void shape_list_axis(sample *s, int a, int n, int degree, const double *knots);

enum { SHAPE_TORUS_RADIUS = 3 }; /* of the ring, for SHAPE_*_TORUS */

#endif
