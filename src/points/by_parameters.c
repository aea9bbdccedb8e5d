/* by_parameters.c - the derivative of embedded points by the placeholders of a lattice file. */
#include "base/memory/memory.h"
#include "lattice/spec.h"
#include "points/adjoint.h"
#include "points/changes.h"
#include <string.h>

/* Finds the derivatives of the control points. */
static ffd_status begin(const ffd_embedding *embedding, const ffd_lattice *lattice,
                        lattice_tangents *tangents, ffd_error *error)
{
    *tangents = (lattice_tangents){0};
    TRY(ffd_embedding_check_lattice(embedding, lattice, error));
    if (ffd_lattice_get_column_count(lattice) == 0)
        return FFD_OK;
    return lattice->edited ? ffd_fail(error, FFD_E_INVALID,
                                      "control points of the lattice were set: they do not follow its "
                                      "placeholders")
                           : ffd_lattice_tangents_find(lattice, tangents, error);
}

ffd_status ffd_embedding_parameters(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                    double *jacobian, const ffd_run_options *options, ffd_error *error)
{
    lattice_tangents tangents;
    control_change *changes = NULL;
    ffd_status status;
    TRY_END(begin(embedding, lattice, &tangents, error));
    changes = ffd_alloc(tangents.columns, sizeof *changes);
    TRY_END(changes ? FFD_OK : ffd_fail_memory(error));
    for (size_t k = 0; k < tangents.columns; k++)
        changes[k] = ffd_tangents_column(&tangents, lattice->count, k);
    TRY_END(ffd_embedding_changes(embedding, lattice, changes, tangents.columns, jacobian, options, error));
end:
    ffd_free(changes);
    ffd_lattice_tangents_free(&tangents);
    return status;
}

/* Adds the columns of one array of tangents, each times its number. width: of a column. */
static void join(const double *columns, size_t count, size_t width, const double *factors, double *sum)
{
    memset(sum, 0, width * sizeof *sum);
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < width; i++)
            sum[i] += columns[k * width + i] * factors[k];
}

ffd_status ffd_embedding_parameters_times(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                          const double *dp, double *dx, const ffd_run_options *options,
                                          ffd_error *error)
{
    const size_t count = embedding->rest->count;
    lattice_tangents tangents;
    double *dq = NULL, *dw = NULL;
    ffd_status status;
    TRY_END(begin(embedding, lattice, &tangents, error));
    dq = ffd_alloc(count, 3 * sizeof *dq);
    dw = tangents.weights ? ffd_alloc(count, sizeof *dw) : NULL;
    TRY_END(dq && (dw || !tangents.weights) ? FFD_OK : ffd_fail_memory(error));
    join(tangents.points, tangents.columns, 3 * count, dp, dq);
    if (dw)
        join(tangents.weights, tangents.columns, count, dp, dw);
    TRY_END(ffd_embedding_changes(embedding, lattice, &(control_change){dq, dw}, 1, dx, options, error));
end:
    ffd_free(dq);
    ffd_free(dw);
    ffd_lattice_tangents_free(&tangents);
    return status;
}

/* Adds to each number the product of its column with a gradient. width: of a column. */
static void project(const double *columns, size_t count, size_t width, const double *gradient, double *sum)
{
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < width; i++)
            sum[k] += columns[k * width + i] * gradient[i];
}

ffd_status ffd_embedding_parameters_transposed(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                               const double *dfdx, double *dfdp,
                                               const ffd_run_options *options, ffd_error *error)
{
    const size_t count = embedding->rest->count;
    lattice_tangents tangents;
    adjoint wanted = {.dfdx = dfdx, .by_points = true};
    double *gradient = NULL;
    ffd_status status;
    TRY_END(begin(embedding, lattice, &tangents, error));
    wanted.weights = lattice->deformed_weights;
    wanted.moved = tangents.weights ? lattice : NULL;
    gradient = ffd_alloc(count, 4 * sizeof *gradient);
    TRY_END(gradient ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_embedding_adjoint(embedding, &wanted, gradient, options, error));
    if (tangents.columns > 0)
        memset(dfdp, 0, tangents.columns * sizeof *dfdp);
    project(tangents.points, tangents.columns, 3 * count, gradient, dfdp);
    if (tangents.weights)
        project(tangents.weights, tangents.columns, count, gradient + 3 * count, dfdp);
end:
    ffd_free(gradient);
    ffd_lattice_tangents_free(&tangents);
    return status;
}
