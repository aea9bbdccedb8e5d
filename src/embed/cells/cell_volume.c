#include "embed/cells/cell_volume.h"
#include "base/vector/vec.h"
#include "embed/frame/rational_volume.h"

enum { N = BEZIER_COMPONENTS };

/* Flat cells */

/* Computes C_u, C_v, C_w by the quotient rule, each coordinate in units of the lattice's extent; also C
   unless value is NULL. */
static void columns_of(const cell_search *cells, const homogeneous *at, double column[3][3], double *value)
{
    for (int r = 0; r < 3; r++) {
        const double unit = at->value[3] * cells->extent[r];
        for (int a = 0; a < 3; a++)
            column[a][r] = (at->derivative[a][r] - at->value[r] / at->value[3] * at->derivative[a][3]) / unit;
        if (value)
            value[r] = at->value[r] / unit;
    }
}

static void derivatives_at(const ffd_locator *locator, const int span[3], const double offset[3],
                           double column[3][3], double *value)
{
    homogeneous at;
    ffd_cells_evaluate(locator, span, offset, &at);
    columns_of(locator->cells, &at, column, value);
}

/* Returns det [C_u C_v C_w]. across[a] is the cross product of the next two columns, cyclically. */
static double determinant_of(const double column[3][3], double across[3][3])
{
    for (int a = 0; a < 3; a++)
        vec_cross(column[(a + 1) % 3], column[(a + 2) % 3], across[a]);
    return vec_dot(column[0], across[0]);
}

/* The basis functions of a cell, without weights, at one u,v,w. */
typedef struct plain_cell {
    cell_basis basis;
    cell_rows rows;
    double points[CELL_NUMBERS];
} plain_cell;

static void take_plain_cell(const ffd_locator *locator, const int span[3], const double offset[3],
                            plain_cell *cell)
{
    const int *const order = locator->cells->order;
    double *to = cell->points;
    ffd_cells_rows(locator, span, cell->rows, cell->points);
    for (int a = 0; a < 3; a++) {
        span_scheme own;
        ffd_basis_derivatives_by(ffd_cells_scheme(locator, a, span[a], &own), offset[a], cell->basis.value[a],
                                 cell->basis.slope[a]);
    }
    for (int k = 0; k < order[2]; k++)
        for (int j = 0; j < order[1]; j++) {
            const double *from = cell->rows[k][j];
            cell->rows[k][j] = to;
            for (int i = 0; i < order[0]; i++, from += N, to += N) {
                const double h = from[3];
                for (int r = 0; r < 3; r++)
                    to[r] = from[r] / h;
                to[3] = 1;
            }
        }
}

/* Computes the rounding error of each coordinate of a control point, in units of the extent: half an ulp in
   the file, if it was computed accurately, and at most another half when the origin is subtracted. */
static void roundings_of(const ffd_locator *locator, const double *point, double rounding[3])
{
    const cell_search *const cells = locator->cells;
    for (int r = 0; r < 3; r++) {
        const double file = point[r] + locator->origin[r] * cells->scale;
        rounding[r] = DBL_EPSILON * larger_of(fabs(file), fabs(point[r])) / cells->extent[r];
    }
}

/* Returns an upper bound of the change of the determinant if every control point moves by its rounding
   error. */
static double effect_of_roundings(const ffd_locator *locator, const plain_cell *cell,
                                  const double column[3][3], const double across[3][3])
{
    const int *const order = locator->cells->order;
    const cell_basis *const basis = &cell->basis;
    double alone[3] = {0, 0, 0}, rounding[3], sum = 0;
    for (int k = 0; k < order[2]; k++)
        for (int j = 0; j < order[1]; j++)
            for (int i = 0; i < order[0]; i++) {
                const double u = basis->value[0][i], v = basis->value[1][j], w = basis->value[2][k];
                const double slope[3] = {basis->slope[0][i] * v * w, u * basis->slope[1][j] * w,
                                         u * v * basis->slope[2][k]};
                roundings_of(locator, cell->rows[k][j] + N * i, rounding);
                for (int r = 0; r < 3; r++) {
                    sum += rounding[r] *
                           fabs(slope[0] * across[0][r] + slope[1] * across[1][r] + slope[2] * across[2][r]);
                    alone[r] += fabs(slope[r]) * vec_length(rounding);
                }
            }
    /* Terms of second and third order, for columns that are nearly parallel or 0. */
    for (int a = 0; a < 3; a++)
        sum += (vec_length(column[a]) + alone[a]) * alone[(a + 1) % 3] * alone[(a + 2) % 3];
    return sum + 4 * DBL_EPSILON * vec_length(column[0]) * vec_length(column[1]) * vec_length(column[2]);
}

