/* tears.h - counts the torn edges of a mesh (src/maths.md 7.4). */
#ifndef FFD_JOB_MEASURE_TEARS_H
#define FFD_JOB_MEASURE_TEARS_H

#include "base/fail.h"
#include "job/measure/tear_edges.h"
#include "job/measure/torn_edges.h"

typedef struct tear_question {
    tear_mesh mesh;
    /* Those of mesh, changed if some have KEPT_ALWAYS: vertices at one position get equal marks. */
    uint8_t *marks;
    torn_edges *torn; /* gets the edges with the largest steps, in the document's numbers; or NULL */
    int threads;      /* never change the result */
    long long most;   /* evaluations along edges of which both ends move; more are FFD_E_LIMIT */
} tear_question;

typedef struct tear_count {
    uint64_t edges;  /* number of torn edges */
    double largest;  /* largest step; 0 if none is torn */
    uint32_t vertex; /* index in faces of that edge's staying end; of equal steps the lowest */
    ffd_tear_cause cause;
} tear_count;

/* Counts the edges whose step exceeds 1e-3 of their length at rest. Vertices that share a position are one,
   so an edge between two parts counts once. Errors: FFD_E_MEMORY, FFD_E_LIMIT, which leaves in count the
   edges of which one end stays, if those could be counted. */
ffd_status ffd_tears_count(const tear_question *question, tear_count *count, ffd_error *error);

#endif
