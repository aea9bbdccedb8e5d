#include "deform/displacement.h"
#include "base/vec.h"
#include <string.h>

#define NO_CELL UINT16_MAX

/* Whether a moved control point acts in the cell whose last knot intervals are span. */
static bool is_reached(const ffd_lattice *lattice, const int span[3])
{
    size_t first[3];
    for (int a = 0; a < 3; a++)
        first[a] = (size_t)(span[a] - lattice->knots[a].degree);
    for (int k = 0; k <= lattice->knots[2].degree; k++) {
        const size_t plane = lattice->size[1] * ffd_knots_point(&lattice->knots[2], first[2] + (size_t)k);
        for (int j = 0; j <= lattice->knots[1].degree; j++) {
            const size_t row =
                lattice->size[0] * (plane + ffd_knots_point(&lattice->knots[1], first[1] + (size_t)j));
            for (int i = 0; i <= lattice->knots[0].degree; i++)
                if (lattice->moved[row + ffd_knots_point(&lattice->knots[0], first[0] + (size_t)i)])
                    return true;
        }
    }
    return false;
}

/* Delta form (maths.md 7): sum (Q - P) R, so that an inversion's residual enters only through the
   displacement's gradient and a translation is exact to rounding. by_uvw may be NULL. */
static void sum_differences(const ffd_lattice *lattice, const lattice_basis *basis, double delta[3],
                            double *by_uvw)
{
    if (!lattice->weights_moved) {
        ffd_lattice_sum_rational(lattice, basis, lattice->difference, lattice->rest_weights, delta, by_uvw);
        return;
    }
    double rest[3], rest_by[9];
    ffd_lattice_sum_rational(lattice, basis, lattice->rest, lattice->rest_weights, rest,
                             by_uvw ? rest_by : NULL);
    ffd_lattice_sum_rational(lattice, basis, lattice->deformed, lattice->deformed_weights, delta, by_uvw);
    for (int r = 0; r < 3; r++)
        delta[r] -= rest[r];
    for (int i = 0; by_uvw && i < 9; i++)
        by_uvw[i] -= rest_by[i];
}

static void wrap(const ffd_lattice *lattice, const double uvw[3], double inside[3])
{
    for (int a = 0; a < 3; a++)
        inside[a] = ffd_knots_wrap(&lattice->knots[a], uvw[a]);
}

/* From derivatives by u,v,w to those by the point: times the Jacobian's inverse; 0 where it has none. */
static void bring_to_space(const double jacobian[9], double gradient[9])
{
    double inverse[9], by_uvw[9];
    memcpy(by_uvw, gradient, sizeof by_uvw);
    if (mat_invert(jacobian, inverse))
        mat_multiply(by_uvw, inverse, gradient);
    else
        memset(gradient, 0, 9 * sizeof *gradient);
}

/* The displacement of one point; by_uvw and jacobian are both there or both NULL. Returns whether a moved
   control point acts on it; else nothing is written. */
static bool displace_rational(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                              double *by_uvw, double *jacobian)
{
    lattice_basis basis;
    double inside[3], point[3];
    wrap(lattice, uvw, inside);
    ffd_lattice_basis(lattice, inside, &basis);
    if (!is_reached(lattice, basis.span))
        return false;
    sum_differences(lattice, &basis, delta, by_uvw);
    if (jacobian)
        ffd_lattice_sum_rational(lattice, &basis, lattice->rest, lattice->rest_weights, point, jacobian);
    return true;
}

