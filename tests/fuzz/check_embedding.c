/* check_embedding.c - u,v,w lead back to their point; displacements lie among those of the control points. */
#include "check_embedding.h"
#include "base/vector/vec.h"
#include "embed/locator.h"
#include "lattice/border.h"
#include "promise.h"
#include <ffd/deform.h>
#include <ffd/embedding.h>
#include <float.h>
#include <math.h>
#include <string.h>

static bool is_placed(const ffd_location *location)
{
    return vec_is_finite(location->uvw);
}

/* 16 eps (max|P_a| + |p_a|), sizes as in the file, whatever the weights are; and those of the origins that
   the library takes: the middle of the control points or a corner of the box. */
static void tolerance_of(const probe *of, bool is_affine, const double p[3], double tolerance[3])
{
    for (int a = 0; a < 3; a++) {
        const double extent = is_affine ? 3 * of->extent[a] : of->extent[a];
        tolerance[a] =
            16 * DBL_EPSILON * fmax(extent + fabs(p[a] - of->centre[a]), of->magnitude[a] + fabs(p[a]));
        /* The box of the file, not its rounded control points, is the map then. */
        if (is_affine)
            tolerance[a] += 4 * DBL_EPSILON * of->magnitude[a];
    }
}

static void check_domain(const probe *of, const double uvw[3])
{
    for (int a = 0; a < 3; a++) {
        const bool closed = ffd_knots_closed(&of->lattice->knots[a]);
        PROMISE(uvw[a] >= of->lo[a] && (closed ? uvw[a] < of->hi[a] : uvw[a] <= of->hi[a]),
                "%c = %.17g is not in the domain %.17g to %.17g", "uvw"[a], uvw[a], of -> lo[a], of -> hi[a]);
    }
}

static void check_residual(const probe *of, bool is_affine, const double p[3], const ffd_location *location)
{
    precise_sample sample;
    double tolerance[3], error[3];
    precise_evaluate(of->lattice, FFD_VOLUME_REST, location->uvw, of->centre, &sample);
    if (!probe_error(of, FFD_VOLUME_REST, location->uvw, &sample, error))
        return;
    tolerance_of(of, is_affine, p, tolerance);
    for (int a = 0; a < 3; a++) {
        const long double residual = fabsl(sample.point[a] - ((long double)p[a] - of->centre[a]));
        PROMISE(
            residual <= tolerance[a] + error[a],
            "%c of C(%.17g, %.17g, %.17g) misses %.17g, %.17g, %.17g by %.3Lg: tolerance %.3g, rounding %.3g",
            "xyz"[a], location -> uvw[0], location -> uvw[1], location -> uvw[2], p[0], p[1], p[2], residual,
            tolerance[a], error[a]);
    }
}

static void check_location(const probe *of, bool is_affine, const double p[3], const ffd_location *location)
{
    PROMISE(location->status < FFD_VERTEX_STATUS_COUNT, "status %d", location->status);
    PROMISE((location->status == FFD_VERTEX_INVALID) == !vec_is_finite(p), "status %d of %g, %g, %g",
            location->status, p[0], p[1], p[2]);
    PROMISE(location->residual >= 0 && (isfinite(location->residual) || !of->is_ordinary), "residual %g",
            location->residual);
    if (!is_placed(location)) {
        PROMISE(isnan(location->uvw[0]) && isnan(location->uvw[1]) && isnan(location->uvw[2]),
                "u,v,w = %g, %g, %g", location->uvw[0], location->uvw[1], location->uvw[2]);
        PROMISE(location->status != FFD_VERTEX_INSIDE && location->status != FFD_VERTEX_MULTIPLE,
                "status %d without u,v,w", location->status);
        PROMISE(location->residual == 0, "residual %g without u,v,w", location->residual);
        return;
    }
    PROMISE(location->status != FFD_VERTEX_OUTSIDE && location->status != FFD_VERTEX_INVALID,
            "status %d with u,v,w", location->status);
    check_domain(of, location->uvw);
    /* Where the search stood still is no root. */
    if (!location->unresolved)
        check_residual(of, is_affine, p, location);
}

