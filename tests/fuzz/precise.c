/* precise.c - the recursion of Cox and de Boor and its derivative in long double. */
#include "precise.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* The basis functions that are not 0 along one direction. */
typedef struct precise_basis {
    int count;
    size_t point[MAX_ORDER]; /* their control points */
    long double value[MAX_ORDER], derivative[MAX_ORDER];
} precise_basis;

long double precise_unit(void)
{
    volatile long double sum = 1;
    sum += LDBL_EPSILON;
    return sum > 1 ? LDBL_EPSILON : DBL_EPSILON;
}

long double precise_determinant(const long double m[9])
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
           m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/* The last span that starts at or before u and is not empty. */
static int span_of(const knot_vector *knots, double u)
{
    int span = knots->spans[0];
    for (size_t s = 1; s < knots->span_count; s++)
        if (knots->t[knots->spans[s]] <= u)
            span = knots->spans[s];
    return span;
}

/* Cox and de Boor's recursion from degree 0 upwards (P&T 2.5), the derivative from the last but one degree
   (P&T 2.7). */
static void find_basis(const knot_vector *knots, double u, precise_basis *basis)
{
    const int d = knots->degree, span = span_of(knots, u);
    const double *const t = knots->t;
    long double lower[MAX_ORDER + 1], *const value = basis->value;
    value[0] = 1;
    for (int r = 1; r <= d; r++) {
        memcpy(lower, value, (size_t)r * sizeof *lower);
        for (int j = 0; j <= r; j++) {
            const int i = span - r + j;
            value[j] = 0;
            basis->derivative[j] = 0;
            if (j > 0) {
                const long double width = (long double)t[i + r] - t[i];
                value[j] += ((long double)u - t[i]) / width * lower[j - 1];
                basis->derivative[j] += r / width * lower[j - 1];
            }
            if (j < r) {
                const long double width = (long double)t[i + r + 1] - t[i + 1];
                value[j] += ((long double)t[i + r + 1] - u) / width * lower[j];
                basis->derivative[j] -= r / width * lower[j];
            }
        }
    }
    basis->count = d + 1;
    for (int j = 0; j <= d; j++)
        basis->point[j] = (size_t)(span - d + j) % knots->points;
}

typedef struct precise_cell {
    const double *points, *weights;
    const double *centre;
    size_t size[3];
    precise_basis basis[3];
} precise_cell;

/* Calls for each control point of the cell: x = P - centre, its weight, N N N and its derivatives. */
typedef void (*cell_visitor)(void *context, const long double x[3], const long double factor[4]);

static void visit_cell(const precise_cell *cell, cell_visitor visit, void *context)
{
    const precise_basis *const u = &cell->basis[0], *const v = &cell->basis[1], *const w = &cell->basis[2];
    for (int k = 0; k < w->count; k++)
        for (int j = 0; j < v->count; j++)
            for (int i = 0; i < u->count; i++) {
                const size_t index =
                    u->point[i] + cell->size[0] * (v->point[j] + cell->size[1] * w->point[k]);
                const long double h = cell->weights ? cell->weights[index] : 1;
                const long double factor[4] = {h * u->value[i] * v->value[j] * w->value[k],
                                               h * u->derivative[i] * v->value[j] * w->value[k],
                                               h * u->value[i] * v->derivative[j] * w->value[k],
                                               h * u->value[i] * v->value[j] * w->derivative[k]};
                long double x[3];
                for (int r = 0; r < 3; r++)
                    x[r] = (long double)cell->points[3 * index + (size_t)r] - cell->centre[r];
                visit(context, x, factor);
            }
}

typedef struct precise_sum {
    long double x[4][3], h[4]; /* value, by u, by v, by w */
} precise_sum;

static void add_point(void *context, const long double x[3], const long double factor[4])
{
    precise_sum *const sum = context;
    for (int c = 0; c < 4; c++) {
        sum->h[c] += factor[c];
        for (int r = 0; r < 3; r++)
            sum->x[c][r] += factor[c] * x[r];
    }
}

static void add_sway(void *context, const long double x[3], const long double factor[4])
{
    precise_sample *const sample = context;
    for (int r = 0; r < 3; r++)
        for (int a = 0; a < 3; a++)
            sample->sway[3 * r + a] += fabsl(factor[a + 1] * (x[r] - sample->point[r]));
}

void precise_evaluate(const ffd_lattice *lattice, ffd_volume volume, const double uvw[3],
                      const double centre[3], precise_sample *sample)
{
    precise_cell cell = {.points = volume == FFD_VOLUME_REST ? lattice->rest : lattice->deformed,
                         .weights =
                             volume == FFD_VOLUME_REST ? lattice->rest_weights : lattice->deformed_weights,
                         .centre = centre};
    for (int a = 0; a < 3; a++) {
        cell.size[a] = lattice->size[a];
        find_basis(&lattice->knots[a], uvw[a], &cell.basis[a]);
    }
    precise_sum sum = {{{0}}, {0}};
    visit_cell(&cell, add_point, &sum);
    memset(sample, 0, sizeof *sample);
    for (int r = 0; r < 3; r++) {
        sample->point[r] = sum.x[0][r] / sum.h[0];
        for (int a = 0; a < 3; a++)
            sample->jacobian[3 * r + a] = (sum.x[a + 1][r] - sample->point[r] * sum.h[a + 1]) / sum.h[0];
    }
    visit_cell(&cell, add_sway, sample);
    for (int i = 0; i < 9; i++)
        sample->sway[i] /= sum.h[0];
}
