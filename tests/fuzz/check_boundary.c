/* check_boundary.c - no point of the border that was tried is nearer, and answers repeat to the bit. */
#include "check_boundary.h"
#include "base/vector/vec.h"
#include "embed/boundary/boundary.h"
#include "promise.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* What distances may be off by, relative to the sizes they are made of. */
#define DISTANCE_ERROR 1e-12

static bool is_on_face(const probe *of, const double uvw[3])
{
    for (int a = 0; a < 3; a++)
        if (!ffd_knots_closed(&of->lattice->knots[a]) && (uvw[a] == of->lo[a] || uvw[a] == of->hi[a]))
            return true;
    return false;
}

static bool has_faces(const probe *of)
{
    for (int a = 0; a < 3; a++)
        if (!ffd_knots_closed(&of->lattice->knots[a]))
            return true;
    return false;
}

/* |p - C(uvw)|, and what it may be off by. False where uvw is too coarse, or the
   distance too long, to say. */
static bool distance_to(const probe *of, const double p[3], const double uvw[3], long double *distance,
                        long double *error)
{
    precise_sample sample;
    double miss[3];
    precise_evaluate(of->lattice, FFD_VOLUME_REST, uvw, of->centre, &sample);
    if (!probe_error(of, FFD_VOLUME_REST, uvw, &sample, miss))
        return false;
    long double square = 0;
    *error = 0;
    for (int a = 0; a < 3; a++) {
        const long double apart = (long double)p[a] - of->centre[a] - sample.point[a];
        square += apart * apart;
        /* A box is known better than its control points, which are rounded. */
        *error += miss[a] + DISTANCE_ERROR * of->extent[a] + 4 * DBL_EPSILON * of->magnitude[a];
    }
    *distance = sqrtl(square);
    *error += DISTANCE_ERROR * *distance;
    return *distance <= DBL_MAX;
}

static void check_direction(const double p[3], const boundary_point *nearest)
{
    const double length = vec_length(nearest->direction);
    PROMISE(nearest->distance == 0 ? length == 0 : fabs(length - 1) < 1e-12,
            "at distance %g from %.17g, %.17g, %.17g the direction has length %g", nearest->distance, p[0],
            p[1], p[2], length);
    for (int i = 0; i < 9; i++)
        PROMISE(isfinite(nearest->uvw_by_p[i]), "d u,v,w / d p is not finite");
}

static void check_nearest(const probe *of, const probe_point *points, size_t count, const double p[3],
                          const boundary_point *nearest)
{
    long double distance, error;
    for (int a = 0; a < 3; a++)
        PROMISE(nearest->uvw[a] >= of->lo[a] && nearest->uvw[a] <= of->hi[a],
                "%c = %.17g is not in the domain", "uvw"[a], nearest -> uvw[a]);
    PROMISE(is_on_face(of, nearest->uvw), "%.17g, %.17g, %.17g is on no face", nearest->uvw[0],
            nearest->uvw[1], nearest->uvw[2]);
    if (!of->is_ordinary || !distance_to(of, p, nearest->uvw, &distance, &error))
        return;
    PROMISE(fabsl(distance - nearest->distance) <= error,
            "from %.17g, %.17g, %.17g it is %.17Lg to C(%.17g, %.17g, %.17g), not %.17g", p[0], p[1], p[2],
            distance, nearest->uvw[0], nearest->uvw[1], nearest->uvw[2], nearest->distance);
    for (size_t i = 0; i < count; i++) {
        long double other_error;
        if (!points[i].is_known || !is_on_face(of, points[i].uvw) ||
            !distance_to(of, p, points[i].uvw, &distance, &other_error))
            continue;
        PROMISE(
            nearest->distance <= distance + error + other_error,
            "from %.17g, %.17g, %.17g it is %.17g to the nearest point, but %.17Lg to C(%.17g, %.17g, %.17g)",
            p[0], p[1], p[2], nearest->distance, distance, points[i].uvw[0], points[i].uvw[1],
            points[i].uvw[2]);
    }
}

