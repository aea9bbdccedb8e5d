/* lattice.h - the control lattice: a trivariate B-spline volume. Each control point has a position and a
   weight at rest, and a position and a weight deformed.

   C(u,v,w) = sum P_ijk R_ijk(u,v,w), R_ijk = h_ijk N_i(u) N_j(v) N_k(w) / sum h N N N (Piegl & Tiller, The
   NURBS Book, 2nd ed., 4.4; src/maths.md 1). Control points are stored with u fastest: index =
   i + size[0]*(j + size[1]*k). */
#ifndef FFD_LATTICE_H
#define FFD_LATTICE_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The greatest degree in any direction; the least is 1. Of a higher one the fold proof could not bound its
 * rounding. */
#define FFD_MAX_DEGREE 14

/* A control lattice. Functions that take a const lattice may run in several threads at once; no other
   function may run on the lattice at that time. */
typedef struct ffd_lattice ffd_lattice;

/* Bytes that the caller owns and must not change or free before the call ends. data NULL: none; size must
   then be 0. The library does not change them; it copies them only if their address is not a multiple of 8.
 */
typedef struct ffd_bytes {
    const void *data;
    size_t size;
} ffd_bytes;

/* A lattice of a job: a file, its text, or an object. */
typedef struct ffd_lattice_source {
    /* The file; "-": standard input. With a text or an object only a name for messages, or NULL, which then
       stands for "lattice N", N from 1. */
    const char *path;
    /* The content of a lattice file. FFD_E_ARGUMENT for a box round named meshes, whose paths are relative to
       the file. */
    ffd_bytes text;
    const ffd_lattice *object; /* or NULL; the job works on a copy, which takes no values for placeholders */
} ffd_lattice_source;

/* Which of the two volumes: that of the control points at rest, or deformed. */
typedef enum ffd_volume { FFD_VOLUME_REST = 0, FFD_VOLUME_DEFORMED = 1 } ffd_volume;

/* Kinds of knot vectors (data/schema/lattice.md 4). */
typedef enum ffd_knots {
    FFD_KNOTS_DEFAULT = 0, /* clamped; closed for v of a cylinder that ffd_lattice_create makes */
    FFD_KNOTS_CLAMPED,     /* ends repeated degree+1 times, domain [0, 1] */
    FFD_KNOTS_OPEN,        /* uniform, scaled to the domain [0, 1], without repeated ends ("unclamped") */
    FFD_KNOTS_UNIFORM,     /* t_i = i/(n+degree), domain [t_degree, t_n] */
    FFD_KNOTS_CLOSED       /* periodic with period 1 */
} ffd_knots;

/* Box: u,v,w along three orthogonal axes. Cylinder: u is the radius, v the angle, w the height. */
typedef enum ffd_lattice_shape { FFD_SHAPE_BOX = 0, FFD_SHAPE_CYLINDER } ffd_lattice_shape;
/* Where control points are along a side of a box: at the Greville abscissae of the knots, so that the rest
   volume is affine; or at equal distances, which needs clamped knots and is not affine. */
typedef enum ffd_spacing { FFD_SPACING_GREVILLE = 0, FFD_SPACING_UNIFORM } ffd_spacing;

/* How ffd_lattice_create makes a lattice. Fill with ffd_lattice_desc_init, then change members. */
typedef struct ffd_lattice_desc {
    size_t struct_size;      /* sizeof(ffd_lattice_desc) in the caller's header */
    ffd_lattice_shape shape; /* default FFD_SHAPE_BOX */
    size_t size[3];          /* control points along u,v,w; default 4,4,4 */
    int degree[3];           /* 1..14, less than size; 0 (default): the smaller of 3 and size-1 */
    ffd_knots knots[3];      /* default FFD_KNOTS_DEFAULT */
    /* Added on both sides, as a fraction of the extent in that direction; >= 0, default 0.05. Box: along x,
       y, z, or along the principal axes. Cylinder: applied to the radius and the height; all three must be
       equal. */
    double margin[3];
    ffd_spacing spacing; /* of a box; default FFD_SPACING_GREVILLE */
    double axis[3];      /* direction of a cylinder's axis, of any length but 0; default 0,0,1 */
    bool principal;      /* box: along the principal axes of the points instead of x,y,z; default false */
} ffd_lattice_desc;

/* Sets desc to defaults. size: sizeof(ffd_lattice_desc) in the caller's header. */
FFD_API void ffd_lattice_desc_init(ffd_lattice_desc *desc, size_t size);

