/* contraction_kernel.c - compiled once for each instruction set; FFD_CONTRACTION_KERNEL is the name of its
   table. It bounds the distance of Y J_F from I over a box, and selects the halving that reduces it most. */
#include "embed/cells/contraction_kernel.h"
#include "base/vector/quad.h"
#include "base/vector/vec.h"
#include <float.h>

enum { N = BEZIER_COMPONENTS };

/* Evaluates the Bernstein polynomials at 1/2: binomial(d, i) / 2^d, exact. */
static void bernstein_at_half(int degree, double value[MAX_ORDER])
{
    double factor = 1;
    for (int i = 0; i < degree; i++)
        factor *= 0.5;
    for (int i = 0; i <= degree; i++) {
        value[i] = factor;
        factor = factor * (degree - i) / (i + 1);
    }
}

static ALWAYS_INLINE quad quad_of(double x, double y, double z)
{
    return quad_load((const double[N]){x, y, z, 0});
}

/* Computes J_F at the centre, row-major. */
static void centre_jacobian(const bezier_box *box, const double p[3], double jacobian[9])
{
    double value[3][MAX_ORDER], slope[3][MAX_ORDER];
    for (int a = 0; a < 3; a++) {
        const int degree = box->order[a] - 1;
        double lower[MAX_ORDER] = {0};
        bernstein_at_half(degree, value[a]);
        bernstein_at_half(degree - 1, lower);
        for (int i = 0; i <= degree; i++)
            slope[a][i] = degree * ((i > 0 ? lower[i - 1] : 0) - (i < degree ? lower[i] : 0));
    }
    const quad middle = quad_of(p[0], p[1], p[2]);
    const double *c = box->coefficients;
    quad by_t[3] = {0};
    for (int k = 0; k < box->order[2]; k++)
        for (int j = 0; j < box->order[1]; j++) {
            /* Products of these are exact. */
            const double du = value[1][j] * value[2][k], dv = slope[1][j] * value[2][k],
                         dw = value[1][j] * slope[2][k];
            for (int i = 0; i < box->order[0]; i++, c += N) {
                quad f = quad_load(c);
                quad_add(&f, -c[3], &middle);
                quad_add(&by_t[0], slope[0][i] * du, &f);
                quad_add(&by_t[1], value[0][i] * dv, &f);
                quad_add(&by_t[2], value[0][i] * dw, &f);
            }
        }
    for (int b = 0; b < 3; b++) {
        double column[N];
        quad_store(&by_t[b], column);
        for (int r = 0; r < 3; r++)
            jacobian[3 * r + b] = column[r];
    }
}

/* A column of Y J_F: for each Bernstein coefficient the values of its three rows, and the derivative of W. */
typedef struct column_form {
    double *numbers; /* N numbers for each coefficient */
    int size[3];     /* orders of the box, one less in the direction of the column */
} column_form;

static column_form column_of(const bezier_box *box, int b, double *columns)
{
    column_form column = {.numbers = columns + (size_t)b * ffd_bezier_size(box->order)};
    for (int a = 0; a < 3; a++)
        column.size[a] = box->order[a] - (a == b);
    return column;
}

static void fill_column(const bezier_box *box, int b, const double p[3], const double inverse[9],
                        const column_form *column)
{
    const quad middle = quad_of(p[0], p[1], p[2]);
    quad turned[3];
    for (int c = 0; c < 3; c++)
        turned[c] = quad_of(inverse[c], inverse[3 + c], inverse[6 + c]);
    const size_t stride = ffd_bezier_stride(box->order, b), slab = stride * (size_t)box->order[b],
                 count = ffd_bezier_count(box->order);
    const double degree = box->order[b] - 1;
    double *to = column->numbers, f[N];
    for (size_t first = 0; first < count; first += slab)
        for (size_t n = first; n < first + slab - stride; n++, to += N) {
            const double *const here = box->coefficients + N * n;
            const quad low = quad_load(here), high = quad_load(here + N * stride),
                       step = quad_difference(&high, &low);
            const double weight = degree * (here[N * stride + 3] - here[3]);
            quad slope = quad_times(degree, &step);
            quad_add(&slope, -weight, &middle);
            quad_store(&slope, f);
            quad result = quad_times(f[0], &turned[0]);
            quad_add(&result, f[1], &turned[1]);
            quad_add(&result, f[2], &turned[2]);
            quad_store(&result, to);
            to[3] = weight;
        }
}

