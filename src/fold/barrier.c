/* barrier.c - ffd_folds_barrier: a smooth measure of folding, and its gradient by the control points
   (src/maths.md 10.7). */
#include <ffd/fold.h>

#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "fold/bernstein.h"
#include "lattice/lattice.h"
#include "spline/bezier.h"
#include "spline/knots.h"
#include <math.h>
#include <string.h>

/* Cells whose gradients are kept at a time; they are added to those of the control points in their order. */
#define ROUND ((size_t)4096)

/* What a volume is made of: with lengths near 1. */
typedef struct barrier_work {
    const ffd_lattice *lattice;
    const double *points;  /* of the volume: 3 for each control point */
    double scale;          /* of lengths */
    int order[3];          /* of Bezier points */
    int slope_order[3][3]; /* of the derivatives by u, v, w */
    int cross_order[3], det_order[3];
    double *extractions[3];      /* of all spans */
    const unsigned char *counts; /* of each cell; NULL: all count */
    double floor, mean;
    double **scratch;       /* of each worker */
    size_t first;           /* cell of the round */
    double *least, *values; /* of each cell of the round */
    double *gradients;      /* of the Bezier points of each; NULL: not wanted */
    double *volumes;        /* of each cell, in the units of the domain; NULL: not wanted */
    size_t points_of_cell;
} barrier_work;

/* Memory of a worker, as parts of one block: three components each. */
typedef struct barrier_scratch {
    double *bezier, *slopes[3], *cross, *det;
    double *of_bezier, *of_slopes[3], *of_cross; /* derivatives of the value by these */
    double *half;                                /* of applying the extraction */
} barrier_scratch;

static void find_orders(barrier_work *w)
{
    for (int a = 0; a < 3; a++) {
        const int degree = w->lattice->knots[a].degree;
        w->order[a] = degree + 1;
        for (int d = 0; d < 3; d++)
            w->slope_order[d][a] = degree + (d != a);
        w->cross_order[a] = 2 * degree + (a == 0);
        w->det_order[a] = 3 * degree;
    }
    w->points_of_cell = ffd_bernstein_count(w->order);
}

/* Divides a block into its parts. Returns how many numbers it needs. */
static size_t lay_out(const barrier_work *w, double *block, barrier_scratch *s)
{
    size_t used = 0;
    const size_t points = 3 * w->points_of_cell, cross = 3 * ffd_bernstein_count(w->cross_order);
    double **const parts[] = {&s->bezier, &s->of_bezier, &s->half, &s->cross, &s->of_cross, &s->det};
    const size_t sizes[] = {points, points, points, cross, cross, ffd_bernstein_count(w->det_order)};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        *parts[i] = block ? block + used : NULL;
        used += sizes[i];
    }
    for (int d = 0; d < 3; d++) {
        const size_t size = 3 * ffd_bernstein_count(w->slope_order[d]);
        s->slopes[d] = block ? block + used : NULL;
        s->of_slopes[d] = block ? block + used + size : NULL;
        used += 2 * size;
    }
    return used;
}

static size_t stride_of(const int order[3], int a)
{
    return a == 0 ? 1 : a == 1 ? (size_t)order[0] : (size_t)order[0] * (size_t)order[1];
}

/* Applies the matrix of a span, or its transposed, along direction a to three components. */
static void extract(const barrier_work *w, int a, const double *matrix, bool back, const double *from,
                    double *to)
{
    const size_t size = w->points_of_cell, stride = stride_of(w->order, a), order = (size_t)w->order[a];
    memset(to, 0, 3 * size * sizeof *to);
    for (size_t i = 0; i < 3 * size; i++) {
        const size_t at = i / stride % order, line = i - at * stride;
        for (size_t j = 0; j < order; j++)
            to[i] += (back ? matrix[order * j + at] : matrix[order * at + j]) * from[line + j * stride];
    }
}

/* The control point of index n of a cell, u fastest. */
static size_t point_of(const barrier_work *w, const int span[3], size_t n)
{
    const ffd_lattice *const lattice = w->lattice;
    size_t index[3];
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const size_t at = n / stride_of(w->order, a) % (size_t)w->order[a];
        index[a] = ffd_knots_point(knots, (size_t)(span[a] - knots->degree) + at);
    }
    return index[0] + lattice->size[0] * (index[1] + lattice->size[1] * index[2]);
}

