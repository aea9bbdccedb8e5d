/* point_search.h - the search for one point: what its parts share. Nothing is carried from one point to the
   next but memory. */
#ifndef FFD_EMBED_CELLS_POINT_SEARCH_H
#define FFD_EMBED_CELLS_POINT_SEARCH_H

#include "embed/cells/brick.h"
#include "embed/cells/cell_locator.h"
#include "embed/cells/roots.h"
#include <stddef.h>
#include <string.h>

/* Bricks that one point may look into. */
#define SEARCH_BRICKS 4096

struct search_scratch {
    struct many_scratch *many; /* search_many.c */
    double *slots;             /* coefficients of a hard leaf's halvings */
    double *columns;           /* of the contraction bound */
    own_bricks own;
};

typedef struct point_search {
    const ffd_locator *locator;
    double x[3], tolerance[3]; /* the point, in the search's units, and its tolerance there */
    double slack[3];           /* that of hulls */
    search_scratch *scratch;
    bool unresolved; /* a part of the lattice is left in which nothing could be shown */
    long hard_boxes; /* that may still be looked at */
    uint32_t bricks; /* looked into */
    uint32_t evaluations, leaves;
    ffd_status status;
    ffd_error *error;
    root_list roots; /* the last: see ffd_search_begin */
} point_search;

/* C - x and F's derivatives at one u,v,w. */
typedef struct sample {
    double equation[3]; /* F = A - x W */
    double residual[3]; /* C - x = F / W */
    double jacobian[9]; /* of F, row by row: by u,v,w, or by a region's t */
    double weight;
} sample;

/* Makes the scratch where there is none; false: no memory. */
bool ffd_search_scratch_make(search_scratch **scratch);

/* Nothing is found. The memory of roots, which are more than all else, is left as it is. */
static inline void ffd_search_begin(point_search *search, const ffd_locator *locator)
{
    memset(search, 0, offsetof(point_search, roots));
    search->roots.count = 0;
    search->locator = locator;
}

/* Sets the point, with the origin subtracted. False where it is farther away than the search's doubles reach.
 */
bool ffd_search_set_point(point_search *search, const double p[3]);

/* Whether a leaf that is not hard can hold the point, by the image of its control points. */
bool ffd_search_image_holds(const point_search *search, const cell_leaf *leaf);

/* What the roots that were found say. */
void ffd_search_judge(const point_search *search, ffd_location *location);

/* At the offsets from the spans' starts. */
void ffd_search_evaluate(point_search *search, const int span[3], const double offset[3], sample *at);

/* Whether the residual is within the tolerance. */
bool ffd_search_accepts(const point_search *search, const sample *at, double weight_ratio);

/* The greatest row of |Y| tolerance: what a rounding of C can do to t. */
double ffd_image_of_tolerance(const double inverse[9], const double tolerance[3], double weight);

#endif
