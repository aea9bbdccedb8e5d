/* spec.h - a lattice as its file describes it, before there are control points. */
#ifndef FFD_LATTICE_SPEC_H
#define FFD_LATTICE_SPEC_H

#include "spline/knots.h"
#include <ffd/lattice.h>

typedef enum rest_kind { SPEC_BOX, SPEC_BOX_MESH, SPEC_CYLINDER, SPEC_POINTS } rest_kind;

typedef enum move_action {
    MOVE_BY,
    MOVE_TO,
    MOVE_SCALE,
    MOVE_ROTATE,
    MOVE_MATRIX,
    MOVE_TWIST,
    MOVE_TAPER,
    MOVE_BEND
} move_action;

typedef struct lattice_move {
    move_action action;
    double weight; /* 0..1 */
    bool has_at, has_within;
    size_t at_first[3], at_last[3]; /* inclusive, resolved against the size */
    double within_min[3], within_max[3];
    bool has_about;
    double about[3];
    double vector[3]; /* by, to, scale factors, toward (of unit length, perpendicular to axis) */
    double axis[3];   /* unit length */
    double amount;    /* degrees, taper factor */
    double matrix[16];
    char pointer[32]; /* "/moves/3", for messages that need the built points */
} lattice_move;

typedef struct lattice_spec {
    char *name; /* of the file, for messages */
    size_t size[3];
    size_t count; /* size[0]*size[1]*size[2], at most FFD_MAX_CONTROL_POINTS */
    int degree[3];
    knot_kind kind[3];
    double *list[3]; /* of the list kinds */
    size_t list_count[3];

    rest_kind rest;
    double box_min[3], box_max[3];
    double box_axes[9]; /* rows are the box's directions; identity where not given */
    bool has_axes;
    ffd_spacing spacing;
    double margin;
    double center[3], radius[2], height, angle[2]; /* degrees */
    double axis[3], zero[3];                       /* unit vectors, perpendicular */
    double *points;                                /* 3*count, SPEC_POINTS */

    double *weights;                            /* or NULL */
    double *deformed_points, *deformed_weights; /* or NULL */
    bool box_units;
    lattice_move *moves;
    size_t move_count;
} lattice_spec;

/* Whether a cylinder goes round once: a span of angles that was written in decimals may miss 360 by its
 * rounding. */
#define SPEC_TURN_TOLERANCE 1e-9
static inline bool ffd_spec_full_turn(const lattice_spec *spec)
{
    return spec->angle[1] - spec->angle[0] >= 360 - SPEC_TURN_TOLERANCE;
}

/* Values of placeholders, and which of them a file had a placeholder for. */
typedef struct spec_settings {
    const ffd_setting *values; /* count */
    bool *used;                /* likewise; marked, never cleared */
    size_t count;
} spec_settings;

#define SPEC_FORMAT "ffd-lattice"
#define SPEC_VERSION 1

/* The file's text for a spec (a final line break, no final 0 needed): NULL when there is no memory. */
char *ffd_spec_text(const lattice_spec *spec, size_t *size);
void ffd_spec_free(lattice_spec *spec);

/* Makes the lattice: knots, control points, moves. min, max are the bounds of the mesh for SPEC_BOX_MESH;
   without them (NULL) such a lattice gets only its knots. Errors name the file and the place in it. On
   success the lattice owns the spec; on failure the spec is still the caller's. */
ffd_status ffd_spec_build(lattice_spec *spec, const double *min, const double *max, ffd_lattice **lattice,
                          ffd_error *error);

/* The region that "units": "box" refers to: position = origin + sum_a fraction_a * (column a of frame).
   A box: its lower corner and its sides. A cylinder: the bounds along x,y,z of the whole solid cylinder (all
   round, whatever its angles). Points: the bounds along x,y,z of the rest points. */
typedef struct rest_region {
    double origin[3], frame[9];
} rest_region;

/* shapes.c: a box grown by margin on every side, as a fraction of the side; sides of no length are widened
   first, so that the volume is not empty. FFD_E_INVALID where the result is not finite. */
ffd_status ffd_shape_grow_box(const double min[3], const double max[3], double margin, double grown_min[3],
                              double grown_max[3], ffd_error *error);
/* The region of a box from min to max along axes (rows). */
void ffd_shape_box_region(const double min[3], const double max[3], const double axes[9],
                          rest_region *region);
/* Whether the curve starts and ends in its first and last control points: presets and lists alike. */
bool ffd_shape_is_clamped(const knot_vector *knots);
/* Where control point i stands between the domain's ends along one direction: 0 and 1 at the ends of the
   domain, with Greville spacing (g_i - t_d)/(t_n - t_d), so that linear maps of it are exact. */
double ffd_shape_fraction(const knot_vector *knots, size_t point, ffd_spacing spacing);
/* from + fraction (to - from), exact at both ends and symmetric. */
static inline double ffd_shape_between(double from, double to, double fraction)
{
    const double length = to - from;
    return fraction <= 0.5 ? from + fraction * length : to - (1 - fraction) * length;
}
/* The control points (3*count) of a box along axes (rows). */
ffd_status ffd_shape_box(const ffd_lattice *lattice, const double min[3], const double max[3],
                         const double axes[9], ffd_spacing spacing, double *points, ffd_error *error);
/* cylinder.c: the control points of the spec's cylinder. */
ffd_status ffd_shape_cylinder(const ffd_lattice *lattice, const lattice_spec *spec, double *points,
                              ffd_error *error);
void ffd_shape_cylinder_region(const lattice_spec *spec, rest_region *region);

/* moves.c: applies the spec's moves to lattice->deformed. */
ffd_status ffd_moves_apply(const lattice_spec *spec, const rest_region *region, ffd_lattice *lattice,
                           ffd_error *error);

#endif
