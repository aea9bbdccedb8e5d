/* evaluate.c - points, derivatives and weights of the volume at u,v,w. */
#include "lattice/lattice.h"
#include "spline/basis.h"
#include "spline/knots.h"
#include <math.h>
#include <string.h>

/* The indices of the control points of a cell in each direction (wrapped round in closed directions). */
typedef struct cell_index {
    int count[3];
    size_t at[3][MAX_ORDER];
} cell_index;

static inline cell_index index_of_block(const ffd_lattice *lattice, const size_t first[3],
                                        const size_t count[3])
{
    cell_index index;
    for (int a = 0; a < 3; a++) {
        index.count[a] = (int)count[a];
        for (size_t i = 0; i < count[a]; i++)
            index.at[a][i] = ffd_knots_point(&lattice->knots[a], first[a] + i);
    }
    return index;
}

static inline cell_index index_of_cell(const ffd_lattice *lattice, const int span[3])
{
    size_t first[3], count[3];
    for (int a = 0; a < 3; a++) {
        first[a] = (size_t)(span[a] - lattice->knots[a].degree);
        count[a] = (size_t)lattice->knots[a].degree + 1;
    }
    return index_of_block(lattice, first, count);
}

/* Returns the index of the first control point of the row along u at position j of v and k of w. */
static size_t row_start(const ffd_lattice *lattice, const cell_index *index, int j, int k)
{
    return lattice->size[0] * (index->at[1][j] + lattice->size[1] * index->at[2][k]);
}

/* The terms of the sum: field alone, or (h field, h), the homogeneous coordinates of a rational volume. */
typedef struct summand {
    const double *field;
    const double *weights; /* may be NULL */
} summand;

/* A sum over a row, a plane or the whole cell, and its partial derivatives; by_u, by_v, by_w are used as far
   as they exist at that level. */
typedef struct partial_sum {
    double value[4], by_u[4], by_v[4], by_w[4];
} partial_sum;

static inline partial_sum sum_row(const lattice_basis *basis, const cell_index *index, summand terms,
                                  size_t start, bool with_derivative)
{
    partial_sum row = {{0}, {0}, {0}, {0}};
    const int components = terms.weights ? 4 : 3;
    for (int i = 0; i < index->count[0]; i++) {
        const size_t point = start + index->at[0][i];
        const double weight = terms.weights ? terms.weights[point] : 1;
        const double *const p = terms.field + 3 * point;
        const double x[4] = {weight * p[0], weight * p[1], weight * p[2], weight};
        for (int c = 0; c < components; c++) {
            row.value[c] += basis->value[0][i] * x[c];
            if (with_derivative)
                row.by_u[c] += basis->derivative[0][i] * x[c];
        }
    }
    return row;
}

static inline partial_sum sum_plane(const ffd_lattice *lattice, const lattice_basis *basis,
                                    const cell_index *index, summand terms, int k, bool with_derivative)
{
    partial_sum plane = {{0}, {0}, {0}, {0}};
    const int components = terms.weights ? 4 : 3;
    for (int j = 0; j < index->count[1]; j++) {
        const size_t start = row_start(lattice, index, j, k);
        const partial_sum row = sum_row(basis, index, terms, start, with_derivative);
        const double n = basis->value[1][j], derivative = basis->derivative[1][j];
        for (int c = 0; c < components; c++) {
            plane.value[c] += n * row.value[c];
            if (with_derivative) {
                plane.by_u[c] += n * row.by_u[c];
                plane.by_v[c] += derivative * row.value[c];
            }
        }
    }
    return plane;
}

/* The order of additions determines the bits of the result: u, then v, then w, each in ascending index. */
static inline partial_sum sum_cell(const ffd_lattice *lattice, const lattice_basis *basis, summand terms,
                                   bool with_derivative)
{
    partial_sum cell = {{0}, {0}, {0}, {0}};
    const int components = terms.weights ? 4 : 3;
    const cell_index index = index_of_cell(lattice, basis->span);
    for (int k = 0; k < index.count[2]; k++) {
        const partial_sum plane = sum_plane(lattice, basis, &index, terms, k, with_derivative);
        const double n = basis->value[2][k], derivative = basis->derivative[2][k];
        for (int c = 0; c < components; c++) {
            cell.value[c] += n * plane.value[c];
            if (with_derivative) {
                cell.by_u[c] += n * plane.by_u[c];
                cell.by_v[c] += n * plane.by_v[c];
                cell.by_w[c] += derivative * plane.value[c];
            }
        }
    }
    return cell;
}

