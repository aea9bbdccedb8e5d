#include "points/block_sums.h"
#include "base/memory/memory.h"
#include <string.h>

/* The most bytes for sums of blocks. */
#define SUM_BYTES ((size_t)64 << 20)
#define BLOCKS_A_THREAD 4

typedef struct sum_work {
    block_sum_function function;
    void *context;
    size_t before, width; /* points before the group */
    double *sums;         /* `width` for each block of a group */
} sum_work;

static void add_block(void *context, size_t block, size_t first, size_t last, int worker)
{
    const sum_work *const work = context;
    double *const sum = work->sums + block * work->width;
    memset(sum, 0, work->width * sizeof *sum);
    work->function(work->context, work->before + first, work->before + last, worker, sum);
}

/* Returns the number of blocks that are summed at a time. */
static size_t group_size(size_t width, int threads)
{
    const size_t most = SUM_BYTES / (width * sizeof(double)), wanted = BLOCKS_A_THREAD * (size_t)threads;
    return most < 1 ? 1 : most < wanted ? most : wanted;
}

static void add_group(sum_work *work, size_t points, int threads, double *sum)
{
    const size_t blocks = points / POINT_TILE + (points % POINT_TILE != 0);
    ffd_parallel_tiles(points, POINT_TILE, threads, add_block, work);
    for (size_t b = 0; b < blocks; b++)
        for (size_t c = 0; c < work->width; c++)
            sum[c] += work->sums[b * work->width + c];
}

ffd_status ffd_block_sums(const point_run *run, size_t width, block_sum_function function, void *context,
                          double *sum, ffd_error *error)
{
    const ffd_run_options *const options = &run->options;
    const size_t count = run->total, group = group_size(width, options->threads);
    sum_work work = {.function = function, .context = context, .width = width};
    ffd_status status = FFD_OK;
    memset(sum, 0, width * sizeof *sum);
    work.sums = ffd_alloc(group, width * sizeof *work.sums);
    TRY_END(work.sums ? FFD_OK : ffd_fail_memory(error));
    for (; work.before < count; work.before += group * POINT_TILE) {
        const size_t left = count - work.before,
                     points = left < group * POINT_TILE ? left : group * POINT_TILE;
        add_group(&work, points, options->threads, sum);
        if (options->progress &&
            !options->progress(options->user, (double)(work.before + points) / (double)count))
            TRY_END(ffd_fail(error, FFD_E_CANCELLED, "cancelled by the progress function"));
    }
end:
    ffd_free(work.sums);
    return status;
}
