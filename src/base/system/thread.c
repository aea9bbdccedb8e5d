#include "base/system/thread.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/processors.h"
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

typedef struct worker_thread {
    void (*run)(void *work, int index);
    void *work;
    int index;
    const deadline *deadline; /* of the calling thread */
    pthread_t thread;
} worker_thread;

static void *start(void *argument)
{
    const worker_thread *self = argument;
    ffd_deadline_set(self->deadline);
    self->run(self->work, self->index);
    return NULL;
}

/* The least stack of a thread. The search for u,v,w in a curved lattice has the Bezier coefficients of
   degrees to 14 on it, 108,000 bytes a volume, and more than one; some C libraries give a thread 128 KB. */
#define LEAST_STACK ((size_t)1 << 20)

/* Starts a thread, with at least that stack where the system allows it. */
static bool create(worker_thread *thread)
{
    pthread_attr_t own;
    size_t size = 0;
    const bool has_own = pthread_attr_init(&own) == 0;
    if (has_own && pthread_attr_getstacksize(&own, &size) == 0 && size < LEAST_STACK)
        pthread_attr_setstacksize(&own, LEAST_STACK);
    const bool created = pthread_create(&thread->thread, has_own ? &own : NULL, start, thread) == 0;
    if (has_own)
        pthread_attr_destroy(&own);
    return created;
}

/* Runs `run` in this many threads. Worker 0 is the calling thread, which does all the work if no others can
   be started. */
static void start_workers(void (*run)(void *work, int index), void *work, int threads)
{
    worker_thread *others = threads > 1 ? ffd_alloc_zero((size_t)threads - 1, sizeof *others) : NULL;
    int started = 0;
    while (others && started < threads - 1) {
        worker_thread *next = &others[started];
        *next =
            (worker_thread){.run = run, .work = work, .index = started + 1, .deadline = ffd_deadline_get()};
        if (!create(next))
            break;
        started++;
    }
    run(work, 0);
    for (int i = 0; i < started; i++)
        pthread_join(others[i].thread, NULL);
    ffd_free(others);
}

/* Number of consecutive tiles that a thread takes at a time, if there are many: neighbours often need the
   same data. */
#define SHARE 8
#define SHARES_A_THREAD 32

typedef struct tiling {
    void *context;
    size_t count, tile_size, tiles;
} tiling;

typedef struct tile_work {
    tiling tiling;
    tile_function function;
    size_t share;
    atomic_size_t next;
} tile_work;

static size_t share_of(size_t tiles, int threads)
{
    const size_t share = threads > 1 ? tiles / SHARES_A_THREAD / (size_t)threads : SHARE;
    return share < 1 ? 1 : share < SHARE ? share : SHARE;
}

static tiling tile(size_t count, size_t tile_size, void *context)
{
    return (tiling){context, count, tile_size, count / tile_size + (count % tile_size != 0)};
}

static int workers_for(size_t tiles, int threads)
{
    return threads > 1 && (size_t)threads > tiles ? (int)tiles : threads;
}

static void call(tile_function function, const tiling *of, size_t index, int worker)
{
    const size_t begin = index * of->tile_size, rest = of->count - begin;
    (void)ffd_deadline_passed(); /* the caller is told how far it is; the work looks itself whether it is to
                                    end */
    function(of->context, index, begin, begin + (rest < of->tile_size ? rest : of->tile_size), worker);
}

static void take_tiles(void *context, int worker)
{
    tile_work *work = context;
    const size_t tiles = work->tiling.tiles;
    for (;;) {
        const size_t first = atomic_fetch_add(&work->next, work->share);
        if (first >= tiles)
            return;
        const size_t last = tiles - first < work->share ? tiles : first + work->share;
        for (size_t index = first; index < last; index++)
            call(work->function, &work->tiling, index, worker);
    }
}

void ffd_parallel_tiles(size_t count, size_t tile_size, int threads, tile_function function, void *context)
{
    tile_work work = {.tiling = tile(count, tile_size, context), .function = function};
    work.share = share_of(work.tiling.tiles, threads);
    atomic_init(&work.next, 0);
    start_workers(take_tiles, &work, workers_for(work.tiling.tiles, threads));
}

void ffd_thread_yield(void)
{
    sched_yield();
}

