#include "fold/cell_form.h"
#include "base/arithmetic.h"
#include "embed/frame/bezier_box.h"
#include "fold/bernstein.h"
#include <string.h>

enum { N = BEZIER_COMPONENTS };

#define UNIT (0.5 * DBL_EPSILON) /* relative rounding error of one operation */

size_t ffd_cell_form_size(const int order[3], bool rational)
{
    return (rational ? 28 : 9) * ffd_bernstein_count(order);
}

size_t ffd_cell_form_scratch(const int order[3])
{
    return ffd_bezier_size(order) + 4 * ffd_bernstein_count(order);
}

bool ffd_cell_is_rational(const fold_plan *plan, const int span[3], double *scratch)
{
    const ffd_lattice *lattice = plan->lattice;
    if (!plan->rational)
        return false;
    for (int volume = 0; volume < 2; volume++) {
        const double *weights = ffd_lattice_get_weights(lattice, (ffd_volume)volume);
        ffd_lattice_cell_weights(lattice, weights, span, scratch);
        for (size_t i = 1; i < ffd_bernstein_count(plan->order); i++)
            if (scratch[i] != scratch[0])
                return true;
    }
    return false;
}

/* Returns the exponent of the power of two that scales size to [1/2, 1); 0 for 0. */
static int exponent_of(double size)
{
    int exponent = 0;
    if (size > 0)
        frexp(size, &exponent);
    return exponent < -1000 ? -1000 : exponent;
}

/* Returns the control point from which the others are seen: with weights that are very different the
   heaviest, so that A is small where W is great; else the middle one. */
static size_t origin_of(const double *weights, size_t count)
{
    size_t origin = count / 2;
    for (size_t i = 0; weights && i < count; i++)
        if (weights[i] > weights[origin] && weights[i] > 2 * weights[count / 2])
            origin = i;
    return origin;
}

/* Shifts a coordinate of the control points of a cell to that of the point `from`, and scales it. Returns the
   exponent. *known is the accuracy of the scaled coordinate if the control points are known only to their
   rounding, *offset the size of the scaled origin. */
static int localise(double *points, size_t count, int r, size_t from, double *known, double *offset)
{
    const double origin = points[3 * from + (size_t)r];
    double far = 0, extent = 0;
    for (size_t i = 0; i < count; i++)
        far = maximum_number(far, fabs(points[3 * i + (size_t)r]));
    const int first = far > 0x1p1000 ? 8 : 0; /* so that differences do not overflow */
    const double shrink = ldexp(1, -first);
    for (size_t i = 0; i < count; i++) {
        double *x = points + 3 * i + r;
        *x = *x * shrink - origin * shrink;
        extent = maximum_number(extent, fabs(*x));
    }
    const int exponent = exponent_of(extent);
    const double scale = ldexp(1, -exponent);
    for (size_t i = 0; i < count; i++)
        points[3 * i + (size_t)r] *= scale;
    *known = extent > 0 ? 2 * DBL_EPSILON * (far * shrink * scale) : 0;
    *offset = fabs(origin) * shrink * scale;
    return exponent + first;
}

static void localise_weights(double *weights, size_t count)
{
    double greatest = 0;
    for (size_t i = 0; i < count; i++)
        greatest = maximum_number(greatest, weights[i]);
    const double scale = ldexp(1, -exponent_of(greatest));
    for (size_t i = 0; i < count; i++)
        weights[i] *= scale;
}

/* Returns how often a coefficient of the Bezier form is rounded: by the shift and the weight, and in each
   direction in the entries of the extraction matrix (5 times in each step of the triangular scheme) and in
   the sum over a row. */
static double roundings_of(const fold_plan *plan)
{
    double steps = 4;
    for (int a = 0; a < 3; a++)
        steps += 6 * (plan->order[a] - 1) + 4;
    return steps;
}

