#include "embed/cells/region_root.h"
#include "base/vector/vec.h"
#include <float.h>

static void offset_of(const cell_region *region, const double t[3], double offset[3])
{
    for (int a = 0; a < 3; a++)
        offset[a] = region->lo[a] + t[a] * region->width[a];
}

void ffd_search_evaluate_in(point_search *search, const cell_region *region, const double t[3], sample *at)
{
    double offset[3];
    offset_of(region, t, offset);
    ffd_search_evaluate(search, region->span, offset, at);
    for (int i = 0; i < 9; i++)
        at->jacobian[i] *= region->width[i % 3];
}

void ffd_search_allowance(const point_search *search, const cell_region *region, const double t[3],
                          const sample *at, double allowance[3])
{
    for (int r = 0; r < 3; r++) {
        double jump = 0;
        for (int a = 0; a < 3; a++) {
            const double grain = DBL_EPSILON * (region->lo[a] / region->width[a] + t[a]);
            jump += fabs(at->jacobian[3 * r + a]) * grain;
        }
        allowance[r] = search->tolerance[r] * region->weight_ratio + jump / at->weight;
    }
}

bool ffd_search_admits(const point_search *search, const cell_region *region, const double t[3],
                       const sample *at)
{
    double allowance[3];
    ffd_search_allowance(search, region, t, at, allowance);
    return ffd_within_tolerance(at->residual, allowance);
}

/* Fills a root at t, whose sample is `at`. */
static void find_root(const point_search *search, const cell_region *region, const double t[3],
                      const sample *at, root *found)
{
    double inverse[9], offset[3];
    *found = (root){.residual = vec_length(at->residual)};
    found->singular = ffd_mat_is_singular(at->jacobian, &found->determinant);
    offset_of(region, t, offset);
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &search->locator->knots[a];
        found->uvw[a] = ffd_knots_wrap(knots, knots->t[region->span[a]] + offset[a]);
    }
    if (mat_invert(at->jacobian, inverse))
        for (int a = 0; a < 3; a++) {
            const double *row = inverse + 3 * a;
            found->spread[a] = 4 * region->width[a] * at->weight * region->weight_ratio *
                               (fabs(row[0]) * search->tolerance[0] + fabs(row[1]) * search->tolerance[1] +
                                fabs(row[2]) * search->tolerance[2]);
        }
}

void ffd_search_record(point_search *search, const cell_region *region, const double t[3], const sample *at,
                       bool singular)
{
    root found;
    find_root(search, region, t, at, &found);
    found.singular = found.singular || singular;
    ffd_roots_add(search->locator, &search->roots, &found);
}

void ffd_search_stall(point_search *search, const cell_region *region, const double t[3], const sample *at,
                      root *stall)
{
    find_root(search, region, t, at, stall);
    stall->singular = true;
}
