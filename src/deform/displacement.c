#include "deform/displacement.h"
#include "base/vec.h"
#include <ffd/deform.h>
#include <string.h>

/* Whether a moved control point acts in the basis' cell. */
static bool is_reached(const ffd_lattice *lattice, const lattice_basis *basis)
{
    size_t first[3];
    for (int a = 0; a < 3; a++)
        first[a] = (size_t)(basis->span[a] - lattice->knots[a].degree);
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

/* Delta form (maths.md 7): sum (Q - P) R, so that an inversion's residual enters only through the
   displacement's gradient and a translation is exact to rounding. by_uvw may be NULL. */
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

/* The basis is that of u,v,w taken to the domain; by_uvw may be NULL. */
static int displace(const ffd_lattice *lattice, const double uvw[3], lattice_basis *basis, double delta[3],
                    double *by_uvw)
{
    double inside[3];
    for (int a = 0; a < 3; a++)
        inside[a] = ffd_knots_wrap(&lattice->knots[a], uvw[a]);
    ffd_lattice_basis(lattice, inside, basis);
    memset(delta, 0, 3 * sizeof *delta);
    if (by_uvw)
        memset(by_uvw, 0, 9 * sizeof *by_uvw);
    if (!is_reached(lattice, basis))
        return 0;
    sum_differences(lattice, basis, delta, by_uvw);
    return 1;
}

int ffd_displacement_by_uvw(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                            double by_uvw[9])
{
    lattice_basis basis;
    return displace(lattice, uvw, &basis, delta, by_uvw);
}

int ffd_displacement(const ffd_lattice *lattice, const double uvw[3], double delta[3], double gradient[9])
{
    lattice_basis basis;
    double by_uvw[9], point[3], jacobian[9], inverse[9];
    const int moved = displace(lattice, uvw, &basis, delta, gradient ? by_uvw : NULL);
    if (!gradient)
        return moved;
    memset(gradient, 0, 9 * sizeof *gradient);
    if (!moved)
        return 0;
    ffd_lattice_sum_rational(lattice, &basis, lattice->rest, lattice->rest_weights, point, jacobian);
    if (mat_invert(jacobian, inverse))
        mat_multiply(by_uvw, inverse, gradient);
    return 1;
}