/* Fills the box with h P, h, and bounds their rounding error in Bezier form. */
static void fill_box(const fold_plan *plan, const double *points, const double *weights,
                     const double known[3], bezier_box *box, double rounding[N], double coarse[N])
{
    const size_t count = ffd_bernstein_count(plan->order);
    const double steps = roundings_of(plan);
    double extent[N] = {0, 0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        double *c = box->coefficients + N * i;
        const double h = weights ? weights[i] : 1;
        for (int r = 0; r < 3; r++)
            c[r] = h * points[3 * i + (size_t)r];
        c[3] = h;
        for (int r = 0; r < N; r++)
            extent[r] = maximum_number(extent[r], fabs(c[r]));
    }
    for (int r = 0; r < N; r++) {
        rounding[r] = r < 3 || weights ? steps * UNIT * extent[r] : 0;
        coarse[r] = rounding[r] + (r < 3 ? known[r] : 0);
    }
}

/* Computes row b: the derivative in direction b. */
static void derive(const bezier_box *box, int b, int components, const double rounding[N],
                   const double coarse[N], cell_form *form)
{
    const size_t next = N * (size_t)(b == 0 ? 1 : b == 1 ? box->order[0] : box->order[0] * box->order[1]);
    const double degree = box->order[b] - 1;
    int *order = form->order[b];
    for (int a = 0; a < 3; a++)
        order[a] = box->order[a] - (a == b);
    double greatest[N] = {0, 0, 0, 0};
    size_t to = 0;
    for (int k = 0; k < order[2]; k++)
        for (int j = 0; j < order[1]; j++) {
            const double *c = box->coefficients + N * (size_t)box->order[0] * (size_t)(j + box->order[1] * k);
            for (int i = 0; i < order[0]; i++, c += N, to++)
                for (int r = 0; r < components; r++) {
                    const double value = degree * (c[next + (size_t)r] - c[r]);
                    form->row[b][r][to] = value;
                    greatest[r] = fabs(value) > greatest[r] ? fabs(value) : greatest[r];
                }
        }
    for (int r = 0; r < components; r++) {
        form->greatest.at[b][r] = greatest[r];
        form->rounding.at[b][r] = 2 * degree * rounding[r] + 2 * UNIT * greatest[r];
        form->coarse.at[b][r] = 2 * degree * coarse[r] + 2 * UNIT * greatest[r];
    }
}

/* Computes row 3: A and W. */
static void copy_values(const bezier_box *box, const double rounding[N], const double coarse[N],
                        cell_form *form)
{
    const size_t count = ffd_bernstein_count(box->order);
    memcpy(form->order[3], box->order, sizeof form->order[3]);
    for (int r = 0; r < N; r++) {
        form->greatest.at[3][r] = 0;
        form->rounding.at[3][r] = rounding[r];
        form->coarse.at[3][r] = coarse[r];
        for (size_t i = 0; i < count; i++) {
            const double value = box->coefficients[N * i + (size_t)r];
            form->row[3][r][i] = value;
            form->greatest.at[3][r] = maximum_number(form->greatest.at[3][r], fabs(value));
        }
    }
}

static void measure_hull(const bezier_box *box, const double rounding[N], cell_form *form)
{
    ffd_bezier_weights(box, &form->least_weight, &form->greatest_weight);
    const bounds hull = ffd_bezier_hull(box);
    for (int r = 0; r < 3; r++) {
        const double size = maximum_number(fabs(hull.lo[r]), fabs(hull.hi[r]));
        form->hull_middle[r] = 0.5 * hull.lo[r] + 0.5 * hull.hi[r];
        form->hull_reach[r] =
            maximum_number(hull.hi[r] - form->hull_middle[r], form->hull_middle[r] - hull.lo[r]) +
            2 * (rounding[r] + size * rounding[3]) / form->least_weight + 4 * UNIT * size;
    }
}