static void find_spans(const barrier_work *w, size_t cell, int span[3], size_t number[3])
{
    const knot_vector *const knots = w->lattice->knots;
    number[0] = cell % knots[0].span_count;
    number[1] = cell / knots[0].span_count % knots[1].span_count;
    number[2] = cell / knots[0].span_count / knots[1].span_count;
    for (int a = 0; a < 3; a++)
        span[a] = knots[a].spans[number[a]];
}

static double width_of(const barrier_work *w, int a, const int span[3])
{
    const double *const t = w->lattice->knots[a].t;
    return t[span[a] + 1] - t[span[a]];
}

static const double *matrix_of(const barrier_work *w, int a, const size_t number[3])
{
    const size_t order = (size_t)w->order[a];
    return w->extractions[a] + order * order * number[a];
}

/* The Bezier points of a cell, seen from the first control point, one component after the other. */
static void find_bezier(const barrier_work *w, const int span[3], const size_t number[3], barrier_scratch *s)
{
    const size_t size = w->points_of_cell;
    const double *const origin = w->points + 3 * point_of(w, span, 0);
    for (size_t n = 0; n < size; n++)
        for (size_t c = 0; c < 3; c++)
            s->bezier[c * size + n] = (w->points[3 * point_of(w, span, n) + c] - origin[c]) * w->scale;
    for (int a = 0; a < 3; a++) {
        extract(w, a, matrix_of(w, a, number), false, s->bezier, s->half);
        memcpy(s->bezier, s->half, 3 * size * sizeof *s->bezier);
    }
}

/* The derivative by direction d, of weighted coefficients, by the width of the cell. */
static void find_slope(const barrier_work *w, int d, double factor, barrier_scratch *s)
{
    const int *const order = w->slope_order[d];
    const size_t size = ffd_bernstein_count(order), stride = stride_of(w->order, d);
    for (size_t c = 0; c < 3; c++) {
        double *const to = s->slopes[d] + c * size;
        const double *const from = s->bezier + c * w->points_of_cell;
        for (size_t i = 0; i < size; i++) {
            const size_t u = i % (size_t)order[0], v = i / (size_t)order[0] % (size_t)order[1],
                         t = i / (size_t)order[0] / (size_t)order[1];
            const size_t at = u + (size_t)w->order[0] * (v + (size_t)w->order[1] * t);
            to[i] = factor * (from[at + stride] - from[at]);
        }
        ffd_bernstein_weight(to, order, to);
    }
}

/* det J of a cell: its coefficients, in units of the scaled lengths and of the domain. */
static void find_determinant(const barrier_work *w, barrier_scratch *s)
{
    const size_t count[3] = {ffd_bernstein_count(w->slope_order[0]), ffd_bernstein_count(w->slope_order[1]),
                             ffd_bernstein_count(w->slope_order[2])};
    const size_t cross = ffd_bernstein_count(w->cross_order), det = ffd_bernstein_count(w->det_order);
    memset(s->cross, 0, 3 * cross * sizeof *s->cross);
    memset(s->det, 0, det * sizeof *s->det);
    for (size_t c = 0; c < 3; c++) {
        const size_t x = (c + 1) % 3, y = (c + 2) % 3;
        double *const to = s->cross + c * cross;
        ffd_bernstein_multiply(s->slopes[1] + x * count[1], w->slope_order[1], s->slopes[2] + y * count[2],
                               w->slope_order[2], 1, to);
        ffd_bernstein_multiply(s->slopes[1] + y * count[1], w->slope_order[1], s->slopes[2] + x * count[2],
                               w->slope_order[2], -1, to);
        ffd_bernstein_multiply(s->slopes[0] + c * count[0], w->slope_order[0], to, w->cross_order, 1, s->det);
    }
    ffd_bernstein_unweight(s->det, w->det_order, 1);
}

/* Replaces the coefficients by the derivative of the value by them. Returns the value; *least: the least one.
 */
