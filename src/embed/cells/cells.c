#include "embed/cells/cells.h"
#include "base/memory/memory.h"
#include "lattice/border.h"
#include "spline/basis.h"
#include <string.h>

enum { N = BEZIER_COMPONENTS };

/* The power of two that brings size into [0.5, 1), as far as doubles allow. */
static double scale_of(double size)
{
    int exponent;
    frexp(size, &exponent);
    return ldexp(1, exponent < -1000 ? 1000 : -exponent);
}

static void find_scale(const ffd_locator *locator, cell_search *cells)
{
    const double *extent = locator->extent;
    cells->scale = scale_of(fmax(extent[0], fmax(extent[1], extent[2])));
    for (int a = 0; a < 3; a++)
        cells->extent[a] = extent[a] * cells->scale;
}

static ffd_status make_points(const ffd_locator *locator, cell_search *cells, ffd_error *error)
{
    const ffd_lattice *lattice = locator->lattice;
    double greatest = 0;
    cells->points = ffd_alloc(lattice->count, N * sizeof(double));
    if (!cells->points)
        return ffd_fail_memory(error);
    for (size_t i = 0; cells->rational && i < lattice->count; i++)
        greatest = fmax(greatest, lattice->rest_weights[i]);
    const double weight_scale = cells->rational ? scale_of(greatest) : 1;
    for (size_t i = 0; i < lattice->count; i++) {
        const double h = cells->rational ? lattice->rest_weights[i] * weight_scale : 1;
        double *point = cells->points + N * i;
        for (size_t a = 0; a < 3; a++)
            point[a] = h * ((lattice->rest[3 * i + a] - locator->origin[a]) * cells->scale);
        point[3] = h;
    }
    return FFD_OK;
}

static ffd_status make_extractions(const ffd_locator *locator, cell_search *cells, ffd_error *error)
{
    for (int a = 0; a < 3; a++) {
        cells->extraction[a] = ffd_bezier_extractions(&locator->knots[a]);
        if (!cells->extraction[a])
            return ffd_fail_memory(error);
    }
    return FFD_OK;
}

/* Half a kilobyte each, so that a direction of millions of spans goes without. */
#define MOST_SCHEMES ((size_t)4096)

static ffd_status make_schemes(const ffd_locator *locator, cell_search *cells, ffd_error *error)
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &locator->knots[a];
        const size_t intervals = knots->functions + (size_t)knots->degree;
        if (intervals > MOST_SCHEMES)
            continue;
        cells->schemes[a] = ffd_alloc(intervals, sizeof *cells->schemes[a]);
        if (!cells->schemes[a])
            return ffd_fail_memory(error);
        for (size_t i = 0; i < knots->span_count; i++)
            ffd_basis_scheme(knots, knots->spans[i], &cells->schemes[a][knots->spans[i]]);
    }
    return FFD_OK;
}

const span_scheme *ffd_cells_scheme(const ffd_locator *locator, int a, int span, span_scheme *own)
{
    if (locator->cells->schemes[a])
        return &locator->cells->schemes[a][span];
    ffd_basis_scheme(&locator->knots[a], span, own);
    return own;
}

const double *ffd_cells_point(const ffd_locator *locator, const size_t function[3])
{
    const ffd_lattice *lattice = locator->lattice;
    const size_t i = ffd_knots_point(&lattice->knots[0], function[0]);
    const size_t j = ffd_knots_point(&lattice->knots[1], function[1]);
    const size_t k = ffd_knots_point(&lattice->knots[2], function[2]);
    return locator->cells->points + N * (i + lattice->size[0] * (j + lattice->size[1] * k));
}

void ffd_cell_spans(const ffd_lattice *lattice, const size_t cell[3], int span[3])
{
    for (int a = 0; a < 3; a++)
        span[a] = lattice->knots[a].spans[cell[a]];
}

void ffd_cell_bezier(const ffd_locator *locator, const size_t cell[3], bezier_box *box)
{
    const cell_search *cells = locator->cells;
    int span[3];
    ffd_cell_spans(locator->lattice, cell, span);
    double *to = box->coefficients;
    size_t function[3];
    for (int k = 0; k < cells->order[2]; k++)
        for (int j = 0; j < cells->order[1]; j++)
            for (int i = 0; i < cells->order[0]; i++, to += N) {
                function[0] = (size_t)(span[0] - cells->order[0] + 1 + i);
                function[1] = (size_t)(span[1] - cells->order[1] + 1 + j);
                function[2] = (size_t)(span[2] - cells->order[2] + 1 + k);
                memcpy(to, ffd_cells_point(locator, function), N * sizeof(double));
            }
    const double *matrix[3];
    for (int a = 0; a < 3; a++) {
        box->order[a] = cells->order[a];
        matrix[a] = cells->extraction[a] + cell[a] * (size_t)cells->order[a] * (size_t)cells->order[a];
    }
    box->rational = cells->rational;
    ffd_bezier_extract(box, matrix);
}

void ffd_cell_region(const ffd_locator *locator, const int span[3], const bezier_box *box,
                     const contraction_bound *contraction, cell_region *result)
{
    double least;
    for (int a = 0; a < 3; a++) {
        const double *t = locator->knots[a].t;
        const double side = t[span[a] + 1] - t[span[a]];
        result->span[a] = span[a];
        result->lo[a] = box->lo[a] * side;
        result->width[a] = (box->hi[a] - box->lo[a]) * side;
    }
    memcpy(result->inverse, contraction->inverse, sizeof result->inverse);
    result->bound = contraction->bound;
    ffd_bezier_weights(box, &least, &result->greatest_weight);
    result->weight_ratio = result->greatest_weight / least;
}

