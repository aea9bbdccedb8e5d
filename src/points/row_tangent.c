#include "points/row_tangent.h"
#include <string.h>

void ffd_row_place(const ffd_lattice *lattice, const basis_row *row, double x[3])
{
    double sum = 0;
    memset(x, 0, 3 * sizeof *x);
    for (size_t e = 0; e < row->count; e++) {
        sum += row->values[e];
        for (size_t c = 0; c < 3; c++)
            x[c] += row->values[e] * lattice->deformed[3 * (size_t)row->columns[e] + c];
    }
    for (size_t c = 0; c < 3 && sum > 0; c++)
        x[c] /= sum;
}

void ffd_row_tangent(const ffd_lattice *lattice, const control_change *change, const basis_row *row,
                     const double x[3], double tangent[3])
{
    const double *const points = change->points, *const weights = change->weights;
    memset(tangent, 0, 3 * sizeof *tangent);
    for (size_t e = 0; e < row->count; e++) {
        const size_t point = row->columns[e];
        const double part =
            weights ? weights[point] / (lattice->deformed_weights ? lattice->deformed_weights[point] : 1) : 0;
        for (size_t c = 0; c < 3; c++)
            tangent[c] += row->values[e] * ((points ? points[3 * point + c] : 0) +
                                            part * (lattice->deformed[3 * point + c] - x[c]));
    }
}