/* Computes the greatest |delta_rb - coefficient| of each row of a column, including the range of p. */
static void column_distance(const column_form *column, int b, const double reach[3], const double inverse[9],
                            double distance[N])
{
    const quad identity = quad_of(b == 0, b == 1, b == 2);
    double away[N] = {0};
    for (int r = 0; r < 3; r++) {
        const double *row = inverse + 3 * r;
        away[r] = fabs(row[0]) * reach[0] + fabs(row[1]) * reach[1] + fabs(row[2]) * reach[2];
    }
    const quad reached = quad_load(away);
    const double *const end = column->numbers + ffd_bezier_size(column->size);
    quad greatest = {0}, zero = {0};
    for (const double *numbers = column->numbers; numbers < end; numbers += N) {
        const quad value = quad_load(numbers), off = quad_difference(&identity, &value);
        quad with_reach = quad_magnitude(&off);
        quad_add(&with_reach, fabs(numbers[3]), &reached);
        greatest = quad_larger(&with_reach, &greatest);
        quad_add(&zero, 0, &with_reach); /* so that NaN and infinity do not pass as a small bound */
    }
    quad_add(&greatest, 1, &zero);
    quad_store(&greatest, distance);
}

/* Computes spread[r][a]: the greatest variation of row r of the column along a, over all rows of
   coefficients. */
static void column_spread(const column_form *column, int a, double spread[3][3])
{
    const size_t stride = ffd_bezier_stride(column->size, a), slab = stride * (size_t)column->size[a],
                 count = ffd_bezier_count(column->size);
    quad widest = {0};
    for (size_t first = 0; first < count; first += slab)
        for (size_t n = first; n < first + stride; n++) {
            quad least = quad_load(column->numbers + N * n), greatest = least;
            for (size_t m = n + stride; m < first + slab; m += stride) {
                const quad value = quad_load(column->numbers + N * m);
                least = quad_lesser(&least, &value);
                greatest = quad_larger(&greatest, &value);
            }
            const quad found = quad_difference(&greatest, &least);
            widest = quad_larger(&found, &widest);
        }
    double rows[N];
    quad_store(&widest, rows);
    for (int r = 0; r < 3; r++)
        spread[r][a] = rows[r];
}

/* Returns the greatest row sum of spreads after the box is halved in direction c (-1: without halving).
   Halving divides by 2 every spread along c, and all of column c (its derivative is by a shorter side), and
   doubles row c (its coordinate is stretched). */
static double predicted_sum(double spread[3][3][3], int c)
{
    double greatest = 0;
    for (int r = 0; r < 3; r++) {
        double sum = 0;
        for (int b = 0; b < 3; b++)
            for (int a = 0; a < 3; a++)
                sum += spread[b][r][a] * (a == c ? 0.5 : 1) * (b == c ? 0.5 : 1) * (r == c ? 2 : 1);
        greatest = sum > greatest ? sum : greatest;
    }
    return greatest;
}

/* If no single halving reduces the bound, the longest side is halved: halving all three always reduces it. */
static int best_halving(const bezier_box *box, double spread[3][3][3])
{
    int best = 0, longest = 0;
    double least = DBL_MAX;
    for (int c = 0; c < 3; c++) {
        const double predicted = predicted_sum(spread, c);
        if (predicted < least) {
            least = predicted;
            best = c;
        }
        if (box->hi[c] - box->lo[c] > box->hi[longest] - box->lo[longest])
            longest = c;
    }
    return least < (1 - 1.0 / 64) * predicted_sum(spread, -1) ? best : longest;
}

static void find_bound(const bezier_box *box, const double middle[3], const double reach[3], double *columns,
                       contraction_bound *result)
{
    double jacobian[9], sum[3] = {0, 0, 0};
    centre_jacobian(box, middle, jacobian);
    result->regular = mat_invert(jacobian, result->inverse);
    if (!result->regular)
        return;
    for (int b = 0; b < 3; b++) {
        double distance[N];
        const column_form column = column_of(box, b, columns);
        fill_column(box, b, middle, result->inverse, &column);
        column_distance(&column, b, reach, result->inverse, distance);
        for (int r = 0; r < 3; r++)
            sum[r] += distance[r];
    }
    result->bound = vec_is_finite(sum) ? larger_of(sum[0], larger_of(sum[1], sum[2])) : HUGE_VAL;
}

static int find_halving(const bezier_box *box, const contraction_bound *found, double *columns)
{
    double spread[3][3][3];
    if (!found->regular)
        return ffd_bezier_widest(box);
    for (int b = 0; b < 3; b++) {
        const column_form column = column_of(box, b, columns);
        for (int a = 0; a < 3; a++)
            column_spread(&column, a, spread[b]);
    }
    return best_halving(box, spread);
}

const contraction_kernel FFD_CONTRACTION_KERNEL = {find_bound, find_halving};