/* A tile that is being processed or waits to be finished. */
typedef struct tile_slot {
    bool taken, made; /* made: it is processed and waits for its turn to be finished */
    size_t tile;
} tile_slot;

typedef struct ordered_work {
    tiling tiling;
    tile_function function, finish;
    int slot_count;
    /* Protected by the lock: */
    tile_slot *slots;
    size_t next, turn; /* the next tile to be taken, and the next one to be finished */
    bool finishing;
    pthread_mutex_t lock;
    pthread_cond_t freed;
} ordered_work;

/* How many tiles may wait for their turn while threads go on with others. */
#define MOST_WAITING 8

int ffd_ordered_slots(int threads)
{
    if (threads <= 1)
        return 1;
    return threads + MOST_WAITING;
}

/* Returns the slot of the tile if it is made; else -1. */
static int find_made(const ordered_work *work, size_t tile)
{
    for (int i = 0; i < work->slot_count; i++)
        if (work->slots[i].made && work->slots[i].tile == tile)
            return i;
    return -1;
}

/* Takes the next tile into a free slot, and waits for a slot if none is free. Returns -1 if no tile is left.
   The caller holds the lock. */
static int take_tile(ordered_work *work)
{
    for (; work->next < work->tiling.tiles; pthread_cond_wait(&work->freed, &work->lock))
        for (int i = 0; i < work->slot_count; i++)
            if (!work->slots[i].taken) {
                work->slots[i] = (tile_slot){.taken = true, .tile = work->next++};
                return i;
            }
    return -1;
}

/* Finishes the tiles whose turn it is, unless another thread is doing so. The caller holds the lock. */
static void finish_made(ordered_work *work)
{
    if (work->finishing)
        return;
    work->finishing = true;
    for (int slot; (slot = find_made(work, work->turn)) >= 0;) {
        pthread_mutex_unlock(&work->lock);
        call(work->finish, &work->tiling, work->turn, slot);
        pthread_mutex_lock(&work->lock);
        work->slots[slot].taken = work->slots[slot].made = false;
        work->turn++;
        pthread_cond_broadcast(&work->freed);
    }
    work->finishing = false;
}

static void run_ordered(void *context, int worker)
{
    ordered_work *work = context;
    (void)worker; /* scratch memory belongs to slots, not to threads */
    pthread_mutex_lock(&work->lock);
    for (int slot; (slot = take_tile(work)) >= 0;) {
        const size_t index = work->slots[slot].tile;
        pthread_mutex_unlock(&work->lock);
        call(work->function, &work->tiling, index, slot);
        pthread_mutex_lock(&work->lock);
        work->slots[slot].made = true;
        finish_made(work);
    }
    pthread_mutex_unlock(&work->lock);
}

bool ffd_parallel_in_order(size_t count, size_t tile_size, int threads, tile_function function,
                           tile_function finish, void *context)
{
    ordered_work work = {.tiling = tile(count, tile_size, context),
                         .function = function,
                         .finish = finish,
                         .slot_count = ffd_ordered_slots(threads),
                         .lock = PTHREAD_MUTEX_INITIALIZER,
                         .freed = PTHREAD_COND_INITIALIZER};
    work.slots = ffd_alloc_zero((size_t)work.slot_count, sizeof *work.slots);
    if (!work.slots)
        return false;
    start_workers(run_ordered, &work, workers_for(work.tiling.tiles, threads));
    pthread_cond_destroy(&work.freed);
    pthread_mutex_destroy(&work.lock);
    ffd_free(work.slots);
    return true;
}

ffd_status ffd_threads_check(int wanted, ffd_error *error)
{
    return wanted >= 0
               ? FFD_OK
               : ffd_fail(error, FFD_E_ARGUMENT, "threads is %d: it is 0 for all cores, or positive", wanted);
}

int ffd_threads_for(int wanted, uint64_t pieces)
{
    if (pieces <= 1)
        return 1;
    const int most = wanted > 0 ? wanted : ffd_processor_count();
    return pieces < (uint64_t)most ? (int)pieces : most;
}

#define PIECE_BYTES ((uint64_t)128 * 1024)

int ffd_threads_for_bytes(int wanted, uint64_t bytes)
{
    return ffd_threads_for(wanted, bytes / PIECE_BYTES + 1);
}
