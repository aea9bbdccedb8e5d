/* thread.h - divides work into fixed tiles for several threads. */
#ifndef FFD_BASE_SYSTEM_THREAD_H
#define FFD_BASE_SYSTEM_THREAD_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A callback for the tile with the index `tile`, items [begin, end). worker is 0..threads-1, to select
   scratch memory. */
typedef void (*tile_function)(void *context, size_t tile, size_t begin, size_t end, int worker);

/* Calls function once for every tile of tile_size items (the last may be smaller). Tiles do not depend on the
   number of threads, and a callback must write only to its own items, so results do not depend on it either.
   Uses fewer threads if some cannot be started. Threads take tiles in ascending order, and each ends one
   before its next, so that a callback may wait for tiles before its own. */
void ffd_parallel_tiles(size_t count, size_t tile_size, int threads, tile_function function, void *context);

/* The same, and then calls `finish` for each tile with the same arguments: one tile at a time, in ascending
   order, in any thread, while other threads process later tiles. Here worker is 0..ffd_ordered_slots-1 and
   selects memory that a tile keeps until it is finished. Returns false if memory runs out, before any
   call. */
bool ffd_parallel_in_order(size_t count, size_t tile_size, int threads, tile_function function,
                           tile_function finish, void *context);
/* Returns the number of values of `worker` in ffd_parallel_in_order. */
int ffd_ordered_slots(int threads);

/* Lets other threads go on, while this one waits for what they do. */
void ffd_thread_yield(void);

/* Checks a number of threads that a caller wants; 0: that of the processors. Errors: FFD_E_ARGUMENT (it is
   negative). */
ffd_status ffd_threads_check(int wanted, ffd_error *error);
/* Returns the number that a caller wants, or that of the processors (processors.h) if it is 0, but at most
   the number of pieces of work and at least 1. A single piece does not count the processors: to read their
   limits takes as long as a tenth of a small job. */
int ffd_threads_for(int wanted, uint64_t pieces);
/* The same for text or data of this many bytes: to start a thread takes longer than to read a small piece. */
int ffd_threads_for_bytes(int wanted, uint64_t bytes);

#endif
