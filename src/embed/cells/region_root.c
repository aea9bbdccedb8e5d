#include "embed/cells/region_root.h"
#include "base/vector/vec.h"
#include "embed/frame/slabs.h"
#include <float.h>
#include <string.h>

/* With weights: the share of the aim at which a root is accepted, for the same reason as TOLERANCE_SHARE. */
#define AIM_SHARE 0.5

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

/* Computes how far the rounding of u,v,w can move t. */
static void find_grain(const cell_region *region, const double t[3], double grain[3])
{
    for (int a = 0; a < 3; a++)
        grain[a] = DBL_EPSILON * (region->lo[a] / region->width[a] + t[a]);
}

void ffd_search_allowance(const point_search *search, const cell_region *region, const double t[3],
                          const sample *at, double allowance[3])
{
    double grain[3];
    find_grain(region, t, grain);
    for (int r = 0; r < 3; r++) {
        double jump = 0;
        for (int a = 0; a < 3; a++)
            jump += fabs(at->jacobian[3 * r + a]) * grain[a];
        allowance[r] = search->tolerance[r] + jump / at->weight;
    }
}

/* Returns whether a tolerance and the rounding of u,v,w, of both this share, explain the residual. */
static bool is_explained(const double tolerance[3], double share, const cell_region *region,
                         const double t[3], const sample *at)
{
    double allowed[3], grain[3];
    find_grain(region, t, grain);
    for (int a = 0; a < 3; a++) {
        allowed[a] = share * at->weight * tolerance[a];
        grain[a] *= share;
    }
    return ffd_residual_is_explained(at->equation, at->jacobian, allowed, grain);
}

bool ffd_search_accepts(const point_search *search, const cell_region *region, const double t[3],
                        const sample *at)
{
    return search->locator->cells->rational ? is_explained(search->aim, AIM_SHARE, region, t, at)
                                            : ffd_within_tolerance(at->residual, search->aim);
}

bool ffd_search_admits(const point_search *search, const cell_region *region, const double t[3],
                       const sample *at)
{
    return is_explained(search->tolerance, TOLERANCE_SHARE, region, t, at);
}

bool ffd_search_meets(const point_search *search, const cell_region *region, const double t[3],
                      const sample *at)
{
    return is_explained(search->tolerance, BORDER_SHARE, region, t, at);
}

/* Fills a root at t, whose sample is `at`. */
static void find_root(const point_search *search, const cell_region *region, const double t[3],
                      const sample *at, root *found)
{
    double offset[3];
    found->residual = vec_length(at->residual);
    found->singular = ffd_mat_is_singular(at->jacobian, &found->determinant);
    offset_of(region, t, offset);
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &search->locator->knots[a];
        found->uvw[a] = ffd_knots_wrap(knots, knots->t[region->span[a]] + offset[a]);
        found->width[a] = 4 * region->width[a] * at->weight;
        found->tolerance[a] = search->tolerance[a];
        found->spread[a] = 0;
    }
    memcpy(found->jacobian, at->jacobian, sizeof found->jacobian);
    found->has_spread = false;
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
    ffd_root_find_spread(stall);
    stall->singular = true;
}
