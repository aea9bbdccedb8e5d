#include "fit/gram.h"
#include "base/memory/memory.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "spline/basis.h"
#include <math.h>

/* The nodes and weights of Gauss and Legendre's quadrature on [-1, 1], which is exact to degree 2 count - 1
   (Abramowitz & Stegun 25.4.29): Newton's method from the usual first guess. */
static void make_quadrature(int count, double *nodes, double *weights)
{
    for (int i = 0; i < count; i++) {
        double x, sine, slope = 1;
        ffd_sincos_degrees(180 * (i + 0.75) / (count + 0.5), &sine, &x);
        for (int turn = 0; turn < 20; turn++) {
            double value = x, before = 1;
            for (int k = 2; k <= count; k++) {
                const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
                before = value;
                value = next;
            }
            slope = count * (x * value - before) / (x * x - 1);
            x -= value / slope;
        }
        nodes[i] = x;
        weights[i] = 2 / ((1 - x * x) * slope * slope);
    }
}

/* Raises numbers of the functions of degree - 1 to those of the derivatives of the functions of `degree`
   (NURBS Book 2.7). in: `degree` numbers; out: one more. */
static void differentiate(const double *t, int span, int degree, const double *in, double *out)
{
    for (int j = 0; j <= degree; j++) {
        const int i = span - degree + j;
        out[j] = 0;
        if (j > 0)
            out[j] += degree * in[j - 1] / (t[i + degree] - t[i]);
        if (j < degree)
            out[j] -= degree * in[j] / (t[i + degree + 1] - t[i + 1]);
    }
}

/* Values, first and second derivatives of the functions of a span. */
static void find_functions(const knot_vector *knots, int span, double u, double functions[3][MAX_ORDER])
{
    const int degree = knots->degree;
    double lower[MAX_ORDER], slopes[MAX_ORDER];
    knot_vector less = *knots;
    ffd_basis_values(knots, span, u, functions[0]);
    less.degree = degree - 1;
    ffd_basis_values(&less, span, u, lower);
    differentiate(knots->t, span, degree, lower, functions[1]);
    for (int j = 0; j <= degree; j++)
        functions[2][j] = 0;
    if (degree < 2)
        return;
    less.degree = degree - 2;
    ffd_basis_values(&less, span, u, lower);
    differentiate(knots->t, span, degree - 1, lower, slopes);
    differentiate(knots->t, span, degree, slopes, functions[2]);
}

/* Adds the integrals over a span. scale: of each derivative. */
static void add_span(gram_matrix *gram, int span, const double *nodes, const double *weights,
                     const double scale[3])
{
    const knot_vector *const knots = gram->knots;
    const int degree = knots->degree;
    const double half = (knots->t[span + 1] - knots->t[span]) / 2;
    for (int node = 0; node <= degree; node++) {
        double functions[3][MAX_ORDER];
        find_functions(knots, span, knots->t[span] + half * (1 + nodes[node]), functions);
        for (int q = 0; q < 3; q++)
            for (int a = 0; a <= degree; a++)
                for (int b = 0; b <= degree; b++) {
                    const size_t i = ffd_knots_point(knots, (size_t)(span - degree + a));
                    const size_t at = (2 * (size_t)degree + 1) * i + (size_t)(degree + b - a);
                    gram->values[q][at] +=
                        scale[q] * half * weights[node] * functions[q][a] * functions[q][b];
                }
    }
}

/* length: of the direction. */
static ffd_status make_gram(const knot_vector *knots, double length, gram_matrix *gram, ffd_error *error)
{
    const size_t count = knots->points * (2 * (size_t)knots->degree + 1);
    const double stretch = length / (ffd_knots_last(knots) - ffd_knots_first(knots));
    double nodes[MAX_ORDER], weights[MAX_ORDER], scale[3];
    *gram = (gram_matrix){.knots = knots};
    for (int q = 0; q < 3; q++) {
        gram->values[q] = ffd_alloc_zero(count, sizeof *gram->values[q]);
        if (!gram->values[q])
            return ffd_fail_memory(error);
        scale[q] = q == 0 ? stretch : scale[q - 1] / (stretch * stretch);
    }
    make_quadrature(knots->degree + 1, nodes, weights);
    for (size_t s = 0; s < knots->span_count; s++)
        add_span(gram, knots->spans[s], nodes, weights, scale);
    return FFD_OK;
}

/* The mean length of the lines of control points along a direction at rest; closed ones return. */
static double mean_length(const ffd_lattice *lattice, int a)
{
    const size_t step = a == 0 ? 1 : a == 1 ? lattice->size[0] : lattice->size[0] * lattice->size[1];
    const size_t n = lattice->size[a], lines = lattice->count / n;
    const bool closed = ffd_knots_closed(&lattice->knots[a]);
    double sum = 0;
    for (size_t i = 0; i < lattice->count; i++) {
        const size_t place = i / step % n;
        const double *const p = lattice->rest + 3 * i;
        double along[3];
        if (place + 1 == n && !closed)
            continue;
        const double *const next = place + 1 < n ? p + 3 * step : p - 3 * step * (n - 1);
        for (int c = 0; c < 3; c++)
            along[c] = next[c] - p[c];
        sum += vec_length(along);
    }
    return sum / (double)lines;
}

void ffd_bending_free(fit_bending *bending)
{
    for (int a = 0; a < 3; a++)
        for (int q = 0; q < 3; q++)
            ffd_free(bending->grams[a].values[q]);
    *bending = (fit_bending){0};
}

