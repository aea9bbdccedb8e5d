/* kernel.c - compiled once for each instruction set; FFD_KERNEL is the name of the function, FFD_LANES the
   number of SIMD lanes, each with one point.

   The functions t^i (1-t)^(d-i) are >= 0, and exact at both ends of the span. The binomial coefficients that
   turn them into Bernstein polynomials are part of the points (NURBS Book 1.3). The tensor product is summed
   over u first, then v, then w, each in ascending index (as in NURBS Book A4.3). Derivatives by u are sums of
   the functions of degree d-1 times the differences of points (NURBS Book 1.10), which are precomputed as
   slopes. Derivatives by v and w use the partial sums, with the derivatives of the functions.

   gcc unrolls the loops over functions only with a pragma, because the degrees come from an array. Without
   unrolling the values would be stored on the stack, which takes longer than everything else. */
#include "deform/kernel.h"
#include <string.h>
#if FFD_LANES == 1
#include "base/inline.h"
#include <stdbool.h>
typedef double lanes;
#else
#include "base/vector/lanes.h"
#endif

/* The d+1 functions of a span and their derivatives by the knot parameter. For u, instead of the derivatives,
   the d functions of degree d-1, scaled to that parameter. */
typedef struct span_basis {
    lanes value[MAX_ORDER], derivative[MAX_ORDER];
} span_basis;

/* A sum over control points (part 0) and its derivatives by u, v, w (parts 1 to 3), as far as they are
   used. */
typedef struct field_sum {
    lanes part[4][3];
} field_sum;

/* Raises t^i (1-t)^(d-1-i) to t^i (1-t)^(d-i), in place. */
static ALWAYS_INLINE void raise_powers(int degree, lanes t, lanes rest, lanes *power)
{
    power[degree] = power[degree - 1] * t;
#pragma GCC unroll 4
    for (int i = 0; i < degree; i++)
        power[i] = power[i] * rest;
}

/* Computes the derivatives i t^(i-1) (1-t)^(d-i) - (d-i) t^i (1-t)^(d-i-1). */
static ALWAYS_INLINE void find_slopes(int degree, double width, const lanes *lower, lanes *slope)
{
    const double factor = 1 / width;
    slope[0] = -degree * factor * lower[0];
#pragma GCC unroll 4
    for (int i = 1; i < degree; i++)
        slope[i] = i * factor * lower[i - 1] - (degree - i) * factor * lower[i];
    slope[degree] = degree * factor * lower[degree - 1];
}

static ALWAYS_INLINE void find_basis(const kernel_cell *cell, int a, int degree, lanes u, bool derivatives,
                                     span_basis *basis)
{
    const lanes t = (u - cell->first[a]) / cell->width[a], rest = 1.0 - t;
    lanes *const power = basis->value;
    power[0] = rest;
    power[1] = t;
#pragma GCC unroll 4
    for (int d = 2; d < degree; d++)
        raise_powers(d, t, rest, power);
    if (derivatives && a == 0) {
        for (int i = 0; i < degree; i++)
            basis->derivative[i] = (degree > 1 ? power[i] : t * 0.0 + 1) * (1 / cell->width[a]);
    } else if (derivatives && degree > 1) {
        find_slopes(degree, cell->width[a], power, basis->derivative);
    } else if (derivatives) {
        basis->derivative[0] = t * 0.0 - 1 / cell->width[a];
        basis->derivative[1] = t * 0.0 + 1 / cell->width[a];
    }
    if (degree > 1)
        raise_powers(degree, t, rest, power);
}

/* Returns the term of a basis function in the sum over the next direction. parts: the parts that term has. */
static ALWAYS_INLINE field_sum share(const span_basis *basis, int function, const field_sum *term, int parts)
{
    field_sum result = {0};
    for (int c = 0; c < 3; c++) {
        for (int p = 0; p < parts; p++)
            result.part[p][c] = basis->value[function] * term->part[p][c];
        result.part[parts][c] = basis->derivative[function] * term->part[0][c];
    }
    return result;
}

static ALWAYS_INLINE void add(field_sum *sum, const field_sum *term, int parts)
{
    for (int p = 0; p < parts; p++)
        for (int c = 0; c < 3; c++)
            sum->part[p][c] += term->part[p][c];
}

