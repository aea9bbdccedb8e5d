/* leaf.c - finds the only root of a region by its contraction (src/maths.md 6.4). */
#include "embed/cells/leaf.h"
#include "base/vector/vec.h"
#include "embed/cells/leaf_exit.h"
#include "embed/cells/region_root.h"
#include "embed/frame/face.h"
#include <float.h>
#include <string.h>

/* Newton steps in a leaf; each at least halves the certified radius, and 2^-64 is below any rounding. */
#define LEAF_STEPS 64

/* Values that are not finite prove nothing. */
static bool is_beyond(const double v[3], double limit)
{
    const double size = vec_greatest(v);
    return size > limit && size <= DBL_MAX;
}

/* Makes the first step, -Y F from the centre, where F is known. Returns false if the region has no root. */
static bool leave_centre(const point_search *search, const cell_region *region, double noise, double t[3],
                         double *e)
{
    static const double middle[3] = {0.5, 0.5, 0.5};
    double equation[3], step[3];
    for (int r = 0; r < 3; r++)
        equation[r] = search->x[r] * region->centre[3] - region->centre[r];
    mat_apply(region->inverse, equation, step);
    if (is_beyond(step, (1 + region->bound) * *e + noise))
        return false;
    step_from(middle, step, t);
    *e = region->bound * *e + noise;
    return true;
}

/* The result of a step. */
typedef struct stride {
    double t[3], radius; /* the new point, and a bound of its distance to the root */
    sample at;
} stride;

/* Makes a Newton step. Returns false if its certified radius is not below that of the contraction step. */
static bool newton_stride(point_search *search, const cell_region *region, const double t[3],
                          const sample *at, double noise, double shorter, stride *ahead)
{
    double step[3], image[3];
    if (!newton_step(at->jacobian, at->equation, step))
        return false;
    step_from(t, step, ahead->t);
    ffd_search_evaluate_in(search, region, ahead->t, &ahead->at);
    mat_apply(region->inverse, ahead->at.equation, image);
    ahead->radius = (vec_greatest(image) + noise) / (1 - region->bound);
    return ahead->radius <= shorter || ffd_search_accepts(search, region, ahead->t, &ahead->at);
}

/* Invariant: if there is a root, |t - root| <= e. The map t - Y F contracts distances to the root by L,
   clamping does not increase them, and |Y F(t)| is between (1-L) and (1+L) times the distance. */
bool ffd_search_region(point_search *search, const cell_region *region, root *stall)
{
    const double noise = ffd_image_of_tolerance(region->inverse, search->tolerance, region->greatest_weight);
    const double bound = region->bound,
                 least = maximum_number(1e-12, 4 * maximum_number(region->grain, noise));
    double t[3], e = 0.5, image[3];
    sample at;
    if (!leave_centre(search, region, noise, t, &e))
        return true;
    ffd_search_evaluate_in(search, region, t, &at);
    for (int i = 0; i < LEAF_STEPS; i++) {
        stride ahead;
        e = e > least ? e : least;
        if (ffd_search_accepts(search, region, t, &at)) {
            ffd_search_record(search, region, t, &at, false);
            return true;
        }
        mat_apply(region->inverse, at.equation, image);
        if (is_beyond(image, (1 + bound) * e + noise))
            return true;
        const double shorter = bound * e + noise;
        if (!newton_stride(search, region, t, &at, noise, shorter, &ahead)) {
            for (int a = 0; a < 3; a++)
                image[a] = -image[a];
            step_from(t, image, ahead.t);
            ffd_search_evaluate_in(search, region, ahead.t, &ahead.at);
            ahead.radius = shorter;
        }
        const bool unmoved = memcmp(t, ahead.t, sizeof t) == 0;
        memcpy(t, ahead.t, sizeof t);
        at = ahead.at;
        e = ahead.radius;
        if (unmoved)
            break;
    }
    return ffd_search_end(search, region, t, &at, stall);
}
