#include "fold/place.h"
#include "base/arithmetic.h"
#include "fold/bernstein.h"
#include "fold/wide.h"
#include <string.h>

/* The determinant of the rows [A_u W_u; A_v W_v; A_w W_w; A W] is W^4 det J (src/maths.md 10.3). All of its
   numbers are computed with the basis functions times the product of their denominators, so that there is no
   division: the quotient is the same. The computation is then repeated with the sizes of all terms. */

enum { ROWS = 4 };

#define CERTAIN_EXPONENT (-192) /* of what the sign is relative to the terms */

/* The d+1 basis functions of a span and their slopes, times a common positive factor. */
typedef struct wide_basis {
    wide value[MAX_ORDER], slope[MAX_ORDER], rise[MAX_ORDER]; /* rise: the sizes of the slopes' terms */
} wide_basis;

static wide difference(double a, double b)
{
    const wide x = ffd_wide_of(a), y = ffd_wide_of(b);
    return wide_subtract(&x, &y);
}

/* Sets others[r] to the product of all but factor r. */
static void products_of_others(const wide *factor, int count, wide *others)
{
    for (int r = 0; r < count; r++) {
        others[r] = ffd_wide_of(1);
        for (int q = 0; q < count; q++)
            if (q != r)
                others[r] = ffd_wide_multiply(&others[r], &factor[q]);
    }
}

/* Raises the degree of functions s-degree+1..s to s-degree..s, times the product of the differences of knots
   in the denominators (NURBS Book A2.2). The last degree also gives the slopes. */
static void raise(const double *t, int s, int degree, double u, bool last, wide_basis *basis)
{
    wide length[MAX_ORDER], others[MAX_ORDER], low[MAX_ORDER] = {{0}};
    for (int r = 0; r < degree; r++) {
        length[r] = difference(t[s + 1 + r], t[s + 1 + r - degree]);
        low[r] = basis->value[r];
    }
    products_of_others(length, degree, others);
    for (int j = 0; j <= degree; j++)
        basis->value[j] = basis->slope[j] = basis->rise[j] = (wide){0};
    for (int r = 0; r < degree; r++) {
        const wide part = ffd_wide_multiply(&low[r], &others[r]), up = difference(u, t[s + 1 + r - degree]),
                   down = difference(t[s + 1 + r], u), rising = ffd_wide_multiply(&part, &up),
                   falling = ffd_wide_multiply(&part, &down);
        basis->value[r + 1] = ffd_wide_add(&basis->value[r + 1], &rising);
        basis->value[r] = ffd_wide_add(&basis->value[r], &falling);
        if (!last)
            continue;
        const wide factor = ffd_wide_of(degree), steep = ffd_wide_multiply(&part, &factor);
        basis->slope[r + 1] = ffd_wide_add(&basis->slope[r + 1], &steep);
        basis->slope[r] = wide_subtract(&basis->slope[r], &steep);
        basis->rise[r + 1] = ffd_wide_add(&basis->rise[r + 1], &steep);
        basis->rise[r] = ffd_wide_add(&basis->rise[r], &steep);
    }
}

static void find_basis(const knot_vector *knots, int span, double u, wide_basis *basis)
{
    basis->value[0] = ffd_wide_of(1);
    for (int degree = 1; degree <= knots->degree; degree++)
        raise(knots->t, span, degree, u, degree == knots->degree, basis);
}

static void add_product(const wide *a, const wide *b, wide *sum)
{
    const wide product = ffd_wide_multiply(a, b);
    *sum = ffd_wide_add(sum, &product);
}

/* The control points of the cell, relative to the first one. */
typedef struct place_cell {
    const fold_plan *plan;
    const double *points, *weights; /* weights may be NULL */
    wide_basis basis[3];
} place_cell;

/* Computes h P, h of a control point, or their sizes. */
static void find_point(const place_cell *cell, size_t i, bool sizes, wide point[ROWS])
{
    point[3] = ffd_wide_of(cell->weights ? cell->weights[i] : 1);
    for (int r = 0; r < 3; r++) {
        const wide offset = difference(cell->points[3 * i + (size_t)r], cell->points[r]);
        point[r] = ffd_wide_multiply(&point[3], &offset);
        if (sizes)
            point[r] = wide_size(&point[r]);
    }
}

/* Adds a row of control points: the value and the slope by u. */
static void add_row(const place_cell *cell, size_t first, bool sizes, wide value[ROWS], wide slope[ROWS])
{
    const wide_basis *u = &cell->basis[0];
    memset(value, 0, ROWS * sizeof *value);
    memset(slope, 0, ROWS * sizeof *slope);
    for (int i = 0; i < cell->plan->order[0]; i++) {
        wide point[ROWS];
        find_point(cell, first + (size_t)i, sizes, point);
        for (int r = 0; r < ROWS; r++) {
            add_product(&u->value[i], &point[r], &value[r]);
            add_product(sizes ? &u->rise[i] : &u->slope[i], &point[r], &slope[r]);
        }
    }
}

