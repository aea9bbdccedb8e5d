/* point_run.h - runs a call on arrays: threads, progress, and the first failure of a tile. */
#ifndef FFD_POINTS_POINT_RUN_H
#define FFD_POINTS_POINT_RUN_H

#include "base/fail.h"
#include "base/system/thread.h"
#include <ffd/points.h>
#include <stdatomic.h>

/* Number of points of a tile. */
#define POINT_TILE ((size_t)4096)

typedef struct point_run {
    ffd_run_options options; /* threads is at least 1 */
    size_t total;
    size_t tile;   /* of so many points; default POINT_TILE */
    size_t passes; /* over all points; default 1 */
    atomic_size_t done;
    atomic_bool stopped;  /* a failure, or the caller cancelled: skip the remaining tiles */
    bool reported;        /* progress was reported at least once */
    ffd_status *statuses; /* for each thread: its first failure */
    ffd_error *errors;    /* for each thread */
    size_t *tiles;        /* for each thread: the tile that failed */
} point_run;

/* As tile_function, but can fail. */
typedef ffd_status (*point_function)(void *context, size_t first, size_t count, int worker, ffd_error *error);

/* Begins a run over total points with the caller's settings. To be ended in every case. Errors:
   FFD_E_ARGUMENT, FFD_E_MEMORY. */
ffd_status ffd_point_run_begin(const ffd_run_options *options, size_t total, point_run *run,
                               ffd_error *error);
/* The same for `total` pieces of work, each of which is a tile. */
ffd_status ffd_point_run_begin_pieces(const ffd_run_options *options, size_t total, point_run *run,
                                      ffd_error *error);
/* Calls function for all tiles. Returns the failure of the lowest tile that failed, or FFD_E_CANCELLED. */
ffd_status ffd_point_run_tiles(point_run *run, point_function function, void *context, ffd_error *error);
/* Frees the memory of a run. */
void ffd_point_run_end(point_run *run);

#endif
