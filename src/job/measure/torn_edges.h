/* torn_edges.h - the torn edges with the largest steps. */
#ifndef FFD_JOB_MEASURE_TORN_EDGES_H
#define FFD_JOB_MEASURE_TORN_EDGES_H

#include "base/fail.h"
#include <stddef.h>
#include <stdint.h>

#define TORN_EDGES_MOST ((size_t)5000)

/* A torn edge, its staying end first. */
typedef struct torn_edge {
    uint32_t ends[2];
    double step;
} torn_edge;

/* Torn edges, without duplicates, largest step first. */
typedef struct torn_edges {
    torn_edge *list; /* count entries */
    size_t count, capacity;
} torn_edges;

/* Adds an edge, which may be there already. When the list is full, the smallest steps are dropped. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_torn_edges_add(torn_edges *torn, uint32_t stays, uint32_t moves, double step,
                              ffd_error *error);
/* Removes duplicates (keeping the largest step), sorts, and keeps at most TORN_EDGES_MOST edges. */
void ffd_torn_edges_thin(torn_edges *torn);

#endif
