#include "embed/locator.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/cells/cell_locator.h"
#include "embed/direct/affine.h"
#include "embed/direct/affine_kernel.h"
#include "embed/direct/separable.h"
#include "embed/frame/box_tree.h"
#include "embed/locator_border.h"
#include "embed/near_border.h"
#include <math.h>

/* Finds the middle of the bounds of the control points, and their extent from it. */
static void find_origin(ffd_locator *locator)
{
    const ffd_lattice *lattice = locator->lattice;
    bounds box = {{lattice->rest[0], lattice->rest[1], lattice->rest[2]},
                  {lattice->rest[0], lattice->rest[1], lattice->rest[2]}};
    for (size_t i = 0; i < lattice->count; i++)
        bounds_add(&box, lattice->rest + 3 * i);
    for (int a = 0; a < 3; a++) {
        locator->origin[a] = 0.5 * box.lo[a] + 0.5 * box.hi[a];
        locator->extent[a] = maximum_number(box.hi[a] - locator->origin[a], locator->origin[a] - box.lo[a]);
    }
    locator->hull = box;
}

/* Copies the knot vectors of the lattice, shifted to start at 0 and scaled to end near 1. The spans are
   shared with the lattice. */
static bool shift_knots(ffd_locator *locator)
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &locator->lattice->knots[a];
        const size_t count = knots->functions + (size_t)knots->degree + 1;
        const double first = ffd_knots_first(knots);
        int exponent;
        frexp(ffd_knots_last(knots) - first, &exponent);
        locator->knot_first[a] = first;
        locator->knot_scale[a] = ldexp(1, exponent < -1000 ? 1000 : -exponent);
        locator->knots[a] = *knots;
        locator->knots[a].t = ffd_alloc(count, sizeof(double));
        if (!locator->knots[a].t)
            return false;
        for (size_t i = 0; i < count; i++)
            locator->knots[a].t[i] = (knots->t[i] - first) * locator->knot_scale[a];
    }
    return true;
}

ffd_status ffd_locator_create(const ffd_lattice *lattice, ffd_locator **locator, ffd_error *error)
{
    return ffd_locator_create_for(lattice, FFD_ISA_AUTO, locator, error);
}

ffd_status ffd_locator_create_for(const ffd_lattice *lattice, ffd_isa isa, ffd_locator **locator,
                                  ffd_error *error)
{
    *locator = NULL;
    if (!lattice->rest)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "the lattice has no control points yet: its box is that of a mesh");
    ffd_locator *made = ffd_alloc_zero(1, sizeof *made);
    if (!made)
        return ffd_fail_memory(error);
    made->lattice = lattice;
    made->isa = isa;
    made->border = ffd_locator_border_create();
    if (!made->border || !shift_knots(made)) {
        ffd_locator_destroy(&made);
        return ffd_fail_memory(error);
    }
    find_origin(made);
    bool separable = false;
    ffd_status status = FFD_OK;
    if (ffd_affine_detect(made)) {
        made->method = METHOD_AFFINE;
    } else {
        TRY_END(ffd_separable_detect(made, &separable, error));
        made->method = separable ? METHOD_SEPARABLE : METHOD_GENERAL;
        if (!separable)
            TRY_END(ffd_cells_create(made, error));
    }
end:
    if (status)
        ffd_locator_destroy(&made);
    *locator = made;
    return status;
}

void ffd_locator_destroy(ffd_locator **locator)
{
    if (!locator || !*locator)
        return;
    ffd_separable_free(*locator);
    ffd_cells_destroy(&(*locator)->cells);
    ffd_locator_border_destroy((*locator)->border);
    for (int a = 0; a < 3; a++)
        ffd_free((*locator)->knots[a].t);
    ffd_free(*locator);
    *locator = NULL;
}

const char *ffd_locator_get_method(const ffd_locator *locator)
{
    static const char *const names[] = {"affine", "separable", "general"};
    return names[locator->method];
}

static const ffd_location nowhere = {.uvw = {NAN, NAN, NAN}, .status = FFD_VERTEX_OUTSIDE};

/* Sets p = xyz - origin. Returns false if the verdict on the point is known already. */
static bool begin(const ffd_locator *locator, const double xyz[3], double p[3], ffd_location *location)
{
    *location = nowhere;
    for (int a = 0; a < 3; a++)
        p[a] = xyz[a] - locator->origin[a];
    if (!vec_is_finite(xyz))
        location->status = FFD_VERTEX_INVALID;
    return vec_is_finite(p); /* false: xyz is not finite, or the difference overflows */
}

#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = ffd_affine_kernel_##set,
static affine_kernel *const affine_kernels[] = {[FFD_ISA_SCALAR] = NULL, /* one by one */
                                                FOR_EACH_SIMD(ROW)};

