#include "deform/displacement_cell.h"
#include "base/vec.h"
#include <string.h>

bool ffd_displacement_reaches(const ffd_lattice *lattice, const int span[3])
{
    size_t first[3];
    for (int a = 0; a < 3; a++)
        first[a] = (size_t)(span[a] - lattice->knots[a].degree);
    for (int k = 0; k <= lattice->knots[2].degree; k++) {
        const size_t plane = lattice->size[1] * ffd_knots_point(&lattice->knots[2], first[2] + (size_t)k);
        for (int j = 0; j <= lattice->knots[1].degree; j++) {
            const size_t row =
                lattice->size[0] * (plane + ffd_knots_point(&lattice->knots[1], first[1] + (size_t)j));
            for (int i = 0; i <= lattice->knots[0].degree; i++)
                if (lattice->moved[row + ffd_knots_point(&lattice->knots[0], first[0] + (size_t)i)])
                    return true;
        }
    }
    return false;
}

void ffd_displacement_wrap(const ffd_lattice *lattice, const double uvw[3], double inside[3])
{
    for (int a = 0; a < 3; a++)
        inside[a] = ffd_knots_wrap(&lattice->knots[a], uvw[a]);
}

void ffd_displacement_to_space(const double jacobian[9], double gradient[9])
{
    double inverse[9], by_uvw[9];
    memcpy(by_uvw, gradient, sizeof by_uvw);
    if (mat_invert(jacobian, inverse))
        mat_multiply(by_uvw, inverse, gradient);
    else
        memset(gradient, 0, 9 * sizeof *gradient);
}

bool ffd_displacement_load(const ffd_lattice *lattice, const size_t number[3], bool gradients,
                           double *difference, double *rest, kernel_cell *cell)
{
    int span[3];
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const size_t order = (size_t)knots->degree + 1;
        span[a] = knots->spans[number[a]];
        cell->degree[a] = knots->degree;
        cell->first[a] = knots->t[span[a]];
        cell->width[a] = knots->t[span[a] + 1] - knots->t[span[a]];
        cell->extraction[a] = knots->extractions + number[a] * order * order;
    }
    if (!ffd_displacement_reaches(lattice, span))
        return false;
    ffd_lattice_cell_points(lattice, lattice->difference, span, difference);
    cell->difference = difference;
    cell->inverse = lattice->has_uvw_by_p ? lattice->uvw_by_p : NULL;
    cell->rest = NULL;
    if (gradients && !cell->inverse) {
        ffd_lattice_cell_points(lattice, lattice->rest, span, rest);
        cell->rest = rest;
    }
    return true;
}