/* sum = sum_i factor[i] vectors[i], vectors of three numbers. */
static ALWAYS_INLINE void sum_vectors(const lanes *factor, int count, const double *vectors, lanes sum[3])
{
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) {
            const lanes term = factor[i] * vectors[3 * i + c];
            sum[c] = i == 0 ? term : sum[c] + term;
        }
}

static ALWAYS_INLINE field_sum sum_plane(const int degree[3], const span_basis basis[3], const double *points,
                                         const double *slopes)
{
    field_sum sum = {0};
    for (int j = 0; j <= degree[1]; j++) {
        field_sum row = {0};
        sum_vectors(basis[0].value, degree[0] + 1, points + 3 * (degree[0] + 1) * j, row.part[0]);
        sum_vectors(basis[0].derivative, degree[0], slopes + 3 * degree[0] * j, row.part[1]);
        const field_sum term = share(&basis[1], j, &row, 2);
        if (j == 0)
            sum = term;
        else
            add(&sum, &term, 3);
    }
    return sum;
}

static ALWAYS_INLINE field_sum sum_cell(const int degree[3], const span_basis basis[3],
                                        const kernel_field *field)
{
    const int rows = degree[1] + 1;
    field_sum sum = {0};
    for (int k = 0; k <= degree[2]; k++) {
        const field_sum plane = sum_plane(degree, basis, field->points + 3 * (degree[0] + 1) * rows * k,
                                          field->slopes + 3 * degree[0] * rows * k);
        const field_sum term = share(&basis[2], k, &plane, 3);
        if (k == 0)
            sum = term;
        else
            add(&sum, &term, 4);
    }
    return sum;
}

/* sum += factor * term; the first term initialises the sum. */
static ALWAYS_INLINE void add_term(lanes sum[3], bool is_first, lanes factor, const lanes term[3])
{
    for (int c = 0; c < 3; c++)
        sum[c] = is_first ? factor * term[c] : sum[c] + factor * term[c];
}

/* sum_cell without derivatives: the same operations in the same order, with fewer live values, so that
   compilers can unroll the loops. */
static ALWAYS_INLINE void sum_values(const int degree[3], const span_basis basis[3], const double *points,
                                     lanes sum[3])
{
    for (int k = 0; k <= degree[2]; k++) {
        lanes plane[3] = {0};
#pragma GCC unroll 4
        for (int j = 0; j <= degree[1]; j++, points += 3 * (degree[0] + 1)) {
            lanes row[3] = {0};
            sum_vectors(basis[0].value, degree[0] + 1, points, row);
            add_term(plane, j == 0, basis[1].value[j], row);
        }
        add_term(sum, k == 0, basis[2].value[k], plane);
    }
}

#if FFD_LANES > 1
/* Returns whether the indices of the points are consecutive. They ascend, except that a block that is not
   full is padded with its first index. */
static ALWAYS_INLINE bool in_a_row(const uint32_t *which)
{
    return which[FFD_LANES - 1] - which[0] == FFD_LANES - 1;
}
#endif

static ALWAYS_INLINE void take(const double *uvw, lanes taken[3])
{
#if FFD_LANES == 1
    for (int a = 0; a < 3; a++)
        taken[a] = uvw[a];
#else
    lanes_load_triples(uvw, taken);
#endif
}

static ALWAYS_INLINE void put_vector(const lanes values[3], double *to, const uint32_t *which)
{
#if FFD_LANES == 1
    for (int c = 0; c < 3; c++)
        to[3 * (size_t)which[0] + (size_t)c] = values[c];
#else
    double triples[3 * FFD_LANES];
    if (in_a_row(which)) {
        lanes_store_triples(values, to + 3 * (size_t)which[0]);
        return;
    }
    lanes_store_triples(values, triples);
    for (int l = 0; l < FFD_LANES; l++)
        memcpy(to + 3 * (size_t)which[l], triples + 3 * l, 3 * sizeof *triples);
#endif
}

