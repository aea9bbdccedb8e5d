/* variant_kernel.c - compiled once for each instruction set; FFD_VARIANT_KERNEL is the name of its table,
   FFD_LANES the number of SIMD lanes, each with one variant.

   Each lane has the operations of extraction_kernel.c and kernel.c, in the same order, so that it has their
   bits. What depends on a point and not on the variant is computed once for all lanes. */
#include "deform/variant_kernel.h"
#include "deform/extraction_steps.h"
#include <math.h>
#include <stdint.h>
#include <string.h>
#if FFD_LANES == 1
typedef double lanes;
typedef int64_t mask;
#else
#include "base/vector/lanes.h"
#endif

static ALWAYS_INLINE lanes take(const variant_numbers *from)
{
    lanes taken;
    memcpy(&taken, from, sizeof taken);
    return taken;
}

static ALWAYS_INLINE void put(lanes values, variant_numbers *to)
{
    memcpy(to, &values, sizeof values);
}

/* Whether all lanes of a mask are true. */
static ALWAYS_INLINE bool all_true(mask which)
{
#if FFD_LANES == 1
    return which != 0;
#else
    return !lanes_any(~which);
#endif
}

/* Bezier point r along a direction, of control points that are `step` registers apart. */
static ALWAYS_INLINE lanes combine(const double *extraction, size_t order, size_t r, const lanes *from,
                                   size_t step)
{
    const double *const row = extraction + r * order;
    const size_t first = band_first(r), last = band_last(r, order);
    lanes sum = row[first] * from[first * step];
    for (size_t j = first + 1; j <= last; j++)
        sum += row[j] * from[j * step];
    return sum;
}

/* Copies an extraction matrix to where no result is stored, so that it can stay in registers. */
static ALWAYS_INLINE void copy_matrix(const variant_cell *cell, const int degree[3], int a, double *to)
{
    const size_t order = (size_t)degree[a] + 1;
    memcpy(to, cell->extraction[a], order * order * sizeof *to);
}

/* Converts a row of control points to Bezier form along u. */
static ALWAYS_INLINE void extract_row(const variant_cell *cell, const int degree[3], const double *extraction,
                                      size_t start, lanes *to)
{
    const size_t order = (size_t)degree[0] + 1;
    lanes from[3 * MAX_ORDER];
#pragma GCC unroll 4
    for (size_t i = 0; i < order; i++)
        for (size_t c = 0; c < 3; c++)
            from[3 * i + c] = take(cell->field + FFD_LANES * (start + cell->at[0][i] + c));
#pragma GCC unroll 4
    for (size_t r = 0; r < order; r++)
        for (size_t c = 0; c < 3; c++)
            to[3 * r + c] = combine(extraction, order, r, from + c, 3);
}

/* Converts plane k of a cell to Bezier form along u and v. */
static ALWAYS_INLINE void extract_plane(const variant_cell *cell, const int degree[3], int k,
                                        variant_numbers *to)
{
    const size_t order = (size_t)degree[1] + 1, inner = 3 * ((size_t)degree[0] + 1);
    lanes rows[3 * MAX_ORDER * MAX_ORDER];
    double by_u[MAX_ORDER * MAX_ORDER], by_v[MAX_ORDER * MAX_ORDER];
    copy_matrix(cell, degree, 0, by_u);
    copy_matrix(cell, degree, 1, by_v);
    for (size_t j = 0; j < order; j++)
        extract_row(cell, degree, by_u, cell->at[1][j] + cell->at[2][k], rows + inner * j);
    for (size_t x = 0; x < inner; x++)
#pragma GCC unroll 4
        for (size_t r = 0; r < order; r++)
            put(combine(by_v, order, r, rows + x, inner), to + FFD_LANES * (inner * r + x));
}

/* Converts planes to Bezier form along w. from: the planes, in their order. */
static ALWAYS_INLINE void extract_depth(const variant_cell *cell, const int degree[3],
                                        const variant_numbers *const *from, variant_numbers *to)
{
    const size_t order = (size_t)degree[2] + 1, inner = 3 * ((size_t)degree[0] + 1) * ((size_t)degree[1] + 1);
    double by_w[MAX_ORDER * MAX_ORDER];
    copy_matrix(cell, degree, 2, by_w);
    for (size_t x = 0; x < inner; x++) {
        lanes column[MAX_ORDER];
#pragma GCC unroll 4
        for (size_t k = 0; k < order; k++)
            column[k] = take(from[k] + FFD_LANES * x);
#pragma GCC unroll 4
        for (size_t r = 0; r < order; r++)
            put(combine(by_w, order, r, column, 1), to + FFD_LANES * (inner * r + x));
    }
}

