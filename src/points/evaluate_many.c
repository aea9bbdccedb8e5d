/* evaluate_many.c - ffd_lattice_evaluate_many: evaluates the volume at many u,v,w. */
#include "lattice/lattice.h"
#include "points/point_run.h"

typedef struct evaluate_work {
    const ffd_lattice *lattice;
    ffd_volume volume;
    const double *uvw;
    double *xyz, *jacobians;
} evaluate_work;

static ffd_status evaluate_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const evaluate_work *const work = context;
    (void)worker;
    (void)error;
    for (size_t i = first; i < first + count; i++)
        ffd_lattice_evaluate(work->lattice, work->volume, work->uvw + 3 * i, work->xyz + 3 * i,
                             work->jacobians ? work->jacobians + 9 * i : NULL);
    return FFD_OK;
}

ffd_status ffd_lattice_evaluate_many(const ffd_lattice *lattice, ffd_volume volume, const double *uvw,
                                     size_t count, double *xyz, double *jacobians,
                                     const ffd_run_options *options, ffd_error *error)
{
    evaluate_work work = {lattice, volume, uvw, xyz, jacobians};
    point_run run = {.total = 0};
    if (!lattice->rest)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "the lattice has no control points yet: its box is that of a mesh");
    ffd_status status;
    TRY_END(ffd_point_run_begin(options, count, &run, error));
    TRY_END(ffd_point_run_tiles(&run, evaluate_tile, &work, error));
end:
    ffd_point_run_end(&run);
    return status;
}