/* Whether p, which was rounded, is the point at its u,v,w as the tolerance sees it. */
static bool is_exact(const probe *of, bool is_affine, const double p[3])
{
    if (!of->is_resolved || !of->is_ordinary)
        return false;
    double tolerance[3];
    tolerance_of(of, false, p, tolerance);
    for (int a = 0; a < 3; a++) {
        const double rounding = DBL_EPSILON * (is_affine ? of->magnitude[a] : fabs(p[a]));
        if (!(rounding <= tolerance[a] / 4))
            return false;
    }
    return true;
}

/* How far roots near uvw can be apart and still be one point to the tolerance; HUGE_VAL where J is singular.
 */
static void root_spread(const probe *of, const double p[3], const double uvw[3], double spread[3])
{
    precise_sample sample;
    double tolerance[3], error[3], jacobian[9], inverse[9];
    precise_evaluate(of->lattice, FFD_VOLUME_REST, uvw, of->centre, &sample);
    tolerance_of(of, true, p, tolerance);
    const bool known = probe_error(of, FFD_VOLUME_REST, uvw, &sample, error);
    for (int i = 0; i < 9; i++)
        jacobian[i] = (double)sample.jacobian[i];
    const bool regular = known && mat_invert(jacobian, inverse);
    for (int a = 0; a < 3; a++) {
        spread[a] = 1e-6 * (of->hi[a] - of->lo[a]);
        for (int r = 0; r < 3; r++)
            spread[a] += regular ? 64 * fabs(inverse[3 * a + r]) * (tolerance[r] + error[r]) : HUGE_VAL;
    }
}

static bool is_on_face(const probe *of, int a, double u)
{
    return u - of->lo[a] < 1e-6 * (of->hi[a] - of->lo[a]) || of->hi[a] - u < 1e-6 * (of->hi[a] - of->lo[a]);
}

/* Whether the roots are on the two faces of a seam, whose parameters along the faces may differ. */
static bool is_across_seam(const probe *of, const double here[3], const double there[3])
{
    for (int a = 0; a < 3; a++)
        if (is_on_face(of, a, here[a]) && is_on_face(of, a, there[a]) &&
            fabs(here[a] - there[a]) > 0.5 * (of->hi[a] - of->lo[a]) && ffd_lattice_is_seam(of->lattice, a))
            return true;
    return false;
}

/* "Exactly one u,v,w" cannot be said of a point that was made from another. Faces that are one place are one
   (a bar bent to a ring). */
static void check_only_root(const probe *of, const probe_point *point, const ffd_location *location)
{
    double here[3], there[3];
    if (is_across_seam(of, location->uvw, point->uvw))
        return;
    root_spread(of, point->p, location->uvw, here);
    root_spread(of, point->p, point->uvw, there);
    for (int a = 0; a < 3; a++) {
        const double side = of->hi[a] - of->lo[a];
        double apart = fabs(point->uvw[a] - location->uvw[a]);
        if (ffd_knots_closed(&of->lattice->knots[a]))
            apart = fmin(apart, side - apart);
        if (is_on_face(of, a, point->uvw[a]) && is_on_face(of, a, location->uvw[a]))
            continue;
        PROMISE(apart <= here[a] + there[a],
                "inside at %.17g, %.17g, %.17g only, but the point was made at %.17g, %.17g, %.17g",
                location->uvw[0], location->uvw[1], location->uvw[2], point->uvw[0], point->uvw[1],
                point->uvw[2]);
    }
}

static void check_known(const probe *of, bool is_affine, const probe_point *point,
                        const ffd_location *location)
{
    if (!is_exact(of, is_affine, point->p))
        return;
    PROMISE(location->status != FFD_VERTEX_OUTSIDE, "outside: C(%.17g, %.17g, %.17g) = %.17g, %.17g, %.17g",
            point->uvw[0], point->uvw[1], point->uvw[2], point->p[0], point->p[1], point->p[2]);
    if (location->status == FFD_VERTEX_INSIDE)
        check_only_root(of, point, location);
}

