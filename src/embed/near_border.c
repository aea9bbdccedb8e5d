#include "embed/near_border.h"
#include "base/vector/vec.h"
#include "embed/locator_border.h"
#include <string.h>

/* The search of the border may miss a border point that is nearer by this fraction of the lattice size. */
#define BORDER_GAP 4e-12
/* A rounding below this fraction of the tolerance is ignored; that of doubles in a file is 1/32 of it. */
#define NEGLIGIBLE (1.0 / 16)
/* NOISE: the search of the border computes C with an error below this fraction of the tolerance. GRAZING: the
   relative gap of its proofs. */
#define NOISE (1.0 / 4)
#define GRAZING 1e-6

/* The allowed distance of a point to the border. */
typedef struct border_reach {
    double each[3]; /* in each coordinate: tolerance plus rounding; 0 without rounding */
    double cell[3]; /* the same plus the error of the search of the border; 0 without rounding */
    double snap;
    double distance; /* upper bound of the distance of border points that are within the reach */
} border_reach;

/* Computes the reach. Returns false if the point has no allowance beyond its tolerance. */
static bool find_reach(const ffd_locator *locator, const double p[3], const double *rounding, double snap,
                       border_reach *reach)
{
    double tolerance[3];
    bool counts = false;
    ffd_world_tolerance(locator, p, tolerance);
    memset(reach, 0, sizeof *reach);
    for (int a = 0; a < 3; a++)
        counts = counts || (rounding && rounding[a] > NEGLIGIBLE * tolerance[a]);
    for (int a = 0; a < 3 && counts; a++) {
        reach->each[a] = tolerance[a] + (rounding[a] > 0 ? rounding[a] : 0);
        reach->cell[a] = reach->each[a] * (1 + GRAZING) + NOISE * tolerance[a];
    }
    reach->snap = snap > 0 ? snap : 0;
    reach->distance = larger_of(vec_length(reach->each), reach->snap);
    return reach->distance > 0 && isfinite(reach->distance);
}

static bool is_near_hull(const ffd_locator *locator, const double p[3], const border_reach *reach)
{
    const double slack[3] = {reach->distance, reach->distance, reach->distance};
    return bounds_hold(&locator->hull, p, slack);
}

static double length_of_domain(const ffd_locator *locator, int a)
{
    const knot_vector *knots = &locator->lattice->knots[a];
    return ffd_knots_last(knots) - ffd_knots_first(knots);
}

/* A border point as a point of the volume. */
typedef struct border_place {
    double uvw[3], residual[3], jacobian[9]; /* C - p, and J by fractions of the domain */
} border_place;

static void evaluate(const ffd_locator *locator, const double p[3], const double uvw[3], border_place *place)
{
    double point[3];
    memcpy(place->uvw, uvw, sizeof place->uvw);
    ffd_lattice_evaluate(locator->lattice, FFD_VOLUME_REST, uvw, point, place->jacobian);
    for (int r = 0; r < 3; r++)
        place->residual[r] = point[r] - p[r];
    for (int i = 0; i < 9; i++)
        place->jacobian[i] *= length_of_domain(locator, i % 3);
}

static void take(const border_place *place, ffd_location *location)
{
    double determinant;
    const bool singular = ffd_mat_is_singular(place->jacobian, &determinant);
    location->status = singular || location->unresolved ? FFD_VERTEX_SINGULAR : FFD_VERTEX_INSIDE;
    location->residual = vec_length(place->residual);
    memcpy(location->uvw, place->uvw, sizeof place->uvw);
}

/* Decides whether the border is within the reach of p. place: the nearest border point, if any. If it is
   within the reach, that decides. Otherwise, if the reach differs among coordinates, another border point may
   be within it, even if it is far away along the border. */