/* Computes the rows, or the sums of the sizes of their terms. */
static void find_rows(const place_cell *cell, bool sizes, wide rows[ROWS][ROWS])
{
    const int *order = cell->plan->order;
    const wide_basis *v = &cell->basis[1], *w = &cell->basis[2];
    size_t first = 0;
    memset(rows, 0, ROWS * sizeof *rows);
    for (int k = 0; k < order[2]; k++) {
        wide plane[3][ROWS] = {{{0}}}, value[ROWS], slope[ROWS]; /* by u, by v, the value */
        for (int j = 0; j < order[1]; j++, first += (size_t)order[0]) {
            add_row(cell, first, sizes, value, slope);
            for (int r = 0; r < ROWS; r++) {
                add_product(&v->value[j], &slope[r], &plane[0][r]);
                add_product(sizes ? &v->rise[j] : &v->slope[j], &value[r], &plane[1][r]);
                add_product(&v->value[j], &value[r], &plane[2][r]);
            }
        }
        for (int r = 0; r < ROWS; r++) {
            add_product(&w->value[k], &plane[0][r], &rows[0][r]);
            add_product(&w->value[k], &plane[1][r], &rows[1][r]);
            add_product(sizes ? &w->rise[k] : &w->slope[k], &plane[2][r], &rows[2][r]);
            add_product(&w->value[k], &plane[2][r], &rows[3][r]);
        }
    }
}

/* a d - b c, or a d + b c. */
static wide minor_of(const wide *a, const wide *b, const wide *c, const wide *d, bool sizes)
{
    const wide first = ffd_wide_multiply(a, d), second = ffd_wide_multiply(b, c);
    return sizes ? ffd_wide_add(&first, &second) : wide_subtract(&first, &second);
}

/* The determinant, by minors of two rows; for sizes the permanent. */
static wide expand(const wide m[ROWS][ROWS], bool sizes)
{
    static const int pair[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    wide sum = {0};
    for (int p = 0; p < 6; p++) {
        const int i = pair[p][0], j = pair[p][1], k = pair[5 - p][0], l = pair[5 - p][1];
        wide upper = minor_of(&m[0][i], &m[0][j], &m[1][i], &m[1][j], sizes);
        const wide lower = minor_of(&m[2][k], &m[2][l], &m[3][k], &m[3][l], sizes);
        if (!sizes && (p == 1 || p == 4))
            upper = wide_negative(&upper);
        add_product(&upper, &lower, &sum);
    }
    return sum;
}

void ffd_place_parameters(const fold_plan *plan, const size_t index[3], const double t[3], double uvw[3])
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &plan->lattice->knots[a];
        const double *knot = knots->t + knots->spans[index[a]];
        const bool is_last = index[a] + 1 == knots->span_count && !ffd_knots_closed(knots);
        uvw[a] = knot[0] + t[a] * (knot[1] - knot[0]);
        if (t[a] >= 1)
            uvw[a] = is_last ? knot[1] : next_below(knot[1]);
    }
}

place_determinant ffd_place_determinant(const fold_plan *plan, const size_t index[3], const double uvw[3],
                                        double *points)
{
    double *weights = points + 3 * ffd_bernstein_count(plan->order);
    place_cell cell = {.plan = plan, .points = points, .weights = plan->rational ? weights : NULL};
    const double *matrix[3];
    wide rows[ROWS][ROWS], sizes[ROWS][ROWS];
    ffd_fold_cell_read(plan, FFD_VOLUME_DEFORMED, index, points, plan->rational ? weights : NULL, matrix);
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &plan->lattice->knots[a];
        find_basis(knots, knots->spans[index[a]], uvw[a], &cell.basis[a]);
    }
    find_rows(&cell, false, rows);
    find_rows(&cell, true, sizes);
    const wide value = expand((const wide(*)[ROWS])rows, false),
               terms = expand((const wide(*)[ROWS])sizes, true);
    scaled size = ffd_wide_scaled(&value), weight = ffd_wide_scaled(&rows[3][3]);
    if (value.sign == 0 || size.exponent - ffd_wide_scaled(&terms).exponent < CERTAIN_EXPONENT)
        return (place_determinant){0, 0};
    for (int i = 0; i < ROWS; i++)
        size = scaled_divide(size, weight);
    size = scaled_multiply(size, scaled_divide(scaled_make(1, 0), plan->volume.reference));
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &plan->lattice->knots[a];
        size = scaled_multiply(size, scaled_make(ffd_knots_last(knots) - ffd_knots_first(knots), 0));
    }
    return (place_determinant){plan->volume.sign * value.sign, scaled_apply(1, size)};
}
