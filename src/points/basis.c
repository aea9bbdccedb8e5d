/* basis.c - computes dX/dQ as a matrix, or its product with a vector. */
#include "base/memory/memory.h"
#include "points/basis_row.h"
#include "points/point_run.h"
#include <string.h>

typedef struct basis_work {
    const ffd_embedding *embedding;
    const double *weights;
    basis_order order;
    basis_row *rows; /* one for each thread */
    ffd_csr *matrix; /* to be filled: the lengths of its rows, and their entries from `most` times the row's
                        number among those that have any on */
    size_t most;
    size_t *before;   /* for each tile: how many rows before it have entries */
    const double *dq; /* for a product: */
    double *dx;
} basis_work;

static void find_row(const basis_work *work, size_t point, size_t *next, basis_row *row)
{
    ffd_basis_row(work->embedding, work->weights, NULL, work->order, point, next, row);
}

/* Whether the row of a point may have entries. next: the first extended point that is not before it. */
static bool has_row(const ffd_embedding *embedding, size_t point, size_t next)
{
    return ffd_embedding_has(embedding, point) ||
           (next < embedding->extended_count && embedding->extended[next].point == point);
}

static ffd_status fill_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const basis_work *const work = context;
    basis_row *const row = &work->rows[worker];
    size_t next = ffd_embedding_first_extended(work->embedding, first);
    size_t start = work->before[first / POINT_TILE] * work->most;
    (void)error;
    for (size_t i = first; i < first + count; i++) {
        find_row(work, i, &next, row);
        work->matrix->starts[i + 1] = row->count;
        if (row->count == 0)
            continue;
        memcpy(work->matrix->indices + start, row->columns, row->count * sizeof *row->columns);
        memcpy(work->matrix->values + start, row->values, row->count * sizeof *row->values);
        start += row->count;
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

/* Counts the rows with entries before each tile, and allocates as many entries as they can have. */
static ffd_status make_entries(basis_work *work, ffd_error *error)
{
    const ffd_embedding *const embedding = work->embedding;
    ffd_csr *const matrix = work->matrix;
    size_t rows = 0, next = 0;
    work->before = ffd_alloc(matrix->rows / POINT_TILE + 1, sizeof *work->before);
    if (!work->before)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < matrix->rows; i++) {
        if (i % POINT_TILE == 0)
            work->before[i / POINT_TILE] = rows;
        while (next < embedding->extended_count && embedding->extended[next].point < i)
            next++;
        rows += has_row(embedding, i, next);
    }
    work->most = 1;
    for (int a = 0; a < 3; a++)
        work->most *= (size_t)embedding->rest->knots[a].degree + 1;
    matrix->starts = ffd_alloc_zero(matrix->rows + 1, sizeof *matrix->starts);
    matrix->indices = ffd_alloc_whole(rows, work->most * sizeof *matrix->indices);
    matrix->values = ffd_alloc_whole(rows, work->most * sizeof *matrix->values);
    return matrix->starts && matrix->indices && matrix->values ? FFD_OK : ffd_fail_memory(error);
}

/* Shrinks a block, which may stay as it is. */
static void shrink(void **block, size_t count, size_t size)
{
    void *const smaller = ffd_realloc(*block, count, size);
    *block = smaller ? smaller : *block;
}

/* Moves the entries of all tiles together: rows on knots are shorter than others. */
static void join_tiles(const basis_work *work)
{
    ffd_csr *const matrix = work->matrix;
    for (size_t i = 0; i < matrix->rows; i++)
        matrix->starts[i + 1] += matrix->starts[i];
    for (size_t first = 0; first < matrix->rows; first += POINT_TILE) {
        const size_t last = matrix->rows - first < POINT_TILE ? matrix->rows : first + POINT_TILE;
        const size_t to = matrix->starts[first], count = matrix->starts[last] - to;
        const size_t from = work->before[first / POINT_TILE] * work->most;
        if (from == to || count == 0)
            continue;
        memmove(matrix->indices + to, matrix->indices + from, count * sizeof *matrix->indices);
        memmove(matrix->values + to, matrix->values + from, count * sizeof *matrix->values);
    }
    const size_t count = matrix->starts[matrix->rows];
    void *indices = matrix->indices, *values = matrix->values;
    shrink(&indices, count, sizeof *matrix->indices);
    shrink(&values, count, sizeof *matrix->values);
    matrix->indices = indices;
    matrix->values = values;
}

ffd_status ffd_embedding_basis_ordered(const ffd_embedding *embedding, const double *weights, bool w_fastest,
                                       ffd_csr *matrix, const ffd_run_options *options, ffd_error *error)
{
    point_run run = {.total = 0};
    basis_work work;
    *matrix = (ffd_csr){.rows = embedding->count, .columns = embedding->rest->count};
    ffd_status status;
    TRY_END(begin(embedding, weights, options, &run, &work, error));
    work.matrix = matrix;
    work.order = w_fastest ? BASIS_BY_W : BASIS_BY_U;
    TRY_END(make_entries(&work, error));
    TRY_END(ffd_point_run_tiles(&run, fill_tile, &work, error));
    join_tiles(&work);
end:
    ffd_free(work.before);
    end(&run, &work);
    if (status)
        ffd_csr_free(matrix);
    return status;
}

ffd_status ffd_embedding_basis(const ffd_embedding *embedding, const double *weights, ffd_csr *matrix,
                               const ffd_run_options *options, ffd_error *error)
{
    return ffd_embedding_basis_ordered(embedding, weights, false, matrix, options, error);
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