void ffd_cells_rows(const ffd_locator *locator, const int span[3], cell_rows rows, double own[CELL_NUMBERS])
{
    const int *const order = locator->cells->order;
    size_t first[3], function[3];
    for (int a = 0; a < 3; a++)
        first[a] = (size_t)(span[a] - order[a] + 1);
    const bool turns = first[0] + (size_t)order[0] > locator->lattice->size[0];
    for (int k = 0; k < order[2]; k++)
        for (int j = 0; j < order[1]; j++) {
            function[0] = first[0];
            function[1] = first[1] + (size_t)j;
            function[2] = first[2] + (size_t)k;
            rows[k][j] = turns ? own : ffd_cells_point(locator, function);
            for (int i = 0; i < order[0] && turns; i++, own += N) {
                function[0] = first[0] + (size_t)i;
                memcpy(own, ffd_cells_point(locator, function), N * sizeof *own);
            }
        }
}

void ffd_cells_evaluate(const ffd_locator *locator, const int span[3], const double offset[3],
                        homogeneous *result)
{
    const cell_search *cells = locator->cells;
    cell_basis basis;
    cell_rows rows;
    double own[CELL_NUMBERS];
    for (int a = 0; a < 3; a++) {
        span_scheme made;
        const span_scheme *const scheme = ffd_cells_scheme(locator, a, span[a], &made);
        ffd_basis_derivatives_by(scheme, offset[a], basis.value[a], basis.slope[a]);
    }
    ffd_cells_rows(locator, span, rows, own);
    cells->kernel(&basis, cells->order, (const cell_rows *)&rows, result);
    if (!cells->rational) {
        result->value[3] = 1;
        for (int a = 0; a < 3; a++)
            result->derivative[a][3] = 0;
    }
}

/* Those of an instruction set; region is NULL where points are searched one by one. */
typedef struct kernel_set {
    cell_kernel *cell;
    const contraction_kernel *contraction;
    region_kernel *region;
    size_t lanes; /* of region */
} kernel_set;

static const kernel_set kernels[] = {
    [FFD_ISA_SCALAR] = {ffd_cell_kernel_scalar, &ffd_contraction_kernel_scalar, NULL, 0},
#ifdef FFD_X86
    [FFD_ISA_SSE2] = {ffd_cell_kernel_sse2, &ffd_contraction_kernel_sse2, ffd_region_kernel_sse2, 2},
    [FFD_ISA_AVX2] = {ffd_cell_kernel_avx2, &ffd_contraction_kernel_avx2, ffd_region_kernel_avx2, 4},
    [FFD_ISA_AVX512] = {ffd_cell_kernel_avx512, &ffd_contraction_kernel_avx512, ffd_region_kernel_avx512, 8},
#endif
};

static void choose_kernels(cell_search *cells, ffd_isa isa)
{
    const kernel_set *set = &kernels[ffd_isa_resolve(isa)];
    cells->kernel = set->cell;
    cells->contraction = set->contraction;
    cells->region_kernel = set->region;
    cells->lanes = set->lanes;
}

void ffd_cells_centre(const ffd_locator *locator, cell_region *region)
{
    homogeneous at;
    double offset[3];
    for (int a = 0; a < 3; a++)
        offset[a] = region->lo[a] + 0.5 * region->width[a];
    ffd_cells_evaluate(locator, region->span, offset, &at);
    memcpy(region->centre, at.value, sizeof region->centre);
}

ffd_status ffd_cells_create(ffd_locator *locator, ffd_error *error)
{
    const ffd_lattice *lattice = locator->lattice;
    cell_search *cells = ffd_alloc_zero(1, sizeof *cells);
    if (!cells)
        return ffd_fail_memory(error);
    locator->cells = cells;
    choose_kernels(cells, locator->isa);
    cells->rational = lattice->rest_weights != NULL;
    for (int a = 0; a < 3; a++) {
        cells->order[a] = lattice->knots[a].degree + 1;
        cells->cells[a] = lattice->knots[a].span_count;
    }
    for (int a = 0; a < 3; a++)
        cells->is_seam[a] = ffd_lattice_is_seam(lattice, a);
    find_scale(locator, cells);
    ffd_status status = make_points(locator, cells, error);
    if (!status)
        status = make_extractions(locator, cells, error);
    if (!status)
        status = make_schemes(locator, cells, error);
    if (!status)
        status = ffd_cells_look_at_volume(locator, error);
    if (!status)
        status = ffd_collapses_find(locator, &cells->collapses, error);
    if (!status)
        status = ffd_bricks_create(locator, error);
    return status; /* the locator's destroy frees what there is */
}

void ffd_cells_destroy(cell_search **cells_pointer)
{
    cell_search *cells = *cells_pointer;
    if (!cells)
        return;
    ffd_bricks_free(cells);
    ffd_collapses_free(&cells->collapses);
    for (int a = 0; a < 3; a++)
        ffd_free(cells->extraction[a]);
    for (int a = 0; a < 3; a++)
        ffd_free(cells->schemes[a]);
    ffd_free(cells->points);
    ffd_free(cells);
    *cells_pointer = NULL;
}
