#include "fit/unknowns.h"

/* How far apart the functions of a place are in a direction: in a closed one the first ones follow the last.
 */
static size_t extent_of(const ffd_lattice *lattice, int a)
{
    const size_t degree = (size_t)lattice->knots[a].degree, last = lattice->size[a] - 1;
    return ffd_knots_closed(&lattice->knots[a]) || degree > last ? last : degree;
}

/* order: the directions from the slowest to the fastest. */
static fit_unknowns order_by(const ffd_lattice *lattice, const int order[3])
{
    fit_unknowns unknowns = {.lattice = lattice, .count = 1, .row = 1};
    for (int o = 3; o-- > 0;) {
        const int a = order[o];
        unknowns.stride[a] = unknowns.count;
        unknowns.reach += extent_of(lattice, a) * unknowns.count;
        unknowns.count *= lattice->size[a];
        unknowns.row *= (size_t)lattice->knots[a].degree + 1;
    }
    return unknowns;
}

fit_unknowns ffd_unknowns_make(const ffd_lattice *lattice)
{
    static const int orders[][3] = {{2, 1, 0}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {0, 1, 2}};
    fit_unknowns best = order_by(lattice, orders[0]);
    for (size_t o = 1; o < sizeof orders / sizeof *orders; o++) {
        const fit_unknowns other = order_by(lattice, orders[o]);
        if (other.reach < best.reach)
            best = other;
    }
    return best;
}

size_t ffd_unknowns_cell(const fit_unknowns *unknowns, const double uvw[3])
{
    const knot_vector *const knots = unknowns->lattice->knots;
    size_t cell = 0;
    for (int a = 3; a-- > 0;)
        cell =
            cell * knots[a].span_count + ffd_knots_span_index(&knots[a], ffd_knots_wrap(&knots[a], uvw[a]));
    return cell;
}

void ffd_unknowns_seen(const fit_unknowns *unknowns, const double uvw[3], uint32_t *seen)
{
    const knot_vector *const knots = unknowns->lattice->knots;
    size_t at[3][MAX_ORDER], n = 0;
    for (int a = 0; a < 3; a++) {
        const int first = ffd_knots_span(&knots[a], ffd_knots_wrap(&knots[a], uvw[a])) - knots[a].degree;
        for (int i = 0; i <= knots[a].degree; i++)
            at[a][i] = unknowns->stride[a] * ffd_knots_point(&knots[a], (size_t)(first + i));
    }
    for (int k = 0; k <= knots[2].degree; k++)
        for (int j = 0; j <= knots[1].degree; j++)
            for (int i = 0; i <= knots[0].degree; i++)
                seen[n++] = (uint32_t)(at[0][i] + at[1][j] + at[2][k]);
}

/* Multiplies the functions by the weights of the lattice, and divides them by their sum. */
static void weigh(const ffd_lattice *lattice, const lattice_basis *basis, size_t count, double *row)
{
    double weights[LONGEST_ROW], sum = 0;
    ffd_lattice_cell_weights(lattice, lattice->rest_weights, basis->span, weights);
    for (size_t n = 0; n < count; n++) {
        row[n] *= weights[n];
        sum += row[n];
    }
    for (size_t n = 0; n < count; n++)
        row[n] /= sum;
}

void ffd_unknowns_row(const fit_unknowns *unknowns, const double uvw[3], double *row)
{
    const ffd_lattice *const lattice = unknowns->lattice;
    const knot_vector *const knots = lattice->knots;
    lattice_basis basis;
    double inside[3];
    size_t n = 0;
    for (int a = 0; a < 3; a++)
        inside[a] = ffd_knots_wrap(&knots[a], uvw[a]);
    ffd_lattice_basis(lattice, inside, &basis);
    for (int k = 0; k <= knots[2].degree; k++)
        for (int j = 0; j <= knots[1].degree; j++) {
            const double outer = basis.value[2][k] * basis.value[1][j];
            for (int i = 0; i <= knots[0].degree; i++)
                row[n++] = outer * basis.value[0][i];
        }
    if (lattice->rest_weights)
        weigh(lattice, &basis, n, row);
}
