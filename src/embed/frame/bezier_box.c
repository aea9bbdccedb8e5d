#include "embed/frame/bezier_box.h"
#include "base/vector/vec.h"
#include <float.h>
#include <string.h>

enum { N = BEZIER_COMPONENTS };

size_t ffd_bezier_count(const int order[3])
{
    return (size_t)order[0] * (size_t)order[1] * (size_t)order[2];
}

size_t ffd_bezier_size(const int order[3])
{
    return N * ffd_bezier_count(order);
}

/* Multiplies every row of points in direction a by the extraction matrix of the span. */
static void extract_direction(bezier_box *box, const double *matrix, int a)
{
    const size_t inner = N * ffd_bezier_stride(box->order, a), size = ffd_bezier_size(box->order),
                 order = (size_t)box->order[a];
    double from[N * MAX_ORDER * MAX_ORDER * MAX_ORDER];
    memcpy(from, box->coefficients, size * sizeof *from);
    for (size_t slab = 0; slab < size; slab += order * inner)
        for (size_t r = 0; r < order; r++) {
            double *restrict const to = box->coefficients + slab + r * inner;
            for (size_t x = 0; x < inner; x++)
                to[x] = 0;
            for (size_t i = 0; i < order; i++)
                for (size_t x = 0; x < inner; x++)
                    to[x] += matrix[r * order + i] * from[slab + i * inner + x];
        }
}

void ffd_bezier_extract(bezier_box *box, const double *const matrix[3])
{
    for (int a = 0; a < 3; a++) {
        box->lo[a] = 0;
        box->hi[a] = 1;
        extract_direction(box, matrix[a], a);
    }
    if (!box->rational) /* the rows of the matrices sum to 1 except for rounding */
        for (size_t i = 0; i < ffd_bezier_count(box->order); i++)
            box->coefficients[N * i + 3] = 1;
}

void ffd_bezier_halve_lines(size_t order, size_t inner, double *restrict low, double *restrict high)
{
    for (size_t k = 0; k < order; k++) {
        memcpy(low + k * inner, high, inner * sizeof *low);
        for (size_t x = 0; x + inner < (order - k) * inner; x++)
            high[x] = 0.5 * high[x] + 0.5 * high[x + inner];
    }
}

void ffd_bezier_halve(const bezier_box *box, int a, bezier_box *lower, bezier_box *upper)
{
    const size_t inner = N * ffd_bezier_stride(box->order, a), size = ffd_bezier_size(box->order),
                 order = (size_t)box->order[a];
    if (upper->coefficients != box->coefficients)
        memcpy(upper->coefficients, box->coefficients, size * sizeof(double));
    for (size_t slab = 0; slab < size; slab += order * inner)
        ffd_bezier_halve_lines(order, inner, lower->coefficients + slab, upper->coefficients + slab);
    const double middle = 0.5 * (box->lo[a] + box->hi[a]), end = box->hi[a];
    for (int b = 0; b < 3; b++) {
        lower->order[b] = upper->order[b] = box->order[b];
        const double lo = box->lo[b], hi = box->hi[b];
        lower->lo[b] = upper->lo[b] = lo;
        lower->hi[b] = upper->hi[b] = hi;
    }
    lower->rational = upper->rational = box->rational;
    lower->hi[a] = middle;
    upper->lo[a] = middle;
    upper->hi[a] = end;
}

static const bounds empty_bounds = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};

bounds ffd_bezier_hull(const bezier_box *box)
{
    bounds hull = empty_bounds;
    const size_t size = ffd_bezier_size(box->order);
    for (size_t i = 0; i < size; i += N) {
        const double *c = box->coefficients + i;
        const double point[3] = {c[0] / c[3], c[1] / c[3], c[2] / c[3]};
        bounds_add(&hull, point);
    }
    return hull;
}

void ffd_bezier_weights(const bezier_box *box, double *least, double *greatest)
{
    *least = DBL_MAX;
    *greatest = 0;
    const size_t size = ffd_bezier_size(box->order);
    for (size_t i = 3; i < size; i += N) {
        const double h = box->coefficients[i];
        *least = h < *least ? h : *least;
        *greatest = h > *greatest ? h : *greatest;
    }
}

/* Computes F at a control point: A - p W. */
static void equation(const double *c, const double p[3], double f[3])
{
    for (int a = 0; a < 3; a++)
        f[a] = c[a] - p[a] * c[3];
}

bounds ffd_bezier_equation_hull(const bezier_box *box, const double p[3])
{
    bounds hull = empty_bounds;
    const size_t size = ffd_bezier_size(box->order);
    for (size_t i = 0; i < size; i += N) {
        double f[3];
        equation(box->coefficients + i, p, f);
        bounds_add(&hull, f);
    }
    return hull;
}

bounds ffd_bezier_image(const bezier_box *box, const double inverse[9], const double p[3])
{
    bounds hull = empty_bounds;
    const size_t size = ffd_bezier_size(box->order);
    for (size_t i = 0; i < size; i += N) {
        double f[3];
        equation(box->coefficients + i, p, f);
        mat_apply(inverse, f, f);
        bounds_add(&hull, f);
    }
    return hull;
}

/* Returns the length in space of the polygon through a row of control points. */
static double polygon_length(const double *first, size_t stride, int count)
{
    double length = 0;
    for (int i = 0; i + 1 < count; i++) {
        const double *c = first + (size_t)i * stride, *d = c + stride;
        const double step[3] = {d[0] / d[3] - c[0] / c[3], d[1] / d[3] - c[1] / c[3],
                                d[2] / d[3] - c[2] / c[3]};
        length += vec_length(step);
    }
    return length;
}

int ffd_bezier_widest(const bezier_box *box)
{
    int best = 0;
    double longest = -1;
    for (int a = 0; a < 3; a++) {
        const size_t inner = N * ffd_bezier_stride(box->order, a), size = ffd_bezier_size(box->order),
                     slab = inner * (size_t)box->order[a];
        for (size_t first = 0; first < size; first += slab)
            for (size_t line = first; line < first + inner; line += N) {
                const double length = polygon_length(box->coefficients + line, inner, box->order[a]);
                if (length > longest) {
                    longest = length;
                    best = a;
                }
            }
    }
    return best;
}