/* Returns whether the rounding errors of the control points can make the determinant 0. Weights are ignored:
   where one weight dominates, C is nearly constant, and its derivatives are mostly rounding. */
static bool is_flat_to_rounding(const ffd_locator *locator, const int span[3], const double offset[3])
{
    const cell_search *const cells = locator->cells;
    double column[3][3], across[3][3];
    plain_cell cell;
    homogeneous at;
    take_plain_cell(locator, span, offset, &cell);
    cells->kernel(&cell.basis, cells->order, (const cell_rows *)&cell.rows, &at);
    columns_of(cells, &at, column, NULL);
    const double determinant = determinant_of((const double(*)[3])column, across);
    return !(fabs(determinant) >
             effect_of_roundings(locator, &cell, (const double(*)[3])column, (const double(*)[3])across));
}

/* Returns whether det [C_u C_v C_w] is 0 to rounding at t in [0,1]^3 of a cell. A cheap test decides most
   cells: the determinant is far greater than the rounding errors of its columns, which are sums of control
   points times slopes of about degree / side. */
static bool is_flat_at(const ffd_locator *locator, const int span[3], const double t[3])
{
    double offset[3], column[3][3], across[3][3], length[3], noise[3], most = 0;
    for (int r = 0; r < 3; r++)
        most = larger_of(most, locator->cells->size[r] / locator->cells->extent[r]);
    for (int a = 0; a < 3; a++) {
        const double *knot = locator->knots[a].t + span[a], side = knot[1] - knot[0];
        offset[a] = t[a] * side;
        noise[a] = 32 * DBL_EPSILON * most * locator->knots[a].degree / side;
    }
    derivatives_at(locator, span, offset, column, NULL);
    for (int a = 0; a < 3; a++)
        length[a] = vec_length(column[a]);
    const double determinant = determinant_of((const double(*)[3])column, across);
    return !(fabs(determinant) > noise[0] * length[1] * length[2] + noise[1] * length[0] * length[2] +
                                     noise[2] * length[0] * length[1]) &&
           is_flat_to_rounding(locator, span, offset);
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

static double triple_product(const double a[3], const double b[3], const double c[3])
{
    double cross[3];
    vec_cross(b, c, cross);
    return vec_dot(a, cross);
}

/* Signed volume: by Gauss's theorem the integral of det [C_u C_v C_w] over the domain equals that of det [C,
   C_b, C_c] / 3 over its border, (a,b,c) cyclic, last face minus first face. Faces of closed directions
   cancel. */

/* The Gauss-Legendre rule with four nodes on [0,1], which is exact for degree 7. Without weights the
   integrand of a face of degree d is a polynomial of degree 3d - 1. */
static const double rule[4][2] = {{0.06943184420297371, 0.17392742256872693},
                                  {0.33000947820757187, 0.32607257743127307},
                                  {0.66999052179242813, 0.32607257743127307},
                                  {0.93056815579702629, 0.17392742256872693}};

/* Returns the number of parts of a cell in a direction to which the rule is applied. */
static int parts_of(int degree)
{
    return 1 + degree / 4;
}

/* Integrates over a cell, given by its spans, of the face of direction a at `end`. */
static double face_cell(const ffd_locator *locator, int a, int end, const int span[3])
{
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    double side[3], offset[3], column[3][3], value[3], sum = 0;
    for (int d = 0; d < 3; d++)
        side[d] = locator->knots[d].t[span[d] + 1] - locator->knots[d].t[span[d]];
    const int parts_b = parts_of(locator->knots[b].degree), parts_c = parts_of(locator->knots[c].degree);
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

static double polynomial_volume(const ffd_locator *locator)
{
    double volume = 0;
    for (int a = 0; a < 3; a++)
        for (int end = 0; end < 2 && !ffd_knots_closed(&locator->knots[a]); end++)
            volume += face_volume(locator, a, end);
    return volume;
}

static ffd_status find_sign(const ffd_locator *locator, ffd_error *error)
{
    rational_volume volume = {0};
    ffd_status status = FFD_OK;
    if (locator->cells->rational)
        status = ffd_rational_volume(locator->lattice, &volume, error);
    else
        volume.triple = polynomial_volume(locator);
    locator->cells->volume_sign = volume.triple < 0 ? -1 : 1;
    return status;
}

ffd_status ffd_cells_check_volume(const ffd_locator *locator, ffd_error *error)
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
    return find_sign(locator, error);
}
