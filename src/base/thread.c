#include "base/thread.h"
#include "base/memory.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <unistd.h>

typedef struct worker {
    void (*run)(void *work, int number);
    void *work;
    int number;
    pthread_t thread;
} worker;

static void *start(void *argument)
{
    const worker *self = argument;
    self->run(self->work, self->number);
    return NULL;
}

/* Runs in so many threads. Worker 0 is this one; it alone suffices where the others cannot be had. */
static void run_all(void (*run)(void *work, int number), void *work, int threads)
{
    worker *others = threads > 1 ? ffd_alloc_zero((size_t)threads - 1, sizeof *others) : NULL;
    int started = 0;
    while (others && started < threads - 1) {
        worker *next = &others[started];
        *next = (worker){.run = run, .work = work, .number = started + 1};
        if (pthread_create(&next->thread, NULL, start, next) != 0)
            break;
        started++;
    }
    run(work, 0);
    for (int i = 0; i < started; i++)
        pthread_join(others[i].thread, NULL);
    ffd_free(others);
}

/* Tiles that a thread takes at a time, if there are many: neighbours often need the same things. */
#define SHARE 8
#define SHARES_A_THREAD 32

typedef struct tile_work {
    tile_function function;
    void *context;
    size_t count, tile_size, tiles, share;
    atomic_size_t next;
} tile_work;

static size_t share_of(size_t tiles, int threads)
{
    const size_t share = threads > 1 ? tiles / SHARES_A_THREAD / (size_t)threads : SHARE;
    return share < 1 ? 1 : share < SHARE ? share : SHARE;
}

static size_t tiles_of(size_t count, size_t tile_size)
{
    return count / tile_size + (count % tile_size != 0);
}

static int workers_for(size_t tiles, int threads)
{
    return threads > 1 && (size_t)threads > tiles ? (int)tiles : threads;
}

static void call(tile_function function, const tile_work *work, size_t tile, int number)
{
    const size_t begin = tile * work->tile_size, rest = work->count - begin;
    function(work->context, tile, begin, begin + (rest < work->tile_size ? rest : work->tile_size), number);
}

static void run_tiles(void *context, int number)
{
    tile_work *work = context;
    for (;;) {
        const size_t first = atomic_fetch_add(&work->next, work->share);
        if (first >= work->tiles)
            return;
        const size_t last = work->tiles - first < work->share ? work->tiles : first + work->share;
        for (size_t tile = first; tile < last; tile++)
            call(work->function, work, tile, number);
    }
}

void ffd_parallel_tiles(size_t count, size_t tile_size, int threads, tile_function function, void *context)
{
    tile_work work = {.function = function,
                      .context = context,
                      .count = count,
                      .tile_size = tile_size,
                      .tiles = tiles_of(count, tile_size)};
    work.share = share_of(work.tiles, threads);
    atomic_init(&work.next, 0);
    run_all(run_tiles, &work, workers_for(work.tiles, threads));
}

/* A tile on its way. */
typedef struct tile_slot {
    bool taken, made; /* made: it waits for its turn */
    size_t tile;
} tile_slot;

typedef struct ordered_work {
    tile_work tiles; /* its next is under the lock */
    tile_function finish;
    tile_slot *slots;
    int slot_count;
    size_t turn; /* the tile to be finished next */
    bool finishing;
    pthread_mutex_t lock; /* of the slots and what follows tiles.next */
    pthread_cond_t freed;
} ordered_work;

/* Tiles that may wait for their turn while threads go on. */
#define MOST_WAITING 8

int ffd_ordered_slots(int threads)
{
    if (threads <= 1)
        return 1;
    return threads + (threads < MOST_WAITING ? threads : MOST_WAITING);
}

/* The slot that has the tile, if it is made; -1: none. */
static int find_made(const ordered_work *work, size_t tile)
{
    for (int i = 0; i < work->slot_count; i++)
        if (work->slots[i].made && work->slots[i].tile == tile)
            return i;
    return -1;
}

/* Takes the next tile into a free slot; waits for one. -1: no tile is left. Under the lock. */
static int take_tile(ordered_work *work)
{
    for (;;) {
        const size_t tile = atomic_load(&work->tiles.next);
        if (tile >= work->tiles.tiles)
            return -1;
        for (int i = 0; i < work->slot_count; i++)
            if (!work->slots[i].taken) {
                work->slots[i] = (tile_slot){.taken = true, .tile = tile};
                atomic_store(&work->tiles.next, tile + 1);
                return i;
            }
        pthread_cond_wait(&work->freed, &work->lock);
    }
}

/* Finishes the tiles whose turn it is, one after the other, unless another thread is at it. Under the lock.
 */
static void finish_made(ordered_work *work)
{
    if (work->finishing)
        return;
    work->finishing = true;
    for (int slot; (slot = find_made(work, work->turn)) >= 0;) {
        pthread_mutex_unlock(&work->lock);
        call(work->finish, &work->tiles, work->turn, slot);
        pthread_mutex_lock(&work->lock);
        work->slots[slot].taken = work->slots[slot].made = false;
        work->turn++;
        pthread_cond_broadcast(&work->freed);
    }
    work->finishing = false;
}

static void run_ordered(void *context, int number)
{
    ordered_work *work = context;
    (void)number;
    pthread_mutex_lock(&work->lock);
    for (int slot; (slot = take_tile(work)) >= 0;) {
        const size_t tile = work->slots[slot].tile;
        pthread_mutex_unlock(&work->lock);
        call(work->tiles.function, &work->tiles, tile, slot);
        pthread_mutex_lock(&work->lock);
        work->slots[slot].made = true;
        finish_made(work);
    }
    pthread_mutex_unlock(&work->lock);
}

bool ffd_parallel_in_order(size_t count, size_t tile_size, int threads, tile_function function,
                           tile_function finish, void *context)
{
    ordered_work work = {.tiles = {.function = function,
                                   .context = context,
                                   .count = count,
                                   .tile_size = tile_size,
                                   .tiles = tiles_of(count, tile_size)},
                         .finish = finish,
                         .slot_count = ffd_ordered_slots(threads),
                         .lock = PTHREAD_MUTEX_INITIALIZER,
                         .freed = PTHREAD_COND_INITIALIZER};
    work.slots = ffd_alloc_zero((size_t)work.slot_count, sizeof *work.slots);
    if (!work.slots)
        return false;
    atomic_init(&work.tiles.next, 0);
    run_all(run_ordered, &work, workers_for(work.tiles.tiles, threads));
    pthread_cond_destroy(&work.freed);
    pthread_mutex_destroy(&work.lock);
    ffd_free(work.slots);
    return true;
}

int ffd_processor_count(void)
{
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > 1024 ? 1024 : (int)count;
}