/* Two control points, by the index of the first and an offset in each direction. */
typedef struct point_pair {
    size_t entry[3]; /* in the values of each direction */
    size_t first, second;
} point_pair;

/* The integral over the domain of the products of all derivatives of the order, each as often as it occurs.
 */
static double energy_of(const fit_bending *bending, const point_pair *pair)
{
    const double *g[3][3];
    for (int a = 0; a < 3; a++)
        for (int q = 0; q < 3; q++)
            g[a][q] = bending->grams[a].values[q] + pair->entry[a];
    if (bending->stretches)
        return *g[0][1] * *g[1][0] * *g[2][0] + *g[0][0] * *g[1][1] * *g[2][0] +
               *g[0][0] * *g[1][0] * *g[2][1];
    return *g[0][2] * *g[1][0] * *g[2][0] + *g[0][0] * *g[1][2] * *g[2][0] + *g[0][0] * *g[1][0] * *g[2][2] +
           2 * (*g[0][1] * *g[1][1] * *g[2][0] + *g[0][1] * *g[1][0] * *g[2][1] +
                *g[0][0] * *g[1][1] * *g[2][1]);
}

/* A callback for each pair of control points whose functions overlap, with its part of the energy. */
typedef void pair_visitor(void *context, const point_pair *pair, double energy);

/* Finds the control point at an offset from another one in a direction. Returns false if there is none. */
static bool step_to(const knot_vector *knots, size_t from, size_t entry, size_t *to)
{
    const size_t n = knots->points, degree = (size_t)knots->degree;
    const size_t ahead = from + entry + (degree / n + 1) * n - degree;
    if (ffd_knots_closed(knots)) {
        *to = ahead % n;
        return true;
    }
    *to = ahead - (degree / n + 1) * n; /* wraps round before the first */
    return *to < n;
}

/* Visits the pairs of a control point i. */
static void visit_point(const fit_bending *bending, const size_t i[3], pair_visitor *visit, void *context)
{
    const fit_unknowns *const unknowns = bending->unknowns;
    size_t width[3], offset[3], j[3];
    for (int a = 0; a < 3; a++)
        width[a] = 2 * (size_t)bending->grams[a].knots->degree + 1;
    for (offset[2] = 0; offset[2] < width[2]; offset[2]++)
        for (offset[1] = 0; offset[1] < width[1]; offset[1]++)
            for (offset[0] = 0; offset[0] < width[0]; offset[0]++) {
                point_pair pair = {.first = ffd_unknown_at(unknowns, i[0], i[1], i[2])};
                bool is_there = true;
                for (int a = 0; a < 3; a++) {
                    pair.entry[a] = width[a] * i[a] + offset[a];
                    is_there = is_there && step_to(bending->grams[a].knots, i[a], offset[a], &j[a]);
                }
                if (!is_there)
                    continue;
                pair.second = ffd_unknown_at(unknowns, j[0], j[1], j[2]);
                visit(context, &pair, energy_of(bending, &pair));
            }
}

static void visit_pairs(const fit_bending *bending, pair_visitor *visit, void *context)
{
    const size_t *const size = bending->unknowns->lattice->size;
    size_t i[3];
    for (i[2] = 0; i[2] < size[2]; i[2]++)
        for (i[1] = 0; i[1] < size[1]; i[1]++)
            for (i[0] = 0; i[0] < size[0]; i[0]++)
                visit_point(bending, i, visit, context);
}

static void add_to_trace(void *context, const point_pair *pair, double energy)
{
    double *const trace = context;
    *trace += pair->first == pair->second ? energy : 0;
}

void ffd_bending_lengths(const ffd_lattice *lattice, double lengths[3])
{
    for (int a = 0; a < 3; a++) {
        const double side[3] = {lattice->frame[a], lattice->frame[3 + a], lattice->frame[6 + a]};
        lengths[a] = lattice->form == REST_BOX_AFFINE ? vec_length(side) : mean_length(lattice, a);
    }
}

ffd_status ffd_bending_make(const fit_unknowns *unknowns, const double lengths[3], fit_bending *bending,
                            ffd_error *error)
{
    const ffd_lattice *const lattice = unknowns->lattice;
    *bending = (fit_bending){.unknowns = unknowns};
    for (int a = 0; a < 3; a++) {
        bending->stretches = bending->stretches || lattice->knots[a].degree == 1;
        TRY(make_gram(&lattice->knots[a], lengths[a], &bending->grams[a], error));
    }
    visit_pairs(bending, add_to_trace, &bending->trace);
    return FFD_OK;
}

/* Context of add_to_band and add_product. */
typedef struct pair_work {
    double factor;
    const band_matrix *band;
    const double *x;
    double *to;
} pair_work;

static void add_to_band(void *context, const point_pair *pair, double energy)
{
    const pair_work *const work = context;
    if (pair->second <= pair->first)
        *ffd_band_entry(work->band, pair->first, pair->second) += work->factor * energy;
}

void ffd_bending_add(const fit_bending *bending, double factor, const band_matrix *band)
{
    pair_work work = {.factor = factor, .band = band};
    visit_pairs(bending, add_to_band, &work);
}

static void add_product(void *context, const point_pair *pair, double energy)
{
    const pair_work *const work = context;
    for (size_t c = 0; c < 3; c++)
        work->to[3 * pair->first + c] += work->factor * energy * work->x[3 * pair->second + c];
}

void ffd_bending_apply(const fit_bending *bending, double factor, const double *x, double *to)
{
    pair_work work = {.factor = factor, .x = x, .to = to};
    visit_pairs(bending, add_product, &work);
}
