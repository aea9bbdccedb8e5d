#include "points/basis_row.h"
#include "base/text/number.h"
#include "deform/extension.h"
#include "spline/basis.h"
#include "spline/knots.h"
#include <math.h>
#include <string.h>

ffd_status ffd_basis_weights(const ffd_embedding *embedding, const double **weights, ffd_error *error)
{
    for (size_t i = 0; *weights && i < embedding->rest->count; i++)
        if (!((*weights)[i] > 0 && isfinite((*weights)[i])))
            return ffd_fail(error, FFD_E_INVALID,
                            "the weight %s of control point %zu is not positive and finite",
                            ffd_number_text((*weights)[i]).text, i);
    *weights = *weights ? *weights : embedding->rest->rest_weights;
    return FFD_OK;
}

/* The control points of a direction whose basis functions are not 0 at u, with these functions. */
typedef struct factor {
    size_t count, index[MAX_ORDER];
    double value[MAX_ORDER];
} factor;

/* Sorts by control point, because the indices wrap round in a closed direction. */
static void make_factor(const knot_vector *knots, int span, const double value[MAX_ORDER], factor *made)
{
    const size_t order = (size_t)knots->degree + 1, first = (size_t)span - (size_t)knots->degree;
    size_t wrapped = 0; /* number of functions before the seam */
    while (wrapped < order && ffd_knots_point(knots, first + wrapped) >= ffd_knots_point(knots, first))
        wrapped++;
    made->count = order;
    for (size_t i = 0; i < order; i++) {
        const size_t from = (i + wrapped) % order;
        made->index[i] = ffd_knots_point(knots, first + from);
        made->value[i] = value[from];
    }
}

/* Replaces the factors of directions with held ends. */
static void seal_factors(const row_seal *seal, const ffd_lattice *lattice, const lattice_basis *basis,
                         const lattice_basis *sealed, factor of[3])
{
    for (int a = 0; a < 3; a++) {
        const size_t degree = (size_t)lattice->knots[a].degree;
        if (seal->directions[a].is_held)
            ffd_row_seal_factors(&seal->directions[a], (int)degree, (size_t)basis->span[a] - degree,
                                 (size_t)sealed->span[a] - degree, sealed->value[a], of[a].value);
    }
}

/* sum h N N N of the deformed volume of a sealed lattice, whose held layers have the weights at rest. */
static double sum_weights(const ffd_lattice *sealed, const lattice_basis *basis)
{
    double weights[BASIS_ENTRIES], sum = 0;
    size_t next = 0;
    if (!sealed->deformed_weights)
        return 1;
    ffd_lattice_cell_weights(sealed, sealed->deformed_weights, basis->span, weights);
    for (int k = 0; k <= sealed->knots[2].degree; k++)
        for (int j = 0; j <= sealed->knots[1].degree; j++)
            for (int i = 0; i <= sealed->knots[0].degree; i++)
                sum += basis->value[2][k] * basis->value[1][j] * basis->value[0][i] * weights[next++];
    return sum;
}

/* N N N of control point i,j,k of three factors, times its weight. */
static inline double product_of(const factor of[3], size_t i, size_t j, size_t k, double weight)
{
    return of[2].value[k] * of[1].value[j] * of[0].value[i] * weight;
}

/* Adds the products that are not 0 to the row, in ascending order of their columns. Without weights. */
static void add_plain(const factor of[3], const size_t step[3], basis_order order, basis_row *row)
{
    const int inner = order == BASIS_BY_U ? 0 : 2, outer = 2 - inner;
    size_t at[3];
    for (at[outer] = 0; at[outer] < of[outer].count; at[outer]++)
        for (at[1] = 0; at[1] < of[1].count; at[1]++)
            for (at[inner] = 0; at[inner] < of[inner].count; at[inner]++) {
                const double value = product_of(of, at[0], at[1], at[2], 1);
                row->columns[row->count] =
                    (uint32_t)(step[0] * of[0].index[at[0]] + step[1] * of[1].index[at[1]] +
                               step[2] * of[2].index[at[2]]);
                row->values[row->count] = value;
                row->count += value != 0;
            }
}