static double judge(const barrier_work *w, barrier_scratch *s, double *least)
{
    const size_t count = ffd_bernstein_count(w->det_order);
    double value = 0;
    *least = HUGE_VAL;
    for (size_t k = 0; k < count; k++) {
        const double c = s->det[k] / w->mean, missing = w->floor - c;
        *least = c < *least ? c : *least;
        value += missing > 0 ? missing * missing : 0;
        s->det[k] = missing > 0 ? -2 * missing / w->mean : 0;
    }
    /* By weighted coefficients, as the products have them. */
    ffd_bernstein_unweight(s->det, w->det_order, 1);
    return value;
}

/* From the derivative by det J back to those by the derivatives of the volume. */
static void go_back(const barrier_work *w, barrier_scratch *s)
{
    size_t count[3];
    const size_t cross = ffd_bernstein_count(w->cross_order);
    memset(s->of_cross, 0, 3 * cross * sizeof *s->of_cross);
    for (int d = 0; d < 3; d++) {
        count[d] = ffd_bernstein_count(w->slope_order[d]);
        memset(s->of_slopes[d], 0, 3 * count[d] * sizeof **s->of_slopes);
    }
    for (size_t c = 0; c < 3; c++) {
        const size_t x = (c + 1) % 3, y = (c + 2) % 3;
        double *const by_cross = s->of_cross + c * cross;
        ffd_bernstein_multiply_back(s->det, w->slope_order[0], s->cross + c * cross, w->cross_order, 1,
                                    s->of_slopes[0] + c * count[0]);
        ffd_bernstein_multiply_back(s->det, w->cross_order, s->slopes[0] + c * count[0], w->slope_order[0], 1,
                                    by_cross);
        ffd_bernstein_multiply_back(by_cross, w->slope_order[1], s->slopes[2] + y * count[2],
                                    w->slope_order[2], 1, s->of_slopes[1] + x * count[1]);
        ffd_bernstein_multiply_back(by_cross, w->slope_order[1], s->slopes[2] + x * count[2],
                                    w->slope_order[2], -1, s->of_slopes[1] + y * count[1]);
        ffd_bernstein_multiply_back(by_cross, w->slope_order[2], s->slopes[1] + x * count[1],
                                    w->slope_order[1], 1, s->of_slopes[2] + y * count[2]);
        ffd_bernstein_multiply_back(by_cross, w->slope_order[2], s->slopes[1] + y * count[1],
                                    w->slope_order[1], -1, s->of_slopes[2] + x * count[2]);
    }
}

/* Adds what the derivative by direction d makes of the Bezier points. */
static void add_slope(const barrier_work *w, int d, double factor, barrier_scratch *s)
{
    const int *const order = w->slope_order[d];
    const size_t size = ffd_bernstein_count(order), stride = stride_of(w->order, d);
    for (size_t c = 0; c < 3; c++) {
        double *const from = s->of_slopes[d] + c * size, *const to = s->of_bezier + c * w->points_of_cell;
        ffd_bernstein_weight(from, order, from);
        for (size_t i = 0; i < size; i++) {
            const size_t u = i % (size_t)order[0], v = i / (size_t)order[0] % (size_t)order[1],
                         t = i / (size_t)order[0] / (size_t)order[1];
            const size_t at = u + (size_t)w->order[0] * (v + (size_t)w->order[1] * t);
            to[at + stride] += factor * from[i];
            to[at] -= factor * from[i];
        }
    }
}

/* The derivative by the control points of the cell. */
static void find_gradient(const barrier_work *w, const size_t number[3], const double factor[3],
                          barrier_scratch *s, double *gradient)
{
    const size_t size = 3 * w->points_of_cell;
    go_back(w, s);
    memset(s->of_bezier, 0, size * sizeof *s->of_bezier);
    for (int d = 0; d < 3; d++)
        add_slope(w, d, factor[d], s);
    for (int a = 2; a >= 0; a--) {
        extract(w, a, matrix_of(w, a, number), true, s->of_bezier, s->half);
        memcpy(s->of_bezier, s->half, size * sizeof *s->of_bezier);
    }
    for (size_t i = 0; i < size; i++)
        gradient[i] = s->of_bezier[i] * w->scale;
}

/* The mean of a polynomial is that of its coefficients. */
static double mean_of(const barrier_work *w, const barrier_scratch *s)
{
    const size_t count = ffd_bernstein_count(w->det_order);
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += s->det[k];
    return sum / (double)count;
}

