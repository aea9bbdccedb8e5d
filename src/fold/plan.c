#include "fold/plan.h"
#include "base/memory/memory.h"
#include "spline/bezier.h"

ffd_status ffd_fold_plan_make(const ffd_lattice *lattice, fold_plan *plan, ffd_error *error)
{
    *plan = (fold_plan){.lattice = lattice, .rational = lattice->rest_weights != NULL, .cell_count = 1};
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &lattice->knots[a];
        plan->order[a] = knots->degree + 1;
        plan->cells[a] = knots->span_count;
        plan->cell_count *= knots->span_count;
        plan->extraction[a] = ffd_bezier_extractions(knots);
        if (!plan->extraction[a])
            return ffd_fail_memory(error);
    }
    return ffd_fold_volume(plan, &plan->volume, error);
}

void ffd_fold_plan_free(fold_plan *plan)
{
    for (int a = 0; a < 3; a++) {
        ffd_free(plan->extraction[a]);
        plan->extraction[a] = NULL;
    }
}

void ffd_fold_cell_at(const fold_plan *plan, size_t cell, size_t index[3], int span[3])
{
    index[0] = cell % plan->cells[0];
    index[1] = cell / plan->cells[0] % plan->cells[1];
    index[2] = cell / plan->cells[0] / plan->cells[1];
    for (int a = 0; a < 3; a++)
        span[a] = plan->lattice->knots[a].spans[index[a]];
}

void ffd_fold_cell_read(const fold_plan *plan, ffd_volume volume, const size_t index[3], double *points,
                        double *weights, const double *matrix[3])
{
    const ffd_lattice *lattice = plan->lattice;
    int span[3];
    for (int a = 0; a < 3; a++) {
        span[a] = lattice->knots[a].spans[index[a]];
        matrix[a] = plan->extraction[a] + index[a] * (size_t)plan->order[a] * (size_t)plan->order[a];
    }
    ffd_lattice_cell_points(lattice, ffd_lattice_get_points(lattice, volume), span, points);
    if (weights)
        ffd_lattice_cell_weights(lattice, ffd_lattice_get_weights(lattice, volume), span, weights);
}
