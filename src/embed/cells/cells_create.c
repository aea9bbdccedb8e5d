/* cells_create.c - builds the search structure of a rest lattice. */
#include "base/memory/memory.h"
#include "embed/cells/brick.h"
#include "embed/cells/cell_locator.h"
#include "embed/cells/cell_volume.h"
#include "embed/cells/collapse.h"
#include "lattice/border.h"
#include "spline/bezier.h"

enum { N = BEZIER_COMPONENTS };

/* Returns the power of two that scales size to [0.5, 1), as far as it is a double. */
static double scale_of(double size)
{
    int exponent;
    frexp(size, &exponent);
    return ldexp(1, exponent < -1000 ? 1000 : -exponent);
}

static void find_scale(const ffd_locator *locator, cell_search *cells)
{
    const double *extent = locator->extent;
    cells->scale = scale_of(maximum_number(extent[0], maximum_number(extent[1], extent[2])));
    for (int a = 0; a < 3; a++)
        cells->extent[a] = extent[a] * cells->scale;
    for (int a = 0; a < 3; a++)
        cells->size[a] = maximum_number(fabs(locator->hull.lo[a]), fabs(locator->hull.hi[a])) * cells->scale;
}

static ffd_status make_points(const ffd_locator *locator, cell_search *cells, ffd_error *error)
{
    const ffd_lattice *lattice = locator->lattice;
    double greatest = 0;
    cells->points = ffd_alloc(lattice->count, N * sizeof(double));
    if (!cells->points)
        return ffd_fail_memory(error);
    for (size_t i = 0; cells->rational && i < lattice->count; i++)
        greatest = maximum_number(greatest, lattice->rest_weights[i]);
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

/* A scheme has half a kilobyte; a direction with more spans does not store them. */
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

/* The kernels of an instruction set; region is NULL if points are to be searched one by one. */
typedef struct kernel_set {
    cell_kernel *cell;
    const contraction_kernel *contraction;
    region_kernel *region;
    size_t lanes; /* of the region kernel */
} kernel_set;

#define ROW(ISA, set, lanes)                                                                                 \
    [FFD_ISA_##ISA] = {ffd_cell_kernel_##set, &ffd_contraction_kernel_##set, ffd_region_kernel_##set, lanes},
static const kernel_set kernels[] = {
    [FFD_ISA_SCALAR] = {ffd_cell_kernel_scalar, &ffd_contraction_kernel_scalar, NULL, 0}, FOR_EACH_SIMD(ROW)};

static void choose_kernels(cell_search *cells, ffd_isa isa)
{
    const kernel_set *set = &kernels[ffd_isa_resolve(isa)];
    cells->kernel = set->cell;
    cells->contraction = set->contraction;
    cells->region_kernel = set->region;
    cells->lanes = set->lanes;
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
    TRY(make_points(locator, cells, error));
    TRY(make_extractions(locator, cells, error));
    TRY(make_schemes(locator, cells, error));
    TRY(ffd_cells_check_volume(locator, error));
    TRY(ffd_collapses_find(locator, &cells->collapses, error));
    return ffd_bricks_create(locator, error); /* ffd_locator_destroy frees what was made */
}

bool ffd_cells_have_seam(const cell_search *cells, int direction)
{
    return cells->is_seam[direction];
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