static void do_cell(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    const barrier_work *const w = context;
    const size_t cell = w->first + begin, own = begin;
    barrier_scratch s;
    int span[3];
    size_t number[3];
    double factor[3], size = 1;
    (void)tile, (void)end;
    if (ffd_deadline_passed() || (w->counts && !w->counts[cell]))
        return;
    lay_out(w, w->scratch[worker], &s);
    find_spans(w, cell, span, number);
    find_bezier(w, span, number, &s);
    for (int d = 0; d < 3; d++) {
        const double width = width_of(w, d, span);
        factor[d] = w->lattice->knots[d].degree / width;
        size *= width;
        find_slope(w, d, factor[d], &s);
    }
    find_determinant(w, &s);
    if (w->volumes) {
        w->volumes[own] = size * mean_of(w, &s);
        return;
    }
    w->values[own] = judge(w, &s, &w->least[own]);
    if (w->gradients && w->values[own] > 0)
        find_gradient(w, number, factor, &s, w->gradients + 3 * w->points_of_cell * own);
}

static size_t cell_count(const ffd_lattice *lattice)
{
    return lattice->knots[0].span_count * lattice->knots[1].span_count * lattice->knots[2].span_count;
}

/* Adds the gradient of a cell to those of its control points. */
static void add_gradient(const barrier_work *w, size_t cell, const double *own, double *gradient)
{
    int span[3];
    size_t number[3];
    find_spans(w, cell, span, number);
    for (size_t n = 0; n < w->points_of_cell; n++)
        for (size_t c = 0; c < 3; c++)
            gradient[3 * point_of(w, span, n) + c] += own[c * w->points_of_cell + n];
}

/* Goes over all cells, a round after the other. */
static ffd_status go_over_cells(barrier_work *w, int threads, ffd_barrier *barrier, double *gradient,
                                double *volume, ffd_error *error)
{
    const size_t cells = cell_count(w->lattice);
    for (w->first = 0; w->first < cells; w->first += ROUND) {
        const size_t count = cells - w->first < ROUND ? cells - w->first : ROUND;
        for (size_t i = 0; i < count; i++) {
            w->least[i] = HUGE_VAL;
            w->values[i] = 0;
        }
        ffd_parallel_tiles(count, 1, threads, do_cell, w);
        TRY(ffd_deadline_check(error));
        for (size_t i = 0; i < count; i++) {
            if (volume) {
                *volume += w->volumes[i];
                continue;
            }
            barrier->least = w->least[i] < barrier->least ? w->least[i] : barrier->least;
            barrier->value += w->values[i];
            if (gradient && w->values[i] > 0)
                add_gradient(w, w->first + i, w->gradients + 3 * w->points_of_cell * i, gradient);
        }
    }
    return FFD_OK;
}

/* Marks the cells that hold places. */
static ffd_status mark_cells(const ffd_lattice *lattice, const double *uvw, size_t count,
                             unsigned char **marks, ffd_error *error)
{
    const knot_vector *const knots = lattice->knots;
    *marks = NULL;
    if (!uvw)
        return FFD_OK;
    *marks = ffd_alloc_zero(cell_count(lattice), 1);
    if (!*marks)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < count; i++) {
        size_t cell = 0;
        if (isnan(uvw[3 * i] + uvw[3 * i + 1] + uvw[3 * i + 2]))
            continue;
        for (size_t a = 3; a-- > 0;)
            cell = cell * knots[a].span_count +
                   ffd_knots_span_index(&knots[a], ffd_knots_wrap(&knots[a], uvw[3 * i + a]));
        (*marks)[cell] = 1;
    }
    return FFD_OK;
}

static ffd_status check(const ffd_lattice *lattice, const double *deformed, double floor,
                        const ffd_barrier *barrier, int threads, ffd_error *error)
{
    TRY(ffd_struct_check(sizeof *barrier, barrier, "ffd_barrier", error));
    TRY(ffd_threads_check(threads, error));
    if (!lattice->rest)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "the lattice has no control points yet: its box is that of a mesh");
    if (lattice->rest_weights)
        return ffd_fail(error, FFD_E_UNSUPPORTED, "the barrier is for lattices without weights");
    if (!isfinite(floor))
        return ffd_fail(error, FFD_E_ARGUMENT, "the floor %g is not finite", floor);
    for (size_t i = 0; deformed && i < 3 * lattice->count; i++)
        if (!isfinite(deformed[i]))
            return ffd_fail(error, FFD_E_ARGUMENT, "control point %zu is not finite", i / 3);
    return FFD_OK;
}