/* Reads a lattice file (JSON; data/schema/lattice.md). The caller destroys *lattice with ffd_lattice_destroy.
   A short file can ask for up to 2^26 control points, which need 5 GB: this function does not limit the
   memory, jobs (ffd/job.h) do. Thread-safe. Errors: FFD_E_IO; FFD_E_INVALID with a line (syntax) or a JSON
   pointer (content); FFD_E_UNSUPPORTED (a later version of the format); FFD_E_MEMORY; FFD_E_LIMIT. */
FFD_API ffd_status ffd_lattice_load(const char *path, ffd_lattice **lattice, ffd_error *error);

/* Destroys the lattice and sets *lattice to NULL. lattice and *lattice may be NULL. */
FFD_API void ffd_lattice_destroy(ffd_lattice **lattice);

/* The value of a placeholder. A lattice file can have {"$": "NAME"} in place of any value in its moves. value
   is JSON ("0.5", "[1, 2, 3]"); text that is not JSON ("x") stands for itself as a string. Both strings
   belong to the caller. */
typedef struct ffd_setting {
    const char *name, *value;
} ffd_setting;

/* As ffd_lattice_load, with count values for the placeholders in the moves. used: count elements, NULL only
   if count is 0. used[i] is set to true if the file has the placeholder of values[i], and is left unchanged
   otherwise. Further errors: FFD_E_INVALID (a placeholder has neither a value nor a default). */
FFD_API ffd_status ffd_lattice_load_set(const char *path, const ffd_setting *values, size_t count, bool *used,
                                        ffd_lattice **lattice, ffd_error *error);

/* As ffd_lattice_load_set, for uses that depend on the rest volume alone, such as u,v,w: placeholders may
   remain without a value. If one does, all moves are left out. */
FFD_API ffd_status ffd_lattice_load_rest(const char *path, const ffd_setting *values, size_t count,
                                         bool *used, ffd_lattice **lattice, ffd_error *error);

/* As ffd_lattice_load, from size bytes of text in memory (no final 0 needed). name stands for the path in
   messages. text is needed during the call only. */
FFD_API ffd_status ffd_lattice_parse(const char *text, size_t size, const char *name, ffd_lattice **lattice,
                                     ffd_error *error);

/* As ffd_lattice_parse, with values for placeholders as in ffd_lattice_load_set, and with what derivatives by
   the placeholders need (ffd_embedding_parameters in ffd/points.h). Further errors: FFD_E_INVALID (a
   placeholder has no value, or stands where there is no derivative: for a text, an index, a seed),
   FFD_E_UNSUPPORTED (a placeholder in the moves of a key). */
FFD_API ffd_status ffd_lattice_parse_set(const char *text, size_t size, const char *name,
                                         const ffd_setting *values, size_t count, bool *used,
                                         ffd_lattice **lattice, ffd_error *error);

/* Returns the number of columns of the derivative by placeholders: one for each number of each placeholder,
   in the order in which the file first uses them. 0 for lattices that are not of ffd_lattice_parse_set.
   Thread-safe. */
FFD_API size_t ffd_lattice_get_column_count(const ffd_lattice *lattice);

/* Returns the name of a column: "S", or "S[1]" for a number of an array, from 0. The caller frees *name with
   ffd_free. Thread-safe. Errors: FFD_E_ARGUMENT (there is no such column), FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_get_column(const ffd_lattice *lattice, size_t column, char **name,
                                          ffd_error *error);

/* A parameter (the declaration of a placeholder) of a lattice file. The library fills it; it is valid during
   the callback only. */
typedef struct ffd_parameter {
    size_t struct_size; /* sizeof(ffd_parameter) in the library: members beyond it do not exist */
    const char *name;
    const char *default_value;  /* JSON; NULL: none */
    const char *unit, *comment; /* NULL: none */
    double min, max;            /* bounds of each number in the value; infinite: no bound */
} ffd_parameter;

/* Receives one parameter. Returns false to end the listing. */
typedef bool (*ffd_parameter_function)(void *user, const ffd_parameter *parameter);

/* Calls function for each parameter that a lattice file declares, in the order of the file, in the calling
   thread. text: size bytes, no final 0 needed. name: for messages. Placeholders need no values. Thread-safe.
   Errors: those of ffd_lattice_parse. */
FFD_API ffd_status ffd_lattice_list_parameters(const char *text, size_t size, const char *name,
                                               ffd_parameter_function function, void *user, ffd_error *error);

/* Makes an undeformed lattice round count points (xyz: 3*count doubles, world units; points that are not
   finite are ignored). The caller destroys *lattice. A direction without extent is widened, so that the
   volume is not empty (src/maths.md 4.2 and 4.3). Thread-safe. Errors: FFD_E_ARGUMENT, FFD_E_INVALID (no
   finite point), FFD_E_MEMORY, FFD_E_LIMIT. */
