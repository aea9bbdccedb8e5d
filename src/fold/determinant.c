#include "fold/determinant.h"
#include "fold/bernstein.h"
#include <string.h>

#define UNIT (0.5 * DBL_EPSILON)

void ffd_determinant_order(const int order[3], bool rational, int result[3])
{
    for (int a = 0; a < 3; a++)
        result[a] = (rational ? 4 : 3) * (order[a] - 1);
}

/* The pairs of four components, and the sign of a pair and its complement in the Laplace expansion by two
   rows. */
static const int pair[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
static const double pair_sign[6] = {1, -1, 1, 1, -1, 1};

/* Returns the sum over all permutations of the products of entries: with sign = 1 the permanent, with -1 the
   determinant. */
static double expand3(const form_matrix *m, double sign)
{
    const double *a = m->at[0], *b = m->at[1], *c = m->at[2];
    return a[0] * (b[1] * c[2] + sign * (b[2] * c[1])) + a[1] * (b[2] * c[0] + sign * (b[0] * c[2])) +
           a[2] * (b[0] * c[1] + sign * (b[1] * c[0]));
}

static double expand4(const form_matrix *matrix, double sign)
{
    const double(*m)[FORM_ROWS] = matrix->at;
    double sum = 0;
    for (int p = 0; p < 6; p++) {
        const int i = pair[p][0], j = pair[p][1], k = pair[5 - p][0], l = pair[5 - p][1];
        const double factor = sign < 0 ? pair_sign[p] : 1;
        sum += factor * (m[0][i] * m[1][j] + sign * (m[0][j] * m[1][i])) *
               (m[2][k] * m[3][l] + sign * (m[2][l] * m[3][k]));
    }
    return sum;
}

static double permanent(int rows, const form_matrix *m)
{
    return rows == 3 ? expand3(m, 1) : expand4(m, 1);
}

static void add_bounds(int rows, const form_matrix *a, const form_matrix *b, form_matrix *sum)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < rows; j++)
            sum->at[i][j] = a->at[i][j] + b->at[i][j];
}

static void row_product_order(const cell_form *form, int a, int b, int order[3])
{
    for (int c = 0; c < 3; c++)
        order[c] = form->order[a][c] + form->order[b][c] - 1;
}

/* Returns the rounding error of a coefficient relative to the permanent: from the sums of both expansions,
   the products with binomials, and this bound itself. */
static double roundings(const cell_form *form)
{
    int order[3], other[3];
    if (form->rows == 3) {
        row_product_order(form, 1, 2, order);
        return 2 * ffd_bernstein_terms(form->order[1], form->order[2]) +
               3 * ffd_bernstein_terms(form->order[0], order) + 32;
    }
    row_product_order(form, 0, 1, order);
    row_product_order(form, 2, 3, other);
    return 2 * ffd_bernstein_terms(form->order[0], form->order[1]) +
           2 * ffd_bernstein_terms(form->order[2], form->order[3]) + 6 * ffd_bernstein_terms(order, other) +
           48;
}

void ffd_determinant_bounds(const cell_form *form, determinant_bounds *bounds)
{
    form_matrix sum;
    const double relative = roundings(form) * UNIT, exact = permanent(form->rows, &form->greatest);
    bounds->relative = relative;
    add_bounds(form->rows, &form->greatest, &form->rounding, &sum);
    bounds->greatest = permanent(form->rows, &sum) * (1 + relative);
    bounds->rounding = bounds->greatest - exact;
    add_bounds(form->rows, &form->greatest, &form->coarse, &sum);
    bounds->coarse = permanent(form->rows, &sum) * (1 + relative) - exact;
    if (bounds->greatest > 0) { /* because products may underflow */
        bounds->rounding += LEAST_ROUNDING;
        bounds->coarse += LEAST_ROUNDING;
    }
}

