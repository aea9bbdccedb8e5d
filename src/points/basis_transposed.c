/* basis_transposed.c - computes products with the transposed dX/dQ. */
#include "base/memory/memory.h"
#include "points/basis_row.h"
#include "points/point_run.h"
#include <string.h>

/* The most bytes for sums of blocks. The sums are added in the order of the blocks, so that the result does
   not depend on threads. */
#define SUM_BYTES ((size_t)64 << 20)
#define BLOCKS_A_THREAD 4

typedef struct transposed_work {
    const ffd_embedding *embedding;
    const double *weights, *dfdx;
    size_t first_block;
    size_t width;    /* 3 for each control point */
    double *sums;    /* `width` for each block of a group */
    basis_row *rows; /* one for each thread */
} transposed_work;

static void add_block(void *context, size_t block, size_t first, size_t last, int worker)
{
    const transposed_work *const work = context;
    const size_t before = work->first_block * POINT_TILE;
    double *const sum = work->sums + block * work->width;
    basis_row *const row = &work->rows[worker];
    size_t next = ffd_embedding_first_extended(work->embedding, before + first);
    memset(sum, 0, work->width * sizeof *sum);
    for (size_t i = before + first; i < before + last; i++) {
        ffd_basis_row(work->embedding, work->weights, NULL, BASIS_BY_U, i, &next, row);
        for (size_t e = 0; e < row->count; e++)
            for (size_t c = 0; c < 3; c++)
                sum[3 * (size_t)row->columns[e] + c] += row->values[e] * work->dfdx[3 * i + c];
    }
}

/* Returns the number of blocks that are summed at a time. */
static size_t group_size(const transposed_work *work, int threads)
{
    const size_t most = SUM_BYTES / (work->width * sizeof(double)),
                 wanted = BLOCKS_A_THREAD * (size_t)threads;
    return most < 1 ? 1 : most < wanted ? most : wanted;
}

static void add_group(transposed_work *work, size_t points, int threads, double *dfdq)
{
    const size_t blocks = points / POINT_TILE + (points % POINT_TILE != 0);
    ffd_parallel_tiles(points, POINT_TILE, threads, add_block, work);
    for (size_t b = 0; b < blocks; b++)
        for (size_t c = 0; c < work->width; c++)
            dfdq[c] += work->sums[b * work->width + c];
}

static ffd_status add_all(transposed_work *work, const ffd_run_options *options, double *dfdq,
                          ffd_error *error)
{
    const size_t count = work->embedding->count, group = group_size(work, options->threads);
    memset(dfdq, 0, work->width * sizeof *dfdq);
    work->sums = ffd_alloc(group, work->width * sizeof *work->sums);
    work->rows = ffd_alloc((size_t)options->threads, sizeof *work->rows);
    if (!work->sums || !work->rows)
        return ffd_fail_memory(error);
    for (size_t first = 0; first < count; first += group * POINT_TILE) {
        const size_t left = count - first, points = left < group * POINT_TILE ? left : group * POINT_TILE;
        work->first_block = first / POINT_TILE;
        add_group(work, points, options->threads, dfdq);
        if (options->progress && !options->progress(options->user, (double)(first + points) / (double)count))
            return ffd_fail(error, FFD_E_CANCELLED, "cancelled by the progress function");
    }
    return FFD_OK;
}

ffd_status ffd_embedding_basis_transposed(const ffd_embedding *embedding, const double *weights,
                                          const double *dfdx, double *dfdq, const ffd_run_options *options,
                                          ffd_error *error)
{
    point_run run = {.total = 0};
    transposed_work work = {
        .embedding = embedding, .weights = weights, .dfdx = dfdx, .width = 3 * embedding->rest->count};
    ffd_status status;
    TRY_END(ffd_basis_weights(embedding, &work.weights, error));
    TRY_END(ffd_point_run_begin(options, embedding->count, &run, error));
    TRY_END(add_all(&work, &run.options, dfdq, error));
end:
    ffd_free(work.sums);
    ffd_free(work.rows);
    ffd_point_run_end(&run);
    return status;
}
