/* basis_transposed.c - computes products with the transposed dX/dQ, and with the derivative by the weights.
 */
#include "base/memory/memory.h"
#include "points/adjoint.h"
#include "points/block_sums.h"
#include "points/row_tangent.h"

typedef struct transposed_work {
    const ffd_embedding *embedding;
    const adjoint *wanted;
    size_t weights;  /* where the sums by weights begin */
    basis_row *rows; /* one for each thread */
} transposed_work;

/* Adds what a point tells of its control points. */
static void add_points(const basis_row *row, const double g[3], double *sum)
{
    for (size_t e = 0; e < row->count; e++)
        for (size_t c = 0; c < 3; c++)
            sum[3 * (size_t)row->columns[e] + c] += row->values[e] * g[c];
}

/* The same of their weights: dX/dh_j = R_j (Q_j - X) / h_j. */
static void add_weights(const ffd_lattice *moved, const basis_row *row, const double g[3], double *sum)
{
    const double *const weights = moved->deformed_weights;
    double x[3];
    ffd_row_place(moved, row, x);
    for (size_t e = 0; e < row->count; e++) {
        const size_t point = row->columns[e];
        double along = 0;
        for (size_t c = 0; c < 3; c++)
            along += (moved->deformed[3 * point + c] - x[c]) * g[c];
        sum[point] += row->values[e] / (weights ? weights[point] : 1) * along;
    }
}

static void add_block(void *context, size_t first, size_t last, int worker, double *sum)
{
    const transposed_work *const work = context;
    const adjoint *const wanted = work->wanted;
    basis_row *const row = &work->rows[worker];
    size_t next = ffd_embedding_first_extended(work->embedding, first);
    for (size_t i = first; i < last; i++) {
        ffd_basis_row(work->embedding, wanted->weights, NULL, BASIS_BY_U, i, &next, row);
        if (wanted->by_points)
            add_points(row, wanted->dfdx + 3 * i, sum);
        if (wanted->moved)
            add_weights(wanted->moved, row, wanted->dfdx + 3 * i, sum + work->weights);
    }
}

ffd_status ffd_embedding_adjoint(const ffd_embedding *embedding, const adjoint *wanted, double *gradient,
                                 const ffd_run_options *options, ffd_error *error)
{
    const size_t count = embedding->rest->count;
    point_run run = {.total = 0};
    transposed_work work = {
        .embedding = embedding, .wanted = wanted, .weights = wanted->by_points ? 3 * count : 0};
    ffd_status status;
    TRY_END(ffd_point_run_begin(options, embedding->count, &run, error));
    work.rows = ffd_alloc((size_t)run.options.threads, sizeof *work.rows);
    TRY_END(work.rows ? FFD_OK : ffd_fail_memory(error));
    TRY_END(
        ffd_block_sums(&run, work.weights + (wanted->moved ? count : 0), add_block, &work, gradient, error));
end:
    ffd_free(work.rows);
    ffd_point_run_end(&run);
    return status;
}

ffd_status ffd_embedding_basis_transposed(const ffd_embedding *embedding, const double *weights,
                                          const double *dfdx, double *dfdq, const ffd_run_options *options,
                                          ffd_error *error)
{
    adjoint wanted = {.weights = weights, .dfdx = dfdx, .by_points = true};
    TRY(ffd_basis_weights(embedding, &wanted.weights, error));
    return ffd_embedding_adjoint(embedding, &wanted, dfdq, options, error);
}