/* Fills in the planes of a cell that are not there. from: receives them, in their order. */
static ALWAYS_INLINE void find_planes(const variant_cell *cell, const int degree[3], variant_planes *planes,
                                      const variant_numbers **from)
{
    const size_t order = (size_t)degree[2] + 1;
    const size_t size = FFD_LANES * 3 * ((size_t)degree[0] + 1) * ((size_t)degree[1] + 1);
    if (planes->column != cell->column)
        memset(planes->number, 0, sizeof planes->number);
    planes->column = cell->column;
    for (size_t k = 0; k < order; k++) {
        const size_t number = cell->first_plane + k, place = number % order;
        variant_numbers *const plane = planes->vectors + size * place;
        if (planes->number[place] != number + 1)
            extract_plane(cell, degree, (int)k, plane);
        planes->number[place] = number + 1;
        from[k] = plane;
    }
}

static ALWAYS_INLINE void extract_all(const variant_cell *cell, const int degree[3], variant_planes *planes)
{
    const variant_numbers *from[MAX_ORDER];
    find_planes(cell, degree, planes, from);
    extract_depth(cell, degree, from, planes->bezier);
}

/* The functions t^i (1-t)^(d-i) of a span (kernel.c). */
static ALWAYS_INLINE void find_basis(double first, double width, int degree, double u, double *power)
{
    const double t = (u - first) / width, rest = 1.0 - t;
    power[0] = rest;
    power[1] = t;
#pragma GCC unroll 4
    for (int d = 2; d <= degree; d++) {
        power[d] = power[d - 1] * t;
#pragma GCC unroll 4
        for (int i = 0; i < d; i++)
            power[i] = power[i] * rest;
    }
}

/* sum += factor * term; the first term initialises the sum. */
static ALWAYS_INLINE void add_term(lanes sum[3], bool is_first, double factor, const lanes term[3])
{
    for (int c = 0; c < 3; c++)
        sum[c] = is_first ? factor * term[c] : sum[c] + factor * term[c];
}

static ALWAYS_INLINE void displace_point(const variant_cell *cell, const int degree[3],
                                         const variant_numbers *bezier, const double uvw[3],
                                         variant_numbers *to)
{
    double basis[3][MAX_ORDER];
    lanes sum[3] = {0};
#pragma GCC unroll 3
    for (int a = 0; a < 3; a++)
        find_basis(cell->first[a], cell->width[a], degree[a], uvw[a], basis[a]);
    for (int k = 0; k <= degree[2]; k++) {
        lanes plane[3] = {0};
#pragma GCC unroll 4
        for (int j = 0; j <= degree[1]; j++) {
            lanes row[3] = {0};
#pragma GCC unroll 4
            for (int i = 0; i <= degree[0]; i++, bezier += 3 * FFD_LANES) {
                const lanes point[3] = {take(bezier), take(bezier + FFD_LANES), take(bezier + 2 * FFD_LANES)};
                add_term(row, i == 0, basis[0][i], point);
            }
            add_term(plane, j == 0, basis[1][j], row);
        }
        add_term(sum, k == 0, basis[2][k], plane);
    }
    for (int c = 0; c < 3; c++)
        put(sum[c], to + c * FFD_LANES);
}

static ALWAYS_INLINE void displace_points(const variant_cell *cell, const int degree[3],
                                          const variant_numbers *bezier, const double *uvw, size_t count,
                                          variant_numbers *vectors)
{
    for (size_t i = 0; i < count; i++)
        displace_point(cell, degree, bezier, uvw + 3 * i, vectors + 3 * FFD_LANES * i);
}

/* The sums of displace_point for all planes of Bezier points at once, each of which is used where it is
 * found. */
static ALWAYS_INLINE void sum_planes(const variant_cell *cell, const int degree[3],
                                     const variant_numbers *const *from, double basis[3][MAX_ORDER],
                                     lanes sum[3])
{
    const size_t order = (size_t)degree[2] + 1;
    double by_w[MAX_ORDER * MAX_ORDER];
    lanes plane[3 * MAX_ORDER];
    size_t x = 0;
    copy_matrix(cell, degree, 2, by_w);
    for (int j = 0; j <= degree[1]; j++) {
        lanes row[3 * MAX_ORDER];
#pragma GCC unroll 4
        for (int i = 0; i <= degree[0]; i++)
            for (size_t c = 0; c < 3; c++, x++) {
                lanes column[MAX_ORDER];
#pragma GCC unroll 4
                for (size_t k = 0; k < order; k++)
                    column[k] = take(from[k] + FFD_LANES * x);
#pragma GCC unroll 4
                for (size_t r = 0; r < order; r++) {
                    const lanes term = basis[0][i] * combine(by_w, order, r, column, 1);
                    row[3 * r + c] = i == 0 ? term : row[3 * r + c] + term;
                }
            }
#pragma GCC unroll 4
        for (size_t r = 0; r < order; r++)
            add_term(plane + 3 * r, j == 0, basis[1][j], row + 3 * r);
    }
#pragma GCC unroll 4
    for (size_t r = 0; r < order; r++)
        add_term(sum, r == 0, basis[2][r], plane + 3 * r);
}

