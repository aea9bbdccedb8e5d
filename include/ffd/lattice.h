/* lattice.h - the control lattice: a trivariate B-spline volume with a rest and a deformed position (and
   weight) for each control point.

   C(u,v,w) = sum P_ijk R_ijk(u,v,w), R_ijk = h_ijk N_i(u) N_j(v) N_k(w) / sum h N N N (Piegl & Tiller, The
   NURBS Book, 2nd ed., 4.4). Control points are stored with u fastest: index = i + size[0]*(j + size[1]*k).
 */
#ifndef FFD_LATTICE_H
#define FFD_LATTICE_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FFD_MAX_DEGREE 9

typedef struct ffd_lattice ffd_lattice;

typedef enum ffd_volume { FFD_VOLUME_REST = 0, FFD_VOLUME_DEFORMED = 1 } ffd_volume;

/* Knot vectors that a new lattice can have (the file knows explicit lists too). */
typedef enum ffd_knots {
    FFD_KNOTS_DEFAULT = 0, /* clamped; v of a cylinder: closed */
    FFD_KNOTS_CLAMPED,
    FFD_KNOTS_OPEN,
    FFD_KNOTS_UNIFORM,
    FFD_KNOTS_CLOSED
} ffd_knots;

typedef enum ffd_lattice_shape { FFD_SHAPE_BOX = 0, FFD_SHAPE_CYLINDER } ffd_lattice_shape;
typedef enum ffd_spacing { FFD_SPACING_GREVILLE = 0, FFD_SPACING_UNIFORM } ffd_spacing;

/* How to make a lattice round a set of points. Fill with ffd_lattice_desc_init, then change what differs. */
typedef struct ffd_lattice_desc {
    size_t struct_size; /* sizeof(ffd_lattice_desc) of the caller */
    ffd_lattice_shape shape;
    size_t size[3];     /* control points along u,v,w; default 4,4,4 */
    int degree[3];      /* 1..9, or 0: 3, or size-1 where that is less */
    ffd_knots knots[3]; /* default FFD_KNOTS_DEFAULT */
    double margin[3]; /* added on both sides, as a fraction of the extent there; >= 0, default 0.05; of a box
                         along u, v, w: x, y, z, or its principal axes; of a cylinder, whose radius and height
                         get it, all three are equal */
    ffd_spacing spacing;
    double axis[3]; /* cylinder: its axis, need not be of unit length; default 0,0,1 */
    bool principal; /* box: along the principal axes of the points instead of x,y,z */
} ffd_lattice_desc;

FFD_API void ffd_lattice_desc_init(ffd_lattice_desc *desc, size_t size);

/* Reads a lattice file (JSON; data/schema/lattice.md). On success *lattice is the caller's, to be destroyed.
   A file of one line can have 2^26 control points, which take 5 GB: jobs (ffd/job.h) count them against the
   memory of their input before they are made, and this function does not. Errors: FFD_E_IO; FFD_E_INVALID
   with line (syntax) or JSON pointer (meaning); FFD_E_MEMORY, FFD_E_LIMIT. */
FFD_API ffd_status ffd_lattice_load(const char *path, ffd_lattice **lattice, ffd_error *error);

/* The value of a placeholder: a lattice file can have {"$": "NAME"} in place of any value within its moves.
   value is JSON ("0.5", "[1, 2, 3]"), or else a text ("x"). */
typedef struct ffd_setting {
    const char *name, *value;
} ffd_setting;

/* The same with values for the placeholders of the file's moves. used (count, NULL only where count is 0):
   set to true for those that the file has; the others are left as they are. Errors also: FFD_E_INVALID for a
   placeholder without a value. */
FFD_API ffd_status ffd_lattice_load_set(const char *path, const ffd_setting *values, size_t count, bool *used,
                                        ffd_lattice **lattice, ffd_error *error);

/* The same for what depends on the rest alone, as u,v,w does: a placeholder without a value is no failure;
   all moves are then left out. */
FFD_API ffd_status ffd_lattice_load_rest(const char *path, const ffd_setting *values, size_t count,
                                         bool *used, ffd_lattice **lattice, ffd_error *error);

/* The same as ffd_lattice_load from memory: text of size bytes (no final 0 needed); messages use
   name. text is not kept. */
FFD_API ffd_status ffd_lattice_parse(const char *text, size_t size, const char *name, ffd_lattice **lattice,
                                     ffd_error *error);