/* Fills the cell and the buffers that it points to. Returns whether a moved control point acts in it. */
static bool load_cell(const ffd_lattice *lattice, const size_t number[3], bool gradients, double *difference,
                      double *rest, kernel_cell *cell)
{
    int span[3];
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const size_t order = (size_t)knots->degree + 1;
        span[a] = knots->spans[number[a]];
        cell->degree[a] = knots->degree;
        cell->first[a] = knots->t[span[a]];
        cell->width[a] = knots->t[span[a] + 1] - knots->t[span[a]];
        cell->extraction[a] = knots->extractions + number[a] * order * order;
    }
    if (!is_reached(lattice, span))
        return false;
    ffd_lattice_cell_points(lattice, lattice->difference, span, difference);
    cell->difference = difference;
    cell->inverse = lattice->has_uvw_by_p ? lattice->uvw_by_p : NULL;
    cell->rest = NULL;
    if (gradients && !cell->inverse) {
        ffd_lattice_cell_points(lattice, lattice->rest, span, rest);
        cell->rest = rest;
    }
    return true;
}

static displacement_kernel *const kernels[] = {
    [FFD_ISA_SCALAR] = ffd_kernel_scalar,
#ifdef FFD_X86
    [FFD_ISA_SSE2] = ffd_kernel_sse2,
    [FFD_ISA_AVX2] = ffd_kernel_avx2,
    [FFD_ISA_AVX512] = ffd_kernel_avx512,
#endif
};

/* As displace_rational. Where the lattice knows d uvw / d p, by_uvw is the gradient and jacobian NULL. */
static bool displace(const ffd_lattice *lattice, const double uvw[3], bool inverse, double delta[3],
                     double *by_uvw, double *jacobian)
{
    static const uint32_t which[1] = {0};
    double inside[3], difference[3 * CELL_POINTS], rest[3 * CELL_POINTS];
    size_t number[3];
    kernel_cell cell;
    if (lattice->rest_weights)
        return displace_rational(lattice, uvw, delta, by_uvw, jacobian);
    wrap(lattice, uvw, inside);
    for (int a = 0; a < 3; a++)
        number[a] = ffd_knots_span_number(&lattice->knots[a], inside[a]);
    if (!load_cell(lattice, number, jacobian, difference, rest, &cell))
        return false;
    cell.inverse = inverse ? cell.inverse : NULL;
    const kernel_points points = {.uvw = inside,
                                  .stride = 3,
                                  .which = which,
                                  .count = 1,
                                  .delta = delta,
                                  .gradient = by_uvw,
                                  .jacobian = jacobian};
    ffd_kernel_scalar(&cell, &points);
    return true;
}

int ffd_displacement_by_uvw(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                            double by_uvw[9])
{
    memset(delta, 0, 3 * sizeof *delta);
    if (by_uvw)
        memset(by_uvw, 0, 9 * sizeof *by_uvw);
    return displace(lattice, uvw, false, delta, by_uvw, NULL);
}

int ffd_displacement(const ffd_lattice *lattice, const double uvw[3], double delta[3], double gradient[9])
{
    const bool general = gradient && !lattice->has_uvw_by_p;
    double jacobian[9];
    memset(delta, 0, 3 * sizeof *delta);
    if (gradient)
        memset(gradient, 0, 9 * sizeof *gradient);
    if (!displace(lattice, uvw, true, delta, gradient, general ? jacobian : NULL))
        return 0;
    if (general)
        bring_to_space(jacobian, gradient);
    return 1;
}

/* The span that holds u, most often the one of the point before. */
static size_t find_span(const knot_vector *knots, double u, size_t guess)
{
    const double *const t = knots->t + knots->spans[guess];
    return t[0] <= u && u < t[1] ? guess : ffd_knots_span_number(knots, u);
}

/* The batch's cell with these spans, made where it is new. */
static size_t take_cell(const size_t span[3], size_t key, displacement_scratch *scratch)
{
    size_t bucket = (key * 0x9e3779b97f4a7c15u >> 20) % (2 * DISPLACEMENT_BATCH);
    while (scratch->buckets[bucket] != NO_CELL) {
        const size_t found = scratch->buckets[bucket];
        if (scratch->cells[found].key == key)
            return found;
        bucket = (bucket + 1) % (2 * DISPLACEMENT_BATCH);
    }
    const size_t made = scratch->cell_count++;
    scratch->buckets[bucket] = (uint16_t)made;
    scratch->cells[made] = (batch_cell){.span = {span[0], span[1], span[2]}, .key = key};
    return made;
}