static bool is_same(const ffd_location *a, const ffd_location *b)
{
    return memcmp(a->uvw, b->uvw, sizeof a->uvw) == 0 &&
           memcmp(&a->residual, &b->residual, sizeof a->residual) == 0 && a->status == b->status &&
           a->evaluations == b->evaluations && a->leaves == b->leaves;
}

/* A convex combination of the control points' displacements, and exactly 0 where none of them moved. */
static void check_displacement(const probe *of, const double uvw[3])
{
    const ffd_lattice *const lattice = of->lattice;
    double delta[3], again[3], gradient[9];
    const int reached = ffd_displacement(lattice, uvw, delta, gradient);
    PROMISE(ffd_displacement(lattice, uvw, again, NULL) == reached && !memcmp(delta, again, sizeof delta),
            "the displacement depends on the gradient's being asked for");
    for (int i = 0; i < 9 && !reached; i++)
        PROMISE(gradient[i] == 0 && delta[i / 3] == 0, "a displacement where nothing moved");
    for (int r = 0; r < 3; r++) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (size_t i = 0; i < lattice->count; i++) {
            lo = fmin(lo, lattice->difference[3 * i + (size_t)r]);
            hi = fmax(hi, lattice->difference[3 * i + (size_t)r]);
        }
        const double rounding = 1e-13 * fmax(fabs(lo), fabs(hi)) + 64 * DBL_TRUE_MIN;
        PROMISE(lattice->weights_moved
                    ? isfinite(delta[r])
                    : delta[r] >= fmin(lo, 0) - rounding && delta[r] <= fmax(hi, 0) + rounding,
                "%c of the displacement is %.17g, of the control points %.17g to %.17g", "xyz"[r], delta[r],
                lo, hi);
    }
    for (int i = 0; i < 9 && of->is_ordinary; i++)
        PROMISE(!isnan(gradient[i]), "gradient %d is not a number at %.17g, %.17g, %.17g", i, uvw[0], uvw[1],
                uvw[2]);
}

/* Every second point (for speed) alone, the last first, by a locator that has seen no other. */
static void check_order(const probe *of, const probe_point *points, size_t count,
                        const ffd_location *locations)
{
    ffd_locator *other;
    PROMISE(ffd_locator_create(of->lattice, &other, NULL) == FFD_OK, "no second locator");
    for (size_t left = count; left > 0; left -= left > 1 ? 2 : 1) {
        const size_t i = left - 1;
        ffd_location alone;
        PROMISE(ffd_locator_find(other, points[i].p, 1, &alone, NULL) == FFD_OK, "point %zu alone fails", i);
        PROMISE(is_same(&alone, &locations[i]), "point %zu depends on the others: %.17g, %.17g, %.17g", i,
                points[i].p[0], points[i].p[1], points[i].p[2]);
    }
    ffd_locator_destroy(&other);
    PROMISE(other == NULL, "a destroyed locator is still there");
}

bool check_embedding(const probe *of, const probe_point *points, size_t count)
{
    ffd_locator *locator = NULL;
    ffd_error error;
    ffd_location locations[PROBE_MOST];
    double xyz[3 * PROBE_MOST];
    const ffd_status status = ffd_locator_create(of->lattice, &locator, &error);
    if (status) {
        PROMISE(!locator && (status == FFD_E_INVALID || status == FFD_E_LIMIT), "status %d: %s", status,
                error.message);
        return false;
    }
    const bool is_affine = strcmp(ffd_locator_get_method(locator), "affine") == 0;
    for (size_t i = 0; i < count; i++)
        memcpy(xyz + 3 * i, points[i].p, 3 * sizeof *xyz);
    const ffd_status found = ffd_locator_find(locator, xyz, count, locations, &error);
    PROMISE(found == FFD_OK || found == FFD_E_LIMIT, "status %d: %s", found, error.message);
    for (size_t i = 0; i < count && !found; i++) {
        check_location(of, is_affine, points[i].p, &locations[i]);
        if (points[i].is_known)
            check_known(of, is_affine, &points[i], &locations[i]);
        if (is_placed(&locations[i]))
            check_displacement(of, locations[i].uvw);
    }
    if (!found)
        check_order(of, points, count, locations);
    ffd_locator_destroy(&locator);
    return true;
}
