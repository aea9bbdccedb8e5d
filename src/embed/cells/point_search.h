/* point_search.h - the state of the search for one point. Only memory is reused from one point to the next,
   so results do not depend on other points. */
#ifndef FFD_EMBED_CELLS_POINT_SEARCH_H
#define FFD_EMBED_CELLS_POINT_SEARCH_H

#include "embed/cells/brick.h"
#include "embed/cells/cell_locator.h"
#include "embed/cells/roots.h"
#include <stddef.h>

/* The most bricks that the search for a point visits. */
#define SEARCH_BRICKS 4096
/* The most stalled iterations that are distinguished for a point. */
#define MOST_STALLS 8

struct search_scratch {
    struct many_scratch *many; /* search_many.c */
    double *slots;             /* coefficients for the halvings of a hard leaf */
    double *columns;           /* scratch memory of the contraction bound */
    own_bricks own;
};

typedef struct point_search {
    const ffd_locator *locator;
    double x[3];                 /* the point, in the search's units */
    double tolerance[3], aim[3]; /* allowed residual of a root, and the residual that the search aims at */
    double slack[3];             /* tolerance for tests against hulls */
    search_scratch *scratch;
    bool unresolved; /* in a part of the lattice nothing could be proven */
    bool blurred;    /* a box was not halved any further because of the size of the tolerance's image */
    bool again;      /* a further search for the point, which looks at the shape of that image */
    bool doubtful;   /* a region was left by an estimate that a sliver of the tolerance may contradict */
    bool strict;     /* a further search that leaves regions by proofs only */
    long hard_boxes; /* remaining budget */
    uint32_t bricks; /* number of visited bricks */
    uint32_t evaluations, leaves;
    ffd_status status;
    ffd_error *error;
    int stall_count; /* iterations that ended with neither a root nor a proof that there is none */
    root_list roots;
    root stalls[MOST_STALLS]; /* where they stalled; the first has the least residual */
} point_search;

/* The evaluation at one u,v,w. */
typedef struct sample {
    double equation[3]; /* F = A - x W */
    double residual[3]; /* C - x = F / W */
    double jacobian[9]; /* of F, row-major: by u,v,w, or by t of a region */
    double weight;
} sample;

/* Allocates scratch memory if there is none. Returns false if memory runs out. */
bool ffd_search_scratch_make(search_scratch **scratch);

/* Clears the results; the caller sets the point. Clears members one by one instead of the whole struct: the
   lists, which need not be cleared, are by far its largest part. */
static inline void ffd_search_begin(point_search *search, const ffd_locator *locator)
{
    search->locator = locator;
    search->scratch = NULL;
    search->unresolved = search->blurred = search->again = search->doubtful = search->strict = false;
    search->hard_boxes = 0;
    search->bricks = search->evaluations = search->leaves = 0;
    search->status = FFD_OK;
    search->error = NULL;
    search->stall_count = 0;
    search->roots.count = 0;
}

/* Sets the point, which is relative to the origin. Returns false if it is too far away for the search's
   units. */
bool ffd_search_set_point(point_search *search, const double p[3]);

/* Returns whether a leaf that is not hard can contain the point, by the image of its control points. */
bool ffd_search_image_holds(const point_search *search, const cell_leaf *leaf);

/* Determines the result of the point from the roots found. */
void ffd_search_judge(point_search *search, ffd_location *location);

/* Evaluates at offsets from the starts of the spans. */
void ffd_search_evaluate(point_search *search, const int span[3], const double offset[3], sample *at);

/* Records a stalled iteration. */
void ffd_search_note_stall(point_search *search, const root *stall);

/* Returns the greatest row of |Y| tolerance: the effect on t of an error of C within the tolerance. */
double ffd_image_of_tolerance(const double inverse[9], const double tolerance[3], double weight);

#endif