FFD_API ffd_status ffd_lattice_create(const ffd_lattice_desc *desc, const double *xyz, size_t count,
                                      ffd_lattice **lattice, ffd_error *error);

/* The parts of a lattice as arrays, which are copied. Fill with ffd_lattice_arrays_init, then set size, and
   either rest or the box. */
typedef struct ffd_lattice_arrays {
    size_t struct_size; /* sizeof(ffd_lattice_arrays) in the caller's header */
    size_t size[3];     /* control points along u,v,w; n is their product */
    int degree[3];      /* 1..14, less than size; 0 (default): the smaller of 3 and size-1 */
    ffd_knots knots[3]; /* FFD_KNOTS_DEFAULT is clamped here; closed needs rest */
    /* NULL: the knots of the kind above. Else the size+degree+1 knots in ascending order (equal ones
       allowed); with FFD_KNOTS_CLOSED the size+1 breakpoints of one period. */
    const double *knot_values[3];
    size_t knot_count[3]; /* number of knot_values, to be checked */
    /* 3*n doubles, u fastest, world units: the control points at rest. NULL: control points that fill the
       box, at the Greville abscissae, so that the rest volume is affine. */
    const double *rest;
    double box_min[3], box_max[3]; /* world units, coordinates along axes */
    double axes[9];                /* three orthogonal unit vectors, the axes in rows; all 0 (default): x, y,
                                      z */
    const double *rest_weights;    /* n positive numbers; NULL: all 1 */
} ffd_lattice_arrays;

/* Sets arrays to defaults. size: sizeof(ffd_lattice_arrays) in the caller's header. */
FFD_API void ffd_lattice_arrays_init(ffd_lattice_arrays *arrays, size_t size);

/* Makes an undeformed lattice from arrays. The caller destroys *lattice. Thread-safe. Errors: FFD_E_ARGUMENT,
   FFD_E_INVALID (numbers that are not finite, weights that are not positive, knots that
   data/schema/lattice.md 4 refuses), FFD_E_MEMORY, FFD_E_LIMIT. */
FFD_API ffd_status ffd_lattice_from_arrays(const ffd_lattice_arrays *arrays, ffd_lattice **lattice,
                                           ffd_error *error);

/* Makes an independent copy of a lattice. The caller destroys *copy. Thread-safe. Errors: FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_copy(const ffd_lattice *lattice, ffd_lattice **copy, ffd_error *error);

/* Sets the positions of count deformed control points.
     index  count indices (u fastest), or NULL for 0, 1, ..., count-1; of equal indices the last one counts
     xyz    3*count doubles, world units
   The new positions replace the result of the moves of a lattice file. Each call takes time in proportion to
   the number of all control points, so set many at once. The lattice must have control points
   (ffd_lattice_fit). A failure changes nothing. Not thread-safe: no other thread may use
   the lattice during the call. Errors: FFD_E_ARGUMENT (an index out of range, a lattice without control
   points), FFD_E_INVALID (a number that is not finite or too large), FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_set_points(ffd_lattice *lattice, const size_t *index, size_t count,
                                          const double *xyz, ffd_error *error);

/* As ffd_lattice_set_points, by displacements from the rest positions (3*count doubles, world units). They
   are stored as given: a control point with 0 0 0 moves nothing, to the bit. */
FFD_API ffd_status ffd_lattice_set_offsets(ffd_lattice *lattice, const size_t *index, size_t count,
                                           const double *xyz, ffd_error *error);

/* As ffd_lattice_set_points, for the weights of deformed control points: count positive doubles. */
FFD_API ffd_status ffd_lattice_set_weights(ffd_lattice *lattice, const size_t *index, size_t count,
                                           const double *weights, ffd_error *error);

/* Returns the displacements of the control points, deformed minus rest: 3*size[0]*size[1]*size[2] doubles,
   world units. They belong to the lattice and are valid until it is changed or destroyed. NULL if
   the lattice has no control points yet. Thread-safe. */
FFD_API const double *ffd_lattice_get_offsets(const ffd_lattice *lattice);

/* Sets *knots to the knots of a direction (0, 1, 2 for u, v, w) and returns their number, size+degree+1. A
   closed direction is stored as the equal open one: size+2*degree+1 knots. The knots belong to the lattice.
   Thread-safe. */
FFD_API size_t ffd_lattice_get_knots(const ffd_lattice *lattice, int direction, const double **knots);

/* Returns how many keys the lattice has (data/schema/lattice.md 13): what it is at several times; 0: none, or
   control points were set since. times: filled with their times in seconds, ascending, room for as many; or
   NULL. Thread-safe. */
