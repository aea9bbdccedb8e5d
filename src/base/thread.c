#include "base/thread.h"
#include "base/memory.h"
#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

typedef struct tile_work {
    tile_function function, finish; /* finish may be NULL */
    void *context;
    size_t count, tile_size, tiles;
    atomic_size_t next;
    size_t turn; /* the tile to be finished next; under the lock */
    pthread_mutex_t lock;
    pthread_cond_t turned;
} tile_work;

typedef struct tile_worker {
    tile_work *work;
    int number;
    pthread_t thread;
} tile_worker;

/* Tiles are given out in ascending order, so that the one whose turn it is always has a thread. */
static void finish(tile_work *work, size_t tile, size_t begin, size_t end, int worker)
{
    pthread_mutex_lock(&work->lock);
    while (work->turn != tile)
        pthread_cond_wait(&work->turned, &work->lock);
    pthread_mutex_unlock(&work->lock);
    work->finish(work->context, tile, begin, end, worker);
    pthread_mutex_lock(&work->lock);
    work->turn++;
    pthread_cond_broadcast(&work->turned);
    pthread_mutex_unlock(&work->lock);
}

static void *run(void *argument)
{
    const tile_worker *worker = argument;
    tile_work *work = worker->work;
    for (;;) {
        const size_t tile = atomic_fetch_add(&work->next, 1);
        if (tile >= work->tiles)
            return NULL;
        const size_t begin = tile * work->tile_size, rest = work->count - begin;
        const size_t size = rest < work->tile_size ? rest : work->tile_size;
        work->function(work->context, tile, begin, begin + size, worker->number);
        if (work->finish)
            finish(work, tile, begin, begin + size, worker->number);
    }
}

static void run_all(tile_work *work, int threads)
{
    work->tiles = work->count / work->tile_size + (work->count % work->tile_size != 0);
    atomic_init(&work->next, 0);
    if (threads > 1 && (size_t)threads > work->tiles)
        threads = (int)work->tiles;

    /* Worker 0 is this thread; it alone suffices where the others cannot be had. */
    tile_worker self = {.work = work, .number = 0};
    tile_worker *others = threads > 1 ? ffd_alloc_zero((size_t)threads - 1, sizeof *others) : NULL;
    int started = 0;
    while (others && started < threads - 1) {
        tile_worker *worker = &others[started];
        worker->work = work;
        worker->number = started + 1;
        if (pthread_create(&worker->thread, NULL, run, worker) != 0)
            break;
        started++;
    }
    run(&self);
    for (int i = 0; i < started; i++)
        pthread_join(others[i].thread, NULL);
    ffd_free(others);
}

void ffd_parallel_tiles(size_t count, size_t tile_size, int threads, tile_function function, void *context)
{
    tile_work work = {.function = function, .context = context, .count = count, .tile_size = tile_size};
    run_all(&work, threads);
}

void ffd_parallel_in_order(size_t count, size_t tile_size, int threads, tile_function function,
                           tile_function finish_function, void *context)
{
    tile_work work = {.function = function,
                      .finish = finish_function,
                      .context = context,
                      .count = count,
                      .tile_size = tile_size,
                      .lock = PTHREAD_MUTEX_INITIALIZER,
                      .turned = PTHREAD_COND_INITIALIZER};
    run_all(&work, threads);
    pthread_cond_destroy(&work.turned);
    pthread_mutex_destroy(&work.lock);
}

int ffd_processor_count(void)
{
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > 1024 ? 1024 : (int)count;
}
