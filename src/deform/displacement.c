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

/* The basis is that of u,v,w taken to the domain; by_uvw may be NULL. */
static int displace(const ffd_lattice *lattice, const double uvw[3], lattice_basis *basis, double delta[3],
                    double *by_uvw)
{
    double inside[3];
    wrap(lattice, uvw, inside);
    ffd_lattice_basis(lattice, inside, basis);
    memset(delta, 0, 3 * sizeof *delta);
    if (by_uvw)
        memset(by_uvw, 0, 9 * sizeof *by_uvw);
    if (!is_reached(lattice, basis->span))
        return 0;
    sum_differences(lattice, basis, delta, by_uvw);
    return 1;
}

int ffd_displacement_by_uvw(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                            double by_uvw[9])
{
    lattice_basis basis;
    return displace(lattice, uvw, &basis, delta, by_uvw);
}

/* by_uvw times the inverse of the Jacobian; 0 where it has none. */
static void make_gradient(const double by_uvw[9], const double jacobian[9], double gradient[9])
{
    double inverse[9];
    if (mat_invert(jacobian, inverse))
        mat_multiply(by_uvw, inverse, gradient);
    else
        memset(gradient, 0, 9 * sizeof *gradient);
}

/* With weights: one point after the other. */
static int displace_rational(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                             double *gradient)
{
    lattice_basis basis;
    double by_uvw[9], point[3], jacobian[9];
    const int moved = displace(lattice, uvw, &basis, delta, gradient ? by_uvw : NULL);
    if (gradient && !moved)
        memset(gradient, 0, 9 * sizeof *gradient);
    if (!gradient || !moved)
        return moved;
    ffd_lattice_sum_rational(lattice, &basis, lattice->rest, lattice->rest_weights, point, jacobian);
    make_gradient(by_uvw, jacobian, gradient);
    return 1;
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

static displacement_kernel *kernel_of(ffd_isa isa)
{
    switch (isa == FFD_ISA_AUTO ? ffd_isa_best() : isa) {
#ifdef FFD_X86
    case FFD_ISA_SSE2:
        return ffd_kernel_sse2;
    case FFD_ISA_AVX2:
        return ffd_kernel_avx2;
    case FFD_ISA_AVX512:
        return ffd_kernel_avx512;
#endif
    default:
        return ffd_kernel_scalar;
    }
}

int ffd_displacement(const ffd_lattice *lattice, const double uvw[3], double delta[3], double gradient[9])
{
    static const uint32_t which[1] = {0};
    double inside[3], by_uvw[9], jacobian[9], difference[3 * CELL_POINTS], rest[3 * CELL_POINTS];
    size_t number[3];
    kernel_cell cell;
    if (lattice->rest_weights)
        return displace_rational(lattice, uvw, delta, gradient);
    wrap(lattice, uvw, inside);
    for (int a = 0; a < 3; a++)
        number[a] = ffd_knots_span_number(&lattice->knots[a], inside[a]);
    memset(delta, 0, 3 * sizeof *delta);
    if (gradient)
        memset(gradient, 0, 9 * sizeof *gradient);
    if (!load_cell(lattice, number, gradient, difference, rest, &cell))
        return 0;
    const bool constant = cell.inverse;
    const kernel_points points = {.uvw = inside,
                                  .stride = 3,
                                  .which = which,
                                  .count = 1,
                                  .delta = delta,
                                  .gradient = gradient ? constant ? gradient : by_uvw : NULL,
                                  .jacobian = gradient && !constant ? jacobian : NULL};
    ffd_kernel_scalar(&cell, &points);
    if (gradient && !constant)
        make_gradient(by_uvw, jacobian, gradient);
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
        double by_uvw[9], *const gradient = batch->gradient + 9 * which[k];
        batch->moves[which[k]] = 1;
        if (cell.rest) {
            memcpy(by_uvw, gradient, sizeof by_uvw);
            make_gradient(by_uvw, scratch->jacobian + 9 * which[k], gradient);
        }
    }
}

void ffd_displacements(const ffd_lattice *lattice, ffd_isa isa, const displacement_batch *batch,
                       displacement_scratch *scratch)
{
    if (lattice->rest_weights) {
        for (size_t k = 0; k < batch->count; k++) {
            const size_t n = batch->which[k];
            batch->moves[n] =
                (uint8_t)displace_rational(lattice, batch->uvw + n * batch->stride, batch->delta + 3 * n,
                                           batch->gradient ? batch->gradient + 9 * n : NULL);
        }
        return;
    }
    displacement_kernel *const kernel = kernel_of(isa);
    find_cells(lattice, batch, scratch);
    sort_points(batch, scratch);
    for (size_t c = 0; c < scratch->cell_count; c++)
        displace_cell(lattice, kernel, batch, &scratch->cells[c], scratch);
}
