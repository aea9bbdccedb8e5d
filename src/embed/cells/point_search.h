/* point_search.h - the search for one point: what its parts share. Nothing is carried from one point to the
   next but memory. */
#ifndef FFD_EMBED_CELLS_POINT_SEARCH_H
#define FFD_EMBED_CELLS_POINT_SEARCH_H

#include "embed/cells/brick.h"
#include "embed/cells/cell_locator.h"
#include "embed/cells/roots.h"
#include <stddef.h>

/* Bricks that one point may look into. */
#define SEARCH_BRICKS 4096
/* Iterations without an end that are told apart for one point. */
#define MOST_STALLS 8

struct search_scratch {
    struct many_scratch *many; /* search_many.c */
    double *slots;             /* coefficients of a hard leaf's halvings */
    double *columns;           /* of the contraction bound */
    own_bricks own;
};

typedef struct point_search {
    const ffd_locator *locator;
    double x[3];                 /* the point, in the search's units */
    double tolerance[3], aim[3]; /* what a root may miss it by, and what the search aims at */
    double slack[3];             /* that of hulls */
    search_scratch *scratch;
    bool unresolved; /* a part of the lattice is left in which nothing could be shown */
    long hard_boxes; /* that may still be looked at */
    uint32_t bricks; /* looked into */
    uint32_t evaluations, leaves;
    ffd_status status;
    ffd_error *error;
    int stall_count; /* iterations that ended without a root or a proof that there is none */
    root_list roots;
    root stalls[MOST_STALLS]; /* where they stood still, the first with the least residual */
} point_search;

/* C - x and F's derivatives at one u,v,w. */
typedef struct sample {
    double equation[3]; /* F = A - x W */
    double residual[3]; /* C - x = F / W */
    double jacobian[9]; /* of F, row by row: by u,v,w, or by a region's t */
    double weight;
} sample;

/* Makes the scratch if there is none. Returns false if memory runs out. */
bool ffd_search_scratch_make(search_scratch **scratch);

/* Clears what was found; the caller sets the point. Member by member: the lists are by far the largest, and
   an instruction that clears a block takes longer to begin than these to end. */
static inline void ffd_search_begin(point_search *search, const ffd_locator *locator)
{
    search->locator = locator;
    search->scratch = NULL;
    search->unresolved = false;
    search->hard_boxes = 0;
    search->bricks = search->evaluations = search->leaves = 0;
    search->status = FFD_OK;
    search->error = NULL;
    search->stall_count = 0;
    search->roots.count = 0;
}

/* Sets the point, with the origin subtracted. Returns false if it is too far away for
   the search's doubles. */
bool ffd_search_set_point(point_search *search, const double p[3]);

/* Whether a leaf that is not hard can hold the point, by the image of its control points. */
bool ffd_search_image_holds(const point_search *search, const cell_leaf *leaf);

/* What the roots that were found say. */
void ffd_search_judge(const point_search *search, ffd_location *location);

/* At the offsets from the spans' starts. */
void ffd_search_evaluate(point_search *search, const int span[3], const double offset[3], sample *at);

/* Whether the residual is within what the search aims at. */
bool ffd_search_accepts(const point_search *search, const sample *at, double weight_ratio);

/* Notes where an iteration ended that proved nothing. */
void ffd_search_note_stall(point_search *search, const root *stall);

/* The greatest row of |Y| tolerance: what a rounding of C can do to t. */
double ffd_image_of_tolerance(const double inverse[9], const double tolerance[3], double weight);

#endif