static ffd_status find_verdict(const boundary *border, const double p[3], const border_reach *reach,
                               const boundary_point *nearest, const border_place *place,
                               boundary_verdict *verdict, ffd_error *error)
{
    ffd_status status = FFD_OK;
    *verdict = BOUNDARY_MISSES;
    if (nearest->found &&
        (nearest->distance <= reach->snap || ffd_within_tolerance(place->residual, reach->each)))
        *verdict = BOUNDARY_MEETS;
    else if (reach->each[0] > 0 && (nearest->found || nearest->cut_short))
        status = ffd_boundary_meets(border, p, reach->cell, verdict, error);
    if ((*verdict == BOUNDARY_MEETS && !nearest->found) ||
        (*verdict == BOUNDARY_MISSES && nearest->cut_short && reach->snap > 0))
        *verdict = BOUNDARY_UNDECIDED;
    return status;
}

static ffd_status retry(const ffd_locator *locator, const double p[3], const border_reach *reach,
                        ffd_location *location, ffd_error *error)
{
    const boundary *border;
    boundary_point nearest;
    boundary_verdict verdict;
    border_place place;
    TRY(ffd_locator_border(locator, &border, error));
    double size = 0;
    for (int a = 0; a < 3; a++)
        size = larger_of(size, locator->hull.hi[a] - locator->hull.lo[a]);
    TRY(ffd_boundary_find(border, p, reach->distance + BORDER_GAP * size, &nearest, error));
    if (nearest.found)
        evaluate(locator, p, nearest.uvw, &place);
    ffd_status status = find_verdict(border, p, reach, &nearest, &place, &verdict, error);
    if (verdict == BOUNDARY_MEETS) {
        take(&place, location);
    } else if (verdict == BOUNDARY_UNDECIDED) {
        location->status = FFD_VERTEX_SINGULAR;
        location->unresolved = true;
    }
    return status;
}

ffd_status ffd_near_border_find(const ffd_locator *locator, const double *xyz, size_t count,
                                const ffd_border_allowance *allowance, ffd_location *locations,
                                ffd_error *error)
{
    if (!allowance->rounding && !(allowance->snap > 0))
        return FFD_OK;
    for (size_t i = 0; i < count; i++) {
        const double *const p = xyz + 3 * i, *const rounding = allowance->rounding;
        border_reach reach;
        if (!isnan(locations[i].uvw[0]) || !vec_is_finite(p) ||
            !find_reach(locator, p, rounding ? rounding + 3 * i : NULL, allowance->snap, &reach) ||
            !is_near_hull(locator, p, &reach))
            continue;
        TRY(retry(locator, p, &reach, &locations[i], error));
    }
    return FFD_OK;
}

/* A cheap test: returns whether a point may be inside with its rounding cell and snap, both doubled to allow
   for the rounding of this test. */
static bool is_near(const bounds *hull, const double x[3], const double half[3], double snap)
{
    double slack[3];
    for (int a = 0; a < 3; a++)
        slack[a] =
            2 * (half[a] + snap) + 64 * DBL_EPSILON * (fabs(x[a]) + fabs(hull->lo[a]) + fabs(hull->hi[a]));
    return bounds_hold(hull, x, slack);
}

ffd_status ffd_near_border_retry(const ffd_locator *locator, const double x[3], const double half[3],
                                 double snap, ffd_location *location, ffd_error *error)
{
    const ffd_border_allowance allowance = {.rounding = half, .snap = snap};
    if (!is_near(&locator->hull, x, half, snap))
        return FFD_OK;
    return ffd_near_border_find(locator, x, 1, &allowance, location, error);
}

ffd_status ffd_near_border_miss(const ffd_locator *locator, const double p[3], double reach, double *miss,
                                bool *searched, ffd_error *error)
{
    static const double none[3];
    const boundary *border;
    boundary_point nearest;
    *miss = HUGE_VAL;
    *searched = false;
    if (!vec_is_finite(p) || !is_near(&locator->hull, p, none, reach))
        return FFD_OK;
    *searched = locator->method != METHOD_AFFINE;
    TRY(ffd_locator_border(locator, &border, error));
    TRY(ffd_boundary_find(border, p, reach, &nearest, error));
    if (nearest.found)
        *miss = nearest.distance;
    return FFD_OK;
}
