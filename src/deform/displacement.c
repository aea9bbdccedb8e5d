#include "deform/displacement.h"
#include <string.h>

/* The delta form (src/maths.md 7.1): sum (Q - P) R. The residual of the inversion enters only multiplied by
   the gradient of the displacement, and a translation is exact to rounding. by_uvw may be NULL. */
static void sum_differences(const ffd_lattice *lattice, const lattice_basis *basis, double delta[3],
                            double *by_uvw)
{
    if (!lattice->weights_moved) {
        ffd_lattice_sum_rational(lattice, basis, lattice->difference, lattice->rest_weights, delta, by_uvw);
        return;
    }
    double rest[3], rest_by[9];
    ffd_lattice_sum_rational(lattice, basis, lattice->rest, lattice->rest_weights, rest,
                             by_uvw ? rest_by : NULL);
    ffd_lattice_sum_rational(lattice, basis, lattice->deformed, lattice->deformed_weights, delta, by_uvw);
    for (int r = 0; r < 3; r++)
        delta[r] -= rest[r];
    for (int i = 0; by_uvw && i < 9; i++)
        by_uvw[i] -= rest_by[i];
}

/* Computes the displacement of a point; by_uvw and jacobian are both given or both NULL. Returns false, and
   writes nothing, if no moved control point acts on it. If all control points that act have the same
   displacement, the result is exactly that, which the sum would miss by rounding. */
static bool displace_rational(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                              double *by_uvw, double *jacobian)
{
    lattice_basis basis;
    double inside[3], point[3];
    ffd_displacement_wrap(lattice, uvw, inside);
    ffd_lattice_basis(lattice, inside, &basis);
    if (!ffd_displacement_reaches(lattice, basis.span))
        return false;
    sum_differences(lattice, &basis, delta, by_uvw);
    const double *const shared = ffd_displacement_shared(lattice, basis.span, inside);
    if (shared)
        memcpy(delta, shared, 3 * sizeof *delta);
    if (by_uvw && ffd_displacement_shared(lattice, basis.span, NULL))
        memset(by_uvw, 0, 9 * sizeof *by_uvw);
    if (jacobian)
        ffd_lattice_sum_rational(lattice, &basis, lattice->rest, lattice->rest_weights, point, jacobian);
    return true;
}

static void shift(const double shared[3], double delta[3], double *by_uvw, double *jacobian)
{
    static const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    memcpy(delta, shared, 3 * sizeof *delta);
    if (by_uvw)
        memset(by_uvw, 0, 9 * sizeof *by_uvw);
    if (jacobian) /* any invertible matrix will do: by_uvw is 0 */
        memcpy(jacobian, unit, sizeof unit);
}

/* As displace_rational. If the lattice has a constant d uvw / d p and inverse is true, by_uvw is the gradient
   and jacobian NULL. */
static bool displace(const ffd_lattice *lattice, const double uvw[3], bool inverse, double delta[3],
                     double *by_uvw, double *jacobian)
{
    static const uint32_t which[1] = {0};
    double inside[3], numbers[2 * FIELD_NUMBERS + 1];
    const cell_use use = jacobian ? CELL_GRADIENTS : by_uvw ? CELL_BY_UVW : CELL_VALUES;
    size_t index[3];
    int span[3];
    kernel_cell cell;
    if (lattice->rest_weights)
        return displace_rational(lattice, uvw, delta, by_uvw, jacobian);
    ffd_displacement_wrap(lattice, uvw, inside);
    for (int a = 0; a < 3; a++)
        index[a] = ffd_knots_span_index(&lattice->knots[a], inside[a]);
    const cell_motion motion =
        ffd_displacement_cell_points(lattice, ffd_extraction_kernel_scalar, index, use, numbers);
    if (motion.kind == CELL_STILL)
        return false;
    ffd_displacement_spans(lattice, index, span);
    if (motion.kind == CELL_SHIFTED) {
        shift(ffd_displacement_shared(lattice, span, NULL), delta, by_uvw, jacobian);
        return true;
    }
    const double *const shared = motion.knots ? ffd_displacement_shared(lattice, span, inside) : NULL;
    ffd_displacement_cell_begin(lattice, index, use, numbers, &cell);
    cell.inverse = inverse ? cell.inverse : NULL;
    const kernel_points points = {
        .uvw = inside, .which = which, .count = 1, .delta = delta, .gradient = by_uvw, .jacobian = jacobian};
    ffd_kernel_scalar(&cell, &points);
    if (shared)
        memcpy(delta, shared, 3 * sizeof *delta);
    return true;
}

int ffd_displacement_by_uvw(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                            double by_uvw[9])
{
    memset(delta, 0, 3 * sizeof *delta);
    if (by_uvw)
        memset(by_uvw, 0, 9 * sizeof *by_uvw);
    return displace(lattice, uvw, false, delta, by_uvw, NULL);
}

int ffd_displacement(const ffd_lattice *lattice, const double uvw[3], double delta[3], double gradient[9])
{
    const bool general = gradient && !lattice->has_uvw_by_p;
    double jacobian[9];
    memset(delta, 0, 3 * sizeof *delta);
    if (gradient)
        memset(gradient, 0, 9 * sizeof *gradient);
    if (!displace(lattice, uvw, true, delta, gradient, general ? jacobian : NULL))
        return 0;
    if (general)
        ffd_displacement_to_space(jacobian, gradient);
    return 1;
}
