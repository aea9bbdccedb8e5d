/* format_spec.h - what readers of formats share: what the caller wishes, and the spec that they fill.
   Declares format_spec.c and grid_order.c. */
#ifndef FFD_LATTICE_FORMATS_FORMAT_SPEC_H
#define FFD_LATTICE_FORMATS_FORMAT_SPEC_H

#include "base/fail.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"

/* What a reader has found that its user is told. */
typedef struct format_notes {
    bool found_order; /* of directions, by the points */
    bool is_rounded;  /* its program writes fewer digits than a double has */
} format_notes;

/* What a file does not tell. */
typedef struct format_wish {
    size_t size[3];        /* of points in a row; 0: not given */
    bool size_is_known;    /* a file that tells its size does not refuse this one: it is compared later */
    int degree[3];         /* 0: min(3, n - 1); of a file that has its own FFD_E_ARGUMENT */
    bool finds_order;      /* of points in a row or a grid: which directions they have (ffd_points_order) */
    bool finds_cage_order; /* the same of a cage that does not tell its size */
    const char *block;     /* of a file of several lattices; NULL: not given */
    format_notes *notes;   /* or NULL */
    uint64_t memory, allowed; /* bytes that a lattice may take of those that are allowed; 0: not limited */
} format_wish;

/* Refuses counts of control points that take more memory than is left: short files can ask for any number.
   Errors: FFD_E_LIMIT. */
ffd_status ffd_format_check_memory(const size_t size[3], const char *name, const format_wish *wish,
                                   ffd_error *error);
/* Refuses a size that no lattice of such a file has, or that memory. Errors: FFD_E_INVALID for a direction of
   one control point, which has no extent; FFD_E_LIMIT. */
ffd_status ffd_format_check_size(const size_t size[3], const char *name, const format_wish *wish,
                                 ffd_error *error);
/* Begins a spec of this size with clamped uniform knots and control points to be filled in. The caller frees
 *spec. Errors: as above, and FFD_E_MEMORY. */
ffd_status ffd_format_begin(const size_t size[3], const char *name, const format_wish *wish,
                            lattice_spec **spec, ffd_error *error);
/* The same with these control points, which it takes: *points is NULL then. */
ffd_status ffd_format_begin_of(const size_t size[3], const char *name, const format_wish *wish,
                               double **points, lattice_spec **spec, ffd_error *error);
/* The degree of a direction that tells none. */
int ffd_format_degree(size_t size);
/* Finds u, v and w of a grid of points, which get the order of a lattice: *points is replaced, and size is
   that along u, v and w. Of all orders and directions in which no cell is turned over or flat, that with u
   nearest to +x, and then v nearest to +y. nests: the counts may be in another order too, the first the
   fastest: that with the nearest neighbours. states: so many grids stand one behind the other, and all get
   the order of the first. Errors: FFD_E_INVALID if there is none, FFD_E_MEMORY. */
ffd_status ffd_points_order(double **points, size_t states, size_t size[3], bool nests, const char *name,
                            const format_wish *wish, ffd_error *error);

#endif