/* Finds the cell of each wanted point. */
static void find_cells(const ffd_lattice *lattice, const displacement_batch *batch,
                       displacement_scratch *scratch)
{
    const knot_vector *const knots = lattice->knots;
    size_t span[3] = {0, 0, 0}, cell = NO_CELL;
    scratch->cell_count = 0;
    memset(scratch->buckets, 0xff, sizeof scratch->buckets);
    for (size_t k = 0; k < batch->count; k++) {
        const size_t n = batch->which[k];
        double *const uvw = scratch->uvw + 3 * n;
        size_t here[3];
        wrap(lattice, batch->uvw + n * batch->stride, uvw);
        for (int a = 0; a < 3; a++)
            here[a] = find_span(&knots[a], uvw[a], span[a]);
        if (cell == NO_CELL || memcmp(here, span, sizeof here) != 0) {
            const size_t key = (here[2] * knots[1].span_count + here[1]) * knots[0].span_count + here[0];
            cell = take_cell(here, key, scratch);
            memcpy(span, here, sizeof here);
        }
        scratch->cell_of[k] = (uint16_t)cell;
        scratch->cells[cell].count++;
    }
}

/* Brings the points of each cell together, in their order. */
static void sort_points(const displacement_batch *batch, displacement_scratch *scratch)
{
    uint32_t first = 0;
    for (size_t c = 0; c < scratch->cell_count; c++) {
        scratch->cells[c].first = first;
        first += scratch->cells[c].count;
        scratch->cells[c].count = 0;
    }
    for (size_t k = 0; k < batch->count; k++) {
        batch_cell *const cell = &scratch->cells[scratch->cell_of[k]];
        scratch->sorted[cell->first + cell->count++] = batch->which[k];
    }
}

static void stay(const displacement_batch *batch, size_t n)
{
    memset(batch->delta + 3 * n, 0, 3 * sizeof *batch->delta);
    if (batch->gradient)
        memset(batch->gradient + 9 * n, 0, 9 * sizeof *batch->gradient);
    batch->moves[n] = 0;
}

static void displace_cell(const ffd_lattice *lattice, displacement_kernel *kernel,
                          const displacement_batch *batch, const batch_cell *of,
                          displacement_scratch *scratch)
{
    const uint32_t *const which = scratch->sorted + of->first;
    kernel_cell cell;
    if (!load_cell(lattice, of->span, batch->gradient, scratch->difference, scratch->rest, &cell)) {
        for (size_t k = 0; k < of->count; k++)
            stay(batch, which[k]);
        return;
    }
    const kernel_points points = {.uvw = scratch->uvw,
                                  .stride = 3,
                                  .which = which,
                                  .count = of->count,
                                  .delta = batch->delta,
                                  .gradient = batch->gradient,
                                  .jacobian = cell.rest ? scratch->jacobian : NULL};
    kernel(&cell, &points);
    for (size_t k = 0; k < of->count; k++) {
        batch->moves[which[k]] = 1;
        if (cell.rest)
            bring_to_space(scratch->jacobian + 9 * which[k], batch->gradient + 9 * which[k]);
    }
}

void ffd_displacements(const ffd_lattice *lattice, ffd_isa isa, const displacement_batch *batch,
                       displacement_scratch *scratch)
{
    if (lattice->rest_weights) {
        for (size_t k = 0; k < batch->count; k++) {
            const size_t n = batch->which[k];
            batch->moves[n] =
                (uint8_t)ffd_displacement(lattice, batch->uvw + n * batch->stride, batch->delta + 3 * n,
                                          batch->gradient ? batch->gradient + 9 * n : NULL);
        }
        return;
    }
    displacement_kernel *const kernel = kernels[ffd_isa_resolve(isa)];
    find_cells(lattice, batch, scratch);
    sort_points(batch, scratch);
    for (size_t c = 0; c < scratch->cell_count; c++)
        displace_cell(lattice, kernel, batch, &scratch->cells[c], scratch);
}
