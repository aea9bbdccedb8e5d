/* point_run.h - how a call on arrays runs: threads, progress, and the first failure of a tile. */
#ifndef FFD_POINTS_POINT_RUN_H
#define FFD_POINTS_POINT_RUN_H

#include "base/fail.h"
#include "base/system/thread.h"
#include <ffd/points.h>
#include <stdatomic.h>

/* Points that a thread takes at a time. */
#define POINT_TILE ((size_t)4096)

typedef struct point_run {
    ffd_run run; /* threads are at least 1 */
    size_t total;
    size_t passes; /* over all points; default 1 */
    atomic_size_t done;
    atomic_bool stopped;  /* by a failure or by the caller: what is left need not be done */
    bool told;            /* the caller, how far it is: once at least */
    ffd_status *statuses; /* one a thread: of its first failure */
    ffd_error *errors;    /* likewise */
    size_t *tiles;        /* likewise: the tile that failed */
} point_run;

/* Work of tile_function, which may fail. */
typedef ffd_status (*point_function)(void *context, size_t first, size_t count, int worker, ffd_error *error);

/* Reads how the caller wants total points done. end it in every case. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY.
 */
ffd_status ffd_point_run_begin(const ffd_run *callers, size_t total, point_run *run, ffd_error *error);
/* Calls function for all tiles. Returns the failure of the first tile that failed, or FFD_E_CANCELLED. */
ffd_status ffd_point_run_tiles(point_run *run, point_function function, void *context, ffd_error *error);
/* Frees what the run has. */
void ffd_point_run_end(point_run *run);

#endif
