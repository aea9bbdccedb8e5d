#include "author/difference.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "lattice/spec.h"
#include "spline/basis.h"
#include <math.h>
#include <string.h>

/* Places of a span and direction, as shares of it. */
static const double shares[] = {1.0 / 6, 0.5, 5.0 / 6};
#define SHARES (sizeof shares / sizeof *shares)

/* The numbers of a control point: h P, h, g Q, g; with weights of 1 where there are none. */
enum { REST = 0, REST_WEIGHT = 3, DEFORMED = 4, DEFORMED_WEIGHT = 7, WIDTH = 8 };

/* One of the two volumes, and what one thread has summed up of it. */
typedef struct volume_sums {
    const ffd_lattice *lattice;
    double *layer; /* WIDTH * size[0] * size[1] numbers: at one w */
    double *row;   /* WIDTH * size[0] numbers: at one v, w */
} volume_sums;

typedef struct comparison {
    const ffd_lattice *lattices[2];
    volume_sums *sums; /* 2 for each thread */
    double *largest;   /* one for each tile */
} comparison;

static double place_at(const knot_vector *knots, size_t index)
{
    const double *const t = knots->t + knots->spans[index / SHARES];
    return t[0] + shares[index % SHARES] * (t[1] - t[0]);
}

static size_t place_count(const knot_vector *knots)
{
    return SHARES * knots->span_count;
}

static void gather(const ffd_lattice *from, size_t i, double numbers[WIDTH])
{
    const double h = from->rest_weights ? from->rest_weights[i] : 1,
                 g = from->deformed_weights ? from->deformed_weights[i] : 1;
    const double *const offsets = from->rest ? from->difference : from->spec->deformed_offsets;
    for (size_t c = 0; c < 3; c++) {
        const double p = from->rest ? from->rest[3 * i + c] : 0;
        numbers[REST + c] = h * p;
        numbers[DEFORMED + c] = g * (p + (offsets ? offsets[3 * i + c] : 0));
    }
    numbers[REST_WEIGHT] = h;
    numbers[DEFORMED_WEIGHT] = g;
}

/* Sums up the layers of control points that act at w. */
static void sum_layers(volume_sums *sums, double w)
{
    const ffd_lattice *const from = sums->lattice;
    const knot_vector *const knots = &from->knots[2];
    const int span = ffd_knots_span(knots, w);
    const size_t plane = from->size[0] * from->size[1];
    double basis[MAX_ORDER];
    ffd_basis_values(knots, span, w, basis);
    memset(sums->layer, 0, WIDTH * plane * sizeof *sums->layer);
    for (int j = 0; j <= knots->degree; j++) {
        const size_t first = plane * ffd_knots_point(knots, (size_t)(span - knots->degree + j));
        for (size_t i = 0; i < plane; i++) {
            double numbers[WIDTH];
            gather(from, first + i, numbers);
            for (size_t c = 0; c < WIDTH; c++)
                sums->layer[WIDTH * i + c] += basis[j] * numbers[c];
        }
    }
}

/* Sums up the rows of that layer that act at v. */
static void sum_rows(volume_sums *sums, double v)
{
    const knot_vector *const knots = &sums->lattice->knots[1];
    const int span = ffd_knots_span(knots, v);
    const size_t length = WIDTH * sums->lattice->size[0];
    double basis[MAX_ORDER];
    ffd_basis_values(knots, span, v, basis);
    memset(sums->row, 0, length * sizeof *sums->row);
    for (int j = 0; j <= knots->degree; j++) {
        const double *const row =
            sums->layer + length * ffd_knots_point(knots, (size_t)(span - knots->degree + j));
        for (size_t i = 0; i < length; i++)
            sums->row[i] += basis[j] * row[i];
    }
}

