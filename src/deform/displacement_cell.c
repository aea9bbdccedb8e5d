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

static bool needs_rest(const ffd_lattice *lattice, bool gradients)
{
    return gradients && !lattice->has_uvw_by_p;
}

static size_t point_count(const ffd_lattice *lattice)
{
    size_t count = 1;
    for (int a = 0; a < 3; a++)
        count *= (size_t)lattice->knots[a].degree + 1;
    return count;
}

static void load_points(const ffd_lattice *lattice, extraction_kernel *extract, const double *field,
                        const size_t number[3], double *points)
{
    int span[3], degree[3];
    const double *extraction[3];
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const size_t order = (size_t)knots->degree + 1;
        span[a] = knots->spans[number[a]];
        degree[a] = knots->degree;
        extraction[a] = knots->extractions + number[a] * order * order;
    }
    ffd_lattice_cell_points(lattice, field, span, points);
    points[3 * point_count(lattice)] = 0;
    extract(degree, extraction, points);
}

size_t ffd_displacement_cell_numbers(const ffd_lattice *lattice, bool gradients)
{
    return (needs_rest(lattice, gradients) ? 2 : 1) * 3 * point_count(lattice);
}

bool ffd_displacement_cell_points(const ffd_lattice *lattice, extraction_kernel *extract,
                                  const size_t number[3], bool gradients, double *numbers)
{
    int span[3];
    for (int a = 0; a < 3; a++)
        span[a] = lattice->knots[a].spans[number[a]];
    if (!ffd_displacement_reaches(lattice, span))
        return false;
    load_points(lattice, extract, lattice->difference, number, numbers);
    if (needs_rest(lattice, gradients))
        load_points(lattice, extract, lattice->rest, number, numbers + 3 * point_count(lattice));
    return true;
}

void ffd_displacement_cell_begin(const ffd_lattice *lattice, const size_t number[3], bool gradients,
                                 const double *numbers, kernel_cell *cell)
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const int span = knots->spans[number[a]];
        cell->degree[a] = knots->degree;
        cell->first[a] = knots->t[span];
        cell->width[a] = knots->t[span + 1] - knots->t[span];
    }
    cell->difference = numbers;
    cell->inverse = lattice->has_uvw_by_p ? lattice->uvw_by_p : NULL;
    cell->rest = needs_rest(lattice, gradients) ? numbers + 3 * point_count(lattice) : NULL;
}