/* size = degree * (c[i] + c[i + 1]) along direction b, which bounds degree * (c[i + 1] - c[i]). */
static void bound_differences(const bezier_box *box, int b, int component, double *size)
{
    const size_t next = N * (size_t)(b == 0 ? 1 : b == 1 ? box->order[0] : box->order[0] * box->order[1]);
    const double degree = box->order[b] - 1;
    int order[3];
    for (int a = 0; a < 3; a++)
        order[a] = box->order[a] - (a == b);
    for (int k = 0; k < order[2]; k++)
        for (int j = 0; j < order[1]; j++) {
            const double *c =
                box->coefficients + component + N * (size_t)box->order[0] * (size_t)(j + box->order[1] * k);
            for (int i = 0; i < order[0]; i++, c += N)
                *size++ = degree * (c[next] + c[0]);
        }
}

/* Bounds the rows coefficient by coefficient. The box is filled with the sizes of h P, with what h P is known
   to, and with h. */
static void bound_rows(const double *points, const double *weights, const double offset[3],
                       const double *const matrix[3], bezier_box *box, double *memory, cell_form *form)
{
    const size_t count = ffd_bernstein_count(box->order);
    for (size_t i = 0; i < count; i++) {
        double *c = box->coefficients + N * i;
        double size = 0, far = 0;
        for (int r = 0; r < 3; r++) {
            const double x = fabs(points[3 * i + (size_t)r]);
            size = maximum_number(size, x);
            far = maximum_number(far, x + offset[r]);
        }
        c[0] = weights[i] * size;
        c[1] = weights[i] * (2 * DBL_EPSILON * far);
        c[2] = 0;
        c[3] = weights[i];
    }
    ffd_bezier_extract(box, matrix);
    for (int b = 0; b < form->rows; b++) {
        form->size[b][0] = memory + (size_t)(3 * b) * count;
        form->size[b][1] = memory + (size_t)(3 * b + 1) * count;
        form->known[b] = memory + (size_t)(3 * b + 2) * count;
        if (b < 3) {
            bound_differences(box, b, 0, form->size[b][0]);
            bound_differences(box, b, 3, form->size[b][1]);
            bound_differences(box, b, 1, form->known[b]);
        }
    }
    for (size_t i = 0; i < count; i++) {
        form->size[3][0][i] = box->coefficients[N * i];
        form->size[3][1][i] = box->coefficients[N * i + 3];
        form->known[3][i] = box->coefficients[N * i + 1];
    }
}

void ffd_cell_form_make(const fold_plan *plan, ffd_volume volume, const size_t index[3], bool rational,
                        double *memory, double *scratch, cell_form *form)
{
    const size_t count = ffd_bernstein_count(plan->order);
    double *points = scratch + ffd_bezier_size(plan->order), *weights = points + 3 * count;
    bezier_box box = {.rational = rational, .coefficients = scratch};
    double known[3], offset[3], rounding[N], coarse[N];
    const double *matrix[3];
    memcpy(box.order, plan->order, sizeof box.order);
    ffd_fold_cell_read(plan, volume, index, points, rational ? weights : NULL, matrix);
    if (rational)
        localise_weights(weights, count);
    const size_t origin = origin_of(rational ? weights : NULL, count);
    form->exponent = 0;
    for (int r = 0; r < 3; r++)
        form->exponent += localise(points, count, r, origin, &known[r], &offset[r]);
    fill_box(plan, points, rational ? weights : NULL, known, &box, rounding, coarse);
    ffd_bezier_extract(&box, matrix);

    form->rows = rational ? 4 : 3;
    for (int b = 0; b < form->rows; b++)
        for (int r = 0; r < form->rows; r++)
            form->row[b][r] = memory + (size_t)(form->rows * b + r) * count;
    for (int b = 0; b < 3; b++)
        derive(&box, b, form->rows, rounding, coarse, form);
    memset(form->hull_middle, 0, sizeof form->hull_middle);
    memset(form->hull_reach, 0, sizeof form->hull_reach);
    form->least_weight = form->greatest_weight = 1;
    if (rational) {
        copy_values(&box, rounding, coarse, form);
        measure_hull(&box, rounding, form);
        form->roundings = roundings_of(plan) + 4;
        bound_rows(points, weights, offset, matrix, &box, memory + 16 * count, form);
    }
}