/* A placeholder's parameter, as a lattice file declares it; valid during the call. */
typedef struct ffd_parameter {
    size_t struct_size; /* of the library's: members beyond are later ones */
    const char *name;
    const char *default_value;  /* as JSON; NULL: there is none */
    const char *unit, *comment; /* NULL: there is none */
    double min, max;            /* of each number of the value; infinite: no bound */
} ffd_parameter;

/* Takes one parameter; false ends the listing. */
typedef bool (*ffd_parameter_function)(void *user, const ffd_parameter *parameter);

/* Lists the parameters of a lattice file's text (size bytes; no final 0 needed) in its order. Errors: those
   of ffd_lattice_parse, but for placeholders without values. Thread-safe. */
FFD_API ffd_status ffd_lattice_list_parameters(const char *text, size_t size, const char *name,
                                               ffd_parameter_function function, void *user, ffd_error *error);

/* Makes an undeformed lattice that covers count points (xyz: 3*count doubles, world units).
   Extents of 0 are widened, so that the volume is not empty. Errors: FFD_E_ARGUMENT, FFD_E_INVALID (no finite
   point), FFD_E_MEMORY, FFD_E_LIMIT. */
FFD_API ffd_status ffd_lattice_create(const ffd_lattice_desc *desc, const double *xyz, size_t count,
                                      ffd_lattice **lattice, ffd_error *error);

/* What a lattice is made of, as arrays, which are copied. Fill with ffd_lattice_arrays_init, then set size
   and rest or the box. */
typedef struct ffd_lattice_arrays {
    size_t struct_size; /* sizeof(ffd_lattice_arrays) of the caller */
    size_t size[3];     /* control points along u,v,w, n in all; at least degree+1 each */
    int degree[3];      /* 1..9, or 0: 3, or size-1 where that is less */
    ffd_knots knots[3]; /* default FFD_KNOTS_DEFAULT, which is clamped here */
    /* Not NULL: the knots themselves, size+degree+1 of them, not falling; with FFD_KNOTS_CLOSED the size+1
       breakpoints of one period. */
    const double *knot_values[3];
    size_t knot_count[3]; /* of knot_values */
    const double *rest; /* 3*n, u fastest: the control points at rest, world units. NULL: those of the box, at
                           the Greville abscissae, so that the map is affine. */
    double box_min[3], box_max[3]; /* along the axes */
    double axes[9];             /* three orthogonal unit vectors, row by row; all 0 (the default): x, y, z */
    const double *rest_weights; /* n, positive; NULL: all 1 */
} ffd_lattice_arrays;

/* Fills arrays, of which the caller knows size bytes (sizeof(ffd_lattice_arrays)), with defaults. */
FFD_API void ffd_lattice_arrays_init(ffd_lattice_arrays *arrays, size_t size);

/* Makes an undeformed lattice of arrays. Errors: FFD_E_ARGUMENT, FFD_E_INVALID (numbers that are not finite,
   weights that are not positive, knots that data/schema/lattice.md refuses), FFD_E_MEMORY, FFD_E_LIMIT. */
FFD_API ffd_status ffd_lattice_from_arrays(const ffd_lattice_arrays *arrays, ffd_lattice **lattice,
                                           ffd_error *error);

/* Makes a lattice that is equal in all, and independent. Errors: FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_copy(const ffd_lattice *lattice, ffd_lattice **copy, ffd_error *error);

/* Sets deformed control points: count of them, whose numbers (u fastest) are index, or 0, 1, ..., count-1
   where index is NULL. xyz: 3*count doubles, world units. Of a number that occurs twice the last one counts.
   What moves of a file have done is overwritten. Takes time in proportion to all control points: set many at
   once. The lattice must not need bounds, and no other thread may use it meanwhile. Nothing is changed by a
   failure. Errors: FFD_E_ARGUMENT (a number that the lattice does not have, a lattice that needs bounds),
   FFD_E_INVALID (a number that is not finite or too large), FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_set_points(ffd_lattice *lattice, const size_t *index, size_t count,
                                          const double *xyz, ffd_error *error);

/* The same by displacements from the rest positions, which are used as they are: what has 0 0 0 moves
   nothing, to the bit. */
FFD_API ffd_status ffd_lattice_set_offsets(ffd_lattice *lattice, const size_t *index, size_t count,
                                           const double *xyz, ffd_error *error);