/* Finds at most AFFINE_POINTS points of an affine rest map. */
static void find_some(const ffd_locator *locator, const double *xyz, size_t count, double *uvw,
                      double *residuals, uint8_t *found)
{
    affine_kernel *const kernel = affine_kernels[ffd_isa_resolve(locator->isa)];
    if (kernel)
        kernel(locator, xyz, count, uvw, residuals, found);
    else
        memset(found, 0, count);
}

static void find_affine(const ffd_locator *locator, const double *xyz, size_t count, ffd_location *locations)
{
    for (size_t first = 0; first < count; first += AFFINE_POINTS) {
        const size_t size = count - first < AFFINE_POINTS ? count - first : AFFINE_POINTS;
        ffd_location *const own = locations + first;
        double uvw[3 * AFFINE_POINTS], residuals[AFFINE_POINTS], p[3];
        uint8_t found[AFFINE_POINTS];
        find_some(locator, xyz + 3 * first, size, uvw, residuals, found);
        for (size_t i = 0; i < size; i++)
            if (found[i])
                own[i] = (ffd_location){.uvw = {uvw[3 * i], uvw[3 * i + 1], uvw[3 * i + 2]},
                                        .residual = residuals[i],
                                        .status = FFD_VERTEX_INSIDE};
            else if (begin(locator, xyz + 3 * (first + i), p, &own[i]))
                ffd_affine_find(locator, p, &own[i]);
    }
}

size_t ffd_locator_find_inside(const ffd_locator *locator, const double *xyz, size_t count, double *uvw,
                               uint8_t *found)
{
    if (locator->method != METHOD_AFFINE)
        return 0;
    double residuals[AFFINE_POINTS];
    for (size_t first = 0; first < count; first += AFFINE_POINTS)
        find_some(locator, xyz + 3 * first, count - first < AFFINE_POINTS ? count - first : AFFINE_POINTS,
                  uvw + 3 * first, residuals, found + first);
    return count;
}

static ffd_status find_general(const ffd_locator *locator, const double *xyz, size_t count,
                               ffd_location *locations, ffd_error *error)
{
    search_scratch *scratch = NULL;
    double *p = ffd_alloc(CELLS_AT_ONCE, 3 * sizeof *p);
    ffd_status status;
    TRY_END(p ? FFD_OK : ffd_fail_memory(error));
    for (size_t first = 0; first < count; first += CELLS_AT_ONCE) {
        const size_t size = count - first < CELLS_AT_ONCE ? count - first : CELLS_AT_ONCE;
        for (size_t i = 0; i < size; i++)
            if (!begin(locator, xyz + 3 * (first + i), p + 3 * i, &locations[first + i]))
                p[3 * i] = NAN;
        TRY_END(ffd_cells_find_many(locator, p, size, &scratch, locations + first, error));
    }
end:
    ffd_search_scratch_free(scratch);
    ffd_free(p);
    return status;
}

ffd_status ffd_locator_find(const ffd_locator *locator, const double *xyz, size_t count,
                            ffd_location *locations, ffd_error *error)
{
    if (locator->method == METHOD_GENERAL)
        return find_general(locator, xyz, count, locations, error);
    if (locator->method == METHOD_AFFINE)
        find_affine(locator, xyz, count, locations);
    for (size_t i = 0; i < count && locator->method == METHOD_SEPARABLE; i++) {
        double p[3];
        if (begin(locator, xyz + 3 * i, p, &locations[i]))
            ffd_separable_find(locator, p, &locations[i]);
    }
    return FFD_OK;
}

ffd_status ffd_locator_find_near(const ffd_locator *locator, const double *xyz, size_t count,
                                 const ffd_border_allowance *allowance, ffd_location *locations,
                                 ffd_error *error)
{
    TRY(ffd_locator_find(locator, xyz, count, locations, error));
    return allowance ? ffd_near_border_find(locator, xyz, count, allowance, locations, error) : FFD_OK;
}

/* A box that comes nearer to the border, as a part of the domain, is looked at point by point. */
#define ROOM 1e-6

bool ffd_locator_holds_box(const ffd_locator *locator, const double min[3], const double max[3])
{
    if (locator->method != METHOD_AFFINE)
        return false;
    for (int r = 0; r < 3; r++) {
        double middle = 0, reach = 0;
        for (int c = 0; c < 3; c++) {
            const double by = locator->affine.inverse[3 * r + c];
            middle += by * (min[c] + (max[c] - min[c]) / 2 - locator->origin[c]);
            reach += fabs(by) * (max[c] - min[c]) / 2;
        }
        if (!(middle - reach > ROOM && middle + reach < 1 - ROOM)) /* NaN counts as outside */
            return false;
    }
    return true;
}

bool ffd_locator_has_seam(const ffd_locator *locator, int direction)
{
    return locator->cells && ffd_cells_have_seam(locator->cells, direction);
}

bool ffd_locator_is_strained(const ffd_locator *locator)
{
    return locator->cells && ffd_cells_are_strained(locator->cells);
}
