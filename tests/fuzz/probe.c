/* probe.c - measures a lattice, and chooses the points that it is tried with. */
#include "probe.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Of the greatest weight to the least; NULL: all are 1. */
static double ratio_of(const double *weights, size_t count, double *greatest)
{
    double least = *greatest = weights ? weights[0] : 1;
    for (size_t i = 1; weights && i < count; i++) {
        least = fmin(least, weights[i]);
        *greatest = fmax(*greatest, weights[i]);
    }
    return *greatest / least;
}

static void measure_points(probe *made)
{
    const ffd_lattice *const lattice = made->lattice;
    for (int a = 0; a < 3; a++) {
        double lo = lattice->rest[a], hi = lo;
        for (size_t i = 1; i < lattice->count; i++) {
            lo = fmin(lo, lattice->rest[3 * i + (size_t)a]);
            hi = fmax(hi, lattice->rest[3 * i + (size_t)a]);
        }
        made->centre[a] = 0.5 * lo + 0.5 * hi;
        made->extent[a] = fmax(hi - made->centre[a], made->centre[a] - lo);
        made->magnitude[a] = fmax(fabs(lo), fabs(hi));
    }
    double greatest;
    made->weight_ratio = ratio_of(lattice->rest_weights, lattice->count, &greatest);
}

/* Weights that are far apart, or whose multiples leave the range of doubles, are beyond reason. */
static bool weights_are_ordinary(const ffd_lattice *lattice)
{
    double rest, deformed;
    return ratio_of(lattice->rest_weights, lattice->count, &rest) < 1e9 && rest < 1e280 &&
           ratio_of(lattice->deformed_weights, lattice->count, &deformed) < 1e9 && deformed < 1e280;
}

static double greatest_deformed(const ffd_lattice *lattice)
{
    double greatest = 0;
    for (size_t i = 0; i < 3 * lattice->count; i++)
        greatest = fmax(greatest, fabs(lattice->deformed[i]));
    return greatest;
}

static double narrowest_span(const knot_vector *knots)
{
    double width = HUGE_VAL;
    for (size_t s = 0; s < knots->span_count; s++)
        width = fmin(width, knots->t[knots->spans[s] + 1] - knots->t[knots->spans[s]]);
    return width;
}

void probe_measure(const ffd_lattice *lattice, probe *made)
{
    *made = (probe){.lattice = lattice, .is_resolved = true};
    ffd_lattice_get_domain(lattice, made->lo, made->hi);
    measure_points(made);
    made->is_ordinary = weights_are_ordinary(lattice) && greatest_deformed(lattice) < 1e280;
    for (int a = 0; a < 3; a++) {
        made->u_error[a] = 4 * DBL_EPSILON * fmax(fabs(made->lo[a]), fabs(made->hi[a])) + DBL_TRUE_MIN;
        made->is_resolved = made->is_resolved && narrowest_span(&lattice->knots[a]) > 64 * made->u_error[a];
        made->is_ordinary = made->is_ordinary && made->extent[a] > 1e-280 && made->magnitude[a] < 1e280;
    }
}

void probe_uvw(const probe *of, const double fraction[3], double uvw[3])
{
    for (int a = 0; a < 3; a++) {
        const double u = of->lo[a] + fraction[a] * (of->hi[a] - of->lo[a]);
        uvw[a] = fraction[a] == 1 ? of->hi[a] : fmin(fmax(u, of->lo[a]), of->hi[a]);
    }
}

/* Whether no span that reaches into u +- error is narrower than that. */
static bool spans_are_wide(const knot_vector *knots, double u, double error)
{
    for (size_t s = 0; s < knots->span_count; s++) {
        const double start = knots->t[knots->spans[s]], end = knots->t[knots->spans[s] + 1];
        if (end >= u - error && start <= u + error && end - start < 2 * error)
            return false;
    }
    return true;
}

