/* thread.h - work on fixed tiles by several threads. */
#ifndef FFD_BASE_SYSTEM_THREAD_H
#define FFD_BASE_SYSTEM_THREAD_H

#include <stdbool.h>
#include <stddef.h>

/* A callback for tile `tile` = items [begin, end). worker is 0 .. threads-1, for scratch memory. */
typedef void (*tile_function)(void *context, size_t tile, size_t begin, size_t end, int worker);

/* Calls function once for every tile of tile_size items (the last may be smaller). Tiles are the same
   whatever the number of threads; each must write only what belongs to it. Works with fewer threads if
   some cannot be started. */
void ffd_parallel_tiles(size_t count, size_t tile_size, int threads, tile_function function, void *context);

/* The same; and calls `finish` for each tile with the same arguments, one at a time in their order, by any
   thread, while other threads go on with later tiles. worker is 0 .. ffd_ordered_slots - 1 here, for what a
   tile keeps until it is finished. Returns false if memory runs out; nothing is called then. */
bool ffd_parallel_in_order(size_t count, size_t tile_size, int threads, tile_function function,
                           tile_function finish, void *context);
/* How many values `worker` has in ffd_parallel_in_order. */
int ffd_ordered_slots(int threads);

/* The number of processors that are switched on, at least 1. */
int ffd_processor_count(void);

#endif
