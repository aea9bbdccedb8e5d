#include "fold/zeros.h"
#include "embed/frame/bezier_box.h"
#include "fold/bernstein.h"
#include "fold/determinant.h"
#include <string.h>

/* A coefficient of a derivative is 0 if all control points on each row in its direction that it depends on
   are equal. Marks (0: the coefficient is 0; 1: it may have any value) are convolved like the rows of the
   determinant: a coefficient of the determinant is a sum of products of coefficients of three rows, and a
   product is 0 if a factor is. With weights, equal control points have equal weights too; the fourth row of
   the determinant is never 0. */

enum { N = BEZIER_COMPONENTS };

static size_t pair_count(const int order[3])
{
    size_t count = 1; /* of the product of two derivatives */
    for (int a = 0; a < 3; a++)
        count *= (size_t)(2 * order[a] - 1);
    return count;
}

static size_t triple_count(const int order[3])
{
    int result[3];
    ffd_determinant_order(order, false, result);
    return ffd_bernstein_count(result);
}

static size_t largest_count(const int order[3], bool rational)
{
    int result[3];
    ffd_determinant_order(order, rational, result);
    return ffd_bernstein_count(result);
}

size_t ffd_zeros_scratch(const int order[3], bool rational)
{
    const size_t count = ffd_bernstein_count(order);
    return ffd_bezier_size(order) + 4 * count + pair_count(order) + triple_count(order) +
           largest_count(order, rational);
}

static bool is_equal(const double *points, const double *weights, size_t i, size_t j)
{
    for (size_t r = 0; r < 3; r++)
        if (points[3 * i + r] != points[3 * j + r])
            return false;
    return !weights || weights[i] == weights[j];
}

/* Sets component b of every point to 1 if the row in direction b through it has unequal points, else to 0. */
static void mark_lines(const double *points, const double *weights, bezier_box *box)
{
    const int *order = box->order;
    const size_t stride[3] = {1, (size_t)order[0], (size_t)order[0] * (size_t)order[1]};
    size_t point = 0;
    int at[3];
    for (at[2] = 0; at[2] < order[2]; at[2]++)
        for (at[1] = 0; at[1] < order[1]; at[1]++)
            for (at[0] = 0; at[0] < order[0]; at[0]++, point++)
                for (int b = 0; b < 3; b++) {
                    const size_t first = point - (size_t)at[b] * stride[b];
                    double mark = 0;
                    for (int i = 1; i < order[b]; i++)
                        if (!is_equal(points, weights, first, first + (size_t)i * stride[b]))
                            mark = 1;
                    box->coefficients[N * point + (size_t)b] = mark;
                }
}

/* Copies row b of the Bezier form, which has one point less in direction b. */
static void copy_row(const bezier_box *box, int b, int order[3], double *row)
{
    for (int a = 0; a < 3; a++)
        order[a] = box->order[a] - (a == b);
    for (int k = 0; k < order[2]; k++)
        for (int j = 0; j < order[1]; j++)
            for (int i = 0; i < order[0]; i++) {
                const size_t point =
                    (size_t)i + (size_t)box->order[0] * ((size_t)j + (size_t)box->order[1] * (size_t)k);
                *row++ = box->coefficients[N * point + (size_t)b] > 0 ? 1 : 0;
            }
}

static void multiply(const double *a, const int order_a[3], const double *b, const int order_b[3],
                     int order[3], double *product)
{
    for (int c = 0; c < 3; c++)
        order[c] = order_a[c] + order_b[c] - 1;
    memset(product, 0, ffd_bernstein_count(order) * sizeof(double));
    ffd_bernstein_multiply(a, order_a, b, order_b, 1, product);
}

/* Computes the marks of the determinant of a volume. Returns a pointer to them in memory, which also holds
   the box and the points. */
static const double *mark_determinant(const fold_plan *plan, ffd_volume volume, const size_t index[3],
                                      bool rational, double *memory)
{
    const size_t count = ffd_bernstein_count(plan->order);
    bezier_box box = {.rational = true, .coefficients = memory};
    double *points = memory + ffd_bezier_size(plan->order), *weights = points + 3 * count;
    const double *matrix[3];
    memcpy(box.order, plan->order, sizeof box.order);
    ffd_fold_cell_read(plan, volume, index, points, rational ? weights : NULL, matrix);
    memset(memory, 0, ffd_bezier_size(plan->order) * sizeof(double));
    mark_lines(points, rational ? weights : NULL, &box);
    ffd_bezier_extract(&box, matrix); /* the matrices have no negative entries */

    double *row = points, *pair = row + 4 * count, *triple = pair + pair_count(plan->order);
    int order[3], order_pair[3], order_triple[3];
    copy_row(&box, 0, order, row);
    copy_row(&box, 1, order_pair, row + count);
    multiply(row, order, row + count, order_pair, order_triple, pair);
    memcpy(order_pair, order_triple, sizeof order_pair);
    copy_row(&box, 2, order, row);
    multiply(pair, order_pair, row, order, order_triple, triple);
    if (!rational)
        return triple;
    double *product = triple + triple_count(plan->order);
    for (size_t i = 0; i < count; i++)
        row[i] = 1;
    multiply(triple, order_triple, row, plan->order, order, product);
    return product;
}

bool ffd_zeros_find(const fold_plan *plan, const size_t index[3], bool rational, double *scratch,
                    double *const other[2])
{
    const size_t count = largest_count(plan->order, rational);
    for (int volume = 0; volume < 2; volume++) {
        const double *marks = mark_determinant(plan, (ffd_volume)volume, index, rational, scratch);
        size_t zeros = 0;
        for (size_t i = 0; i < count; i++) {
            other[volume][i] = marks[i] > 0 ? 1 : 0;
            zeros += !(marks[i] > 0);
        }
        if (volume == FFD_VOLUME_REST && zeros == 0)
            return false;
    }
    return true;
}
