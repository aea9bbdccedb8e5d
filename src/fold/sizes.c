#include "fold/sizes.h"
#include "fold/bernstein.h"
#include <string.h>

/* The bounds are sums of positive terms: their relative rounding error is far below this. */
#define SUM_ROUNDING 1e-12
#define EVEN_RATIO 4 /* of weights in a box */

size_t ffd_sizes_count(const int order[3])
{
    return 2 * FORM_ROWS * ffd_bernstein_count(order);
}

/* Points the rows to their places in memory. */
static void lay_out(const cell_form *form, double *memory, row_sizes *sizes)
{
    for (int b = 0; b < FORM_ROWS; b++)
        for (int c = 0; c < 2; c++) {
            sizes->row[b][c] = memory;
            memory += ffd_bernstein_count(form->order[b]);
        }
}

void ffd_sizes_make(const cell_form *form, double *memory, row_sizes *sizes)
{
    lay_out(form, memory, sizes);
    for (int b = 0; b < FORM_ROWS; b++)
        for (int c = 0; c < 2; c++)
            memcpy(sizes->row[b][c], form->size[b][c], ffd_bernstein_count(form->order[b]) * sizeof(double));
}

void ffd_sizes_halve(const cell_form *form, int a, double *memory, const row_sizes *whole, row_sizes *lower)
{
    lay_out(form, memory, lower);
    for (int b = 0; b < FORM_ROWS; b++)
        for (int c = 0; c < 2; c++)
            ffd_bernstein_halve(whole->row[b][c], form->order[b], a, lower->row[b][c]);
}

static double greatest_of(const cell_form *form, int b, const double *row)
{
    return ffd_bernstein_greatest_size(row, ffd_bernstein_count(form->order[b])) * (1 + SUM_ROUNDING);
}

static bool is_even(const cell_form *form, const double *weights)
{
    double least = weights[0], greatest = weights[0];
    for (size_t i = 1; i < ffd_bernstein_count(form->order[3]); i++) {
        least = weights[i] < least ? weights[i] : least;
        greatest = weights[i] > greatest ? weights[i] : greatest;
    }
    return greatest <= EVEN_RATIO * least;
}

void ffd_sizes_bound(const cell_form *form, const row_sizes *sizes, size_bounds *bounds)
{
    memset(bounds, 0, sizeof *bounds);
    for (int b = 0; b < FORM_ROWS; b++)
        for (int c = 0; c < 2; c++)
            bounds->row[b][c] = greatest_of(form, b, sizes->row[b][c]);
    bounds->is_even = is_even(form, sizes->row[3][1]);
}

void ffd_sizes_bound_part(const cell_form *form, const double lo[3], const double hi[3], double *scratch,
                          size_bounds *bounds)
{
    for (int b = 0; b < FORM_ROWS; b++) {
        const size_t count = ffd_bernstein_count(form->order[b]);
        const double *rows[3] = {form->size[b][0], form->size[b][1], form->known[b]};
        double *greatest[3] = {&bounds->row[b][0], &bounds->row[b][1], &bounds->known[b]};
        for (int c = 0; c < 3; c++) {
            memcpy(scratch, rows[c], count * sizeof(double));
            ffd_bernstein_restrict(scratch, form->order[b], lo, hi, scratch + count);
            *greatest[c] = greatest_of(form, b, scratch);
            if (b == 3 && c == 1)
                bounds->is_even = is_even(form, scratch);
        }
    }
}

double ffd_sizes_products(const size_bounds *bounds, bool with_known)
{
    double a[FORM_ROWS], sum = 0;
    for (int b = 0; b < FORM_ROWS; b++)
        a[b] = bounds->row[b][0] + (with_known ? bounds->known[b] : 0);
    for (int b = 0; b < FORM_ROWS; b++)
        sum += bounds->row[b][1] * (a[(b + 1) % FORM_ROWS] * a[(b + 2) % FORM_ROWS] * a[(b + 3) % FORM_ROWS]);
    return 6 * sum; /* the other three rows have x, y, z in any order */
}
