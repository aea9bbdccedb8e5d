#include "fold/bernstein.h"
#include <math.h>
#include <string.h>

size_t ffd_bernstein_count(const int order[3])
{
    return (size_t)order[0] * (size_t)order[1] * (size_t)order[2];
}

/* Fills row with C(n,i), i = 0..n. Exact, because all products are below 2^53. */
static void binomials(int n, double row[BERNSTEIN_MAX_ORDER])
{
    row[0] = 1;
    for (int i = 0; i < n; i++)
        row[i + 1] = row[i] * (n - i) / (i + 1);
}

static void all_binomials(const int order[3], double row[3][BERNSTEIN_MAX_ORDER])
{
    for (int a = 0; a < 3; a++)
        binomials(order[a] - 1, row[a]);
}

void ffd_bernstein_weight(const double *from, const int order[3], double *to)
{
    double row[3][BERNSTEIN_MAX_ORDER];
    all_binomials(order, row);
    for (int k = 0; k < order[2]; k++)
        for (int j = 0; j < order[1]; j++) {
            const double weight = row[1][j] * row[2][k];
            for (int i = 0; i < order[0]; i++)
                *to++ = *from++ * (row[0][i] * weight);
        }
}

void ffd_bernstein_unweight(double *coefficients, const int order[3], double factor)
{
    double row[3][BERNSTEIN_MAX_ORDER];
    all_binomials(order, row);
    for (int k = 0; k < order[2]; k++)
        for (int j = 0; j < order[1]; j++) {
            const double weight = row[1][j] * row[2][k];
            for (int i = 0; i < order[0]; i++, coefficients++)
                *coefficients = factor * *coefficients / (row[0][i] * weight);
        }
}

/* product += factor * the convolution of two rows. */
static inline void multiply_rows(const double *restrict a, int count_a, const double *restrict b, int count_b,
                                 double factor, double *restrict product)
{
    for (int i = 0; i < count_a; i++) {
        const double value = factor * a[i];
        for (int j = 0; j < count_b; j++)
            product[i + j] += value * b[j];
    }
}

void ffd_bernstein_multiply(const double *a, const int order_a[3], const double *b, const int order_b[3],
                            double factor, double *product)
{
    const size_t row = (size_t)(order_a[0] + order_b[0] - 1);
    const size_t plane = row * (size_t)(order_a[1] + order_b[1] - 1);
    for (int k = 0; k < order_a[2]; k++)
        for (int j = 0; j < order_a[1]; j++, a += order_a[0]) {
            const double *row_b = b;
            for (int m = 0; m < order_b[2]; m++)
                for (int l = 0; l < order_b[1]; l++, row_b += order_b[0])
                    multiply_rows(a, order_a[0], row_b, order_b[0], factor,
                                  product + (size_t)(k + m) * plane + (size_t)(j + l) * row);
        }
}

/* slope[i] += factor * sum_j of_product[i + j] b[j] */
static void multiply_rows_back(const double *of_product, int count_a, const double *b, int count_b,
                               double factor, double *slope)
{
    for (int i = 0; i < count_a; i++) {
        double sum = 0;
        for (int j = 0; j < count_b; j++)
            sum += of_product[i + j] * b[j];
        slope[i] += factor * sum;
    }
}

void ffd_bernstein_multiply_back(const double *of_product, const int order_a[3], const double *b,
                                 const int order_b[3], double factor, double *slope)
{
    const size_t row = (size_t)(order_a[0] + order_b[0] - 1);
    const size_t plane = row * (size_t)(order_a[1] + order_b[1] - 1);
    for (int k = 0; k < order_a[2]; k++)
        for (int j = 0; j < order_a[1]; j++, slope += order_a[0]) {
            const double *row_b = b;
            for (int m = 0; m < order_b[2]; m++)
                for (int l = 0; l < order_b[1]; l++, row_b += order_b[0])
                    multiply_rows_back(of_product + (size_t)(k + m) * plane + (size_t)(j + l) * row,
                                       order_a[0], row_b, order_b[0], factor, slope);
        }
}