/* C at rest and deformed. */
static void sum_points(const volume_sums *sums, double u, double places[6])
{
    const knot_vector *const knots = &sums->lattice->knots[0];
    const int span = ffd_knots_span(knots, u);
    double basis[MAX_ORDER], sum[WIDTH] = {0};
    ffd_basis_values(knots, span, u, basis);
    for (int j = 0; j <= knots->degree; j++) {
        const double *const numbers =
            sums->row + WIDTH * ffd_knots_point(knots, (size_t)(span - knots->degree + j));
        for (size_t c = 0; c < WIDTH; c++)
            sum[c] += basis[j] * numbers[c];
    }
    for (size_t c = 0; c < 3; c++) {
        places[c] = sum[REST + c] / sum[REST_WEIGHT];
        places[3 + c] = sum[DEFORMED + c] / sum[DEFORMED_WEIGHT];
    }
}

static double compare_row(const comparison *of, const volume_sums *sums)
{
    const knot_vector *const u = &of->lattices[1]->knots[0];
    double largest = 0;
    for (size_t i = 0; i < place_count(u); i++) {
        double places[2][6];
        for (int s = 0; s < 2; s++)
            sum_points(&sums[s], place_at(u, i), places[s]);
        for (int c = 0; c < 6; c++)
            largest = maximum_number(largest, fabs(places[0][c] - places[1][c]));
    }
    return largest;
}

static void compare_layers(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    const comparison *const of = context;
    volume_sums *const sums = of->sums + 2 * worker;
    const knot_vector *const v = &of->lattices[1]->knots[1], *const w = &of->lattices[1]->knots[2];
    double largest = 0;
    for (size_t k = begin; k < end; k++) {
        for (int s = 0; s < 2; s++)
            sum_layers(&sums[s], place_at(w, k));
        for (size_t j = 0; j < place_count(v); j++) {
            for (int s = 0; s < 2; s++)
                sum_rows(&sums[s], place_at(v, j));
            largest = maximum_number(largest, compare_row(of, sums));
        }
    }
    of->largest[tile] = largest;
}

static ffd_status allocate(comparison *of, int threads, ffd_error *error)
{
    for (int i = 0; i < 2 * threads; i++) {
        volume_sums *const sums = &of->sums[i];
        const size_t *const size = of->lattices[i % 2]->size;
        sums->lattice = of->lattices[i % 2];
        sums->layer = ffd_alloc(size[0] * size[1], WIDTH * sizeof *sums->layer);
        sums->row = ffd_alloc(size[0], WIDTH * sizeof *sums->row);
        if (!sums->layer || !sums->row)
            return ffd_fail_memory(error);
    }
    return FFD_OK;
}

uint64_t ffd_lattice_difference_bytes(const ffd_lattice *a, const ffd_lattice *b)
{
    const ffd_lattice *const both[] = {a, b};
    uint64_t numbers = 0;
    for (int s = 0; s < 2; s++)
        numbers += WIDTH * ((uint64_t)both[s]->size[0] * both[s]->size[1] + both[s]->size[0]);
    return numbers * sizeof(double);
}

ffd_status ffd_lattice_difference(const ffd_lattice *a, const ffd_lattice *b, int threads, double *largest,
                                  ffd_error *error)
{
    const size_t layers = place_count(&b->knots[2]);
    threads = ffd_threads_for(threads, layers);
    comparison of = {.lattices = {a, b},
                     .sums = ffd_alloc_zero((size_t)threads, 2 * sizeof *of.sums),
                     .largest = ffd_alloc_zero(layers, sizeof *of.largest)};
    ffd_status status;
    TRY_END(of.sums && of.largest ? FFD_OK : ffd_fail_memory(error));
    TRY_END(allocate(&of, threads, error));
    ffd_parallel_tiles(layers, 1, threads, compare_layers, &of);
    *largest = 0;
    for (size_t i = 0; i < layers; i++)
        *largest = maximum_number(*largest, of.largest[i]);
end:
    for (int i = 0; of.sums && i < 2 * threads; i++) {
        ffd_free(of.sums[i].layer);
        ffd_free(of.sums[i].row);
    }
    ffd_free(of.sums);
    ffd_free(of.largest);
    return status;
}
