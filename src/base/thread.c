#include "base/thread.h"
#include "base/memory.h"
#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

typedef struct tile_work {
    tile_function function;
    void *context;
    size_t count, tile_size, tiles;
    atomic_size_t next;
} tile_work;

typedef struct tile_worker {
    tile_work *work;
    int number;
    pthread_t thread;
} tile_worker;

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
    }
}

void ffd_parallel_tiles(size_t count, size_t tile_size, int threads, tile_function function, void *context)
{
    tile_work work = {.function = function, .context = context, .count = count, .tile_size = tile_size};
    work.tiles = count / tile_size + (count % tile_size != 0);
    atomic_init(&work.next, 0);
    if (threads > 1 && (size_t)threads > work.tiles)
        threads = (int)work.tiles;

    /* Worker 0 is this thread; it alone suffices where the others cannot be had. */
    tile_worker self = {.work = &work, .number = 0};
    tile_worker *others = threads > 1 ? ffd_alloc_zero((size_t)threads - 1, sizeof *others) : NULL;
    int started = 0;
    while (others && started < threads - 1) {
        tile_worker *worker = &others[started];
        worker->work = &work;
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

int ffd_processor_count(void)
{
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > 1024 ? 1024 : (int)count;
}
