#include "embed/acceptance.h"
#include "base/vector/vec.h"
#include "embed/frame/slabs.h"

/* The search computes C from Bezier forms about its own origin, other code from the lattice. Each is accurate
   to a few eps, so the tolerance is multiplied by this. */
#define EVALUATIONS 4
/* The error of the search for the nearest border point, relative to the size of the lattice. */
#define BORDER_GAP 1e-11

/* C at a stored u,v,w, and what its residual is judged by. */
typedef struct judged_place {
    double residual[3], jacobian[9];
    double tolerance[3], grain[3]; /* of p, and of u,v,w */
    double allowance[3];           /* at most, in each coordinate */
} judged_place;

static void evaluate_place(const ffd_locator *locator, const double xyz[3], const double uvw[3],
                           judged_place *at)
{
    const ffd_lattice *const lattice = locator->lattice;
    double point[3];
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, at->jacobian);
    ffd_world_tolerance(locator, xyz, at->tolerance);
    for (int a = 0; a < 3; a++) {
        /* u,v,w is rounded in the range of the knots, and its distance to the first knot is. */
        at->grain[a] = EVALUATIONS * DBL_EPSILON * (fabs(uvw[a]) + fabs(ffd_knots_first(&lattice->knots[a])));
        at->tolerance[a] *= EVALUATIONS;
        at->residual[a] = point[a] - xyz[a];
    }
    for (int r = 0; r < 3; r++) {
        at->allowance[r] = at->tolerance[r];
        for (int a = 0; a < 3; a++)
            at->allowance[r] += fabs(at->jacobian[3 * r + a]) * at->grain[a];
    }
}

static bool is_on_border(const ffd_lattice *lattice, const double uvw[3])
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        if (!ffd_knots_closed(knots) && (uvw[a] == ffd_knots_first(knots) || uvw[a] == ffd_knots_last(knots)))
            return true;
    }
    return false;
}

bool ffd_locator_accepts(const ffd_locator *locator, const double xyz[3], const ffd_location *location,
                         const double *rounding, double snap)
{
    judged_place at;
    double tolerance[3], reach[3], size = 0;
    bool is_widened = snap > 0;
    ffd_world_tolerance(locator, xyz, tolerance);
    if (location->residual <= lesser_of(tolerance[0], lesser_of(tolerance[1], tolerance[2])))
        return true;
    evaluate_place(locator, xyz, location->uvw, &at);
    if (ffd_residual_is_explained(at.residual, at.jacobian, at.tolerance, at.grain))
        return true;
    for (int a = 0; a < 3; a++) {
        is_widened = is_widened || (rounding && rounding[a] > 0);
        reach[a] = at.allowance[a] + (rounding && rounding[a] > 0 ? rounding[a] : 0);
        size = larger_of(size, locator->hull.hi[a] - locator->hull.lo[a]);
    }
    const double farthest = larger_of(vec_length(reach), snap + vec_length(at.allowance)) + BORDER_GAP * size;
    return is_widened && is_on_border(locator->lattice, location->uvw) && vec_length(at.residual) <= farthest;
}
