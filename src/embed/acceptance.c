#include "embed/acceptance.h"
#include "base/vector/vec.h"

/* The search computes C from Bezier forms about its own origin, other code from the lattice. Each is accurate
   to a few eps, so the tolerance is multiplied by this. */
#define EVALUATIONS 4
/* The error of the search for the nearest border point, relative to the size of the lattice. */
#define BORDER_GAP 1e-11

/* Returns the ratio of the greatest and the least weight that act at u,v,w, by which the tolerance of a
   rational volume is multiplied. */
static double weight_ratio(const ffd_lattice *lattice, const double uvw[3])
{
    double weights[MAX_ORDER * MAX_ORDER * MAX_ORDER], least = HUGE_VAL, most = 0;
    int span[3];
    size_t count = 1;
    if (!lattice->rest_weights)
        return 1;
    for (int a = 0; a < 3; a++) {
        span[a] = ffd_knots_span(&lattice->knots[a], uvw[a]);
        count *= (size_t)lattice->knots[a].degree + 1;
    }
    ffd_lattice_cell_weights(lattice, lattice->rest_weights, span, weights);
    for (size_t i = 0; i < count; i++) {
        least = lesser_of(least, weights[i]);
        most = larger_of(most, weights[i]);
    }
    return most / least;
}

/* Computes the allowed and the actual residual in each coordinate. */
static void find_allowance(const ffd_locator *locator, const double xyz[3], const double uvw[3],
                           double allowance[3], double residual[3])
{
    const ffd_lattice *const lattice = locator->lattice;
    const double ratio = weight_ratio(lattice, uvw);
    double point[3], jacobian[9], tolerance[3];
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, jacobian);
    ffd_world_tolerance(locator, xyz, tolerance);
    for (int r = 0; r < 3; r++) {
        double jump = 0; /* from the rounding of u,v,w in the range of the knots, and of its distance to the
                            first knot */
        for (int a = 0; a < 3; a++) {
            const double first = fabs(ffd_knots_first(&lattice->knots[a]));
            jump += fabs(jacobian[3 * r + a]) * DBL_EPSILON * (fabs(uvw[a]) + first);
        }
        allowance[r] = EVALUATIONS * (tolerance[r] * ratio + jump);
        residual[r] = point[r] - xyz[r];
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
    double allowance[3], residual[3], reach[3], size = 0;
    bool is_widened = snap > 0;
    ffd_world_tolerance(locator, xyz, allowance);
    if (location->residual <= lesser_of(allowance[0], lesser_of(allowance[1], allowance[2])))
        return true;
    find_allowance(locator, xyz, location->uvw, allowance, residual);
    if (ffd_within_tolerance(residual, allowance))
        return true;
    for (int a = 0; a < 3; a++) {
        is_widened = is_widened || (rounding && rounding[a] > 0);
        reach[a] = allowance[a] + (rounding && rounding[a] > 0 ? rounding[a] : 0);
        size = larger_of(size, locator->hull.hi[a] - locator->hull.lo[a]);
    }
    const double farthest = larger_of(vec_length(reach), snap + vec_length(allowance)) + BORDER_GAP * size;
    return is_widened && is_on_border(locator->lattice, location->uvw) && vec_length(residual) <= farthest;
}
