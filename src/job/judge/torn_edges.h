/* torn_edges.h - the torn edges of a mesh that are worth a look. */
#ifndef FFD_JOB_JUDGE_TORN_EDGES_H
#define FFD_JOB_JUDGE_TORN_EDGES_H

#include "base/fail.h"
#include <stddef.h>
#include <stdint.h>

#define TORN_EDGES_MOST ((size_t)5000)

/* An edge that is torn: the end that stays first. */
typedef struct torn_edge {
    uint32_t ends[2];
    double step;
} torn_edge;

/* The torn edges with the largest steps, largest first, each once. */
typedef struct torn_edges {
    torn_edge *list; /* count */
    size_t count, capacity;
} torn_edges;

/* Adds an edge, perhaps again. Those with the smallest steps go where there are too many. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_torn_edges_add(torn_edges *torn, uint32_t stays, uint32_t moves, double step,
                              ffd_error *error);
/* Leaves each edge once, with its largest step, and of these TORN_EDGES_MOST, the largest step first. */
void ffd_torn_edges_thin(torn_edges *torn);

#endif