double ffd_bernstein_terms(const int order_a[3], const int order_b[3])
{
    double terms = 1;
    for (int a = 0; a < 3; a++)
        terms *= order_a[a] < order_b[a] ? order_a[a] : order_b[a];
    return terms;
}

/* De Casteljau's algorithm at 1/2 for `width` adjacent rows: after step k the points 0..n-1-k hold level k,
   and the first of them is point k of the lower half. */
static void halve_lines(double *restrict line, int points, size_t width, double *restrict lower)
{
    for (int k = 0; k < points; k++) {
        memcpy(lower + (size_t)k * width, line, width * sizeof(double));
        const size_t count = (size_t)(points - 1 - k) * width;
        for (size_t i = 0; i < count; i++)
            line[i] = 0.5 * (line[i] + line[i + width]);
    }
}

void ffd_bernstein_halve(double *coefficients, const int order[3], int a, double *lower)
{
    const size_t width = a == 0 ? 1 : a == 1 ? (size_t)order[0] : (size_t)order[0] * (size_t)order[1];
    const size_t block = width * (size_t)order[a], count = ffd_bernstein_count(order);
    for (size_t start = 0; start < count; start += block)
        halve_lines(coefficients + start, order[a], width, lower + start);
}

void ffd_bernstein_restrict(double *coefficients, const int order[3], const double lo[3], const double hi[3],
                            double *scratch)
{
    for (int a = 0; a < 3; a++) {
        double start = 0, end = 1;
        while (start < lo[a] || end > hi[a]) {
            const double middle = 0.5 * (start + end);
            ffd_bernstein_halve(coefficients, order, a, scratch);
            if (hi[a] <= middle) {
                memcpy(coefficients, scratch, ffd_bernstein_count(order) * sizeof(double));
                end = middle;
            } else {
                start = middle;
            }
        }
    }
}

/* Evaluates the Bernstein polynomials of degree order - 1 at t, without cancellation. */
static void basis_values(int order, double t, double value[BERNSTEIN_MAX_ORDER])
{
    value[0] = 1;
    for (int n = 1; n < order; n++) {
        value[n] = t * value[n - 1];
        for (int i = n - 1; i > 0; i--)
            value[i] = (1 - t) * value[i] + t * value[i - 1];
        value[0] *= 1 - t;
    }
}

double ffd_bernstein_value(const double *coefficients, const int order[3], const double t[3])
{
    double value[3][BERNSTEIN_MAX_ORDER], sum = 0;
    for (int a = 0; a < 3; a++)
        basis_values(order[a], t[a], value[a]);
    for (int k = 0; k < order[2]; k++) {
        double plane = 0;
        for (int j = 0; j < order[1]; j++) {
            double row = 0;
            for (int i = 0; i < order[0]; i++)
                row += value[0][i] * *coefficients++;
            plane += value[1][j] * row;
        }
        sum += value[2][k] * plane;
    }
    return sum;
}

/* Returns the greatest second difference along the rows, `width` of which are adjacent. */
static double greatest_bend(const double *c, int points, size_t width, size_t blocks)
{
    double greatest = 0;
    for (size_t block = 0; block < blocks; block++, c += (size_t)points * width)
        for (size_t i = 0; i < (size_t)(points - 2) * width; i++) {
            const double bend = fabs((c[i] - c[i + width]) + (c[i + 2 * width] - c[i + width]));
            greatest = bend > greatest ? bend : greatest;
        }
    return greatest;
}

int ffd_bernstein_direction(const double *coefficients, const int order[3])
{
    int best = 0;
    double greatest = -1;
    size_t width = 1;
    for (int a = 0; a < 3; a++) {
        const size_t blocks = ffd_bernstein_count(order) / (width * (size_t)order[a]);
        const double bend =
            order[a] > 2 ? (order[a] - 1) * greatest_bend(coefficients, order[a], width, blocks) : 0;
        if (bend > greatest) {
            greatest = bend;
            best = a;
        }
        width *= (size_t)order[a];
    }
    return best;
}

double ffd_bernstein_greatest_size(const double *values, size_t count)
{
    double greatest = 0;
    for (size_t i = 0; i < count; i++)
        greatest = fabs(values[i]) > greatest ? fabs(values[i]) : greatest;
    return greatest;
}