static bool is_same(const boundary_point *a, const boundary_point *b)
{
    return a->found == b->found && !memcmp(a->uvw, b->uvw, sizeof a->uvw) && a->distance == b->distance &&
           !memcmp(a->direction, b->direction, sizeof a->direction) &&
           !memcmp(a->uvw_by_p, b->uvw_by_p, sizeof a->uvw_by_p);
}

static void find(const boundary *border, const double p[3], double reach, boundary_point *nearest)
{
    ffd_error error;
    PROMISE(ffd_boundary_find(border, p, reach, nearest, &error) == FFD_OK, "%s", error.message);
}

/* A shorter reach changes found only, and no point changes another's answer. */
static void check_again(const boundary *border, const double p[3], const boundary_point *nearest)
{
    boundary_point again;
    find(border, p, HUGE_VAL, &again);
    PROMISE(is_same(nearest, &again), "%.17g, %.17g, %.17g has another answer the second time", p[0], p[1],
            p[2]);
    if (!nearest->found)
        return;
    find(border, p, nearest->distance, &again);
    PROMISE(is_same(nearest, &again),
            "%.17g, %.17g, %.17g has another answer for a reach of its distance %.17g", p[0], p[1], p[2],
            nearest->distance);
    if (nearest->distance > DBL_MIN && nearest->distance <= DBL_MAX) {
        find(border, p, 0.5 * nearest->distance, &again);
        PROMISE(!again.found, "found at %.17g within %.17g", again.distance, 0.5 * nearest->distance);
    }
}

/* A cube that holds the nearest point meets the border, one within the ball as far as that does not. */
static void check_cubes(const boundary *border, const probe *of, const double p[3],
                        const boundary_point *nearest)
{
    const double d = nearest->distance;
    const double large[3] = {1.001 * d, 1.001 * d, 1.001 * d};
    const double small[3] = {0.577 * d, 0.577 * d, 0.577 * d};
    boundary_verdict verdict;
    ffd_error error;
    if (nearest->cut_short || !(d > 1e-9 * of->lattice->diagonal && d < 1e9 * of->lattice->diagonal))
        return;
    PROMISE(ffd_boundary_meets(border, p, large, &verdict, &error) == FFD_OK, "%s", error.message);
    PROMISE(verdict != BOUNDARY_MISSES, "a cube round %.17g, %.17g, %.17g, %.17g from the border, misses it",
            p[0], p[1], p[2], d);
    PROMISE(ffd_boundary_meets(border, p, small, &verdict, &error) == FFD_OK, "%s", error.message);
    PROMISE(verdict != BOUNDARY_MEETS, "a cube round %.17g, %.17g, %.17g, %.17g from the border, meets it",
            p[0], p[1], p[2], d);
}

void check_boundary(const probe *of, const probe_point *points, size_t count)
{
    boundary *border = NULL;
    boundary_point nearest[PROBE_MOST];
    ffd_error error;
    PROMISE(ffd_boundary_create(of->lattice, &border, &error) == FFD_OK, "%s", error.message);
    for (size_t i = 0; i < count; i++) {
        const double *const p = points[i].p;
        find(border, p, HUGE_VAL, &nearest[i]);
        PROMISE(nearest[i].found == (vec_is_finite(p) && has_faces(of)), "found %d for %g, %g, %g",
                nearest[i].found, p[0], p[1], p[2]);
        if (!nearest[i].found)
            continue;
        check_direction(p, &nearest[i]);
        check_nearest(of, points, count, p, &nearest[i]);
    }
    ffd_boundary_destroy(&border);
    PROMISE(!border && ffd_boundary_create(of->lattice, &border, &error) == FFD_OK, "no second boundary");
    /* Every third point, for speed; which ones, the number of points decides. */
    for (size_t i = count; i > 2; i -= 3) {
        check_again(border, points[i - 1].p, &nearest[i - 1]);
        if (nearest[i - 1].found)
            check_cubes(border, of, points[i - 1].p, &nearest[i - 1]);
    }
    ffd_boundary_destroy(&border);
}