static ALWAYS_INLINE void displace_alone(const variant_cell *cell, const int degree[3],
                                         variant_planes *planes, const double uvw[3], variant_numbers *to)
{
    const variant_numbers *from[MAX_ORDER];
    double basis[3][MAX_ORDER];
    lanes sum[3] = {0};
    find_planes(cell, degree, planes, from);
#pragma GCC unroll 3
    for (int a = 0; a < 3; a++)
        find_basis(cell->first[a], cell->width[a], degree[a], uvw[a], basis[a]);
    sum_planes(cell, degree, from, basis, sum);
    for (int c = 0; c < 3; c++)
        put(sum[c], to + c * FFD_LANES);
}

/* sum += factor * term; the first term initialises the sum. */
static ALWAYS_INLINE void add_quad(quad *sum, bool is_first, double factor, const quad *term)
{
    if (is_first)
        *sum = quad_times(factor, term);
    else
        quad_add(sum, factor, term);
}

/* Displaces a point of a single variant. The fourth number of each quad is of the next vector, and not used.
 */
static ALWAYS_INLINE void displace_vector(const kernel_cell *cell, const int degree[3], const double uvw[3],
                                          double *delta)
{
    const double *point = cell->difference.points;
    double basis[3][MAX_ORDER], result[4];
    quad sum = {0};
#pragma GCC unroll 3
    for (int a = 0; a < 3; a++)
        find_basis(cell->first[a], cell->width[a], degree[a], uvw[a], basis[a]);
    for (int k = 0; k <= degree[2]; k++) {
        quad plane = {0};
#pragma GCC unroll 4
        for (int j = 0; j <= degree[1]; j++) {
            quad row = {0};
#pragma GCC unroll 4
            for (int i = 0; i <= degree[0]; i++, point += 3) {
                const quad vector = quad_load(point);
                add_quad(&row, i == 0, basis[0][i], &vector);
            }
            add_quad(&plane, j == 0, basis[1][j], &row);
        }
        add_quad(&sum, k == 0, basis[2][k], &plane);
    }
    quad_store(&sum, result);
    memcpy(delta, result, 3 * sizeof *delta);
}

static bool is_cubic(const int degree[3])
{
    return degree[0] == 3 && degree[1] == 3 && degree[2] == 3;
}

/* Constant degrees let the compiler unroll the loops. */
static const int cubic[3] = {3, 3, 3};

static void extract(const variant_cell *cell, variant_planes *planes)
{
    if (is_cubic(cell->degree))
        extract_all(cell, cubic, planes);
    else
        extract_all(cell, cell->degree, planes);
}

static void displace(const variant_cell *cell, const variant_numbers *bezier, const double *uvw, size_t count,
                     variant_numbers *vectors)
{
    if (is_cubic(cell->degree))
        displace_points(cell, cubic, bezier, uvw, count, vectors);
    else
        displace_points(cell, cell->degree, bezier, uvw, count, vectors);
}

static void displace_one(const variant_cell *cell, variant_planes *planes, const double uvw[3],
                         variant_numbers *vector)
{
    if (is_cubic(cell->degree))
        displace_alone(cell, cubic, planes, uvw, vector);
    else
        displace_alone(cell, cell->degree, planes, uvw, vector);
}

/* Loads a vector and the number after it, or 0 where that is beyond the end. */
static ALWAYS_INLINE quad load_vector(const double *vectors, size_t place, size_t last)
{
    double end[4] = {0};
    if (place != last)
        return quad_load(vectors + place);
    memcpy(end, vectors + place, 3 * sizeof *end);
    return quad_load(end);
}

