/* spec.h - the content of a lattice file, from which a lattice is built (freed by destroy.c). */
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
    MOVE_PULL,
    MOVE_DRAG,
    MOVE_JITTER
} move_action;

/* Of the lengths and positions in moves: of the world, or fractions of the rest region's sides, or of the
   bounds of the mesh that the box goes round. */
typedef enum lattice_units { UNITS_WORLD, UNITS_BOX, UNITS_MESH } lattice_units;

typedef enum falloff_kind { FALLOFF_NONE, FALLOFF_AXIS, FALLOFF_BALL } falloff_kind;

/* How the weight of a move depends on the rest position, in the units of the file. */
typedef struct move_falloff {
    falloff_kind kind;
    double axis[3], from, to; /* FALLOFF_AXIS; axis has unit length, from != to */
    double raw_axis[3];       /* as the file has it */
    double center[3], radius; /* FALLOFF_BALL; radius > 0 */
} move_falloff;

/* The plane of a mirrored move: none, through the middle of the rest points, at a coordinate along its
   normal, through a point. */
typedef enum mirror_kind { MIRROR_NONE, MIRROR_MIDDLE, MIRROR_AT, MIRROR_POINT } mirror_kind;

/* In the units of the file. */
typedef struct move_mirror {
    mirror_kind kind;
    double normal[3]; /* unit length; of MIRROR_MIDDLE a coordinate axis */
    double at, point[3];
} move_mirror;

/* A place that a drag takes along, in the units of the file. */
typedef struct spec_drag {
    double point[3], by[3];
    size_t line; /* of the point in the file, for messages */
} spec_drag;

typedef struct lattice_move {
    move_action action;
    double weight; /* 0..1 */
    bool has_at, has_within;
    size_t at_first[3], at_last[3]; /* inclusive ranges of indices, not negative */
    double within_min[3], within_max[3];
    bool has_about;
    double about[3];
    double vector[3]; /* by (also of a pull), to, scale factors, sigma of a jitter, or toward (unit length,
                         perpendicular to axis) */
    double axis[3];   /* unit length */
    double raw_axis[3], raw_toward[3]; /* as the file has them */
    double amount;                     /* degrees, taper factor */
    double seed;                       /* of a jitter: a whole number from 0 to NOISE_MOST_SEED */
    double matrix[16];
    double point[3], radius; /* of a pull, in the units of the file; the radius also of a drag, 0: none */
    spec_drag *drags;        /* drag_count of the spec's */
    size_t drag_count;
    bool exact; /* of a bend: with rational quadratic arcs */
    move_mirror mirror;
    move_falloff falloff;
    char pointer[48]; /* "/moves/3", "/keys/1/moves/3", for messages when the moves are applied; */
    size_t line;      /* its line; 0: unknown */
} lattice_move;

/* The declaration of a placeholder. */
typedef struct spec_parameter {
    char *name;
    char *value;          /* default as JSON; NULL: none */
    char *unit, *comment; /* or NULL */
    double min, max;      /* bounds of each number; infinite: none */
} spec_parameter;

/* The value of a placeholder, a number or an array of numbers, as an independent variable of derivatives. */
typedef struct spec_variable {
    char *name;
    bool is_array;
    size_t size; /* number of its numbers; 0: not numeric */
    double *numbers;
} spec_variable;

/* A number of a move that equals a factor times a number of a variable. */
typedef struct spec_seed {
    bool is_dragged;     /* a number of a spec_drag: then move is the index of that */
    size_t move, offset; /* offset of the number in the lattice_move or the spec_drag, in bytes */
    size_t variable, component;
    double factor;
} spec_seed;

/* What the keys of a file give at their times: control points, as offsets or by moves of their own; or values
   of placeholders in the moves of the file. */
typedef enum keys_kind { KEYS_NONE, KEYS_POINTS, KEYS_VALUES } keys_kind;

/* A key. Each has one of the three: offsets, moves (which may be none), values. */
typedef struct spec_key {
    double time;     /* seconds */
    double *offsets; /* 3*count of the spec */
    lattice_move *moves;
    size_t move_count;
    spec_drag *drags; /* of all its moves */
    size_t drag_count;
    char **values; /* JSON, for each of the names */
} spec_key;

/* A placeholder and its value as JSON. */
typedef struct spec_value {
    char *name, *value;
} spec_value;

/* The keys of a file, in ascending order of their times. */
typedef struct spec_keys {
    keys_kind kind;
    spec_key *list; /* count, at least 2 */
    size_t count;
    double time;    /* that the moves of the spec, and the lattice that is built, are those of */
    bool is_chosen; /* by the user; else it is that of the first key */
    /* Of KEYS_VALUES: */
    char **names; /* name_count placeholders, of which each key has a value */
    size_t name_count;
    spec_value *others; /* other_count values of the other placeholders, of which some may not be used */
    size_t other_count;
    char *moves; /* the moves of the file, as JSON with placeholders */
    size_t moves_line;
} spec_keys;