double ffd_determinant_corner(const cell_form *form, int corner)
{
    form_matrix m;
    for (int b = 0; b < form->rows; b++) {
        const int *order = form->order[b];
        const int i = corner & 1 ? order[0] - 1 : 0, j = corner & 2 ? order[1] - 1 : 0,
                  k = corner & 4 ? order[2] - 1 : 0;
        const size_t at = (size_t)i + (size_t)order[0] * ((size_t)j + (size_t)order[1] * (size_t)k);
        for (int r = 0; r < form->rows; r++)
            m.at[b][r] = form->row[b][r][at];
    }
    return form->rows == 3 ? expand3(&m, -1) : expand4(&m, -1);
}

/* Memory layout: the weighted rows, then minors of two rows each. */

static size_t minor_size(const int order[3])
{
    size_t size = 1; /* products of two rows have order 2 order - 1 at most */
    for (int a = 0; a < 3; a++)
        size *= (size_t)(2 * order[a] - 1);
    return size;
}

size_t ffd_determinant_scratch(const int order[3], bool rational)
{
    return (rational ? 16 : 9) * ffd_bernstein_count(order) + (rational ? 2 : 1) * minor_size(order);
}

/* minor = (row a, component i) * (row b, component j) - (row a, component j) * (row b, component i). */
static void multiply_minor(const cell_form *form, double *weighted[FORM_ROWS][FORM_ROWS], int a, int b, int i,
                           int j, double *minor)
{
    int order[3];
    row_product_order(form, a, b, order);
    memset(minor, 0, ffd_bernstein_count(order) * sizeof(double));
    ffd_bernstein_multiply(weighted[a][i], form->order[a], weighted[b][j], form->order[b], 1, minor);
    ffd_bernstein_multiply(weighted[a][j], form->order[a], weighted[b][i], form->order[b], -1, minor);
}

/* C_u . (C_v x C_w) */
static void expand_three_rows(const cell_form *form, double *weighted[FORM_ROWS][FORM_ROWS], double *minor,
                              double *product)
{
    int order[3];
    row_product_order(form, 1, 2, order);
    for (int r = 0; r < 3; r++) {
        multiply_minor(form, weighted, 1, 2, (r + 1) % 3, (r + 2) % 3, minor);
        ffd_bernstein_multiply(weighted[0][r], form->order[0], minor, order, 1, product);
    }
}

static void expand_four_rows(const cell_form *form, double *weighted[FORM_ROWS][FORM_ROWS], double *minors,
                             size_t size, double *product)
{
    int upper[3], lower[3];
    row_product_order(form, 0, 1, upper);
    row_product_order(form, 2, 3, lower);
    for (int p = 0; p < 6; p++) {
        double *first = minors, *second = minors + size;
        multiply_minor(form, weighted, 0, 1, pair[p][0], pair[p][1], first);
        multiply_minor(form, weighted, 2, 3, pair[5 - p][0], pair[5 - p][1], second);
        ffd_bernstein_multiply(first, upper, second, lower, pair_sign[p], product);
    }
}

void ffd_determinant_coefficients(const cell_form *form, double factor, double *scratch, double *coefficients)
{
    double *weighted[FORM_ROWS][FORM_ROWS];
    double *next = scratch;
    int order[3];
    for (int b = 0; b < form->rows; b++)
        for (int r = 0; r < form->rows; r++) {
            weighted[b][r] = next;
            ffd_bernstein_weight(form->row[b][r], form->order[b], next);
            next += ffd_bernstein_count(form->order[b]);
        }
    for (int a = 0; a < 3; a++) {
        order[a] = 1 - form->rows;
        for (int b = 0; b < form->rows; b++)
            order[a] += form->order[b][a];
    }
    memset(coefficients, 0, ffd_bernstein_count(order) * sizeof(double));
    if (form->rows == 3) {
        expand_three_rows(form, weighted, next, coefficients);
    } else {
        expand_four_rows(form, weighted, next, minor_size(form->order[3]), coefficients);
    }
    ffd_bernstein_unweight(coefficients, order, factor);
}