FFD_API size_t ffd_lattice_get_keys(const ffd_lattice *lattice, double *times);

/* Sets the deformed control points of a lattice with keys to those at a time, in seconds: between two keys
   those between them, before the first key those of the first, after the last those of the last. A lattice
   file is loaded with those of its first key. It may be called again with another time. A failure changes
   nothing. Not thread-safe. Errors: FFD_E_ARGUMENT (a lattice without keys, a time that is not finite),
   FFD_E_INVALID (the moves cannot be done with the values of that time, or placeholders have none),
   FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_set_time(ffd_lattice *lattice, double time, ffd_error *error);

/* Returns the text of a lattice file (data/schema/lattice.md). *text ends with a 0 byte that *size does not
   count; the caller frees it with ffd_free. Control points that were set are written as offsets, a lattice
   whose time was set as it is at that time, without keys. Thread-safe. Errors: FFD_E_INVALID (a lattice round
   a mesh without one, between keys that need positions), FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_text(const ffd_lattice *lattice, char **text, size_t *size, ffd_error *error);

/* Frees memory that the library has allocated for the caller, where a comment says so. block may be NULL.
   Thread-safe. */
FFD_API void ffd_free(void *block);

/* Writes a lattice file (data/schema/lattice.md). The file is complete or absent. force: replace an existing
   file. Errors: FFD_E_EXISTS (without force), FFD_E_IO, FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_save(const ffd_lattice *lattice, const char *path, bool force,
                                    ffd_error *error);

/* Returns whether the rest box goes round meshes ("mesh" or {"meshes": [..]}). Such a lattice has no control
   points until ffd_lattice_fit is called; this function returns true before and after that. Thread-safe. */
FFD_API bool ffd_lattice_needs_bounds(const ffd_lattice *lattice);

/* Returns how many meshes the rest box names ({"meshes": [..]}); 0 for "mesh", which stands for the mesh that
   the lattice is used on. Thread-safe. */
FFD_API size_t ffd_lattice_get_mesh_count(const ffd_lattice *lattice);

/* Returns the path of mesh i that the rest box names, resolved relative to the lattice file. The caller frees
 *path with ffd_free. Thread-safe. Errors: FFD_E_ARGUMENT (i is not below ffd_lattice_get_mesh_count),
   FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_get_mesh(const ffd_lattice *lattice, size_t i, char **path, ffd_error *error);

/* Lays the rest box round the bounds min, max (world units), widened by the margin of the file, and applies
   the moves. It may be called again with other bounds. Does nothing if ffd_lattice_needs_bounds is false. A
   failure changes nothing. Not thread-safe. Errors: FFD_E_INVALID (bounds that are not finite, or whose size
   a lattice cannot have), FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_fit(ffd_lattice *lattice, const double min[3], const double max[3],
                                   ffd_error *error);

/* The number of control points, the degree and the domain [lo, hi] along u, v, w; in the range of the knots.
   Each function fills the caller's array. Thread-safe. */
FFD_API void ffd_lattice_get_size(const ffd_lattice *lattice, size_t size[3]);
FFD_API void ffd_lattice_get_degree(const ffd_lattice *lattice, int degree[3]);
FFD_API void ffd_lattice_get_domain(const ffd_lattice *lattice, double lo[3], double hi[3]);

/* Returns the control points of a volume, 3*size[0]*size[1]*size[2] doubles, world units, u fastest. They
   belong to the lattice and are valid until it is changed or destroyed. NULL if the lattice has no control
   points yet. Thread-safe. */
FFD_API const double *ffd_lattice_get_points(const ffd_lattice *lattice, ffd_volume volume);

/* Returns the weights of a volume, one for each control point, or NULL if all are 1. They belong to the
   lattice as above. Thread-safe. */
FFD_API const double *ffd_lattice_get_weights(const ffd_lattice *lattice, ffd_volume volume);

/* Evaluates C(u,v,w) and, unless jacobian is NULL, J = [C_u | C_v | C_w] as 9 doubles, row-major:
   jacobian[3*r+c] = dC_r/du_c. u,v,w outside of the domain is clamped to it; closed directions are taken
   modulo their period. Derivatives at an inner knot are from the right, at the end of the domain from the
   left. Basis functions: The NURBS Book A2.1 to A2.3; rational: 4.4. point and jacobian are NaN if the
   lattice has no control points yet. Thread-safe. */
FFD_API void ffd_lattice_evaluate(const ffd_lattice *lattice, ffd_volume volume, const double uvw[3],
                                  double point[3], double jacobian[9]);

#ifdef __cplusplus
}
#endif

#endif
