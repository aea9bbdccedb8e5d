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
    double weight;          /* 0..1 */
    bool has_at, has_within;
    size_t at_first[3], at_last[3]; /* inclusive, resolved against the size */
    double within_min[3], within_max[3];
    bool has_about;
    double about[3];
    double vector[3];       /* by, to, scale factors, toward */
    double axis[3];         /* unit length */
    double amount;          /* degrees, taper factor */
    double matrix[16];
    char pointer[32];       /* "/moves/3", for messages that need the built points */
} lattice_move;

typedef struct lattice_spec {
    char *name;             /* of the file, for messages */
    size_t size[3];
    int degree[3];
    knot_kind kind[3];
    double *list[3];        /* of the list kinds */
    size_t list_count[3];

    rest_kind rest;
    double box_min[3], box_max[3];
    double box_axes[9];     /* rows are the box's directions; identity where not given */
    bool has_axes;
    ffd_spacing spacing;
    double margin;
    double center[3], axis[3], zero[3], radius[2], height, angle[2];
    double *points;         /* 3*count, SPEC_POINTS */

    double *weights;        /* or NULL */
    double *deformed_points, *deformed_weights; /* or NULL */
    bool box_units;
    lattice_move *moves;
    size_t move_count;
} lattice_spec;

/* Reads the JSON text of interface 3. Errors as ffd_lattice_parse. */
ffd_status ffd_spec_parse(const char *text, size_t size, const char *name, lattice_spec **spec, ffd_error *error);
/* The file's text for a spec (a final line break, no final 0 needed): NULL when there is no memory. */
char *ffd_spec_text(const lattice_spec *spec, size_t *size);
void ffd_spec_free(lattice_spec *spec);

/* Builds knots, control points, moves. bounds (min, max) are used by SPEC_BOX_MESH and may be NULL else.
   The lattice takes the spec over on success. */
ffd_status ffd_spec_build(lattice_spec *spec, ffd_lattice *lattice, const double *min, const double *max,
                          ffd_error *error);

/* shapes.c: the rest control points (3*count) of a box (its sides along box_axes) and of a cylinder. */
void ffd_shape_box(const ffd_lattice *lattice, const double min[3], const double max[3], const double axes[9],
                   ffd_spacing spacing, double *points);
ffd_status ffd_shape_cylinder(const ffd_lattice *lattice, const lattice_spec *spec, double *points,
                              ffd_error *error);

/* moves.c: applies the spec's moves to lattice->deformed. */
ffd_status ffd_moves_apply(const lattice_spec *spec, ffd_lattice *lattice, ffd_error *error);

#endif
