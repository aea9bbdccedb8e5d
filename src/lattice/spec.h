/* spec.h - a lattice as its file describes it, before there are control points (freed by destroy.c). */
#ifndef FFD_LATTICE_SPEC_H
#define FFD_LATTICE_SPEC_H

#include "base/memory/intern.h"
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
    MOVE_BEND,
    MOVE_PULL
} move_action;

typedef enum falloff_kind { FALLOFF_NONE, FALLOFF_AXIS, FALLOFF_BALL } falloff_kind;

/* How the weight of a move falls off with the place at rest, in the file's units. */
typedef struct move_falloff {
    falloff_kind kind;
    double axis[3], from, to; /* FALLOFF_AXIS; unit length; from and to differ */
    double raw_axis[3];       /* as the file has it */
    double center[3], radius; /* FALLOFF_BALL; the radius is positive */
} move_falloff;

typedef struct lattice_move {
    move_action action;
    double weight; /* 0..1 */
    bool has_at, has_within;
    size_t at_first[3], at_last[3]; /* inclusive, resolved against the size */
    double within_min[3], within_max[3];
    bool has_about;
    double about[3];
    double vector[3]; /* by (also of a pull), to, scale factors, toward (of unit length, perpendicular to
                         axis) */
    double axis[3];   /* unit length */
    double raw_axis[3], raw_toward[3]; /* as the file has them */
    double amount;                     /* degrees, taper factor */
    double matrix[16];
    double point[3], radius; /* of a pull, in the file's units */
    bool exact;              /* of a bend: as a rational quadratic */
    bool has_mirror;
    int mirror; /* the coordinate that is reflected */
    move_falloff falloff;
    char pointer[32]; /* "/moves/3", for messages that need the built points */
} lattice_move;

/* What the file says of a placeholder's values. */
typedef struct spec_parameter {
    char *name;
    char *value;          /* the default, as JSON; NULL: none */
    char *unit, *comment; /* or NULL */
    double min, max;      /* of each number; infinite where the file has none */
} spec_parameter;

/* A number, or an array of numbers, that moves depend on: a placeholder's value. */
typedef struct spec_variable {
    char *name;
    bool is_array;
    size_t size; /* its numbers; 0: it is something else */
    double *numbers;
} spec_variable;

/* A number of a move that is a factor times a number of a variable. */
typedef struct spec_seed {
    size_t move, offset; /* of the number in the lattice_move, in bytes */
    size_t variable, component;
    double factor;
} spec_seed;

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
    double margin[3]; /* of SPEC_BOX_MESH, in each direction */
    char **meshes;    /* mesh_count files that it goes round, as the lattice file names them; none: the mesh
                         that the lattice is used on */
    size_t mesh_count;
    double center[3], radius[2], height, angle[2]; /* degrees */
    double axis[3], zero[3];                       /* unit vectors, perpendicular */
    double *points;                                /* 3*count, SPEC_POINTS */

    double *weights;                            /* or NULL */
    double *deformed_points, *deformed_weights; /* or NULL */
    double *deformed_offsets;                   /* or NULL; never beside deformed_points */
    spec_parameter *parameters;                 /* parameter_count, in the file's order */
    size_t parameter_count;
    /* Only where the settings ask for them: in the order of their first use, and what comes from them. */
    spec_variable *variables;
    size_t variable_count;
    spec_seed *seeds;
    size_t seed_count;
    bool box_units;
    lattice_move *moves;
    size_t move_count;
    intern_table open; /* names of placeholders without a value; where there are some, there are no moves */
} lattice_spec;

/* Whether a cylinder goes round once: a span of angles that was written in decimals may
   miss 360 by its rounding. */
#define SPEC_TURN_TOLERANCE 1e-9
static inline bool ffd_spec_full_turn(const lattice_spec *spec)
{
    return spec->angle[1] - spec->angle[0] >= 360 - SPEC_TURN_TOLERANCE;
}

/* Whether a move makes weights, and whether one is mirrored. */
static inline bool ffd_spec_has_exact(const lattice_spec *spec)
{
    for (size_t i = 0; i < spec->move_count; i++)
        if (spec->moves[i].exact)
            return true;
    return false;
}

static inline bool ffd_spec_has_mirror(const lattice_spec *spec)
{
    for (size_t i = 0; i < spec->move_count; i++)
        if (spec->moves[i].has_mirror)
            return true;
    return false;
}

/* Values of placeholders, and which of them a file had a placeholder for. */
typedef struct spec_settings {
    const ffd_setting *values; /* count */
    bool *used;                /* likewise; marked, never cleared */
    size_t count;
    bool may_be_open; /* where a placeholder has no value, the moves are left out instead of refused */
    bool derives; /* the spec is to say what comes from placeholders: FFD_E_INVALID for one that is no number
                   */
} spec_settings;

#define SPEC_FORMAT "ffd-lattice"
#define SPEC_VERSION 1

/* NULL is allowed. */
void ffd_spec_free(lattice_spec *spec);

#endif
