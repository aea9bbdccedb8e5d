/* by_weights.c - the derivative of embedded points by the weights of the deformed volume, and along any
   change of control points and weights. */
#include "base/memory/memory.h"
#include "points/adjoint.h"
#include "points/changes.h"
#include <string.h>

typedef struct change_work {
    const ffd_embedding *embedding;
    const ffd_lattice *moved;
    const control_change *changes; /* count; NULL: all weights, one by one */
    size_t count;
    bool w_fastest; /* the order of these weights */
    double *dx;
    basis_row *rows; /* one for each thread */
} change_work;

static void along_changes(const change_work *work, const basis_row *row, const double x[3], double *dx)
{
    for (size_t k = 0; k < work->count; k++) {
        double tangent[3];
        ffd_row_tangent(work->moved, &work->changes[k], row, x, tangent);
        for (size_t c = 0; c < 3; c++)
            dx[c * work->count + k] = tangent[c];
    }
}

/* The number of a control point, u fastest, in the other order. */
static size_t in_other_order(const ffd_lattice *lattice, size_t point)
{
    const size_t *const size = lattice->size;
    const size_t u = point % size[0], v = point / size[0] % size[1], w = point / (size[0] * size[1]);
    return (u * size[1] + v) * size[2] + w;
}

/* dX/dh_j = R_j (Q_j - X) / h_j. */
static void along_weights(const change_work *work, const basis_row *row, const double x[3], double *dx)
{
    const double *const weights = work->moved->deformed_weights;
    memset(dx, 0, 3 * work->count * sizeof *dx);
    for (size_t e = 0; e < row->count; e++) {
        const size_t point = row->columns[e];
        const size_t column = work->w_fastest ? in_other_order(work->moved, point) : point;
        const double part = row->values[e] / (weights ? weights[point] : 1);
        for (size_t c = 0; c < 3; c++)
            dx[c * work->count + column] = part * (work->moved->deformed[3 * point + c] - x[c]);
    }
}

static ffd_status change_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const change_work *const work = context;
    basis_row *const row = &work->rows[worker];
    size_t next = ffd_embedding_first_extended(work->embedding, first);
    (void)error;
    for (size_t i = first; i < first + count; i++) {
        double x[3], *const dx = work->dx + 3 * i * work->count;
        ffd_basis_row(work->embedding, work->moved->deformed_weights, NULL, BASIS_BY_U, i, &next, row);
        ffd_row_place(work->moved, row, x);
        if (work->changes)
            along_changes(work, row, x, dx);
        else
            along_weights(work, row, x, dx);
    }
    return FFD_OK;
}

static ffd_status change_all(change_work *work, const ffd_run_options *options, ffd_error *error)
{
    point_run run = {.total = 0};
    ffd_status status;
    TRY_END(ffd_embedding_check_lattice(work->embedding, work->moved, error));
    TRY_END(ffd_point_run_begin(options, work->embedding->count, &run, error));
    work->rows = ffd_alloc((size_t)run.options.threads, sizeof *work->rows);
    TRY_END(work->rows ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_point_run_tiles(&run, change_tile, work, error));
end:
    ffd_free(work->rows);
    ffd_point_run_end(&run);
    return status;
}

ffd_status ffd_embedding_changes(const ffd_embedding *embedding, const ffd_lattice *moved,
                                 const control_change *changes, size_t count, double *dx,
                                 const ffd_run_options *options, ffd_error *error)
{
    change_work work = {.embedding = embedding, .moved = moved, .changes = changes, .count = count, .dx = dx};
    return change_all(&work, options, error);
}

ffd_status ffd_embedding_weights(const ffd_embedding *embedding, const ffd_lattice *moved, bool w_fastest,
                                 double *jacobian, const ffd_run_options *options, ffd_error *error)
{
    change_work work = {.embedding = embedding,
                        .moved = moved,
                        .count = embedding->rest->count,
                        .w_fastest = w_fastest,
                        .dx = jacobian};
    return change_all(&work, options, error);
}

ffd_status ffd_embedding_weights_times(const ffd_embedding *embedding, const ffd_lattice *moved,
                                       const double *dw, double *dx, const ffd_run_options *options,
                                       ffd_error *error)
{
    return ffd_embedding_changes(embedding, moved, &(control_change){.weights = dw}, 1, dx, options, error);
}

ffd_status ffd_embedding_weights_transposed(const ffd_embedding *embedding, const ffd_lattice *moved,
                                            const double *dfdx, double *dfdw, const ffd_run_options *options,
                                            ffd_error *error)
{
    TRY(ffd_embedding_check_lattice(embedding, moved, error));
    const adjoint wanted = {.weights = moved->deformed_weights, .dfdx = dfdx, .moved = moved};
    return ffd_embedding_adjoint(embedding, &wanted, dfdw, options, error);
}
