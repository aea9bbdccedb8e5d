/* tear_cut.h - finds where the displacement jumps along edges, and how far: edges are cut again and again
   where the displacement changes more than its derivative says. Both ends move, or what moves one goes on to
   the other. */
#ifndef FFD_JOB_MEASURE_TEAR_CUT_H
#define FFD_JOB_MEASURE_TEAR_CUT_H

#include "job/measure/tear_field.h"

/* A step counts above this part of its edge's length. */
#define TORN 1e-3

/* The largest jump along an edge. */
typedef struct tear_step {
    double length;
    ffd_tear_cause cause;
} tear_step;

/* The most edges at once. */
#define CUT_RUN ((size_t)256)

typedef struct tear_cuts tear_cuts; /* scratch memory of a thread */

/* Returns NULL if memory runs out. */
tear_cuts *ffd_tear_cuts_make(void);
/* Accepts NULL. */
void ffd_tear_cuts_free(tear_cuts *cuts);
/* The scratch memory for places, which is free between calls. */
field_scratch *ffd_tear_cuts_scratch(const tear_cuts *cuts);

/* Finds the steps of at most CUT_RUN edges between vertices of faces, the first end in the upper 32 bits. A
   step of 0: no jump above a quarter of what counts was found. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_tear_cut(const tear_field *field, const uint64_t *edges, size_t count, tear_step *steps,
                        tear_cuts *cuts, ffd_error *error);

/* Clips the segment start + t along, t in 0 .. 1, to a lattice's volume if it is a box, else to the bounds of
   its control points. Returns whether it meets that. */
bool ffd_link_clip(const chain_link *link, const double start[3], const double along[3], double *from,
                   double *to);

/* Whether the displacement along an edge may jump, by those of its ends and their derivatives: it changes
   otherwise than a curve with these ends would, by more than a quarter of what counts. along: from end to
   end. */
bool ffd_tear_may_jump(const double along[3], const double *const delta[2], const double *const gradient[2]);

#endif