static bool allocate(barrier_work *w, int threads, bool gradients)
{
    barrier_scratch unused;
    const size_t needed = lay_out(w, NULL, &unused), cells = cell_count(w->lattice),
                 round = cells < ROUND ? cells : ROUND;
    bool made = true;
    w->scratch = ffd_alloc_zero((size_t)threads, sizeof *w->scratch);
    for (int t = 0; w->scratch && t < threads; t++) {
        w->scratch[t] = ffd_alloc(needed, sizeof **w->scratch);
        made = made && w->scratch[t];
    }
    for (int a = 0; a < 3; a++)
        w->extractions[a] = ffd_bezier_extractions(&w->lattice->knots[a]);
    w->least = ffd_alloc(round, sizeof *w->least);
    w->values = ffd_alloc(round, sizeof *w->values);
    w->volumes = ffd_alloc(round, sizeof *w->volumes);
    w->gradients = gradients ? ffd_alloc(round, 3 * w->points_of_cell * sizeof *w->gradients) : NULL;
    return made && w->scratch && w->extractions[0] && w->extractions[1] && w->extractions[2] && w->least &&
           w->values && w->volumes && (w->gradients || !gradients);
}

static void free_work(barrier_work *w, int threads)
{
    for (int t = 0; w->scratch && t < threads; t++)
        ffd_free(w->scratch[t]);
    for (int a = 0; a < 3; a++)
        ffd_free(w->extractions[a]);
    ffd_free(w->scratch);
    ffd_free(w->least);
    ffd_free(w->values);
    ffd_free(w->volumes);
    ffd_free(w->gradients);
}

/* The mean of det J_P over the domain, in scaled lengths. */
static ffd_status find_mean(barrier_work *w, int threads, ffd_error *error)
{
    double volume = 0, domain = 1;
    w->points = w->lattice->rest;
    TRY(go_over_cells(w, threads, NULL, NULL, &volume, error));
    for (int a = 0; a < 3; a++)
        domain *= ffd_knots_last(&w->lattice->knots[a]) - ffd_knots_first(&w->lattice->knots[a]);
    w->mean = volume / domain;
    return isfinite(w->mean) && w->mean != 0
               ? FFD_OK
               : ffd_fail(error, FFD_E_INVALID, "the rest volume of the lattice is %g", volume);
}

ffd_status ffd_folds_barrier(const ffd_lattice *lattice, const double *deformed, double floor,
                             const double *uvw, size_t count, int threads, ffd_barrier *callers,
                             double *gradient, ffd_error *error)
{
    barrier_work w = {.lattice = lattice, .floor = floor};
    ffd_barrier barrier = {.struct_size = sizeof barrier, .least = HUGE_VAL};
    unsigned char *marks = NULL;
    int exponent, used = 0;
    ffd_status status;
    TRY(check(lattice, deformed, floor, callers, threads, error));
    find_orders(&w);
    used = ffd_threads_for(threads, cell_count(lattice));
    frexp(lattice->diagonal, &exponent);
    w.scale = ldexp(1, -exponent);
    TRY_END(allocate(&w, used, gradient != NULL) ? FFD_OK : ffd_fail_memory(error));
    TRY_END(find_mean(&w, used, error));
    TRY_END(mark_cells(lattice, uvw, count, &marks, error));
    ffd_free(w.volumes);
    w.volumes = NULL;
    w.counts = marks;
    w.points = deformed ? deformed : lattice->deformed;
    if (gradient)
        memset(gradient, 0, 3 * lattice->count * sizeof *gradient);
    TRY_END(go_over_cells(&w, used, &barrier, gradient, NULL, error));
    ffd_struct_give(&barrier, sizeof barrier, callers, callers->struct_size);
end:
    free_work(&w, used);
    ffd_free(marks);
    return status;
}
