/* displacement_batch.c - many points at once: those of each cell together. */
#include "deform/displacement.h"
#include "deform/displacement_cell.h"
#include <string.h>

#define NO_CELL UINT16_MAX

static displacement_kernel *const kernels[] = {
    [FFD_ISA_SCALAR] = ffd_kernel_scalar,
#ifdef FFD_X86
    [FFD_ISA_SSE2] = ffd_kernel_sse2,
    [FFD_ISA_AVX2] = ffd_kernel_avx2,
    [FFD_ISA_AVX512] = ffd_kernel_avx512,
#endif
};

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
        ffd_displacement_wrap(lattice, batch->uvw + n * batch->stride, uvw);
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
    if (!ffd_displacement_load(lattice, of->span, batch->gradient, scratch->difference, scratch->rest,
                               &cell)) {
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
            ffd_displacement_to_space(scratch->jacobian + 9 * which[k], batch->gradient + 9 * which[k]);
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