/* The same for the weights of deformed control points, count positive doubles. */
FFD_API ffd_status ffd_lattice_set_weights(ffd_lattice *lattice, const size_t *index, size_t count,
                                           const double *weights, ffd_error *error);

/* The displacements of the control points, 3*size[0]*size[1]*size[2] doubles. Lent by the lattice, valid
   until it is changed or destroyed; NULL while ffd_lattice_fit is still needed. */
FFD_API const double *ffd_lattice_get_offsets(const ffd_lattice *lattice);

/* The knots of a direction (0..2: u,v,w), lent by the lattice; returns how many. A closed direction of n
   control points and degree d has those of the equal open one, n + 2 d + 1. */
FFD_API size_t ffd_lattice_get_knots(const ffd_lattice *lattice, int direction, const double **knots);

/* The text of the lattice's file (data/schema/lattice.md), with a final 0 that size does not count. Control
   points that were set are offsets in it. *text is the caller's, freed with ffd_free. Errors: FFD_E_MEMORY.
 */
FFD_API ffd_status ffd_lattice_text(const ffd_lattice *lattice, char **text, size_t *size, ffd_error *error);

/* Frees what functions of this library hand over to be freed by it. NULL is allowed. */
FFD_API void ffd_free(void *block);

/* Writes the lattice as a file (data/schema/lattice.md), complete or not at all. force:
   replace an existing file. */
FFD_API ffd_status ffd_lattice_save(const ffd_lattice *lattice, const char *path, bool force,
                                    ffd_error *error);

/* Whether the rest box goes round meshes ("mesh" or {"meshes": [..]}), so that ffd_lattice_fit must come
   before anything that needs control points. */
FFD_API bool ffd_lattice_needs_bounds(const ffd_lattice *lattice);

/* How many meshes the rest box names ({"meshes": [..]}) to go round, rather than the mesh that the lattice is
   used on. */
FFD_API size_t ffd_lattice_get_mesh_count(const ffd_lattice *lattice);

/* The path of one of them, which the file gives relative to itself. *path is the caller's, freed with
   ffd_free. Errors: FFD_E_ARGUMENT (a number that it has not), FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_get_mesh(const ffd_lattice *lattice, size_t i, char **path, ffd_error *error);

/* Fits a "mesh" lattice around the bounds min, max (3 doubles each, world units) and applies its moves. May
   be called again with other bounds. Does nothing where ffd_lattice_needs_bounds is false. Errors:
   FFD_E_INVALID (bounds that are not finite, or of a size that a lattice cannot have), FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_fit(ffd_lattice *lattice, const double min[3], const double max[3],
                                   ffd_error *error);

/* Frees the lattice and clears the pointer. NULL and pointers to NULL are allowed. */
FFD_API void ffd_lattice_destroy(ffd_lattice **lattice);

/* Shape. Each fills the caller's array. */
FFD_API void ffd_lattice_get_size(const ffd_lattice *lattice, size_t size[3]);
FFD_API void ffd_lattice_get_degree(const ffd_lattice *lattice, int degree[3]);
FFD_API void ffd_lattice_get_domain(const ffd_lattice *lattice, double lo[3], double hi[3]);

/* The 3*size[0]*size[1]*size[2] control points; lent by the lattice, valid until it is changed or destroyed.
   NULL while ffd_lattice_fit is still needed. */
FFD_API const double *ffd_lattice_get_points(const ffd_lattice *lattice, ffd_volume volume);

/* The weights, one a control point, or NULL where all are 1. Lent as above. */
FFD_API const double *ffd_lattice_get_weights(const ffd_lattice *lattice, ffd_volume volume);

/* Evaluates C at u,v,w (in the domain; values outside are taken to its nearest point, closed directions
   modulo their period) and, where jacobian is not NULL, J = [C_u | C_v | C_w] as 9 doubles, row by row:
   jacobian[3*r+c] = dC_r/du_c. At an inner knot the right-hand derivative, at the end of the domain the
   left-hand one. Basis: Piegl & Tiller A2.1 to A2.3; rational: 4.4. All NaN while ffd_lattice_fit is
   still needed. Thread-safe. */
FFD_API void ffd_lattice_evaluate(const ffd_lattice *lattice, ffd_volume volume, const double uvw[3],
                                  double point[3], double jacobian[9]);

#ifdef __cplusplus
}
#endif

#endif
