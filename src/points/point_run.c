#include "points/point_run.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/vector/isa.h"

void ffd_run_options_init(ffd_run_options *options, size_t size)
{
    const ffd_run_options defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, options, size);
}

static ffd_status begin(const ffd_run_options *options, size_t total, size_t tile, point_run *run,
                        ffd_error *error)
{
    *run = (point_run){.total = total, .tile = tile, .passes = 1};
    ffd_run_options_init(&run->options, sizeof run->options);
    const size_t tiles = tile == 1 ? total : total / tile + 1;
    TRY(options ? ffd_struct_take(&run->options, sizeof run->options, options, "ffd_run_options", error)
                : FFD_OK);
    TRY(ffd_threads_check(run->options.threads, error));
    if (run->options.isa != FFD_ISA_AUTO && !ffd_isa_available(run->options.isa))
        return ffd_fail(error, FFD_E_ARGUMENT, "instruction set %d is not available here",
                        (int)run->options.isa);
    run->options.threads = ffd_threads_for(run->options.threads, tiles);
    atomic_init(&run->done, 0);
    atomic_init(&run->stopped, false);
    const size_t threads = (size_t)run->options.threads;
    run->statuses = ffd_alloc_zero(threads, sizeof *run->statuses);
    run->errors = ffd_alloc_zero(threads, sizeof *run->errors);
    run->tiles = ffd_alloc_zero(threads, sizeof *run->tiles);
    return run->statuses && run->errors && run->tiles ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_point_run_begin(const ffd_run_options *options, size_t total, point_run *run, ffd_error *error)
{
    return begin(options, total, POINT_TILE, run, error);
}

ffd_status ffd_point_run_begin_pieces(const ffd_run_options *options, size_t total, point_run *run,
                                      ffd_error *error)
{
    return begin(options, total, 1, run, error);
}

void ffd_point_run_end(point_run *run)
{
    ffd_free(run->statuses);
    ffd_free(run->errors);
    ffd_free(run->tiles);
}

typedef struct tile_context {
    point_run *run;
    point_function function;
    void *context;
} tile_context;

/* Reports the progress of all threads to the caller, in the caller's thread. */
static void report_progress(point_run *run, size_t done, int worker)
{
    if (worker != 0 || !run->options.progress)
        return;
    run->reported = true;
    if (!run->options.progress(run->options.user,
                               (double)done / ((double)run->passes * (double)run->total))) {
        run->statuses[0] = run->statuses[0] ? run->statuses[0] : FFD_E_CANCELLED;
        atomic_store(&run->stopped, true);
    }
}

static void run_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    tile_context *const work = context;
    point_run *const run = work->run;
    if (atomic_load(&run->stopped))
        return;
    const ffd_status status =
        work->function(work->context, first, last - first, worker, &run->errors[worker]);
    if (status) {
        run->statuses[worker] = status;
        run->tiles[worker] = tile;
        atomic_store(&run->stopped, true);
        return;
    }
    report_progress(run, atomic_fetch_add(&run->done, last - first) + (last - first), worker);
}

ffd_status ffd_point_run_tiles(point_run *run, point_function function, void *context, ffd_error *error)
{
    tile_context work = {run, function, context};
    int first = -1;
    ffd_parallel_tiles(run->total, run->tile, run->options.threads, run_tile, &work);
    /* Other threads may have done all tiles; the caller gets a chance to cancel all the same. */
    if (run->total > 0 && !run->reported && !atomic_load(&run->stopped))
        report_progress(run, run->total, 0);
    for (int i = 0; i < run->options.threads; i++)
        if (run->statuses[i] && (first < 0 || run->tiles[i] < run->tiles[first]))
            first = i;
    if (first < 0)
        return FFD_OK;
    if (run->statuses[first] == FFD_E_CANCELLED)
        return ffd_fail(error, FFD_E_CANCELLED, "cancelled by the progress function");
    if (error)
        *error = run->errors[first];
    return run->statuses[first];
}