/* The same with weights. Returns their sum, which has u innermost in every order. */
static double add_weighted(const factor of[3], const ffd_lattice *lattice, const double *weights,
                           const size_t step[3], basis_order order, basis_row *row)
{
    const int inner = order == BASIS_BY_U ? 0 : 2, outer = 2 - inner;
    const size_t *const size = lattice->size;
    double sum = 0;
    size_t at[3];
    for (size_t k = 0; k < of[2].count; k++)
        for (size_t j = 0; j < of[1].count; j++)
            for (size_t i = 0; i < of[0].count; i++)
                sum += product_of(
                    of, i, j, k,
                    weights[of[0].index[i] + size[0] * (of[1].index[j] + size[1] * of[2].index[k])]);
    for (at[outer] = 0; at[outer] < of[outer].count; at[outer]++)
        for (at[1] = 0; at[1] < of[1].count; at[1]++)
            for (at[inner] = 0; at[inner] < of[inner].count; at[inner]++) {
                const size_t index[3] = {of[0].index[at[0]], of[1].index[at[1]], of[2].index[at[2]]};
                const double weight = weights[index[0] + size[0] * (index[1] + size[1] * index[2])];
                const double value = product_of(of, at[0], at[1], at[2], weight);
                row->columns[row->count] =
                    (uint32_t)(step[0] * index[0] + step[1] * index[1] + step[2] * index[2]);
                row->values[row->count] = value;
                row->count += value != 0;
            }
    return sum;
}

/* As ffd_lattice_basis, without derivatives. */
static void find_values(const ffd_lattice *lattice, const double inside[3], lattice_basis *basis)
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        basis->span[a] = ffd_knots_span(knots, inside[a]);
        ffd_basis_values(knots, basis->span[a], inside[a], basis->value[a]);
    }
}

/* Fills the row at u,v,w of a lattice, times the scale: R_j = h_j N N N / sum h N N N (NURBS Book 4.2). */
static void fill_row(const ffd_lattice *lattice, const double *weights, const row_seal *seal,
                     basis_order order, const double uvw[3], double scale, basis_row *row)
{
    const size_t *const size = lattice->size;
    const size_t steps[2][3] = {{1, size[0], size[0] * size[1]}, {size[1] * size[2], size[2], 1}};
    const size_t *const step = steps[order == BASIS_BY_W];
    lattice_basis basis, sealed;
    factor of[3];
    double inside[3], sum = 1;
    row->count = 0;
    for (int a = 0; a < 3; a++)
        inside[a] = ffd_knots_wrap(&lattice->knots[a], uvw[a]);
    find_values(lattice, inside, &basis);
    for (int a = 0; a < 3; a++)
        make_factor(&lattice->knots[a], basis.span[a], basis.value[a], &of[a]);
    if (seal) {
        find_values(seal->sealed, inside, &sealed);
        seal_factors(seal, lattice, &basis, &sealed, of);
    }
    if (weights)
        sum = add_weighted(of, lattice, weights, step, order, row);
    else
        add_plain(of, step, order, row);
    if (seal && weights)
        sum = sum_weights(seal->sealed, &sealed);
    for (size_t i = 0; i < row->count && (weights || scale != 1); i++)
        row->values[i] = weights ? scale * (row->values[i] / sum) : scale * row->values[i];
}

/* Returns the extended point that a point is, if it is one; next as of ffd_basis_row. */
static const extended_point *extended_at(const ffd_embedding *embedding, size_t point, size_t next)
{
    return next < embedding->extended_count && embedding->extended[next].point == point
               ? &embedding->extended[next]
               : NULL;
}

bool ffd_basis_uvw(const ffd_embedding *embedding, size_t point, size_t next, double uvw[3])
{
    const extended_point *const extended = extended_at(embedding, point, next);
    const bool has = ffd_embedding_has(embedding, point);
    if (has || extended)
        memcpy(uvw, has ? embedding->uvw + 3 * point : extended->nearest.uvw, 3 * sizeof *uvw);
    return has || extended;
}

void ffd_basis_row(const ffd_embedding *embedding, const double *weights, const row_seal *seal,
                   basis_order order, size_t point, size_t *next, basis_row *row)
{
    row->count = 0;
    if (ffd_embedding_has(embedding, point)) {
        fill_row(embedding->rest, weights, seal, order, embedding->uvw + 3 * point, 1, row);
        return;
    }
    while (*next < embedding->extended_count && embedding->extended[*next].point < point)
        ++*next;
    const extended_point *const extended = extended_at(embedding, point, *next);
    const double fade =
        extended ? ffd_extension_fade(extended->nearest.distance, embedding->falloff, NULL) : 0;
    if (fade > 0)
        fill_row(embedding->rest, weights, seal, order, extended->nearest.uvw, fade, row);
}
