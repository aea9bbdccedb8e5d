/* basis.c - computes dX/dQ as a matrix, or its product with a vector. */
#include "base/memory/memory.h"
#include "points/basis_row.h"
#include "points/point_run.h"
#include <string.h>

typedef struct basis_work {
    const ffd_embedding *embedding;
    const double *weights;
    basis_row *rows;  /* one for each thread */
    ffd_csr *matrix;  /* to be filled; in the first pass the lengths of its rows */
    const double *dq; /* for a product: */
    double *dx;
} basis_work;

static void find_row(const basis_work *work, size_t point, size_t *next, basis_row *row)
{
    ffd_basis_row(work->embedding, work->weights, NULL, point, next, row);
}

static ffd_status count_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const basis_work *const work = context;
    size_t next = ffd_embedding_first_extended(work->embedding, first);
    (void)error;
    for (size_t i = first; i < first + count; i++) {
        find_row(work, i, &next, &work->rows[worker]);
        work->matrix->starts[i + 1] = work->rows[worker].count;
    }
    return FFD_OK;
}

static ffd_status fill_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const basis_work *const work = context;
    basis_row *const row = &work->rows[worker];
    size_t next = ffd_embedding_first_extended(work->embedding, first);
    (void)error;
    for (size_t i = first; i < first + count; i++) {
        const size_t start = work->matrix->starts[i];
        find_row(work, i, &next, row);
        memcpy(work->matrix->indices + start, row->columns, row->count * sizeof *row->columns);
        memcpy(work->matrix->values + start, row->values, row->count * sizeof *row->values);
    }
    return FFD_OK;
}

static ffd_status multiply_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const basis_work *const work = context;
    basis_row *const row = &work->rows[worker];
    size_t next = ffd_embedding_first_extended(work->embedding, first);
    (void)error;
    for (size_t i = first; i < first + count; i++) {
        double sum[3] = {0, 0, 0};
        find_row(work, i, &next, row);
        for (size_t e = 0; e < row->count; e++)
            for (size_t c = 0; c < 3; c++)
                sum[c] += row->values[e] * work->dq[3 * (size_t)row->columns[e] + c];
        memcpy(work->dx + 3 * i, sum, sizeof sum);
    }
    return FFD_OK;
}

static ffd_status begin(const ffd_embedding *embedding, const double *weights, const ffd_run_options *options,
                        point_run *run, basis_work *work, ffd_error *error)
{
    *work = (basis_work){.embedding = embedding, .weights = weights};
    TRY(ffd_basis_weights(embedding, &work->weights, error));
    TRY(ffd_point_run_begin(options, embedding->count, run, error));
    work->rows = ffd_alloc((size_t)run->options.threads, sizeof *work->rows);
    return work->rows ? FFD_OK : ffd_fail_memory(error);
}

static void end(point_run *run, basis_work *work)
{
    ffd_free(work->rows);
    ffd_point_run_end(run);
}

void ffd_csr_free(ffd_csr *matrix)
{
    ffd_free(matrix->starts);
    ffd_free(matrix->indices);
    ffd_free(matrix->values);
    *matrix = (ffd_csr){0};
}

/* Allocates the entries from the lengths of the rows. */
static ffd_status make_entries(ffd_csr *matrix, ffd_error *error)
{
    for (size_t i = 0; i < matrix->rows; i++)
        matrix->starts[i + 1] += matrix->starts[i];
    const size_t count = matrix->starts[matrix->rows];
    matrix->indices = ffd_alloc(count, sizeof *matrix->indices);
    matrix->values = ffd_alloc(count, sizeof *matrix->values);
    return matrix->indices && matrix->values ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_embedding_basis(const ffd_embedding *embedding, const double *weights, ffd_csr *matrix,
                               const ffd_run_options *options, ffd_error *error)
{
    point_run run = {.total = 0};
    basis_work work;
    *matrix = (ffd_csr){.rows = embedding->count, .columns = embedding->rest->count};
    ffd_status status;
    TRY_END(begin(embedding, weights, options, &run, &work, error));
    work.matrix = matrix;
    run.passes = 2;
    matrix->starts = ffd_alloc_zero(matrix->rows + 1, sizeof *matrix->starts);
    TRY_END(matrix->starts ? ffd_point_run_tiles(&run, count_tile, &work, error) : ffd_fail_memory(error));
    TRY_END(make_entries(matrix, error));
    TRY_END(ffd_point_run_tiles(&run, fill_tile, &work, error));
end:
    end(&run, &work);
    if (status)
        ffd_csr_free(matrix);
    return status;
}

ffd_status ffd_embedding_basis_times(const ffd_embedding *embedding, const double *weights, const double *dq,
                                     double *dx, const ffd_run_options *options, ffd_error *error)
{
    point_run run = {.total = 0};
    basis_work work;
    ffd_status status;
    TRY_END(begin(embedding, weights, options, &run, &work, error));
    work.dq = dq;
    work.dx = dx;
    TRY_END(ffd_point_run_tiles(&run, multiply_tile, &work, error));
end:
    end(&run, &work);
    return status;
}