static ALWAYS_INLINE void put_matrix(const lanes m[9], double *to, const uint32_t *which)
{
#if FFD_LANES == 1
    for (int i = 0; i < 9; i++)
        to[9 * (size_t)which[0] + (size_t)i] = m[i];
#else
    double *rows[FFD_LANES];
    for (int l = 0; l < FFD_LANES; l++)
        rows[l] = to + 9 * (size_t)which[l];
    lanes_store_nines(m, rows);
#endif
}

/* Stores the derivatives as the columns of a matrix. */
static ALWAYS_INLINE void put_derivatives(const field_sum *sum, double *to, const uint32_t *which)
{
    lanes m[9];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            m[3 * r + c] = sum->part[1 + c][r];
    put_matrix(m, to, which);
}

/* Stores the product of that matrix and m. */
static ALWAYS_INLINE void put_product(const field_sum *sum, const double m[9], double *to,
                                      const uint32_t *which)
{
    lanes product[9];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            product[3 * r + c] =
                sum->part[1][r] * m[c] + sum->part[2][r] * m[3 + c] + sum->part[3][r] * m[6 + c];
    put_matrix(product, to, which);
}

/* Computes FFD_LANES points with these indices. */
static ALWAYS_INLINE void displace(const kernel_cell *cell, const int degree[3], const kernel_points *points,
                                   const double *parameters, const uint32_t *which, bool derivatives,
                                   bool jacobian)
{
    span_basis basis[3];
    lanes uvw[3];
    take(parameters, uvw);
#pragma GCC unroll 3
    for (int a = 0; a < 3; a++)
        find_basis(cell, a, degree[a], uvw[a], derivatives, &basis[a]);
    if (!derivatives) {
        lanes delta[3] = {0};
        sum_values(degree, basis, cell->difference.points, delta);
        put_vector(delta, points->delta, which);
        return;
    }
    const field_sum sum = sum_cell(degree, basis, &cell->difference);
    put_vector(sum.part[0], points->delta, which);
    if (cell->inverse)
        put_product(&sum, cell->inverse, points->gradient, which);
    else
        put_derivatives(&sum, points->gradient, which);
    if (jacobian) {
        const field_sum rest = sum_cell(degree, basis, &cell->rest);
        put_derivatives(&rest, points->jacobian, which);
    }
}

static ALWAYS_INLINE void displace_all(const kernel_cell *cell, const int degree[3],
                                       const kernel_points *points, bool derivatives, bool jacobian)
{
    size_t first = 0;
    for (; first + FFD_LANES <= points->count; first += FFD_LANES)
        displace(cell, degree, points, points->uvw + 3 * first, points->which + first, derivatives, jacobian);
    if (first == points->count)
        return;
    uint32_t rest[FFD_LANES];
    double parameters[3 * FFD_LANES];
    for (size_t l = 0; l < FFD_LANES; l++) {
        const size_t k = first + l < points->count ? first + l : first;
        rest[l] = points->which[k];
        memcpy(parameters + 3 * l, points->uvw + 3 * k, 3 * sizeof *parameters);
    }
    displace(cell, degree, points, parameters, rest, derivatives, jacobian);
}

/* Whether all degrees are this one. */
static ALWAYS_INLINE bool is_all(const kernel_cell *cell, int degree)
{
    return cell->degree[0] == degree && cell->degree[1] == degree && cell->degree[2] == degree;
}

void FFD_KERNEL(const kernel_cell *cell, const kernel_points *points)
{
    /* Constant degrees let the compiler unroll the loops: those of most lattices, and of the one cell of
       5 x 5 x 5 points in which PyGeM's users work. WebAssembly has to be small. */
    static const int cubic[3] = {3, 3, 3};
#ifndef __wasm__
    static const int quartic[3] = {4, 4, 4};
    if (is_all(cell, 4) && !points->gradient) {
        displace_all(cell, quartic, points, false, false);
        return;
    }
#endif
    if (!is_all(cell, 3))
        displace_all(cell, cell->degree, points, points->gradient, points->jacobian);
    else if (points->jacobian)
        displace_all(cell, cubic, points, true, true);
    else if (points->gradient)
        displace_all(cell, cubic, points, true, false);
    else
        displace_all(cell, cubic, points, false, false);
}