typedef struct lattice_spec {
    char *name; /* path of the file, for messages */
    size_t size[3];
    size_t count; /* size[0]*size[1]*size[2], at most FFD_MAX_CONTROL_POINTS */
    int degree[3];
    knot_kind kind[3];
    double *list[3]; /* for the list kinds */
    size_t list_count[3];

    rest_kind rest;
    double box_min[3], box_max[3];
    double box_axes[9]; /* directions of the box in rows; default: identity */
    bool has_axes;
    ffd_spacing spacing;
    double margin[3]; /* of SPEC_BOX_MESH, for each direction */
    char **meshes;    /* mesh_count paths of the meshes that the box goes round, as in the lattice file; none:
                         the mesh that the lattice is used on */
    size_t mesh_count;
    double center[3], radius[2], height, angle[2]; /* degrees */
    double axis[3], zero[3];                       /* unit vectors, perpendicular */
    double *points;                                /* 3*count, SPEC_POINTS */

    double *weights;                            /* or NULL */
    double *deformed_points, *deformed_weights; /* or NULL */
    double *deformed_offsets;                   /* may be NULL; never together with deformed_points */
    spec_parameter *parameters;                 /* parameter_count, in the order of the file */
    size_t parameter_count;
    /* Only if the settings request derivatives: the variables in the order of their first use, and the
       numbers of the moves that come from them. */
    spec_variable *variables;
    size_t variable_count;
    spec_seed *seeds;
    size_t seed_count;
    lattice_units units;
    /* Lines of members of the file, for messages when the lattice is built; 0: unknown. */
    size_t knots_line[3], rest_line, units_line;
    lattice_move *moves;
    size_t move_count;
    spec_drag *drags; /* of all moves */
    size_t drag_count;
    spec_keys keys;
    intern_table open; /* names of placeholders without a value; if there are any, there are no moves */
} lattice_spec;

/* Returns whether a cylinder makes a full turn. An angle written in decimals may differ from 360 by
   rounding. */
#define SPEC_TURN_TOLERANCE 1e-9
static inline bool ffd_spec_full_turn(const lattice_spec *spec)
{
    return spec->angle[1] - spec->angle[0] >= 360 - SPEC_TURN_TOLERANCE;
}

/* Returns one of the lists of moves: 0 is that of the file, i that of key i, from 1. */
static inline const lattice_move *ffd_spec_moves(const lattice_spec *spec, size_t list, size_t *count)
{
    *count = list > 0 ? spec->keys.list[list - 1].move_count : spec->move_count;
    return list > 0 ? spec->keys.list[list - 1].moves : spec->moves;
}

/* Returns whether a move in any of the lists has a trait. */
static inline bool ffd_spec_any_move(const lattice_spec *spec, bool (*has)(const lattice_move *move))
{
    for (size_t list = 0; list <= spec->keys.count; list++) {
        size_t count;
        const lattice_move *const moves = ffd_spec_moves(spec, list, &count);
        for (size_t i = 0; i < count; i++)
            if (has(&moves[i]))
                return true;
    }
    return false;
}

static inline bool ffd_move_is_exact(const lattice_move *move)
{
    return move->exact;
}

/* Returns whether a move adds weights (an exact bend). */
static inline bool ffd_spec_has_exact(const lattice_spec *spec)
{
    return ffd_spec_any_move(spec, ffd_move_is_exact);
}

/* Returns whether the weight of a move depends on positions: its mirror image then acts on the same points.
 */
static inline bool ffd_move_weighs_places(const lattice_move *move)
{
    return move->action == MOVE_PULL || move->falloff.kind != FALLOFF_NONE;
}

/* Returns whether a move looks for the mirror images of control points. */
static inline bool ffd_move_finds_images(const lattice_move *move)
{
    return move->mirror.kind != MIRROR_NONE && !ffd_move_weighs_places(move);
}

/* Returns whether one of the moves does. */
static inline bool ffd_spec_finds_images(const lattice_spec *spec)
{
    return ffd_spec_any_move(spec, ffd_move_finds_images);
}

/* Values for placeholders, and whether the file has these placeholders. */
typedef struct spec_settings {
    const ffd_setting *values; /* count */
    bool *used;                /* count flags; set to true, never to false */
    size_t count;
    size_t keyed; /* so many at the end are of keys: they are not variables, and their bounds hold already */
    const double *time; /* of a still of keys; NULL: that of the first key */
    bool may_be_open;   /* if a placeholder has no value, leave out the moves instead of failing */
    bool derives; /* record what derivatives by placeholders need; FFD_E_INVALID for a placeholder that is not
                     numeric */
} spec_settings;

#define SPEC_FORMAT "ffd-lattice"
#define SPEC_VERSION 1

/* Frees a spec; NULL is allowed. */
void ffd_spec_free(lattice_spec *spec);
/* Frees keys, and leaves none. */
void ffd_keys_free(spec_keys *keys);

#endif
