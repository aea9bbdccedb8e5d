#include "embed/cells/cell_volume.h"
#include "base/vector/vec.h"

/* Flat cells */

/* C's derivatives, each coordinate in units of the lattice's extent; C itself likewise where value is not
   NULL. */
static void derivatives_at(const ffd_locator *locator, const int span[3], const double offset[3],
                           double column[3][3], double *value)
{
    homogeneous at;
    ffd_cells_evaluate(locator, span, offset, &at);
    for (int r = 0; r < 3; r++) {
        const double unit = at.value[3] * locator->cells->extent[r];
        for (int a = 0; a < 3; a++)
            column[a][r] = (at.derivative[a][r] - at.value[r] / at.value[3] * at.derivative[a][3]) / unit;
        if (value)
            value[r] = at.value[r] / unit;
    }
}

static double triple_product(const double a[3], const double b[3], const double c[3])
{
    double cross[3];
    vec_cross(b, c, cross);
    return vec_dot(a, cross);
}

/* Whether det [C_u C_v C_w] at t of a cell's [0,1]^3 is no more than the rounding of its columns can make,
   which are sums of control points times slopes of about degree / side. */
static bool is_flat_at(const ffd_locator *locator, const int span[3], const double t[3])
{
    double offset[3], column[3][3], length[3], noise[3];
    for (int a = 0; a < 3; a++) {
        const double *knot = locator->knots[a].t + span[a], side = knot[1] - knot[0];
        offset[a] = t[a] * side;
        noise[a] = 32 * DBL_EPSILON * locator->knots[a].degree / side;
    }
    derivatives_at(locator, span, offset, column, NULL);
    for (int a = 0; a < 3; a++)
        length[a] = vec_length(column[a]);
    const double det = triple_product(column[0], column[1], column[2]);
    return !(fabs(det) > noise[0] * length[1] * length[2] + noise[1] * length[0] * length[2] +
                             noise[2] * length[0] * length[1]);
}

static bool is_flat(const ffd_locator *locator, const size_t cell[3])
{
    static const double samples[9][3] = {{0.5, 0.5, 0.5},    {0.25, 0.25, 0.25}, {0.75, 0.25, 0.25},
                                         {0.25, 0.75, 0.25}, {0.75, 0.75, 0.25}, {0.25, 0.25, 0.75},
                                         {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}, {0.75, 0.75, 0.75}};
    int span[3];
    ffd_cell_spans(locator->lattice, cell, span);
    for (int i = 0; i < 9; i++)
        if (!is_flat_at(locator, span, samples[i]))
            return false;
    return true;
}

/* Signed volume: the integral of det [C_u C_v C_w] over the domain is that of det [C, C_b, C_c] / 3 over its
   border (Gauss), (a,b,c) cyclic, last face less first. Faces of closed directions cancel. */

/* The four points of Gauss-Legendre's rule on [0,1]. It is exact for degree 7; a face of degree d has 3d - 1.
 */
static const double rule[4][2] = {{0.06943184420297371, 0.17392742256872693},
                                  {0.33000947820757187, 0.32607257743127307},
                                  {0.66999052179242813, 0.32607257743127307},
                                  {0.93056815579702629, 0.17392742256872693}};

/* Parts of a cell in each direction that the rule is used on. */
static int parts_of(const cell_search *cells, int degree)
{
    return 1 + degree / 4 + (cells->rational ? 2 : 0);
}

/* Over the cell of the face of direction a at `end` whose spans are given. */
static double face_cell(const ffd_locator *locator, int a, int end, const int span[3])
{
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    double side[3], offset[3], column[3][3], value[3], sum = 0;
    for (int d = 0; d < 3; d++)
        side[d] = locator->knots[d].t[span[d] + 1] - locator->knots[d].t[span[d]];
    const int parts_b = parts_of(locator->cells, locator->knots[b].degree),
              parts_c = parts_of(locator->cells, locator->knots[c].degree);
    offset[a] = end ? side[a] : 0;
    for (int j = 0; j < 4 * parts_c; j++)
        for (int i = 0; i < 4 * parts_b; i++) {
            offset[b] = side[b] * ((i / 4 + rule[i % 4][0]) / parts_b);
            offset[c] = side[c] * ((j / 4 + rule[j % 4][0]) / parts_c);
            derivatives_at(locator, span, offset, column, value);
            sum += rule[i % 4][1] * rule[j % 4][1] * triple_product(value, column[b], column[c]);
        }
    return sum * (side[b] / parts_b) * (side[c] / parts_c);
}

static double face_volume(const ffd_locator *locator, int a, int end)
{
    const cell_search *cells = locator->cells;
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    size_t cell[3];
    double sum = 0;
    cell[a] = end ? cells->cells[a] - 1 : 0;
    for (cell[c] = 0; cell[c] < cells->cells[c]; cell[c]++)
        for (cell[b] = 0; cell[b] < cells->cells[b]; cell[b]++) {
            int span[3];
            ffd_cell_spans(locator->lattice, cell, span);
            sum += face_cell(locator, a, end, span);
        }
    return end ? sum : -sum;
}

static double signed_volume(const ffd_locator *locator)
{
    double volume = 0;
    for (int a = 0; a < 3; a++)
        for (int end = 0; end < 2 && !ffd_knots_closed(&locator->knots[a]); end++)
            volume += face_volume(locator, a, end);
    return volume;
}

ffd_status ffd_cells_look_at_volume(const ffd_locator *locator, ffd_error *error)
{
    cell_search *cells = locator->cells;
    const size_t count = cells->cells[0] * cells->cells[1] * cells->cells[2];
    for (size_t n = 0; n < count; n++) {
        const size_t cell[3] = {n % cells->cells[0], n / cells->cells[0] % cells->cells[1],
                                n / cells->cells[0] / cells->cells[1]};
        if (is_flat(locator, cell))
            return ffd_fail(
                error, FFD_E_INVALID,
                "the rest lattice has no volume in cell (%zu, %zu, %zu): its control points lie in a plane "
                "or on a line",
                cell[0], cell[1], cell[2]);
    }
    cells->volume_sign = signed_volume(locator) < 0 ? -1 : 1;
    return FFD_OK;
}