void ffd_lattice_basis(const ffd_lattice *lattice, const double uvw[3], lattice_basis *basis)
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        basis->span[a] = ffd_knots_span(knots, uvw[a]);
        ffd_basis_derivatives(knots, basis->span[a], uvw[a], basis->value[a], basis->derivative[a]);
    }
}

/* The sum of a volume without weights. */
static void sum_plain(const ffd_lattice *lattice, const lattice_basis *basis, const double *field,
                      double value[3], double derivative[9])
{
    const partial_sum sum = sum_cell(lattice, basis, (summand){field, NULL}, derivative != NULL);
    for (int r = 0; r < 3; r++) {
        value[r] = sum.value[r];
        if (derivative) {
            derivative[3 * r] = sum.by_u[r];
            derivative[3 * r + 1] = sum.by_v[r];
            derivative[3 * r + 2] = sum.by_w[r];
        }
    }
}

/* C = A/W, C_u = (A_u - C W_u)/W (NURBS Book 4.4). */
void ffd_lattice_sum_rational(const ffd_lattice *lattice, const lattice_basis *basis, const double *field,
                              const double *weights, double value[3], double derivative[9])
{
    if (!weights) {
        sum_plain(lattice, basis, field, value, derivative);
        return;
    }
    const partial_sum sum = sum_cell(lattice, basis, (summand){field, weights}, derivative != NULL);
    const double weight = sum.value[3];
    for (int r = 0; r < 3; r++) {
        value[r] = sum.value[r] / weight;
        if (derivative) {
            derivative[3 * r] = (sum.by_u[r] - value[r] * sum.by_u[3]) / weight;
            derivative[3 * r + 1] = (sum.by_v[r] - value[r] * sum.by_v[3]) / weight;
            derivative[3 * r + 2] = (sum.by_w[r] - value[r] * sum.by_w[3]) / weight;
        }
    }
}

static inline void copy_block(const ffd_lattice *lattice, const double *field, size_t components,
                              const cell_index *index, double *copy)
{
    const size_t *const u = index->at[0];
    const size_t count = (size_t)index->count[0], row = components * count;
    const bool wraps = u[count - 1] != u[0] + count - 1; /* a block may go round more than once */
    for (int k = 0; k < index->count[2]; k++)
        for (int j = 0; j < index->count[1]; j++, copy += row) {
            const double *const start = field + components * row_start(lattice, index, j, k);
            if (!wraps)
                memcpy(copy, start + components * u[0], row * sizeof *copy);
            for (size_t i = 0; i < count && wraps; i++)
                memcpy(copy + components * i, start + components * u[i], components * sizeof *copy);
        }
}

void ffd_lattice_block_points(const ffd_lattice *lattice, const double *field, const size_t first[3],
                              const size_t count[3], double *points)
{
    const cell_index index = index_of_block(lattice, first, count);
    copy_block(lattice, field, 3, &index, points);
}

void ffd_lattice_cell_points(const ffd_lattice *lattice, const double *field, const int span[3],
                             double *points)
{
    const cell_index index = index_of_cell(lattice, span);
    copy_block(lattice, field, 3, &index, points);
}

void ffd_lattice_cell_weights(const ffd_lattice *lattice, const double *weights, const int span[3],
                              double *cell_weights)
{
    const cell_index index = index_of_cell(lattice, span);
    if (weights)
        copy_block(lattice, weights, 1, &index, cell_weights);
}

void ffd_lattice_evaluate(const ffd_lattice *lattice, ffd_volume volume, const double uvw[3], double point[3],
                          double jacobian[9])
{
    const double *const points = ffd_lattice_get_points(lattice, volume);
    if (!points) {
        for (int i = 0; i < 3; i++)
            point[i] = NAN;
        for (int i = 0; jacobian && i < 9; i++)
            jacobian[i] = NAN;
        return;
    }
    double inside[3];
    for (int a = 0; a < 3; a++)
        inside[a] = ffd_knots_wrap(&lattice->knots[a], uvw[a]);
    lattice_basis basis;
    ffd_lattice_basis(lattice, inside, &basis);
    ffd_lattice_sum_rational(lattice, &basis, points, ffd_lattice_get_weights(lattice, volume), point,
                             jacobian);
}
