#include "deform/displacement_cell.h"
#include "base/vector/vec.h"
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

static bool needs_rest(const ffd_lattice *lattice, cell_use use)
{
    return use == CELL_GRADIENTS && !lattice->has_uvw_by_p;
}

/* Numbers of the points, and those of the slopes, of a field in a cell. */
static size_t point_numbers(const ffd_lattice *lattice)
{
    size_t count = 3;
    for (int a = 0; a < 3; a++)
        count *= (size_t)lattice->knots[a].degree + 1;
    return count;
}

static size_t slope_numbers(const ffd_lattice *lattice)
{
    const size_t degree = (size_t)lattice->knots[0].degree;
    return point_numbers(lattice) / (degree + 1) * degree;
}

static size_t field_numbers(const ffd_lattice *lattice, cell_use use)
{
    return point_numbers(lattice) + (use == CELL_VALUES ? 0 : slope_numbers(lattice));
}

static void load_field(const ffd_lattice *lattice, extraction_kernel *extract, const double *field,
                       const size_t number[3], cell_use use, double *numbers)
{
    const size_t count = point_numbers(lattice);
    int span[3], degree[3];
    const double *extraction[3];
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const size_t order = (size_t)knots->degree + 1;
        span[a] = knots->spans[number[a]];
        degree[a] = knots->degree;
        extraction[a] = knots->extractions + number[a] * order * order;
    }
    ffd_lattice_cell_points(lattice, field, span, numbers);
    numbers[count] = 0;
    extract(degree, extraction, numbers, use == CELL_VALUES ? NULL : numbers + count);
}

size_t ffd_displacement_cell_numbers(const ffd_lattice *lattice, cell_use use)
{
    return (needs_rest(lattice, use) ? 2 : 1) * field_numbers(lattice, use);
}

bool ffd_displacement_cell_points(const ffd_lattice *lattice, extraction_kernel *extract,
                                  const size_t number[3], cell_use use, double *numbers)
{
    int span[3];
    for (int a = 0; a < 3; a++)
        span[a] = lattice->knots[a].spans[number[a]];
    if (!ffd_displacement_reaches(lattice, span))
        return false;
    load_field(lattice, extract, lattice->difference, number, use, numbers);
    if (needs_rest(lattice, use))
        load_field(lattice, extract, lattice->rest, number, use, numbers + field_numbers(lattice, use));
    return true;
}

void ffd_displacement_cell_begin(const ffd_lattice *lattice, const size_t number[3], cell_use use,
                                 const double *numbers, kernel_cell *cell)
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const int span = knots->spans[number[a]];
        cell->degree[a] = knots->degree;
        cell->first[a] = knots->t[span];
        cell->width[a] = knots->t[span + 1] - knots->t[span];
    }
    const size_t points = point_numbers(lattice);
    const double *const rest = numbers + field_numbers(lattice, use);
    cell->difference = (kernel_field){numbers, numbers + points};
    cell->rest = needs_rest(lattice, use) ? (kernel_field){rest, rest + points} : (kernel_field){NULL, NULL};
    cell->inverse = lattice->has_uvw_by_p ? lattice->uvw_by_p : NULL;
}
