/* locator.h - the search structure for one rest lattice (public: ffd/embedding.h). */
#ifndef FFD_EMBED_LOCATOR_H
#define FFD_EMBED_LOCATOR_H

#include "base/fail.h"
#include "base/vector/isa.h"
#include "embed/frame/box_tree.h"
#include "lattice/lattice.h"
#include <ffd/embedding.h>
#include <float.h>

typedef enum locator_method { METHOD_AFFINE, METHOD_SEPARABLE, METHOD_GENERAL } locator_method;

/* C(u,v,w) - origin = frame t, t in [0,1]^3 over the domain (maths.md 5). */
typedef struct affine_map {
    double frame[9], inverse[9];
} affine_map;

/* One direction of a separable lattice: a strictly monotone spline x(u). */
typedef struct monotone_curve {
    double *points;      /* one a basis function, origin subtracted */
    double *breakpoints; /* x at the start of each non-empty span, and at the domain's end: span_count + 1 */
    bool falling;
} monotone_curve;

struct ffd_locator {
    const ffd_lattice *lattice;
    ffd_isa isa;
    locator_method method;
    /* The lattice's knots with the domain's start subtracted, times a power of two that brings the domain's
       side to size 1: far from 0 a parameter would be too coarse to meet the tolerance, and derivatives by
       very long or short parameters leave the range of doubles. Every search is in these; what is reported is
       taken back. */
    knot_vector knots[3];
    double knot_scale[3];
    double origin[3]; /* subtracted from control points and points before anything else */
    double extent[3]; /* max |P_a - origin_a| over the control points */
    affine_map affine;
    monotone_curve curves[3];
    struct cell_search *cells;
};

/* ffd_locator_create with the instructions of the kernels; they change no bit. */
ffd_status ffd_locator_create_for(const ffd_lattice *lattice, ffd_isa isa, ffd_locator **locator,
                                  ffd_error *error);

/* Whether points so far needed what a limit counts (FFD_E_LIMIT): then it has less room for others. */
bool ffd_locator_is_strained(const ffd_locator *locator);

/* tol_a = 16 eps (max|P_a| + |p_a|), p with the origin subtracted (maths.md 6.6). */
static inline void ffd_locator_tolerance(const ffd_locator *locator, const double p[3], double tolerance[3])
{
    for (int a = 0; a < 3; a++)
        tolerance[a] = 16 * DBL_EPSILON * (locator->extent[a] + (p[a] < 0 ? -p[a] : p[a]));
}

/* The search's u,v,w in the lattice's own range. */
static inline void ffd_locator_report(const ffd_locator *locator, const double local[3], double uvw[3])
{
    for (int a = 0; a < 3; a++)
        uvw[a] = ffd_knots_wrap(&locator->lattice->knots[a], ffd_knots_first(&locator->lattice->knots[a]) +
                                                                 local[a] / locator->knot_scale[a]);
}

/* Whether |r_a| <= tol_a for each a. */
static inline bool ffd_within_tolerance(const double residual[3], const double tolerance[3])
{
    for (int a = 0; a < 3; a++)
        if (!(residual[a] <= tolerance[a] && residual[a] >= -tolerance[a]))
            return false;
    return true;
}

/* affine.c. find takes p with the origin subtracted and fills uvw, residual and status of *location. */
bool ffd_affine_detect(ffd_locator *locator);
void ffd_affine_find(const ffd_locator *locator, const double p[3], ffd_location *location);

/* separable.c */
ffd_status ffd_separable_detect(ffd_locator *locator, bool *found, ffd_error *error);
void ffd_separable_free(ffd_locator *locator);
void ffd_separable_find(const ffd_locator *locator, const double p[3], ffd_location *location);

/* cells.c and search.c: the certified cell search. */
typedef struct search_scratch search_scratch; /* of one thread; NULL at first, made when needed */
ffd_status ffd_cells_create(ffd_locator *locator, ffd_error *error);
void ffd_cells_destroy(struct cell_search **cells);
ffd_status ffd_cells_find(const ffd_locator *locator, const double p[3], search_scratch **scratch,
                          ffd_location *location, ffd_error *error);
/* search_many.c: the same for so many points at most; those whose first coordinate is NaN are left alone. */
#define CELLS_AT_ONCE ((size_t)1024)
ffd_status ffd_cells_find_many(const ffd_locator *locator, const double *p, size_t count,
                               search_scratch **scratch, ffd_location *locations, ffd_error *error);
void ffd_search_scratch_free(search_scratch *scratch);

#endif