bool probe_error(const probe *of, ffd_volume volume, const double uvw[3], const precise_sample *sample,
                 double error[3])
{
    const ffd_lattice *const lattice = of->lattice;
    long double sway[9];
    int orders = 0;
    memcpy(sway, sample->sway, sizeof sway);
    for (int a = 0; a < 3; a++) {
        orders += lattice->knots[a].degree + 1;
        if (!spans_are_wide(&lattice->knots[a], uvw[a], of->u_error[a]))
            return false;
    }
    for (int side = -1; side <= 1; side += 2) {
        double near[3];
        precise_sample there;
        for (int a = 0; a < 3; a++)
            near[a] = ffd_knots_wrap(&lattice->knots[a], uvw[a] + side * of->u_error[a]);
        precise_evaluate(lattice, volume, near, of->centre, &there);
        for (int i = 0; i < 9; i++)
            sway[i] = fmaxl(sway[i], there.sway[i]);
    }
    for (int r = 0; r < 3; r++) {
        long double sum = 2 * orders * (long double)DBL_EPSILON * (of->extent[r] + fabsl(sample->point[r]));
        for (int a = 0; a < 3; a++)
            sum += sway[3 * r + a] * of->u_error[a];
        error[r] = (double)sum + DBL_TRUE_MIN * 64;
    }
    return true;
}

static void add_point(probe_point *points, size_t *count, const double p[3])
{
    if (*count == PROBE_MOST)
        return;
    points[*count] = (probe_point){.is_known = false};
    memcpy(points[(*count)++].p, p, 3 * sizeof *p);
}

/* The point at uvw, rounded once. */
static void add_known(const probe *of, probe_point *points, size_t *count, const double uvw[3])
{
    precise_sample sample;
    if (*count == PROBE_MOST)
        return;
    probe_point *const point = &points[(*count)++];
    precise_evaluate(of->lattice, FFD_VOLUME_REST, uvw, of->centre, &sample);
    point->is_known = true;
    memcpy(point->uvw, uvw, sizeof point->uvw);
    for (int r = 0; r < 3; r++)
        point->p[r] = (double)(of->centre[r] + sample.point[r]);
}

static void add_tail(const probe *of, const unsigned char *tail, size_t size, probe_point *points,
                     size_t *count)
{
    for (size_t at = 0; at + 24 <= size && *count < PROBE_MOST - 32; at += 24) {
        double p[3], uvw[3];
        memcpy(p, tail + at, sizeof p);
        add_point(points, count, p);
        bool is_fraction = true;
        for (int a = 0; a < 3; a++)
            is_fraction = is_fraction && p[a] >= 0 && p[a] <= 1;
        if (is_fraction) {
            probe_uvw(of, p, uvw);
            add_known(of, points, count, uvw);
        }
    }
}

static void add_fixed(const probe *of, probe_point *points, size_t *count)
{
    static const double places[][3] = {{0, 0, 0},    {1, 1, 1},    {-1, 1, -1},     {0.3, -0.2, 0.1},
                                       {2, 0, 0},    {0, -1e6, 1}, {1e12, 1, -1e9}, {0, 0, 1.0000000001},
                                       {1, 0, 1e-9}, {NAN, 0, 0},  {0, INFINITY, 0}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        double p[3];
        for (int a = 0; a < 3; a++)
            p[a] = of->centre[a] + places[i][a] * of->extent[a];
        add_point(points, count, p);
    }
    add_point(points, count, (const double[3]){DBL_MAX, -DBL_MAX, DBL_TRUE_MIN});
}

size_t probe_points(const probe *of, const unsigned char *tail, size_t size, probe_point points[PROBE_MOST])
{
    static const double fractions[][3] = {{0.5, 0.5, 0.5}, {0, 0, 0},          {1, 1, 1},
                                          {1, 0, 1},       {0.1, 0.2, 0.9},    {0, 0.4, 0.6},
                                          {0.3, 1, 0.2},   {0.77, 0.31, 0.05}, {0.9, 0.8, 0},
                                          {0, 1, 0.35},    {0.99, 1e-9, 0.7},  {0.25, 0.75, 0.5}};
    size_t count = 0;
    double uvw[3];
    add_tail(of, tail, size, points, &count);
    if (count == 0)
        add_fixed(of, points, &count);
    for (size_t i = 0; i < sizeof fractions / sizeof *fractions; i++) {
        probe_uvw(of, fractions[i], uvw);
        add_known(of, points, &count, uvw);
    }
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &of->lattice->knots[a];
        uvw[a] = knots->t[knots->spans[knots->span_count / 2]];
    }
    add_known(of, points, &count, uvw);
    return count;
}