static ALWAYS_INLINE void extract_source(const variant_source *source, const double *rest, double *points)
{
    double by_u[3 * 64 + 1], by_v[3 * 64];
    for (size_t k = 0; k < 4; k++)
        for (size_t j = 0; j < 4; j++) {
            quad row[4];
#pragma GCC unroll 4
            for (size_t i = 0; i < 4; i++) {
                const size_t place = source->at[0][i] + source->at[1][j] + source->at[2][k];
                row[i] = load_vector(source->values, place, source->last);
                if (rest) {
                    const size_t at = source->rest_at[0][i] + source->rest_at[1][j] + source->rest_at[2][k];
                    const quad origin = load_vector(rest, at, source->last);
                    row[i] = quad_difference(&row[i], &origin);
                }
            }
            combine_quads(source->extraction[0], row, 3, by_u + 12 * (4 * k + j));
        }
    combine_cubic_slabs(source->extraction[1], 12, 3 * 64, by_u, by_v);
    combine_cubic_slabs(source->extraction[2], 48, 3 * 64, by_v, points);
    points[3 * 64] = 0;
}

static void extract_cubic(const variant_source *source, double *points)
{
    if (source->rest)
        extract_source(source, source->rest, points);
    else
        extract_source(source, NULL, points);
}

static void displace_few(const kernel_cell *cell, const double *uvw, size_t count, double *delta)
{
    if (is_cubic(cell->degree))
        for (size_t i = 0; i < count; i++)
            displace_vector(cell, cubic, uvw + 3 * i, delta + 3 * i);
    else
        for (size_t i = 0; i < count; i++)
            displace_vector(cell, cell->degree, uvw + 3 * i, delta + 3 * i);
}

/* Whether a number is NaN or too large. */
static ALWAYS_INLINE mask is_beyond(lanes number, double most)
{
#if FFD_LANES == 1
    return fabs(number) <= most ? 0 : -1;
#else
    return ~(lanes_magnitude(number) <= most);
#endif
}

static bool fits(const double *numbers, size_t count, double most)
{
    mask beyond = (mask){0};
    bool rest = true;
    size_t i = 0;
    for (; i + FFD_LANES <= count; i += FFD_LANES)
        beyond |= is_beyond(take(numbers + i), most);
    for (; i < count; i++)
        rest = rest && fabs(numbers[i]) <= most;
    return rest && all_true(~beyond);
}

/* The numbers from i on of all lanes, as many as there are lanes. */
static ALWAYS_INLINE mask pack_square(const double *const *from, const double *minus, size_t i, double most,
                                      double *to)
{
    lanes row[FFD_LANES];
    mask beyond = (mask){0};
    for (size_t l = 0; l < FFD_LANES; l++) {
        row[l] = take(from[l] + i);
        beyond |= is_beyond(row[l], most);
        row[l] = minus ? row[l] - take(minus + i) : row[l];
    }
#if FFD_LANES > 1
    lanes_transpose(row);
#endif
    for (size_t l = 0; l < FFD_LANES; l++)
        put(row[l], to + FFD_LANES * (i + l));
    return beyond;
}

static bool pack(const double *const *from, const double *minus, size_t count, double most, double *to)
{
    mask beyond = (mask){0};
    bool rest = true;
    size_t i = 0;
    for (; i + FFD_LANES <= count; i += FFD_LANES)
        beyond |= pack_square(from, minus, i, most, to);
    for (; i < count; i++)
        for (size_t l = 0; l < FFD_LANES; l++) {
            rest = rest && fabs(from[l][i]) <= most;
            to[FFD_LANES * i + l] = minus ? from[l][i] - minus[i] : from[l][i];
        }
    return rest && all_true(~beyond);
}

/* Returns the mask of the lanes in which a coordinate may not be moved there. */
static ALWAYS_INLINE mask move_number(variant_numbers *number, double x, const double *fade,
                                      const double *weight, double largest)
{
    lanes vector = take(number);
    if (fade)
        vector = *fade * vector;
    if (weight)
        vector = *weight * vector;
#if FFD_LANES == 1
    const lanes moved = vector != 0 ? x + vector : x;
    const mask unfit = moved != x && !(fabs(moved) <= largest) ? -1 : 0;
#else
    const lanes moved = lanes_choose(vector != 0.0, x + vector, lanes_all(x));
    const mask unfit = (moved != x) & ~(lanes_magnitude(moved) <= largest);
#endif
    put(moved, number);
    return unfit;
}

static bool move(const variant_moves *moves)
{
    mask unfit = (mask){0};
    for (size_t i = 0; i < moves->count; i++)
        for (size_t c = 0; c < 3; c++)
            unfit |= move_number(moves->vectors + FFD_LANES * (3 * i + c), moves->x[3 * i + c],
                                 moves->fade ? moves->fade + i : NULL,
                                 moves->weight ? moves->weight + i : NULL, moves->largest);
    return all_true(~unfit);
}

const variant_kernel FFD_VARIANT_KERNEL = {FFD_LANES, pack,          fits,         extract, displace_one,
                                           displace,  extract_cubic, displace_few, move};
