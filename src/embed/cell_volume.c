#include "base/vec.h"
#include "embed/cells.h"

/* det [C_u C_v C_w] at t of a cell's [0,1]^3, each coordinate in units of the lattice's extent; *flat: it is
   no more than the rounding of its columns can make, which are sums of control points times slopes of about
   degree / side. */
static double determinant_in(const ffd_locator *locator, const int span[3], const double t[3], bool *flat)
{
    homogeneous at;
    double offset[3], column[3][3], cross[3], length[3], noise[3];
    for (int a = 0; a < 3; a++) {
        const double *knot = locator->knots[a].t + span[a], side = knot[1] - knot[0];
        offset[a] = t[a] * side;
        noise[a] = 32 * DBL_EPSILON * locator->knots[a].degree / side;
    }
    ffd_cells_evaluate(locator, span, offset, &at);
    for (int a = 0; a < 3; a++) {
        for (int r = 0; r < 3; r++)
            column[a][r] = (at.derivative[a][r] - at.value[r] / at.value[3] * at.derivative[a][3]) /
                           (at.value[3] * locator->cells->extent[r]);
        length[a] = vec_length(column[a]);
    }
    vec_cross(column[1], column[2], cross);
    const double det = vec_dot(column[0], cross);
    *flat = !(fabs(det) > noise[0] * length[1] * length[2] + noise[1] * length[0] * length[2] +
                              noise[2] * length[0] * length[1]);
    return det;
}

/* The part of the signed volume that a cell has, by one-point quadrature; *flat: it has none at any
   of 9 places. */
static double cell_volume(const ffd_locator *locator, const size_t cell[3], bool *flat)
{
    static const double places[9][3] = {{0.5, 0.5, 0.5},    {0.25, 0.25, 0.25}, {0.75, 0.25, 0.25},
                                        {0.25, 0.75, 0.25}, {0.75, 0.75, 0.25}, {0.25, 0.25, 0.75},
                                        {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}, {0.75, 0.75, 0.75}};
    int span[3];
    double side = 1;
    ffd_cell_spans(locator->lattice, cell, span);
    for (int a = 0; a < 3; a++) {
        const double *knot = locator->knots[a].t + span[a];
        side *= knot[1] - knot[0];
    }
    const double volume = determinant_in(locator, span, places[0], flat) * side;
    for (int i = 1; i < 9 && *flat; i++)
        determinant_in(locator, span, places[i], flat);
    return volume;
}

ffd_status ffd_cells_look_at_volume(const ffd_locator *locator, ffd_error *error)
{
    cell_search *cells = locator->cells;
    const size_t count = cells->cells[0] * cells->cells[1] * cells->cells[2];
    double volume = 0;
    for (size_t n = 0; n < count; n++) {
        const size_t cell[3] = {n % cells->cells[0], n / cells->cells[0] % cells->cells[1],
                                n / cells->cells[0] / cells->cells[1]};
        bool flat;
        volume += cell_volume(locator, cell, &flat);
        if (flat)
            return ffd_fail(
                error, FFD_E_INVALID,
                "the rest lattice has no volume in cell (%zu, %zu, %zu): its control points lie in a plane "
                "or on a line",
                cell[0], cell[1], cell[2]);
    }
    cells->volume_sign = volume < 0 ? -1 : 1;
    return FFD_OK;
}
